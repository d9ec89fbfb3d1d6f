#include "leaf/tissue/leaf_numbers.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "leaf/tissue/absorption.h"
#include "leaf/tissue/specimens.h"

namespace frond::leaf {
namespace {

/// A number that keys of caches lack would serve the table of another leaf.
TEST(LeafNumbers, EachOneChangesTheKeyOfACache) {
  const TissueParams leaf = find_specimen("soybean")->params;
  std::set<std::string> keys{describe(leaf)};
  for (const LeafNumber& n : leaf_parameters()) {
    TissueParams other = leaf;
    n.value(other) += 0.01;
    // Tables of reflectance and transmittance hold for any fluorescence.
    EXPECT_EQ(keys.insert(describe(other)).second, n.action != LeafAction::emission) << n.name;
    EXPECT_FALSE(other == leaf) << n.name;
  }
  for (const auto change : {+[](TissueParams& p) { p.structure = Structure::unifacial; },
                            +[](TissueParams& p) { p.absorption_tables = AbsorptionTables::prospect; },
                            +[](TissueParams& p) { p.sieve_and_detour = true; },
                            +[](TissueParams& p) {
                              p.pigments = {{1, std::vector<double>(429, 2)}};
                            }}) {
    TissueParams other = leaf;
    change(other);
    EXPECT_TRUE(keys.insert(describe(other)).second) << describe(other);
  }
}

/// Caches and table files of earlier versions keep their keys.
TEST(LeafNumbers, HeadsOfTablesAreThoseOfEarlierVersions) {
  EXPECT_EQ(describe(find_specimen("maize")->params),
            "# structure unifacial, thickness 0.000204 m, mesophyll fraction 0.8\n"
            "# kg/m3: chlorophyll a 2.895146, b 0.79866, carotenoids 0.658895, protein 53.08714, cellulose 53.18709, "
            "lignin 6.05853; else 1/m 0\n"
            "# aspect ratios: cuticle 10, epidermis 5, spongy 5, palisade 5; sieve and detour false\n");
  EXPECT_EQ(describe(find_specimen("autumn")->params),
            "# structure bifacial, thickness 8.906e-05 m, mesophyll fraction 0.5\n"
            "# kg/m3: chlorophyll a 0.8552, b 0.2497, carotenoids 0.8634, protein 0, cellulose 0, lignin 0; else 1/m "
            "671.4\n"
            "# aspect ratios: cuticle 5, epidermis 0.7, spongy 3.356, palisade 1.595; sieve and detour true\n"
            "# PROSPECT-D's absorption " +
                fmt::format("{:016x}", prospect_hash()) +
                ": all, kg/m3: anthocyanins 0.4352, dry matter 1500\n"
                "# brown pigments 18590 1/m\n"
                "# share below the air space 0.2919\n"
                "# relative refractivity of the cuticle 0.8863\n");
}

TEST(LeafNumbers, HaveNamesOfTheirOwnAndWhatFitsNeed) {
  std::set<std::string_view> names;
  for (const LeafNumber& n : kLeafNumbers) {
    EXPECT_TRUE(names.insert(n.name).second) << n.name;
    EXPECT_EQ(find_leaf_number(n.name), &n);
    EXPECT_EQ(n.is_parameter(), n.range.min < n.range.max) << n.name;
    if (n.is_fitted()) {
      // A search varies logarithms.
      EXPECT_GT(n.fit_range.min, 0) << n.name;
      EXPECT_TRUE(n.range.contains(n.fit_range.min) && n.range.contains(n.fit_range.max)) << n.name;
    }
    if (n.follows.empty()) continue;
    const LeafNumber* leader = find_leaf_number(n.follows);
    ASSERT_TRUE(leader && leader->is_fitted()) << n.name;
    for (const double nm : {430.0, 551.0, 2100.0})
      EXPECT_EQ(specific_absorption(n, AbsorptionTables::baranoski, nm),
                specific_absorption(*leader, AbsorptionTables::baranoski, nm))
          << n.name;
  }
  EXPECT_EQ(find_leaf_number("chlorophyll"), nullptr);
}

TEST(LeafNumbers, ContentsAreThoseOfTheirParts) {
  std::vector<std::string_view> names;
  for (const AreaContent& c : area_contents()) names.push_back(c.name);
  EXPECT_EQ(names, (std::vector<std::string_view>{"chlorophyll", "carotenoids", "anthocyanins", "brownpigments",
                                                  "water", "drymatter"}));
  const TissueParams& p = find_specimen("soybean")->params;
  EXPECT_NEAR(area_content(p, area_contents()[0]) * kMicrogramsPerCm2.per_kg_per_m2, 42.65, 0.01);
  EXPECT_NEAR(area_content(p, area_contents()[4]) * kGramsPerCm2.per_kg_per_m2, 0.0083, 1e-6);
}

}  // namespace
}  // namespace frond::leaf
