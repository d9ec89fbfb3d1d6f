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

/// The ladder: from the cheapest to the most accurate.
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
     .doc = "The material that stands for the leaf; auto: frond render takes the cheapest that meets maxrms "
            "(docs/choosing.md), all else takes abm, by weighted walks, or, of a reciprocal leaf, leaf_solved.",
     .choices = kModels},
    {.name = "maxrms",
     .kind = ParamKind::real,
     .default_value = 0.01,
     .range = {1e-6, 1},
     .doc = "Largest RMS error of the image that the model may cause, in linear SMPTE-C, where white is 1."},
};
constexpr auto kLeaf = with_leaf_params(kOwn);

const MaterialInfo& material_of(std::string_view model, bool is_reciprocal) {
  if (model == kAuto) return is_reciprocal ? leaf_solved_material : abm_material;
  const auto found = std::ranges::find(kLadder, model, &Model::name);
  if (found == kLadder.end()) throw std::logic_error("no leaf model is called " + std::string(model));
  return *found->info;
}

ParsedParam weighted_walks() { return {"string", "mode", {}, {}, std::vector<std::string>{"weighted"}}; }

/// A material cannot see the image, so it does not choose: who can writes down what was chosen as "model".
std::unique_ptr<Material> make_leaf(const Params& p) {
  (void)p.real("maxrms");
  const MaterialInfo& info = material_of(p.string("model"), p.string("incident") == "reciprocal");
  const bool walks = &info == &abm_material;
  return info.make(p.forwarded(info, walks ? std::vector{weighted_walks()} : std::vector<ParsedParam>{}));
}

}  // namespace

extern const MaterialInfo leaf_material{
    {"material", "leaf", "Leaf by the cheapest model that is accurate enough for the image.", "docs/choosing.md",
     kLeaf},
    make_leaf};

}  // namespace frond
