#include "scene/leaf_models.h"

#include <gmock/gmock.h>

#include "core/log.h"
#include "render/plugins.h"
#include "scene/format/parser.h"

namespace frond {
namespace {

using ::testing::ElementsAre;

class LeafModels : public ::testing::Test {
 protected:
  SceneDescription described(const std::string& world) const {
    return parse_scene_text("WorldBegin\n" + world, "s.pbrt", silent_log());
  }
  Registry registry_ = builtin_registry();
};

TEST_F(LeafModels, FollowFromTheRecords) {
  std::vector<std::string> names;
  for (const MaterialInfo* model : leaf_models(registry_)) names.emplace_back(model->name);
  EXPECT_THAT(names, ElementsAre("leaf_lambert", "leaf_simplified", "leaf_solved", "abm"));
  EXPECT_EQ(open_leaf(registry_).name, "leaf");
  EXPECT_EQ(reference_model(registry_).name, "abm");
  EXPECT_EQ(noiseless_model(registry_).name, "leaf_solved");
  EXPECT_EQ(model_with(LeafModel::Table::shares, registry_).name, "leaf_simplified");
  EXPECT_EQ(model_with(LeafModel::Table::modes, registry_).name, "leaf_solved");
  EXPECT_EQ(quiet_text(reference_model(registry_)), "abm,mode=weighted");
  EXPECT_EQ(quiet_text(noiseless_model(registry_)), "leaf_solved");
}

TEST_F(LeafModels, AMixtureIsALeafIfItMixesOne) {
  // Mixtures may name materials that are defined later, and each other.
  const SceneDescription d = described(R"(
MakeNamedMaterial "twice" "string type" "mix" "string materials" ["half" "stone"]
MakeNamedMaterial "half" "string type" "mix" "string materials" ["stone" "blade"]
MakeNamedMaterial "stone" "string type" "diffuse"
MakeNamedMaterial "blade" "string type" "leaf_lambert"
MakeNamedMaterial "stones" "string type" "mix" "string materials" ["stone" "stone"]
MakeNamedMaterial "a" "string type" "mix" "string materials" ["b" "b"]
MakeNamedMaterial "b" "string type" "mix" "string materials" ["a" "a"]
)");
  std::map<std::string, int> flags;
  const auto found = leaf_flags(d, registry_);
  for (size_t i = 0; i < found.size(); ++i) flags[d.materials[i].name] = found[i];
  EXPECT_EQ(flags["twice"] + flags["half"] + flags["blade"], 3);
  EXPECT_EQ(flags["stone"] + flags["stones"] + flags["a"] + flags["b"], 0);
  std::vector<std::string> leaves;
  for (const size_t i : leaf_materials(d, registry_)) leaves.push_back(d.materials[i].name);
  EXPECT_THAT(leaves, ElementsAre("blade"));
}

// Materials are not made for it: a swap of all leaves also replaces one that could not be made.
TEST_F(LeafModels, AreFoundWithoutMakingAMaterial) {
  const SceneDescription d = described("Material \"leaf_simplified\" \"string tablefile\" \"missing.csv\"\n");
  EXPECT_THAT(leaf_materials(d, registry_), ElementsAre(d.materials.size() - 1));
}

}  // namespace
}  // namespace frond
