#pragma once

#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/spectrum.h"
#include "leaf/solve/solver.h"

namespace frond::leaf {

enum class TableMethod : uint8_t {
  monte_carlo,  ///< the paper's: analog walks at every angle
  solve,        ///< without noise
};

/// first, first + step, ... up to last, which counts when it is hit but for rounding; step > 0.
std::vector<double> even_steps(double first, double last, double step);

/// All that a table depends on.
struct TableRequest {
  TissueParams params;
  std::vector<double> wavelengths_nm;
  std::vector<double> theta_deg = even_steps(0, 180, 1);  ///< ascending, in [0, 180]
  TableMethod method = TableMethod::solve;
  int rays = 1'000'000;  ///< for each angle, Monte Carlo only
  int nodes = 0;         ///< for each segment, solutions only; 0: `solver_nodes`
  uint64_t seed = 0;

  friend bool operator==(const TableRequest&, const TableRequest&) = default;
};

/// Rs, Rd and T by angle of incidence and wavelength, made here or measured.
struct Table {
  std::vector<double> theta_deg;  ///< ascending, in [0, 180]; above 90 the abaxial side is lit
  std::vector<double> wavelengths_nm;
  std::vector<Shares> shares = {};           ///< [wavelength][angle]
  std::vector<Shares> standard_errors = {};  ///< likewise; empty where there are none
  /// Largest standard error; of a solved table the discretisation's, at the first, middle and last wavelength; 0 where
  /// nobody knows.
  double error = 0;

  const Shares& at(size_t wavelength, size_t angle) const { return shares[wavelength * theta_deg.size() + angle]; }
  /// Both sides are the same, and the angles end at 90 or before.
  bool has_equal_sides() const { return theta_deg.back() <= 90; }
};

/// The same bits for any number of threads, and for each wavelength whichever others are asked for with it.
Table make_table(const TableRequest& request, const ThreadPool& pool);

/// A table whose sides are the mean of both sides of `table`, which has 180 - theta for every theta.
Table mean_of_sides(const Table& table);

/// Linear between the wavelengths of `table`, in any order, and within their range; a single one stands for all.
Table at_wavelengths(const Table& table, const std::vector<double>& wavelengths_nm);

}  // namespace frond::leaf
