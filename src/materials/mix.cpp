#include "core/material.h"
#include "core/texture.h"
#include "materials/lobes/mixture.h"

namespace frond {
namespace {

constexpr Param kMix[] = {
    {.name = "materials",
     .kind = ParamKind::material,
     .doc = "The names of two materials.",
     .list = true,
     .required = true},
    {.name = "amount",
     .kind = ParamKind::float_texture,
     .default_value = 0.5,
     .range = {0, 1},
     .doc = "Share of the second material."},
};

class Mix final : public Material {
 public:
  explicit Mix(const Params& p) : materials_(p.materials("materials")), amount_(p.float_texture("amount")) {
    if (materials_.size() != 2) fail(p.where("materials"), "\"materials\" takes 2 names, {} given", materials_.size());
  }

  void prepare(const Preparation& preparation) override {
    for (const auto& material : materials_) material->prepare(preparation);
  }

  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    const float amount = std::clamp(amount_->evaluate(hit.at), 0.f, 1.f);
    if (amount == 0) return materials_[0]->evaluate(hit, lambda, arena);
    if (amount == 1) return materials_[1]->evaluate(hit, lambda, arena);
    const Bsdf* first = materials_[0]->evaluate(hit, lambda, arena);
    const Bsdf* second = materials_[1]->evaluate(hit, lambda, arena);
    if (!first && !second) return nullptr;
    if (!first) first = arena.make<PassThroughBsdf>(lambda);
    if (!second) second = arena.make<PassThroughBsdf>(lambda);
    return arena.make<MixtureBsdf>(*first, *second, amount);
  }

  /// Not claimed where either refracts: unless the other does the same or is opaque, which materials do not say, no
  /// index of the mixture makes both reciprocal.
  bool is_reciprocal() const override {
    return materials_[0]->is_reciprocal() && materials_[1]->is_reciprocal() && !refracts();
  }
  bool refracts() const override { return materials_[0]->refracts() || materials_[1]->refracts(); }
  bool is_leaf() const override { return materials_[0]->is_leaf() || materials_[1]->is_leaf(); }

 private:
  std::vector<std::shared_ptr<Material>> materials_;
  std::shared_ptr<const FloatTexture> amount_;
};

}  // namespace

extern const MaterialInfo mix_material{{"material", "mix", "Two materials at once.", "pbrt-v4", kMix},
                                       make_material<Mix>};

}  // namespace frond
