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
// of them; the least of three renders, since other work on the machine only adds to a time. The factor of 2 allows for
// other machines and for the scene: a model that has become much slower or faster than its record says is found.
TEST(LeafCosts, AreThoseOfTheRecordsWithinAFactorOfTwo) {
  const TestFolder folder("leaf_costs");
  const auto models = leaf_models(builtin_registry());
  std::map<std::string_view, double> us;
  for (int round = 0; round < 3; ++round)
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
  for (const MaterialInfo* model : models) {
    const double measured = us[model->name] / us[models.front()->name], stated = model->leaf->cost;
    EXPECT_GT(measured, stated / 2) << model->name;
    EXPECT_LT(measured, stated * 2) << model->name;
  }
}

}  // namespace
}  // namespace frond
