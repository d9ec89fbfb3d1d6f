#include "core/material.h"
#include "core/sampling.h"
#include "leaf/walk.h"
#include "materials/leaf_params.h"

namespace frond {
namespace {

using leaf::Tissue;

constexpr std::string_view kModes[] = {"analog", "weighted"};
constexpr Param kOwn[] = {
    {.name = "mode",
     .kind = ParamKind::string,
     .default_value = std::string_view("analog"),
     .doc = "Absorption: analog kills whole rays, as published; weighted takes a share of each, with the same mean.",
     .choices = kModes},
};
constexpr auto kAbm = with_leaf_params(kOwn);

/// Closer than this to the surface's plane, a direction counts as in it.
constexpr float kLeastCosine = 1e-20f;

Vec3d in_double(const Vec3& w) { return normalize(Vec3d{w.x, w.y, w.z}); }

/// Walks through the leaf, one wavelength each: refraction differs by wavelength, so no walk serves two. `f` walks once
/// for every lane; `sample` walks for one lane, drawn evenly, and leaves the others black.
class AbmBsdf final : public Bsdf {
 public:
  /// A tissue for each active lane, nullptr for the others.
  AbmBsdf(const std::array<const Tissue*, kLanes>& tissues, leaf::Absorption absorption)
      : tissues_(tissues), absorption_(absorption) {
    for (int lane = 0; lane < kLanes; ++lane)
      if (tissue(lane)) active_[static_cast<size_t>(count_++)] = lane;
  }

  Lobes flags() const override {
    return Lobes::reflection | Lobes::transmission | Lobes::diffuse | Lobes::glossy | Lobes::surface |
           Lobes::stochastic;
  }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const override {
    SampledSpectrum f;
    if (wo.z == 0 || std::abs(wi.z) < kLeastCosine) return f;
    const Vec3d o = in_double(wo), i = in_double(wi);
    for (int k = 0; k < count_; ++k) {
      const int lane = active_[static_cast<size_t>(k)];
      f[lane] = static_cast<float>(leaf::surface_f(*tissue(lane), o, i) +
                                   leaf::estimate_body_f(*tissue(lane), o, i, absorption_, rng));
    }
    return f;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    if (wo.z == 0 || count_ == 0) return {};
    const float place = uc * static_cast<float>(count_);
    const int hero = std::min(static_cast<int>(place), count_ - 1), lane = active_[static_cast<size_t>(hero)];
    const Vec2 disk = sample_disk(u);
    const leaf::WalkEnd end =
        leaf::walk(*tissue(lane), in_double(wo), absorption_, {place - static_cast<float>(hero), disk.x, disk.y}, rng);
    if (end.weight == 0) return {};
    const Vec3 wi{static_cast<float>(end.wi.x), static_cast<float>(end.wi.y), static_cast<float>(end.wi.z)};
    if (std::abs(wi.z) < kLeastCosine) return {};
    BsdfSample s{{}, wi, pdf(wo, wi), lobes_of(end.fate), true};
    s.f[lane] = static_cast<float>(count_ * end.weight) * (s.pdf / std::abs(wi.z));
    return s;
  }

  /// Exact for the surface at one of the wavelengths, a cosine lobe on each side for all that has been inside.
  float pdf(const Vec3& wo, const Vec3& wi) const override {
    if (wo.z == 0 || std::abs(wi.z) < kLeastCosine || count_ == 0) return 0;
    const Tissue& any_tissue = *tissue(active_[0]);
    // Kept off 1, so that no direction is left without density.
    const double surface = std::min(leaf::surface_reflectance(any_tissue, wo.z), 0.95);
    double density = (1 - surface) / 2 * std::abs(wi.z) * kInvPi;
    if (same_side(wo, wi)) {
      const leaf::Lobe& lobe = any_tissue.surface_lobe();
      density += surface * lobe.density(dot(Vec3{-wo.x, -wo.y, wo.z}, wi)) / lobe.kept(std::abs(wo.z));
    }
    return static_cast<float>(density);
  }

 private:
  const Tissue* tissue(int lane) const { return tissues_[static_cast<size_t>(lane)]; }

  static Lobes lobes_of(leaf::Fate fate) {
    if (fate == leaf::Fate::surface) return Lobes::reflection | Lobes::glossy | Lobes::surface | Lobes::stochastic;
    const Lobes side = fate == leaf::Fate::reflected ? Lobes::reflection : Lobes::transmission;
    return side | Lobes::diffuse | Lobes::stochastic;
  }

  std::array<const Tissue*, kLanes> tissues_;
  std::array<int, kLanes> active_{};  ///< the lanes that have a tissue
  int count_ = 0;
  leaf::Absorption absorption_;
};

class Abm final : public Material {
 public:
  explicit Abm(const Params& p)
      : leaf_(p),
        model_(leaf_.tissue()),
        absorption_(p.string("mode") == "analog" ? leaf::Absorption::analog : leaf::Absorption::weighted) {}

  void prepare(const Preparation& preparation) override { leaf_.check_wavelengths(preparation.wavelengths); }

  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    std::array<const Tissue*, kLanes> tissues{};
    for (size_t lane = 0; lane < kLanes; ++lane)
      if (lambda.active[lane]) tissues[lane] = arena.make<Tissue>(model_.at(lambda.nm[lane]));
    return arena.make<AbmBsdf>(tissues, absorption_);
  }

  bool is_leaf() const override { return true; }

 private:
  LeafParams leaf_;
  leaf::TissueModel model_;
  leaf::Absorption absorption_;
};

}  // namespace

extern const MaterialInfo abm_material{
    {"material", "abm", "Leaf by random walks through its cells (algorithmic BDF model).",
     "Baranoski and Rokne 1997; Baranoski 2006; Baranoski and Eng 2007", kAbm},
    make_material<Abm>};

}  // namespace frond
