#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "render/plugins.h"
#include "scene/leaf_models.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

// The selection of models relies on the records' costs, which are means over four scenes (docs/selection.md). Here one
// of them; the least of three renders, or of up to twelve if a cost seems wrong, since other work on the machine only
// adds to a time. The factor of 2 allows for other machines and for the scene: a model that has become much slower or
// faster than its record says is found.
TEST(LeafCosts, AreThoseOfTheRecordsWithinAFactorOfTwo) {
  const TestFolder folder("leaf_costs");
  const auto models = leaf_models(builtin_registry());
  std::map<std::string_view, double> us;
  const auto relative = [&](const MaterialInfo* model) {
    return us[model->name] / us[models.front()->name] / model->leaf->cost;
  };
  const auto is_right = [&](const MaterialInfo* model) { return relative(model) > 0.5 && relative(model) < 2; };
  for (int round = 0; round < 3 || (round < 12 && !std::ranges::all_of(models, is_right)); ++round)
    for (const MaterialInfo* model : models) {
      const Outcome o = frond_command({"render", FROND_SOURCE_DIR "/scenes/hundred-leaves/scene.pbrt", "--swap",
                                       "*=" + quiet_text(*model), "--wavelengths", "hero", "--spp", "4", "--crop",
                                       "0.3,0.7,0.3,0.7", "--threads", "1", "--cache", folder.name_of("cache"), "-q",
                                       "-o", folder.name_of("a.exr"), "--json", "-"});
      ASSERT_EQ(o.code, 0) << o.err;
      const double once = nlohmann::json::parse(o.out)["cpu_us_per_path"];
      const auto [least, is_new] = us.emplace(model->name, once);
      least->second = std::min(least->second, once);
    }
  for (const MaterialInfo* model : models) EXPECT_TRUE(is_right(model)) << model->name << ": " << relative(model);
}

}  // namespace
}  // namespace frond
