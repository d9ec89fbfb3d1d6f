#include "materials/measured/direction_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/sampling.h"
#include "materials/measured/nodes.h"

namespace frond {
namespace {

/// Chooses a cell in proportion to the steps of a cumulative function, and stretches u to [0, 1) in it.
size_t choose(std::span<const float> cumulative, float& u) {
  const float at = u * cumulative.back();
  const auto inner = cumulative.subspan(1, cumulative.size() - 2);
  const auto cell = static_cast<size_t>(std::ranges::upper_bound(inner, at) - inner.begin());
  const float width = cumulative[cell + 1] - cumulative[cell];
  u = width > 0 ? std::clamp((at - cumulative[cell]) / width, 0.f, 1.f) : 0;
  return cell;
}

}  // namespace

DirectionGrid::DirectionGrid(DirectionAxes axes, size_t wavelengths, std::vector<float> values)
    : theta_(std::move(axes.theta)),
      phi_(std::move(axes.phi)),
      wavelengths_(wavelengths),
      slices_(values.size() / (theta_.size() * phi_.size() * wavelengths)),
      values_(std::move(values)) {
  phi_.push_back(phi_.front() + 2 * kPi);
}

DirectionGrid::Place DirectionGrid::place(float theta, float phi) const {
  phi -= 2 * kPi * std::floor((phi - phi_.front()) * (0.5f * kInvPi));
  return {cell_of(theta_, theta), cell_of(phi_, phi)};
}

SampledSpectrum DirectionGrid::value(size_t slice, const Place& place,
                                     const std::array<leaf::AxisCell, kLanes>& lanes) const {
  const auto [theta, s] = place.theta;
  const auto [phi, t] = place.phi;
  SampledSpectrum sum;
  for (const auto& [i, j, weight] : {std::tuple(theta, phi, (1 - s) * (1 - t)), std::tuple(theta, phi + 1, (1 - s) * t),
                                     std::tuple(theta + 1, phi, s * (1 - t)), std::tuple(theta + 1, phi + 1, s * t)}) {
    const float* const spectrum = values_.data() + index(slice, i, j);
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const auto [below, u] = lanes[lane];
      sum[int(lane)] += weight * (u > 0 ? (1 - u) * spectrum[below] + u * spectrum[below + 1] : spectrum[below]);
    }
  }
  return sum;
}

DirectionGrid::Weights DirectionGrid::weights(size_t theta_cell) const {
  const double a = double(theta_[theta_cell]), b = double(theta_[theta_cell + 1]);
  // Integrals of sin cos and theta sin cos.
  const auto zeroth = [](double x) { return std::sin(x) * std::sin(x) / 2; };
  const auto first = [](double x) { return std::sin(2 * x) / 8 - x * std::cos(2 * x) / 4; };
  const double m0 = zeroth(b) - zeroth(a), m1 = first(b) - first(a);
  return {(b * m0 - m1) / (b - a), (m1 - a * m0) / (b - a)};
}

double DirectionGrid::albedo(size_t slice, size_t wavelength) const {
  double sum = 0;
  for (size_t i = 0; i < theta_cells(); ++i) {
    const Weights w = weights(i);
    for (size_t j = 0; j < phi_cells(); ++j) {
      const auto at = [&](size_t theta, size_t phi) { return double(values_[index(slice, theta, phi) + wavelength]); };
      const double width = double(phi_[j + 1] - phi_[j]) / 2;
      sum += width * (w.lower * (at(i, j) + at(i, j + 1)) + w.upper * (at(i + 1, j) + at(i + 1, j + 1)));
    }
  }
  return sum;
}

void DirectionGrid::scale(size_t slice, size_t wavelength, double factor) {
  for (size_t i = 0; i < theta_.size(); ++i)
    for (size_t j = 0; j < phi_cells(); ++j) values_[index(slice, i, j) + wavelength] *= static_cast<float>(factor);
}

void DirectionGrid::make_densities(size_t first_wavelength, size_t last_wavelength) {
  density_.clear(), rows_.clear(), columns_.clear();
  const auto mean = [&](size_t slice, size_t theta, size_t phi) {
    const float* const spectrum = values_.data() + index(slice, theta, phi);
    double sum = 0;
    for (size_t w = first_wavelength; w <= last_wavelength; ++w) sum += double(spectrum[w]);
    return sum / double(last_wavelength - first_wavelength + 1);
  };
  for (size_t slice = 0; slice < slices_; ++slice) {
    double below = 0;
    rows_.push_back(0);
    for (size_t i = 0; i < theta_cells(); ++i) {
      const Weights w = weights(i);
      double row = 0;
      columns_.push_back(0);
      for (size_t j = 0; j < phi_cells(); ++j) {
        const double width = double(phi_[j + 1] - phi_[j]);
        const double cell = width / 2 *
                            (w.lower * (mean(slice, i, j) + mean(slice, i, j + 1)) +
                             w.upper * (mean(slice, i + 1, j) + mean(slice, i + 1, j + 1)));
        density_.push_back(static_cast<float>(cell / (width * w.sum())));
        columns_.push_back(static_cast<float>(row += cell));
      }
      rows_.push_back(static_cast<float>(below += row));
    }
  }
}

float DirectionGrid::density(size_t slice, const Place& place) const {
  return density_[(slice * theta_cells() + place.theta.below) * phi_cells() + place.phi.below];
}

Vec2 DirectionGrid::sample(size_t slice, Vec2 u) const {
  const size_t i = choose(std::span(rows_).subspan(slice * (theta_cells() + 1), theta_cells() + 1), u.y);
  const size_t j =
      choose(std::span(columns_).subspan((slice * theta_cells() + i) * (phi_cells() + 1), phi_cells() + 1), u.x);
  const float a = std::sin(theta_[i]), b = std::sin(theta_[i + 1]);
  return {std::asin(std::min(std::sqrt(a * a + (b * b - a * a) * u.y), 1.f)), phi_[j] + (phi_[j + 1] - phi_[j]) * u.x};
}

}  // namespace frond
