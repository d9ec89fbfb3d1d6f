#include "instruments/errors/convergence.h"

#include <cassert>
#include <cmath>
#include <numeric>

namespace frond {
namespace {

double noise_of(const ConvergencePoint& p, double z) { return p.noise.value + z * p.noise.standard_error; }

/// Effort between two points at which noise reaches `noise`: linear in logarithms.
Effort interpolate_effort(const ConvergencePoint& a, const ConvergencePoint& b, double noise, double z) {
  const double t = std::log(noise_of(a, z) / noise) / std::log(noise_of(a, z) / noise_of(b, z));
  const auto mix = [t](double from, double to) { return from * std::pow(to / from, t); };
  return {mix(a.samples, b.samples), mix(a.seconds, b.seconds), true};
}

}  // namespace

Convergence::Convergence(std::vector<ConvergencePoint> points, MeanSquare bias)
    : points_(std::move(points)), bias_(bias) {
  assert(!points_.empty());
}

std::optional<Effort> Convergence::until_noise(double mean_square, double z) const {
  if (!(mean_square > 0)) return {};
  const ConvergencePoint *first = &points_.front(), *last = &points_.back();
  if (noise_of(*first, z) <= mean_square) return Effort{first->samples, first->seconds, true};
  for (size_t i = 1; i < points_.size(); ++i)
    if (noise_of(points_[i], z) <= mean_square) {
      if (noise_of(points_[i], z) <= 0) return Effort{points_[i].samples, points_[i].seconds, true};
      return interpolate_effort(points_[i - 1], points_[i], mean_square, z);
    }
  const double more = noise_of(*last, z) / mean_square;
  return Effort{last->samples * more, last->seconds * more, false};
}

std::optional<Effort> Convergence::until_rms(double rms, double z) const {
  return until_noise(rms * rms - std::max(0.0, bias_.value + z * bias_.standard_error), z);
}

double Convergence::noise_after(double samples) const {
  const ConvergencePoint *first = &points_.front(), *last = &points_.back();
  if (samples <= first->samples) return first->noise.value * first->samples / samples;
  for (size_t i = 1; i < points_.size(); ++i) {
    const ConvergencePoint &a = points_[i - 1], &b = points_[i];
    if (samples > b.samples || a.noise.value <= 0 || b.noise.value <= 0) continue;
    const double t = std::log(samples / a.samples) / std::log(b.samples / a.samples);
    return a.noise.value * std::pow(b.noise.value / a.noise.value, t);
  }
  return last->noise.value * last->samples / samples;
}

std::optional<Effort> Convergence::until_plateau() const {
  if (bias_.value <= kZ95 * bias_.standard_error) return {};
  return until_noise(bias_.value);
}

std::vector<size_t> pareto_frontier(std::span<const CostAndError> points) {
  std::vector<size_t> order(points.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) {
    return points[i].cost != points[j].cost ? points[i].cost < points[j].cost : points[i].error < points[j].error;
  });
  std::vector<size_t> frontier;
  for (const size_t i : order)
    if (frontier.empty() || points[i].error < points[frontier.back()].error) frontier.push_back(i);
  return frontier;
}

}  // namespace frond
