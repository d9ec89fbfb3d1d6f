#pragma once

#include "core/parallel.h"
#include "leaf/solve/solver.h"
#include "leaf/table/table_axes.h"

namespace frond::leaf {

/// Rs, Rd and T of leaves that differ in the optical depth of their mesophyll alone. Pigments, water, thickness and
/// mesophyll fraction affect light through this one number, so one table serves all points of a leaf on which they
/// vary. The wavelength enters only through the refractive indices.
struct DepthTable {
  std::vector<double> theta_deg;  ///< ascending, in [0, 180]
  std::vector<double> wavelengths_nm;
  DepthAxis depths;
  std::vector<Shares> shares = {};  ///< [wavelength][depth][angle]
};

/// Solves the table by `solve_depths`; `model` gives everything except the depth.
DepthTable make_depth_table(const TissueModel& model, const std::vector<double>& theta_deg,
                            const std::vector<double>& wavelengths_nm, const DepthAxis& depths, const ThreadPool& pool);

}  // namespace frond::leaf
