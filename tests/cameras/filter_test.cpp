#include "core/filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/registry.h"
#include "tests/support/bind.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

struct Moments {
  double weight = 0, x = 0, xx = 0;
};

/// Over a stratified grid of u: no random numbers, so the error is that of the grid.
Moments moments(const Filter& filter) {
  constexpr int kSteps = 1000;
  Moments m;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const auto [offset, weight] = filter.sample({(float(i) + 0.5f) / kSteps, (float(j) + 0.5f) / kSteps});
      const double w = double(weight), x = double(offset.x);
      m.weight += w, m.x += w * x, m.xx += w * x * x;
    }
  const double n = double(kSteps) * kSteps;
  return {m.weight / n, m.x / m.weight, m.xx / m.weight};
}

std::unique_ptr<Filter> make(std::string_view name, std::vector<ParsedParam> params = {}) {
  const Registry registry = make_registry({}, {});
  return test::make_plugin(registry.filters.get(name, {}), std::move(params));
}

TEST(Filters, WeightsAverageToOneAndCentreOnThePixel) {
  struct Case {
    std::string_view name;
    double sign_changes;  ///< along an axis
  };
  for (const auto& [name, sign_changes] :
       {Case{"box", 0}, {"triangle", 0}, {"gaussian", 0}, {"mitchell", 2}, {"sinc", 4}}) {
    // A sign that changes within a step of the grid is misplaced by half of it at most; |weight| is below 1.5.
    const double tolerance = 1e-5 + 2 * sign_changes * 1e-3 * 1.5;
    const Moments m = moments(*make(name));
    EXPECT_NEAR(m.weight, 1, tolerance) << name;
    EXPECT_NEAR(m.x, 0, 1e-3) << name;
  }
}

TEST(Filters, SecondMomentsAreThoseOfTheShapes) {
  const auto radii = [](double r) {
    return std::vector{test::number("float", "xradius", {r}), test::number("float", "yradius", {r})};
  };
  EXPECT_NEAR(moments(*make("box", radii(0.5))).xx, 1.0 / 12, 1e-5);
  EXPECT_NEAR(moments(*make("triangle", radii(2))).xx, 4.0 / 6, 1e-4);
  // With a radius of ten deviations nothing is cut off.
  EXPECT_NEAR(moments(*make("gaussian", radii(5))).xx, 0.25, 1e-3);
}

TEST(Filters, MitchellHasItsSecondMoment) {
  // B / 3, in squares of half the radius.
  EXPECT_NEAR(moments(*make("mitchell")).xx, (1.0 / 3) / 3, 5e-3);
}

TEST(Filters, ThatWeighNothingAreRefused) {
  EXPECT_NE(error_of([] { make("gaussian", {test::number("float", "sigma", {1e-6})}); }), "");
}

}  // namespace
}  // namespace frond
