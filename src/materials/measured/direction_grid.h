#pragma once

#include <array>
#include <vector>

#include "core/math/vec.h"
#include "core/spectrum.h"
#include "leaf/table/table_axes.h"

namespace frond {

/// Directions of a hemisphere at which a function is known: all combinations of polar angles and azimuths.
struct DirectionAxes {
  std::vector<float> theta;  ///< radians from the pole, ascending from 0 to pi / 2
  std::vector<float> phi;    ///< radians, ascending in [0, 2 pi); one or more
};

/// Spectra over a hemisphere, one function in each slice, interpolated bilinearly in polar angle and azimuth. All
/// integrals are of the interpolated functions, weighted by the cosine.
class DirectionGrid {
 public:
  /// Cell of a direction.
  struct Place {
    leaf::AxisCell theta, phi;
  };

  DirectionGrid() = default;
  /// `values`: from 0, [slice][theta][phi][wavelength].
  DirectionGrid(DirectionAxes axes, size_t wavelengths, std::vector<float> values);

  /// Whether there are no functions: nothing is scattered to this hemisphere.
  bool empty() const { return values_.empty(); }
  /// `phi` in any turn.
  Place place(float theta, float phi) const;
  SampledSpectrum value(size_t slice, const Place& place, const std::array<leaf::AxisCell, kLanes>& lanes) const;
  /// Integral of a function times the cosine, at one wavelength.
  double albedo(size_t slice, size_t wavelength) const;
  void scale(size_t slice, size_t wavelength, double factor);

  /// Makes densities for sampling: of the mean of the functions at these wavelengths, constant times the cosine in each
  /// cell.
  void make_densities(size_t first_wavelength, size_t last_wavelength);
  /// Integral of the mean function times the cosine.
  float total(size_t slice) const { return rows_[(slice + 1) * theta_cells() + slice]; }
  /// Density of `sample` times `total`, over the cosine, 1/sr.
  float density(size_t slice, const Place& place) const;
  /// Returns theta and phi; `total` is not 0.
  Vec2 sample(size_t slice, Vec2 u) const;

 private:
  size_t theta_cells() const { return theta_.size() - 1; }
  size_t phi_cells() const { return phi_.size() - 1; }
  size_t index(size_t slice, size_t theta, size_t phi) const {
    return ((slice * theta_.size() + theta) * phi_cells() + phi % phi_cells()) * wavelengths_;
  }
  /// Integrals of the cosine over a cell, for interpolation between its lower and its upper polar angle.
  struct Weights {
    double lower, upper;
    double sum() const { return lower + upper; }
  };
  Weights weights(size_t theta_cell) const;

  std::vector<float> theta_, phi_;  ///< phi_: also the first one a turn later
  size_t wavelengths_ = 0, slices_ = 0;
  std::vector<float> values_;
  std::vector<float> density_;  ///< [slice][theta cell][phi cell]
  std::vector<float> rows_;     ///< cumulative integrals, [slice][theta cell + 1]
  std::vector<float> columns_;  ///< the same within a row, [slice][theta cell][phi cell + 1]
};

}  // namespace frond
