#include "leaf/plates/plate_leaf.h"

#include <gmock/gmock.h>

#include <numbers>

#include "materials/leaf_params.h"
#include "tests/leaf/statistics.h"
#include "tests/materials/support.h"
#include "tests/support/input_error.h"

/// Leaves by PROSPECT's parameters.
namespace frond::test {
namespace {

using test::number;
using ::testing::HasSubstr;

const leaf::PlateLeaf kPlates{{1.5, 40, 8, 0, 0, 0.01, 0.009}};

/// The parameters of kPlates; without `left_out`.
std::vector<ParsedParam> plates(std::string_view left_out = "") {
  std::vector<ParsedParam> params;
  const auto numbers = leaf::plate_numbers();
  for (size_t i = 0; i < numbers.size(); ++i)
    if (numbers[i].name != left_out)
      params.push_back(number("float", std::string(numbers[i].name), {kPlates.values[i]}));
  return params;
}

/// Ready's wavelengths, nm.
constexpr double kNm[] = {608, 551, 455};

TEST(PlateLeafMaterials, HaveItsReflectanceAndTransmittance) {
  const std::vector<leaf::LeafMeasurement> spectra = leaf::plate_spectra(kPlates);
  const Vec3 wo = normalize(Vec3{0, 1, 2}), above = normalize(Vec3{1, 0, 0.02f}), below{0, 0, -1};
  for (const bool back : {false, true}) {
    Ready lambert("leaf_lambert", plates());
    std::vector<ParsedParam> no_surface = plates();
    no_surface.push_back(number("float", "tablesurface", {0}));
    Ready simplified("leaf_simplified", no_surface);
    const float side = back ? -1 : 1;
    RandomStream rng(1);
    for (Ready* leaf : {&lambert, &simplified})
      for (int lane = 0; lane < 3; ++lane) {
        const leaf::LeafMeasurement& m = spectra[static_cast<size_t>(kNm[lane] - 399)];
        EXPECT_NEAR(double(leaf->bsdf().f(wo * side, above * side, rng)[lane]), *m.r / std::numbers::pi, 1e-6);
        EXPECT_NEAR(double(leaf->bsdf().f(wo * side, below * side, rng)[lane]), *m.t / std::numbers::pi, 1e-6);
      }
  }
}

// From 360 nm on, of which PROSPECT knows those from 400.
TEST(PlateLeafMaterials, CoverTheVisible) {
  for (const char* name : {"leaf_lambert", "leaf_simplified", "leaf_solved", "abm"})
    EXPECT_EQ(error_of([&] { Ready(name, plates(), "hero"); }), "") << name;
}

TEST(PlateLeafMaterials, OfTheWalkAreTheNearestLeaf) {
  Resolver resolver;
  for (const char* name : {"leaf_solved", "abm"}) {
    const MaterialInfo& info = material_info(name);
    const LeafParams leaf(Params(info, {name, {}, plates()}, resolver));
    leaf::TissueParams expected = leaf::nearest_walk(kPlates).params;
    EXPECT_EQ(leaf.tissue().number("chlorophylla"), expected.number("chlorophylla")) << name;
    EXPECT_EQ(leaf.tissue().epidermis_aspect, expected.epidermis_aspect) << name;
  }
}

TEST(PlateLeafMaterials, AreDescribedWhole) {
  for (const char* name : {"leaf_lambert", "leaf_solved"}) {
    EXPECT_THAT(error_of([&] { Ready(name, plates("Cab")); }), HasSubstr("a leaf of PROSPECT needs \"Cab\" too"));
    EXPECT_EQ(error_of([&] { Ready(name, plates("Cbrown")); }), "");
    std::vector<ParsedParam> mixed = plates();
    mixed.push_back(number("float", "thickness", {1e-4}));
    EXPECT_THAT(error_of([&] { Ready(name, mixed); }), HasSubstr("\"thickness\" has no effect beside PROSPECT's"));
    mixed.back() = number("float", "cuticleaspect", {3});
    EXPECT_EQ(error_of([&] { Ready(name, mixed); }), "");
  }
  EXPECT_THAT(error_of([&] { Ready("leaf_lambert", {number("float", "Cab", {40})}); }), HasSubstr("needs \"N\" too"));
}

}  // namespace
}  // namespace frond::test
