#pragma once

#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/spectrum.h"
#include "leaf/solve/solver.h"

namespace frond::leaf {

/// How a leaf table is computed.
enum class TableMethod : uint8_t {
  monte_carlo,  ///< the paper's method: analog walks at every angle
  solve,        ///< without noise
};

/// Returns first, first + step, ... up to `last`, which is included if it is a step apart from rounding; step > 0.
std::vector<double> even_steps(double first, double last, double step);

/// Input of `make_table`.
struct TableRequest {
  TissueParams params;
  std::vector<double> wavelengths_nm;
  std::vector<double> theta_deg = even_steps(0, 180, 1);  ///< ascending, in [0, 180]
  TableMethod method = TableMethod::solve;
  int rays = 1'000'000;  ///< per angle, Monte Carlo only
  int nodes = 0;         ///< per segment, solutions only; 0: `solver_nodes`
  uint64_t seed = 0;

  friend bool operator==(const TableRequest&, const TableRequest&) = default;
};

/// Leaf table: Rs, Rd and T by angle of incidence and wavelength, computed or measured.
struct Table {
  std::vector<double> theta_deg;  ///< ascending, in [0, 180]; above 90 the abaxial side is lit
  std::vector<double> wavelengths_nm;
  std::vector<Shares> shares = {};           ///< [wavelength][angle]
  std::vector<Shares> standard_errors = {};  ///< as `shares`; empty if unknown
  /// Largest standard error. Of a solved table: the discretisation error, at the first, middle and last wavelength. 0
  /// if unknown.
  double error = 0;

  const Shares& at(size_t wavelength, size_t angle) const { return shares[wavelength * theta_deg.size() + angle]; }
  /// Whether the table holds for both sides: its angles end at 90 degrees or before.
  bool has_equal_sides() const { return theta_deg.back() <= 90; }
};

/// Computes the table. Bitwise equal for any number of threads; a wavelength's values do not depend on the others
/// requested.
Table make_table(const TableRequest& request, const ThreadPool& pool);

/// Returns a table whose sides are the mean of both sides of `table`, which has 180 - theta for every theta.
Table mean_of_sides(const Table& table);

/// Returns the table at other wavelengths, in any order and within its range: linear between them; a table of one
/// wavelength is constant.
Table at_wavelengths(const Table& table, const std::vector<double>& wavelengths_nm);

}  // namespace frond::leaf
