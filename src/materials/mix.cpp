#include "core/material.h"
#include "core/texture.h"
#include "materials/lobes/mixture.h"

namespace frond {
namespace {

constexpr Param kMix[] = {
    {.name = "materials",
     .kind = ParamKind::material,
     .doc = "Names of two materials; with \"select\" of any number.",
     .list = true,
     .required = true},
    {.name = "amount",
     .kind = ParamKind::float_texture,
     .default_value = 0.5,
     .range = {0, 1},
     .doc = "Share of the second material."},
    {.name = "select",
     .kind = ParamKind::float_texture,
     .range = {0, 1},
     .doc =
         "Selects one of the materials instead of a blend: of n materials the first below 1/n, the next below 2/n, and "
         "so on. The texture \"instance\" selects one for each instance.",
     .in_place_of_others = true},
};

// Material "mix". pbrt-v4 chooses one material at random at each hit; here both are evaluated, which has less noise and
// the same mean.
class Mix final : public Material {
 public:
  explicit Mix(const Params& p) : materials_(p.materials("materials")), amount_(p.float_texture("amount")) {
    if (p.given("select")) select_ = p.float_texture("select");
    if (select_ && p.given("amount")) fail(p.where("amount"), "\"amount\" has no effect beside \"select\"");
    if (select_ ? materials_.empty() : materials_.size() != 2)
      fail(p.where("materials"), "\"materials\" takes 2 names, {} given; with \"select\" any number",
           materials_.size());
  }

  void prepare(const Preparation& preparation) override {
    for (const auto& material : materials_) material->prepare(preparation);
  }

  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    if (select_) {
      const float at = select_->evaluate(hit.at) * float(materials_.size());
      const auto index = static_cast<size_t>(std::max(0.f, at));
      return materials_[std::min(index, materials_.size() - 1)]->evaluate(hit, lambda, arena);
    }
    const float amount = std::clamp(amount_->evaluate(hit.at), 0.f, 1.f);
    // The ends are the materials themselves, with their exact flags and densities.
    if (amount == 0) return materials_[0]->evaluate(hit, lambda, arena);
    if (amount == 1) return materials_[1]->evaluate(hit, lambda, arena);
    const Bsdf* first = materials_[0]->evaluate(hit, lambda, arena);
    const Bsdf* second = materials_[1]->evaluate(hit, lambda, arena);
    if (!first && !second) return nullptr;
    // A material without a surface transmits its share of the light unchanged.
    if (!first) first = arena.make<PassThroughBsdf>(lambda);
    if (!second) second = arena.make<PassThroughBsdf>(lambda);
    return arena.make<MixtureBsdf>(*first, *second, amount);
  }

  /// Not claimed if either refracts: unless the other has the same index or is opaque, which materials do not report,
  /// no index of the mixture makes both reciprocal.
  bool is_reciprocal() const override {
    return std::ranges::all_of(materials_, &Material::is_reciprocal) && !refracts();
  }
  bool refracts() const override { return std::ranges::any_of(materials_, &Material::refracts); }

 private:
  std::vector<std::shared_ptr<Material>> materials_;
  std::shared_ptr<const FloatTexture> amount_, select_;
};

}  // namespace

extern const MaterialInfo mix_material{
    {"material", "mix", "Blend of two materials, or a selection of one of many.", "pbrt-v4", kMix}, make_material<Mix>};

}  // namespace frond
