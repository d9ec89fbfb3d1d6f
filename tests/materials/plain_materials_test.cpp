#include <gmock/gmock.h>

#include "tests/materials/support.h"
#include "tests/support/input_error.h"

namespace frond::test {
namespace {

using ::testing::HasSubstr;

TEST(DiffuseTransmission, ScalesDownWhatWouldGiveOffMoreThanItGets) {
  Ready much("diffusetransmission", {level("reflectance", 0.9), level("transmittance", 0.6)});
  RandomStream rng(1);
  const Vec3 up{0, 0, 1};
  EXPECT_FLOAT_EQ(much.bsdf().f(up, up, rng)[0], 0.6f * kInvPi);
  EXPECT_FLOAT_EQ(much.bsdf().f(up, -up, rng)[0], 0.4f * kInvPi);
}

TEST(DiffuseTransmission, AllowsPeaksAtDifferentWavelengths) {
  const ParsedParam red = {"spectrum", "reflectance", {}, {}, std::vector<double>{300, 0, 590, 0, 600, 0.9, 3000, 0.9}};
  const ParsedParam blue = {
      "spectrum", "transmittance", {}, {}, std::vector<double>{300, 0.9, 500, 0.9, 510, 0, 3000, 0}};
  EXPECT_EQ(error_of([&] { Ready("diffusetransmission", {red, blue}); }), "");
}

TEST(Diffuse, NamesTheDataThatDoNotReachTheWavelengths) {
  const ParsedParam narrow = {"spectrum", "reflectance", {}, {}, std::vector<double>{500, 0.5, 600, 0.5}};
  EXPECT_THAT(error_of([&] { Ready("diffuse", {narrow}); }), HasSubstr("\"reflectance\" is known from 500 to 600 nm"));
}

TEST(Mix, TakesTwoMaterials) {
  EXPECT_THAT(error_of([] { Ready("mix", {words("materials", {"diffuse"})}); }), HasSubstr("takes 2 names, 1 given"));
  EXPECT_THAT(error_of([] { Ready("mix", {}); }), HasSubstr("needs parameter"));
}

TEST(Mix, IsTheWeightedSum) {
  Ready mix("mix", {words("materials", {"diffuse", "diffusetransmission"}), test::number("float", "amount", {0.25})});
  RandomStream rng(1);
  const Vec3 wo = normalize(Vec3{0.3f, 0, 1}), up = normalize(Vec3{0, 0.5f, 1}), down = -up;
  EXPECT_FLOAT_EQ(mix.bsdf().f(wo, up, rng)[0], (0.75f * 0.5f + 0.25f * 0.25f) * kInvPi);
  EXPECT_FLOAT_EQ(mix.bsdf().f(wo, down, rng)[0], 0.25f * 0.25f * kInvPi);
}

TEST(Mix, SelectsOneOfManyMaterials) {
  const auto f = [](const char* select) {
    Ready mix("mix", {words("materials", {"diffuse", "diffusetransmission", "diffuse"}), texture("select", {select})});
    RandomStream rng(1);
    return mix.bsdf().f(Vec3{0, 0, 1}, Vec3{0, 0, 1}, rng)[0] * kPi;
  };
  for (const char* select : {"0:0", "0.33:0.33", "0.67:0.67", "1:1"}) EXPECT_FLOAT_EQ(f(select), 0.5f) << select;
  for (const char* select : {"0.34:0.34", "0.66:0.66"}) EXPECT_FLOAT_EQ(f(select), 0.25f) << select;
  EXPECT_THAT(error_of([] {
                Ready("mix", {words("materials", {"diffuse", "diffuse"}), texture("select", {"0:1"}),
                              test::number("float", "amount", {0.5})});
              }),
              HasSubstr("\"amount\" has no effect beside \"select\""));
}

}  // namespace
}  // namespace frond::test
