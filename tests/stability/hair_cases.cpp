#include <numbers>

#include "tests/stability/cases.h"
#include "tests/stability/comparison.h"
#include "tests/stability/specimen.h"

namespace frond::stability {
namespace {

using test::level;
using test::Ready;
using test::real;

constexpr double kOffsets[] = {0, 0.02, 0.5, 0.9, 1};                         ///< texture coordinate v
constexpr double kAngles_deg[] = {0, 60, -89, 89.9, -89.9999, 89.99999, 90};  ///< against the plane normal to the fibre

/// 1000 samples at each offset and angle: numbers, f and pdf of `f` and `pdf`, and weights of `white`, or at most 1.
Cell samples_of(const Parameters& params, bool white) {
  Comparison comparison(2e-5);
  try {
    Ready ready("hair", params);
    RandomStream rng(1);
    for (const double v : kOffsets)
      for (const double angle : kAngles_deg) {
        const double theta = angle * std::numbers::pi / 180;
        const Vec3 wo{float(std::sin(theta)), float(0.6 * std::cos(theta)), float(0.8 * std::cos(theta))};
        const Bsdf& bsdf = ready.bsdf({0, float(v)});
        for (int i = 0; i < 1000; ++i) {
          const auto s = bsdf.sample(wo, rng.uniform(), {rng.uniform(), rng.uniform()}, rng);
          if (!s) continue;
          comparison.require(s->f.is_physical() && s->pdf > 0 && std::isfinite(s->pdf), "a sample is no number");
          comparison.require(s->pdf == bsdf.pdf(wo, s->wi) && s->f == bsdf.f(wo, s->wi, rng),
                             "f and pdf of a sample are not those of its direction");
          const double weight = double(s->f[0]) * double(std::abs(s->wi.z)) / double(s->pdf);
          if (white)
            comparison.add("weight of a sample", weight, 1);
          else
            comparison.require(weight < 1 + 2e-5, "a sample weighs more than 1");
        }
      }
  } catch (const InputError& error) {
    comparison.require(false, error.what());
  }
  return comparison.cell();
}

}  // namespace

Theme hair() {
  Theme theme{"Hair",
              "Material `hair` at the offsets 0, 0.02, 0.5, 0.9 and 1 across the fibre, for light at up to 90 degrees "
              "from the plane normal to it. Without absorption every sample has the weight 1."};
  const auto add = [&](std::string name, Parameters params) {
    const ParsedParam nothing_absorbs = level("sigma_a", 0);
    Parameters white = params;
    white.push_back(nothing_absorbs);
    theme.add(name + ", no absorption", "each sample weighs 1").add(Method::hair, samples_of(white, true));
    params.push_back(level("sigma_a", 0.5));
    theme.add(std::move(name), "samples are numbers, none above 1").add(Method::hair, samples_of(params, false));
  };
  add("defaults", {});
  add("smooth: beta_m = beta_n = 0", {real("beta_m", 0), real("beta_n", 0)});
  add("rough: beta_m = beta_n = 1", {real("beta_m", 1), real("beta_n", 1)});
  add("eta = 1", {real("eta", 1)});
  add("eta = 10", {real("eta", 10)});
  add("alpha = 90", {real("alpha", 90)});
  add("alpha = -90, smooth", {real("alpha", -90), real("beta_m", 0)});
  theme.add("sigma_a = 1e30", "samples are numbers, none above 1")
      .add(Method::hair, samples_of({level("sigma_a", 1e30)}, false));
  theme.add("reflectance = 0", "samples are numbers, none above 1")
      .add(Method::hair, samples_of({level("reflectance", 0)}, false));
  const auto refuse = [&](std::string name, ParsedParam param, const std::string& part) {
    theme.add(std::move(name), expect_refusal(part)).add(Method::hair, refusal(part, [&] {
                                                           Ready("hair", {std::move(param)});
                                                         }));
  };
  refuse("eta = 0.9", real("eta", 0.9), "outside its range 1 to 10");
  refuse("beta_m = 1.5", real("beta_m", 1.5), "outside its range 0 to 1");
  refuse("beta_n below 0", real("beta_n", -0.1), "outside its range 0 to 1");
  refuse("alpha = 91", real("alpha", 91), "outside its range -90 to 90 deg");
  refuse("eumelanin below 0", real("eumelanin", -1), "outside its range 0 to inf");
  refuse("pheomelanin NaN", real("pheomelanin", NAN), "finite numbers are needed");
  return theme;
}

}  // namespace frond::stability
