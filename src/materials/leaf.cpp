#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/material.h"
#include "materials/leaf_params.h"

namespace frond {

extern const MaterialInfo abm_material;
extern const MaterialInfo leaf_lambert_material;
extern const MaterialInfo leaf_simplified_material;
extern const MaterialInfo leaf_solved_material;

namespace {

constexpr std::string_view kAuto = "auto";

/// A leaf model; kLadder orders them from the cheapest to the most accurate.
struct Model {
  std::string_view name;
  const MaterialInfo* info;
};
constexpr std::array kLadder{Model{"leaf_lambert", &leaf_lambert_material},
                             Model{"leaf_simplified", &leaf_simplified_material},
                             Model{"leaf_solved", &leaf_solved_material}, Model{"abm", &abm_material}};

constexpr auto kModels = [] {
  std::array<std::string_view, kLadder.size() + 1> names{kAuto};
  std::ranges::transform(kLadder, names.begin() + 1, &Model::name);
  return names;
}();
constexpr Param kOwn[] = {
    {.name = "model",
     .kind = ParamKind::string,
     .default_value = kAuto,
     .doc = "Leaf model. auto: frond render selects the cheapest that meets maxrms (docs/selection.md); other commands "
            "use leaf_solved, or abm with weighted walks where a texture gives the aspect ratio of an inner wall.",
     .choices = kModels},
    {.name = "maxrms",
     .kind = ParamKind::real,
     .default_value = 0.01,
     .range = {1e-6, 1},
     .doc =
         "Largest RMS error of the image that the model may cause, in linear SMPTE-C (white: 1). It has no effect if "
         "only maxrelativerms is given."},
    {.name = "maxrelativerms",
     .kind = ParamKind::real,
     .range = {1e-6, 1},
     .doc = "The same error relative to each channel's mean over the image, such as 0.02."},
};
constexpr auto kLeaf = with_leaf_params(kOwn);

/// Whether a texture gives the aspect ratio of an inner wall, for which no table holds.
bool has_wall_textures(const Params& p) {
  const LeafParams leaf(p);
  return leaf.epidermis_aspect() || leaf.spongy_aspect() || leaf.palisade_aspect();
}

/// The material of a model; for "auto", `leaf_solved`, or `abm` for the leaves that it refuses.
const MaterialInfo& material_of(std::string_view model, const Params& p) {
  if (model == kAuto) return has_wall_textures(p) ? abm_material : leaf_solved_material;
  const auto found = std::ranges::find(kLadder, model, &Model::name);
  if (found == kLadder.end()) throw std::logic_error("no leaf model is called " + std::string(model));
  return *found->info;
}

ParsedParam weighted_walks() { return {"string", "mode", {}, {}, std::vector<std::string>{"weighted"}}; }

/// Does not select a model, since a material has no access to the image: the renderer (docs/selection.md) replaces
/// "auto" by a model's name before the material is made.
std::unique_ptr<Material> make_leaf(const Params& p) {
  // Read so that the parameters count as used; the renderer reads their values.
  (void)p.real("maxrms");
  if (p.given("maxrelativerms")) (void)p.real("maxrelativerms");
  const MaterialInfo& info = material_of(p.string("model"), p);
  const bool walks = &info == &abm_material;
  return info.make(p.forwarded(info, walks ? std::vector{weighted_walks()} : std::vector<ParsedParam>{}));
}

}  // namespace

extern const MaterialInfo leaf_material{
    {"material", "leaf", "Open leaf: replaced by the cheapest leaf model that meets a stated error of the image.",
     "docs/selection.md", kLeaf},
    make_leaf};

}  // namespace frond
