#include <algorithm>
#include <map>
#include <mutex>
#include <stdexcept>

#include "core/leaf_models.h"
#include "materials/leaf_params.h"
#include "materials/registry.h"

namespace frond {
namespace {

constexpr std::string_view kAuto = "auto";

constexpr Param kOwnLeafParams[] = {
    {.name = "model",
     .kind = ParamKind::string,
     .default_value = kAuto,
     .doc = "Leaf model. auto: frond render selects the cheapest that meets maxrms (docs/selection.md); other commands "
            "use leaf_solved, or abm with weighted walks where a texture gives the aspect ratio of an inner wall."},
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
const std::vector<Param> kLeaf = with_leaf_params(kOwnLeafParams);

/// Whether a texture gives the aspect ratio of an inner wall, for which no table holds.
bool has_wall_textures(const Params& p) {
  const LeafParams leaf(p, LeafParams::Plates::table);
  return leaf.epidermis_aspect() || leaf.spongy_aspect() || leaf.palisade_aspect();
}

/// Record of `leaf` for some leaf models: their names are the choices of "model".
class OpenLeaf : public MaterialInfo {
 public:
  explicit OpenLeaf(std::span<const MaterialInfo* const> materials);
  OpenLeaf(const OpenLeaf&) = delete;

  /// Returns the model of this name; for "auto" the cheapest that is exact and takes the textures of `p`.
  const MaterialInfo& chosen(std::string_view model, const Params& p) const;

 private:
  std::vector<const MaterialInfo*> models_;  ///< by cost
  const MaterialInfo* reference_;            ///< nullptr: none
  std::vector<std::string_view> names_{kAuto};
  std::vector<Param> own_params_{kLeaf.begin(), kLeaf.end()};
};

const MaterialInfo& OpenLeaf::chosen(std::string_view model, const Params& p) const {
  if (model != kAuto) return **std::ranges::find(models_, model, [](const MaterialInfo* m) { return m->name; });
  const auto found = std::ranges::find_if(models_, [this, textures = has_wall_textures(p)](const MaterialInfo* m) {
    return reference_ && m->leaf->reference == reference_->name && m->leaf->is_exact &&
           (m->leaf->accepts_wall_textures || !textures);
  });
  if (found == models_.end()) throw std::logic_error("no leaf model is exact and takes textures of walls");
  return **found;
}

/// Does not select a model by its error, since a material has no access to the image: the renderer (docs/selection.md)
/// replaces "auto" by a model's name before the material is made.
std::unique_ptr<Material> make_leaf(const Params& p) {
  // Read so that the parameters count as used; the renderer reads their values.
  (void)p.real("maxrms");
  if (p.given("maxrelativerms")) (void)p.real("maxrelativerms");
  const MaterialInfo& model = static_cast<const OpenLeaf&>(p.info()).chosen(p.string("model"), p);
  const auto& [parameter, value] = model.leaf->quiet;
  std::vector<ParsedParam> quiet;
  if (!parameter.empty())
    quiet.push_back({"string", std::string(parameter), {}, {}, std::vector<std::string>{std::string(value)}});
  return model.make(p.forwarded(model, quiet));
}

OpenLeaf::OpenLeaf(std::span<const MaterialInfo* const> materials)
    : MaterialInfo{{"material",
                    "leaf",
                    "Open leaf: replaced by the cheapest leaf model that meets a stated error of the image.",
                    "docs/selection.md",
                    {}},
                   make_leaf,
                   LeafModel{.is_open = true}},
      models_(leaf_models(materials)),
      reference_(reference_model(materials)) {
  for (const MaterialInfo* m : models_) names_.push_back(m->name);
  std::ranges::find(own_params_, "model", &Param::name)->choices = names_;
  params = own_params_;
}

}  // namespace

const MaterialInfo& open_leaf_of(std::span<const MaterialInfo* const> materials) {
  static std::mutex guard;
  static auto& made = *new std::map<std::vector<const MaterialInfo*>, OpenLeaf>;  // records outlive all registries
  const std::scoped_lock lock(guard);
  return made.try_emplace({materials.begin(), materials.end()}, materials).first->second;
}

}  // namespace frond
