#include "leaf/table/depth_map.h"

#include <gtest/gtest.h>

#include "leaf/tissue/absorption.h"
#include "leaf/tissue/specimens.h"
#include "leaf/tissue/tissue.h"
#include "tests/support/ramp.h"

namespace frond::leaf {
namespace {

using test::Ramp;

SampledWavelengths wavelengths() {
  SampledWavelengths lambda;
  lambda.nm = {452.3f, 608, 717.9f, 1931};
  lambda.active = {true, true, true, true};
  lambda.count = 4;
  return lambda;
}

double depth_of(const TissueParams& params, float lambda_nm) {
  const TissueModel model(params);
  return model.at(double(lambda_nm)).optical_depth[2];
}

TEST(DepthMap, IsTheModelsDepthEverywhere) {
  TissueParams leaf = find_specimen("soybean")->params;
  leaf.pigments.push_back({2, std::vector<double>(kAbsorptionGrid.size(), 30)});
  const std::vector<DepthMap::Varying> varying{
      {[](TissueParams& t) -> double& { return t.number("chlorophyllb"); }, std::make_shared<Ramp>(0.f, 2.f)},
      {[](TissueParams& t) -> double& { return t.number("lignin"); }, std::make_shared<Ramp>(5.f, 500.f)},
      {[](TissueParams& t) -> double& { return t.pigments[0].concentration; }, std::make_shared<Ramp>(1.f, 3.f)},
      {[](TissueParams& t) -> double& { return t.thickness_m; }, std::make_shared<Ramp>(1e-4f, 2e-4f)},
      {[](TissueParams& t) -> double& { return t.mesophyll_fraction; }, std::make_shared<Ramp>(0.25f, 1.f)}};
  const DepthMap map(leaf, varying);
  EXPECT_FALSE(map.is_constant());
  const SampledWavelengths lambda = wavelengths();
  for (const float u : {0.f, 0.25f, 1.f}) {
    for (const auto& [number, texture] : varying) number(leaf) = double(texture->evaluate({u, 0}));
    const auto depth = map.at({u, 0}, lambda);
    for (size_t i = 0; i < kLanes; ++i) {
      EXPECT_NEAR(depth[i], depth_of(leaf, lambda.nm[i]), 1e-12 * depth[i]) << u << " " << lambda.nm[i];
      const Interval range = map.range(double(lambda.nm[i]));
      const double bound = u < 1 ? range.min : range.max;
      if (u == 0 || u == 1) {
        EXPECT_NEAR(bound, depth[i], 1e-12 * depth[i]);
      }
    }
  }
}

TEST(DepthMap, IsConstantWithoutTextures) {
  const TissueParams& leaf = find_specimen("maize")->params;
  const DepthMap map(leaf, {});
  EXPECT_TRUE(map.is_constant());
  EXPECT_DOUBLE_EQ(map.at({0.3f, 0.7f}, wavelengths())[1], depth_of(leaf, 608));
}

}  // namespace
}  // namespace frond::leaf
