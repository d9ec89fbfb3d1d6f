#include "core/material.h"
#include "materials/leaf_params.h"

namespace frond {

extern const MaterialInfo abm_material;
extern const MaterialInfo leaf_lambert_material;
extern const MaterialInfo leaf_simplified_material;
extern const MaterialInfo leaf_solved_material;

namespace {

/// After the first, the ladder: from the cheapest to the most accurate.
constexpr std::string_view kModels[] = {"auto", "leaf_lambert", "leaf_simplified", "leaf_solved", "abm"};
constexpr Param kOwn[] = {
    {.name = "model",
     .kind = ParamKind::string,
     .default_value = std::string_view("auto"),
     .doc = "The material that stands for the leaf; auto: frond render takes the cheapest that meets maxrms "
            "(docs/choosing.md), all else takes abm, by weighted walks.",
     .choices = kModels},
    {.name = "maxrms",
     .kind = ParamKind::real,
     .default_value = 0.01,
     .range = {1e-6, 1},
     .doc = "Largest RMS error of the picture that the model may cause, in linear SMPTE-C, where white is 1."},
};
constexpr auto kLeaf = with_leaf_params(kOwn);

const MaterialInfo& material_of(std::string_view model) {
  for (const MaterialInfo* info : {&leaf_lambert_material, &leaf_simplified_material, &leaf_solved_material})
    if (info->name == model) return *info;
  return abm_material;
}

ParsedParam weighted_walks() { return {"string", "mode", {}, {}, std::vector<std::string>{"weighted"}}; }

/// A material cannot see the picture, so it does not choose: who can writes down what was chosen as "model".
std::unique_ptr<Material> make_leaf(const Params& p) {
  (void)p.real("maxrms");
  const MaterialInfo& info = material_of(p.string("model"));
  const bool walks = &info == &abm_material;
  return info.make(p.forwarded(info, walks ? std::vector{weighted_walks()} : std::vector<ParsedParam>{}));
}

}  // namespace

extern const MaterialInfo leaf_material{
    {"material", "leaf", "Leaf by the cheapest model that is accurate enough for the picture.", "docs/choosing.md",
     kLeaf},
    make_leaf};

}  // namespace frond
