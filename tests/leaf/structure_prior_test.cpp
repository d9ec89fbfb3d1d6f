#include "leaf/fit/structure_prior.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "leaf/fit/measured_spectra.h"

namespace frond::leaf {
namespace {

/// The seven measured leaves of tests/reference, by name.
std::map<std::string, FitRequest> reference_leaves() {
  std::map<std::string, FitRequest> leaves;
  for (const char* file : {"lopex93_leaves.csv", "davis_leaves.csv", "lopex93_soybean.csv"})
    for (MeasuredLeaf& leaf :
         read_measured_leaves(std::string(FROND_SOURCE_DIR "/tests/reference/") + file, SpectraMeasurement{}))
      leaves[leaf.name].measurements = std::move(leaf.spectra.measurements);
  return leaves;
}

FitRequest reflectance_of(FitRequest leaf) {
  for (LeafMeasurement& m : leaf.measurements) m.t.reset();
  return leaf;
}

const FittedContent& content(const FitResult& result, std::string_view name) {
  return *std::ranges::find(result.contents, name, &FittedContent::name);
}

const FittedNumber& number(const FitResult& result, std::string_view name) {
  return *std::ranges::find_if(result.numbers, [name](const FittedNumber& n) { return n.variable->name == name; });
}

TEST(StructurePrior, IsThatOfTheReferenceLeaves) {
  std::vector<FitRequest> leaves;
  for (auto& [name, leaf] : reference_leaves()) leaves.push_back(std::move(leaf));
  ASSERT_EQ(leaves.size(), 7u);
  ASSERT_EQ(prior_numbers().size(), built_in_prior().mean.size());
  const StructurePrior learned = learn_prior(leaves, ""), &built_in = built_in_prior();
  for (size_t i = 0; i < prior_numbers().size(); ++i) {
    EXPECT_NEAR(learned.mean[i], built_in.mean[i], 0.002) << prior_numbers()[i]->name;
    EXPECT_NEAR(learned.deviation[i], built_in.deviation[i], 0.002) << prior_numbers()[i]->name;
  }
  EXPECT_NEAR(learned.error, built_in.error, 1e-4);
  EXPECT_NEAR(learned.reach_nm, built_in.reach_nm, 1);
}

/// Of R alone without a prior the chlorophyll of these leaves is 1.3 to 1.5 times that of R and T, water likewise.
TEST(StructurePrior, MakesContentsOfReflectanceAloneThoseOfBoth) {
  auto leaves = reference_leaves();
  for (const char* name : {"tomato_0000", "lettuce_0000"}) {
    const FitResult both = fit_leaf(leaves[name], ThreadPool(1));
    const FitResult alone = fit_leaf(reflectance_of(leaves[name]), ThreadPool(1));
    EXPECT_EQ(both.prior, nullptr);
    EXPECT_EQ(alone.prior, &built_in_prior());
    EXPECT_FALSE(number(alone, "spongyaspect").is_identified());
    for (const auto& [of, share] : {std::pair("chlorophyll", 0.15), std::pair("water", 0.1)}) {
      const double off = std::log(content(alone, of).kg_per_m2 / content(both, of).kg_per_m2);
      EXPECT_LT(std::abs(off), share) << name << " " << of;
      EXPECT_LT(content(alone, of).relative_error, 0.3) << name << " " << of;
    }
  }
}

TEST(StructurePrior, IsForOneQuantityAndOneKindOfLeaf) {
  FitRequest both;
  for (const double nm : {500.0, 600.0}) both.measurements.push_back({nm, 8, 0.1, 0.2});
  FitRequest r = reflectance_of(both), t = both;
  for (LeafMeasurement& m : t.measurements) m.r.reset();
  EXPECT_EQ(used_prior(both), nullptr);
  EXPECT_EQ(used_prior(r), &built_in_prior());
  EXPECT_EQ(used_prior(t), &built_in_prior());
  r.structure = Structure::unifacial;
  EXPECT_EQ(used_prior(r), nullptr);
  r.structure = Structure::bifacial, r.sieve = false;
  EXPECT_EQ(used_prior(r), nullptr);
  r.sieve = true;
  EXPECT_EQ(used_prior(r), &built_in_prior());
  r.has_prior = true;
  EXPECT_EQ(used_prior(r), nullptr);
  t.absorption_tables = AbsorptionTables::baranoski;
  EXPECT_EQ(used_prior(t), nullptr);
}

/// A number that is given needs no prior, even where its coordinate is that of none.
TEST(StructurePrior, LeavesWhatIsFixed) {
  FitRequest request = reflectance_of(reference_leaves()["tomato_0000"]);
  request.fixed = {{"otherabsorption", 0}, {"spongyshare", 0.1}};
  const FitResult result = fit_leaf(request, ThreadPool(1));
  EXPECT_EQ(result.params.number("otherabsorption"), 0);
  EXPECT_EQ(result.params.spongy_share, 0.1);
  EXPECT_LT(result.rmse, 0.01);
  EXPECT_FALSE(number(result, "spongyshare").is_of_prior);
}

}  // namespace
}  // namespace frond::leaf
