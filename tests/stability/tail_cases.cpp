#include <cmath>

#include "core/math/sampling.h"
#include "tests/stability/cases.h"
#include "tests/stability/comparison.h"
#include "tests/stability/specimen.h"

namespace frond::stability {
namespace {

constexpr double kTailNm = 551;

/// Sample weights (factors of a path's throughput) for paths that arrive uniformly from all directions.
struct Weights {
  double largest = 0;
  double share_of_largest = 0;  ///< of the sum of squares
};

Weights weights_of(const Bsdf& bsdf) {
  constexpr int kSamples = 1 << 20;
  Weights result;
  RandomStream rng(7);
  double squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    const float a = rng.uniform(), b = rng.uniform();
    Vec3 wo = sample_cosine_hemisphere({a, b});
    if (rng.uniform() < 0.5f) wo.z = -wo.z;
    const float uc = rng.uniform(), u = rng.uniform(), v = rng.uniform();
    const auto s = bsdf.sample(wo, uc, {u, v}, rng);
    if (!s) continue;
    const double weight = double(s->f[0]) * std::abs(double(s->wi.z)) / double(s->pdf);
    squares += weight * weight;
    result.largest = std::max(result.largest, weight);
  }
  result.share_of_largest = squares > 0 ? result.largest * result.largest / squares : 0;
  return result;
}

Cell bounded(const Weights& w) {
  constexpr double kMost = 6, kShare = 1e-4;
  return {fmt::format("weights up to {}", rounded_up(w.largest)), w.largest > kMost || w.share_of_largest > kShare};
}

Cell unbounded(const Weights& w) {
  constexpr double kLeast = 15;  // grows like the square root of the number of samples
  return {fmt::format("weights up to {}; one has a share of {} of the squares", rounded_up(w.largest),
                      rounded_up(w.share_of_largest)),
          w.largest < kLeast};
}

Specimen leaf(std::string_view material, const std::string& specimen, const std::string& incident) {
  return {material, {test::words("specimen", {specimen}), test::words("incident", {incident})}, kTailNm};
}

}  // namespace

Theme tails() {
  Theme theme{
      "Sample weights",
      "Weights f |cos| / pdf of a million samples at 551 nm, for paths that arrive uniformly from all directions. "
      "With \"incident\" \"light\", f grows like 1 / cos toward grazing views and the squared weight has no finite "
      "mean: the noise of images with light between leaves does not converge ([leaf models](../leaf_models.md))."};
  for (const std::string specimen : {"soybean", "maize"})
    for (const std::string incident : {"traced", "light", "reciprocal"}) {
      const bool settles = incident != "light";
      Row& row =
          theme.add(fmt::format("{}, incident {}", specimen, incident),
                    settles ? "bounded, no weight above 6" : "not bounded, except for lambert, whose f is constant");
      for (const auto& [method, name] : kLeafMaterials) {
        if (method == Method::abm && incident == "reciprocal") {
          row.add(method, refusal("reciprocal", [&] { leaf("abm", specimen, incident); }));
          continue;
        }
        Specimen made = leaf(name, specimen, incident);
        const Weights weights = weights_of(made.bsdf());
        row.add(method, settles || method == Method::lambert ? bounded(weights) : unbounded(weights));
      }
    }
  return theme;
}

}  // namespace frond::stability
