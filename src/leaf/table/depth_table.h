#pragma once

#include "core/parallel.h"
#include "leaf/solve/solver.h"
#include "leaf/table/table_axes.h"

namespace frond::leaf {

/// Rs, Rd and T of leaves that differ in the optical depth of their mesophyll alone. Pigments, water, thickness and the
/// mesophyll's part of it act on light through this one number, so that a leaf on which they vary needs no table for
/// each of its points. The wavelength enters beside it through the refractive indices alone.
struct DepthTable {
  std::vector<double> theta_deg;  ///< ascending, in [0, 180]
  std::vector<double> wavelengths_nm;
  DepthAxis depths;
  std::vector<Shares> shares = {};  ///< [wavelength][depth][angle]
};

/// Solved. `model` gives all but the depth.
DepthTable make_depth_table(const TissueModel& model, const std::vector<double>& theta_deg,
                            const std::vector<double>& wavelengths_nm, const DepthAxis& depths, const ThreadPool& pool);

}  // namespace frond::leaf
