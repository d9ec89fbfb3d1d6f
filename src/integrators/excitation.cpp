#include "integrators/excitation.h"

#include <numeric>

namespace frond {
namespace {

constexpr double kStep_nm = 5;
constexpr auto kCells = static_cast<size_t>((kExcitation_nm.max - kExcitation_nm.min) / kStep_nm);

/// Returns the weights of the cells: means over points 1 nm apart, so that the lines of a lamp are not missed.
std::vector<float> weights_of(const std::function<double(double)>& photons) {
  constexpr double kUniform = 0.1;
  std::vector<double> weights(kCells);
  for (size_t i = 0; i < kCells; ++i)
    for (double nm = 0.5; nm < kStep_nm; ++nm)
      weights[i] += std::max(0.0, photons(kExcitation_nm.min + double(i) * kStep_nm + nm));
  const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / double(kCells);
  std::vector<float> result;
  for (const double w : weights) result.push_back(mean > 0 ? float(std::lerp(w / mean, 1.0, kUniform)) : 1);
  return result;
}

}  // namespace

ExcitationSampler::ExcitationSampler(const std::function<double(double)>& photons) : cells_(weights_of(photons)) {}

SampledWavelengths ExcitationSampler::sample(float u) const {
  SampledWavelengths lambda;
  lambda.count = kLanes;
  for (size_t i = 0; i < kLanes; ++i) {
    float turned = u + float(i) / kLanes;
    turned -= turned < 1 ? 0.f : 1.f;
    const auto [cell, fraction, probability] = cells_.sample(turned);
    lambda.nm[i] = float(kExcitation_nm.min + (double(cell) + double(fraction)) * kStep_nm);
    lambda.pdf[i] = probability / float(kStep_nm);
    lambda.active[i] = true;
  }
  return lambda;
}

}  // namespace frond
