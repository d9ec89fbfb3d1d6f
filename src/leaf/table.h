#pragma once

#include <string>
#include <vector>

#include "core/parallel.h"
#include "leaf/solver.h"

namespace frond::leaf {

enum class TableMethod : uint8_t {
  monte_carlo,  ///< the paper's: analog walks at every degree
  solve,        ///< without noise
};

/// All that a table depends on.
struct TableRequest {
  TissueParams params;
  std::vector<double> wavelengths_nm;  ///< ascending where it shall be interpolated
  TableMethod method = TableMethod::solve;
  int rays = 1'000'000;  ///< for each degree, Monte Carlo only
  uint64_t seed = 0;

  friend bool operator==(const TableRequest&, const TableRequest&) = default;
};

/// Rs, Rd and T at every degree of incidence in [0, 180] (above 90 the abaxial side is lit).
struct Table {
  static constexpr size_t kDegrees = 181;

  std::vector<double> wavelengths_nm;
  std::vector<Shares> shares;  ///< [wavelength][degree]
  double error = 0;  ///< largest standard error; of a solved table, the discretisation's, seen at the middle wavelength

  const Shares& at(size_t wavelength, size_t degree) const { return shares[wavelength * kDegrees + degree]; }
};

/// The same bits for any number of threads, and for each wavelength whichever others are asked for with it.
Table make_table(const TableRequest& request, const ThreadPool& pool);

}  // namespace frond::leaf
