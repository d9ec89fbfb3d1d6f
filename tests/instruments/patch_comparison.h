#pragma once

#include <gtest/gtest.h>

#include <limits>

#include "instruments/goniophotometer.h"

namespace frond::test {

/// Deviation of the patches' ray counts from their expectations.
struct PatchComparison {
  ChiSquare chi_square;         ///< over patches and the rays that none has caught
  double largest = 0;           ///< difference of one patch in standard errors: of a normal variable that is as rare
  double l2 = 0, l2_noise = 0;  ///< relative L2 difference of f over the sphere, and what the rays' noise makes of it
};

/// A binomial count as the normal variable of the same chance.
inline double score(double count, double rays, double probability) {
  const double p = binomial_p(static_cast<int64_t>(count), static_cast<int64_t>(rays), probability, probability);
  if (p == 0) return std::numeric_limits<double>::infinity();
  return p < 1 ? normal_upper_quantile(p / 2) : 0;
}

/// All exitant rays must have weight 1, as in an analog walk: then the counts are multinomial, and the exact integrals
/// determine their variances too.
inline PatchComparison compare(const GoniophotometerMeasurement& walked, const GoniophotometerMeasurement& exact) {
  PatchComparison result;
  const auto rays = static_cast<double>(walked.rays);
  std::vector<double> observed, expected;
  double lost = rays, missing = 1, difference = 0, noise = 0, whole = 0;
  for (size_t i = 0; i < walked.sphere.size(); ++i) {
    const double share = exact.integral[i], count = static_cast<double>(walked.count(i));
    EXPECT_EQ(walked.caught[i].mean() * count, count);
    observed.push_back(count), expected.push_back(share * rays);
    lost -= count, missing -= share;
    result.largest = std::max(result.largest, score(count, rays, share));
    const Patch patch = walked.sphere.patch(i);
    const double weight = patch.solid_angle / (patch.projected_solid_angle * patch.projected_solid_angle);
    difference += weight * (count / rays - share) * (count / rays - share);
    noise += weight * share * (1 - share) / rays;
    whole += weight * share * share;
  }
  observed.push_back(lost), expected.push_back(missing * rays);
  result.chi_square = chi_square(observed, expected);
  result.l2 = std::sqrt(difference / whole), result.l2_noise = std::sqrt(noise / whole);
  return result;
}

}  // namespace frond::test
