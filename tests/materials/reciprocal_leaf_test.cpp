#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>

#include "leaf/solve/quadrature.h"
#include "tests/materials/support.h"
#include "tests/support/input_error.h"
#include "tests/support/slow.h"

/// "string incident" "reciprocal"
namespace frond::test {
namespace {

using ::testing::HasSubstr;

struct Case {
  std::string material;
  std::vector<ParsedParam> params;
  std::string wavelengths = "smpte";
};

ParsedParam number(std::string name, double value) {
  return {"float", std::move(name), {}, {}, std::vector<double>{value}};
}

std::string name_of(const Case& c) {
  std::string name = c.material + ", " + c.wavelengths;
  for (const ParsedParam& p : c.params) {
    name += ", " + p.name;
    if (const auto* words = std::get_if<std::vector<std::string>>(&p.values)) name += " " + words->front();
    if (const auto* numbers = std::get_if<std::vector<double>>(&p.values)) name += fmt::format(" {}", numbers->front());
  }
  return name;
}

std::vector<Case> cases() {
  std::vector<Case> result;
  for (const std::string specimen : {"soybean", "maize"})
    for (const std::string wavelengths : {"smpte", "hero"})
      for (const std::string material : {"leaf_solved", "leaf_simplified", "leaf_lambert"})
        result.push_back({material, {words("specimen", {specimen})}, wavelengths});
  for (const std::string material : {"leaf_solved", "leaf_simplified"}) {
    for (const std::string wavelengths : {"smpte", "hero"}) {
      result.push_back({material, {texture("chlorophylla", {"0.1:9"})}, wavelengths});
      result.push_back({material, {texture("cuticleaspect", {"0.5:40"})}, wavelengths});
    }
    for (const double aspect : {0.0, 0.3, 300.0}) result.push_back({material, {number("cuticleaspect", aspect)}});
    result.push_back({material, {number("mesophyllfraction", 0)}});
    result.push_back({material, {number("thickness", 1e-2)}});
  }
  result.push_back({"leaf_solved", {number("epidermisaspect", 0.5), number("spongyaspect", 20)}});
  // Tables over the spectrum take long: without --slow, wavelengths that vary are tried once for each material.
  std::set<std::string> tried;
  std::erase_if(result, [&](const Case& c) {
    return c.wavelengths == "hero" && !tried.insert(c.material).second && !slow_tests();
  });
  return result;
}

Case with(Case c, const std::string& incident) {
  c.params.push_back(words("incident", {incident}));
  return c;
}
Ready ready(const Case& c) { return {c.material, c.params, c.wavelengths}; }

/// The case with `incident` "reciprocal", prepared once for all tests.
Ready& reciprocal(const Case& c) {
  static std::map<std::string, std::unique_ptr<Ready>> prepared;
  std::unique_ptr<Ready>& leaf = prepared[name_of(c)];
  const Case of = with(c, "reciprocal");
  if (!leaf) leaf = std::make_unique<Ready>(of.material, of.params, of.wavelengths);
  return *leaf;
}

Vec3 direction(double cosine, double phi) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {float(sine * std::cos(phi)), float(sine * std::sin(phi)), float(cosine)};
}

constexpr Vec2 kSomewhere{0.3f, 0.6f};

TEST(ReciprocalLeaf, GivesBackWhatItTakesToTheLastBit) {
  const int kPairs = slow_tests() ? 2000 : 400;
  for (const Case& c : cases()) {
    Ready& leaf = reciprocal(c);
    EXPECT_TRUE(leaf.material().is_reciprocal());
    const Bsdf& bsdf = leaf.bsdf(kSomewhere);
    RandomStream rng(1);
    int different = 0;
    const auto any = [&] {
      const double u = rng.uniform_double(), cosine = rng.uniform() < 0.3f ? std::pow(u, 8) : u;
      return direction(rng.uniform() < 0.5f ? cosine : -cosine, 6.3 * rng.uniform_double());
    };
    for (int i = 0; i < kPairs; ++i) {
      const Vec3 a = any(), b = any();
      if (bsdf.f(a, b, rng) != bsdf.f(b, a, rng)) ++different;
    }
    EXPECT_EQ(different, 0) << name_of(c);
  }
}

/// Integral of f |cos theta_i| over all wi, by lane.
SampledSpectrum albedo(const Bsdf& bsdf, const Vec3& wo) {
  constexpr int kAzimuths = 96;
  static const auto rule = leaf::gauss_legendre(96);
  std::array<double, kLanes> sums{};
  RandomStream rng(0);
  for (const auto& [x, weight] : rule)
    for (const double side : {-1.0, 1.0})
      for (int k = 0; k < kAzimuths; ++k) {
        const double theta = x * double(kPi) / 2, cosine = std::cos(theta);
        const SampledSpectrum f = bsdf.f(wo, direction(side * cosine, 2 * double(kPi) * (k + 0.5) / kAzimuths), rng);
        const double whole = weight * double(kPi) / 2 * std::sin(theta) * cosine * 2 * double(kPi) / kAzimuths;
        for (size_t lane = 0; lane < kLanes; ++lane) sums[lane] += whole * double(f[int(lane)]);
      }
  SampledSpectrum sum;
  for (size_t lane = 0; lane < kLanes; ++lane) sum[int(lane)] = float(sums[lane]);
  return sum;
}

/// Surface lobes for which this quadrature is too coarse (narrow, or bright at the cut) are tested in
/// tests/leaf/surface_scaling_test.cpp.
bool is_within_quadrature(const Case& c) {
  const auto* numbers = std::get_if<std::vector<double>>(&c.params.back().values);
  return c.params.back().name != "cuticleaspect" || !numbers || (numbers->front() >= 1 && numbers->front() <= 100);
}

// Twice as far where walls inside have lobes with an edge, which the solution itself is good to 1e-3 for.
TEST(ReciprocalLeaf, GivesBackAsMuchAsTheModelFromEveryDirection) {
  const auto angles_deg =
      slow_tests() ? std::vector{0.0, 13.0, 31.0, 47.0, 62.0, 74.0, 83.0, 87.5, 89.5} : std::vector{13.0, 62.0, 87.5};
  for (const Case& c : cases()) {
    if (!is_within_quadrature(c)) continue;
    Ready model = ready(with(c, "traced"));
    Ready& leaf = reciprocal(c);
    const double tolerance = c.params.front().name == "epidermisaspect" ? 2e-4 : 1e-4;
    for (const double theta_deg : angles_deg) {
      for (const double side : {-1.0, 1.0}) {
        const Vec3 wo = direction(side * std::cos(theta_deg * double(kPi) / 180), 0.3);
        const SampledSpectrum a = albedo(model.bsdf(kSomewhere), wo), b = albedo(leaf.bsdf(kSomewhere), wo);
        for (int lane = 0; lane < leaf.lambda().count; ++lane)
          EXPECT_NEAR(double(a[lane]), double(b[lane]), tolerance) << name_of(c) << ", " << theta_deg << ", " << side;
      }
    }
  }
}

TEST(ReciprocalLeaf, SamplesHaveBoundedWeights) {
  constexpr float kMost = 6;
  for (const Case& c : cases()) {
    Ready& leaf = reciprocal(c);
    const Bsdf& bsdf = leaf.bsdf(kSomewhere);
    RandomStream rng(2);
    float largest = 0;
    for (const double cosine : {1e-6, 1e-3, 0.03, 0.2, 0.6, 1.0})
      for (const double side : {-1.0, 1.0}) {
        const Vec3 wo = direction(side * cosine, 1);
        for (int i = 0; i < 2000; ++i) {
          const float uc = rng.uniform(), u = rng.uniform(), v = rng.uniform();
          const auto s = bsdf.sample(wo, uc, {u, v}, rng);
          if (!s) continue;
          for (int lane = 0; lane < leaf.lambda().count; ++lane)
            largest = std::max(largest, s->f[lane] * std::abs(s->wi.z) / s->pdf);
        }
      }
    EXPECT_LT(largest, kMost) << name_of(c);
  }
}

TEST(ReciprocalLeaf, IsRefusedByTheWalk) {
  EXPECT_THAT(error_of([] { Ready("abm", {words("incident", {"reciprocal"})}); }),
              ::testing::AllOf(HasSubstr("reciprocal"), HasSubstr("light")));
}

TEST(ReciprocalLeaf, IsSolvedWhereNothingIsChosen) {
  Ready leaf("leaf", {words("incident", {"reciprocal"})}), solved("leaf_solved", {words("incident", {"reciprocal"})});
  RandomStream rng(3);
  const Vec3 a = direction(0.4, 1), b = direction(-0.8, 2);
  EXPECT_EQ(leaf.bsdf().f(a, b, rng), solved.bsdf().f(a, b, rng));
}

}  // namespace
}  // namespace frond::test
