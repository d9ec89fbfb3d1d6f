// Materials of the command line: abm,specimen=maize, and *=leaf,specimen=maize.

#include "jobs/record/common_params.h"
#include "render/measured_material.h"
#include "render/plugins.h"
#include "scene/resolver.h"
#include "scene/scene.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(material_words, bytes) {
  static const Registry registry = builtin_registry();
  static const JobInfo& job = find_job("render");
  (void)fuzz::folder();
  const std::string text(bytes);
  fuzz::accepts([&] {
    SceneDescription scene = scene_of_materials(registry);
    const auto wavelengths = make_wavelengths(scene, registry);
    scene.materials.push_back({"", parse_material(text, registry).plugin});
    material_seed(text);
    const auto material = SceneResolver(scene, registry, *wavelengths).material(scene.materials.size() - 1);
    fuzz::require(material != nullptr, "a material is made");
  });
  fuzz::accepts([&] {
    SceneDescription scene = scene_of_materials(registry);
    Arguments args(params_of(job), command_spelling);
    args.set("swap", text);
    apply_overrides(overrides_of(args), scene, registry, silent_log());
    fuzz::require(scene.materials.size() == scene_of_materials(registry).materials.size(), "a swap adds no material");
  });
}
