#include "core/material.h"
#include "core/math/sampling.h"
#include "leaf/walk/batch_walk.h"
#include "materials/leaf_fluorescence.h"
#include "materials/leaf_params.h"
#include "materials/lobes/surface_lobe.h"

namespace frond {
namespace {

using leaf::Tissue;

constexpr std::string_view kModes[] = {"analog", "weighted"};
constexpr Param kOwnAbmParams[] = {
    {.name = "mode",
     .kind = ParamKind::string,
     .default_value = std::string_view("analog"),
     .doc = "Absorption. analog: of whole rays at random, as published; weighted: of a share of each, same mean.",
     .choices = kModes},
};
// Without incident "reciprocal": a random walk cannot be symmetrised. leaf_solved can.
const std::vector<Param> kAbm = without_reciprocal(with_leaf_params(kOwnAbmParams));

/// A leaf at a hit, at the wavelengths of the path: a tissue for each active lane.
struct LeafLanes {
  std::array<const Tissue*, kLanes> tissues{};
  std::array<int, kLanes> lane{};
  size_t count = 0;

  void add(int of_lane, const Tissue* tissue) {
    tissues[count] = tissue;
    lane[count++] = of_lane;
  }
  std::span<const Tissue* const> all() const { return std::span(tissues).first(count); }
  /// Index of the hero, uniform.
  size_t draw_hero(RandomStream& rng) const { return count > 1 ? rng.bits() % count : 0; }
};

/// BSDF by random walks through the leaf, one walk for all wavelengths of a path (hero wavelengths).
class AbmBsdf : public Bsdf {
 public:
  AbmBsdf(const LeafLanes& lanes, leaf::Absorption absorption)
      : lanes_(lanes), absorption_(absorption), surface_(is_empty() ? nullptr : &tissue().surface_lobe()) {}

  Lobes flags() const override {
    return Lobes::reflection | Lobes::transmission | Lobes::diffuse | Lobes::glossy | Lobes::surface |
           Lobes::stochastic;
  }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const override { return leaf_f(wo, wi, rng); }

  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    const auto [wi, lobe, weight] = walk(wo, uc, u, rng);
    // The weight is exact for any pdf > 0; `pdf` is the approximate density for MIS, as in LayeredBsdf.
    if (weight.is_black()) return {};
    const float density = pdf(wo, wi);
    return BsdfSample{weight * (density / std::abs(wi.z)), wi, density, lobe, true};
  }

  /// Approximate: exact for the surface at one of the wavelengths, a cosine lobe on each side for light that has been
  /// inside.
  float pdf(const Vec3& wo, const Vec3& wi) const override {
    if (wo.z == 0 || std::abs(wi.z) < kLeastCosine || lanes_.count == 0) return 0;
    const float share = surface_share(wo);
    float density = (1 - share) / 2 * std::abs(wi.z) * kInvPi;
    if (same_side(wo, wi)) density += share * surface_.pdf(wo, wi);
    return density;
  }

  // For instruments: batches of one wavelength use the SIMD walk.
  void scatter(const Vec3& incident, RandomStream& rng, std::span<Scattered> rays) const override {
    if (lanes_.count == 1 && incident.z != 0) return scatter_batch(incident, rng, rays);
    for (Scattered& ray : rays) {
      const float uc = rng.uniform(), u = rng.uniform();
      ray = walk(incident, uc, {u, rng.uniform()}, rng);
    }
  }

 protected:
  /// Estimate of f for light from `incident` to `leaving`.
  SampledSpectrum leaf_f(const Vec3& incident, const Vec3& leaving, RandomStream& rng) const {
    SampledSpectrum f;
    if (incident.z == 0 || std::abs(leaving.z) < kLeastCosine || lanes_.count == 0) return f;
    // Walks run in double: cosines of grazing rays are small.
    const Vec3d from = normalize(to_double(incident)), to = normalize(to_double(leaving));
    const auto body = leaf::estimate_subsurface_f(lanes_.all(), lanes_.draw_hero(rng), from, to, absorption_, rng);
    for (size_t i = 0; i < lanes_.count; ++i)
      f[lanes_.lane[i]] = static_cast<float>(leaf::surface_f(*lanes_.tissues[i], from, to) + body[i]);
    return f;
  }

  /// Probability of the surface's lobe; at most 0.95, so that no direction has density 0.
  float surface_share(const Vec3& wo) const {
    return std::min(static_cast<float>(leaf::surface_reflectance(tissue(), wo.z)), 0.95f);
  }

  const SurfaceLobe& surface() const { return surface_; }
  const Tissue& tissue() const { return *lanes_.tissues[0]; }
  bool is_empty() const { return lanes_.count == 0; }

 private:
  void scatter_batch(const Vec3& incident, RandomStream& rng, std::span<Scattered> rays) const {
    std::array<leaf::BatchRay, 256> batch;
    while (!rays.empty()) {
      const auto part = std::span(batch).first(std::min(batch.size(), rays.size()));
      leaf::walk_batch(tissue(), normalize(to_double(incident)), absorption_, rng.bits(), part);
      for (size_t i = 0; i < part.size(); ++i) {
        rays[i] = {part[i].wi, lobes_of(part[i].fate), {}};
        rays[i].weight[lanes_.lane[0]] = part[i].weight;
      }
      rays = rays.subspan(part.size());
    }
  }

  /// `uc` draws the hero; its remainder draws the first branch.
  Scattered walk(const Vec3& incident, float uc, Vec2 u, RandomStream& rng) const {
    if (incident.z == 0 || lanes_.count == 0) return {};
    const float place = uc * static_cast<float>(lanes_.count);
    const size_t hero = std::min(static_cast<size_t>(place), lanes_.count - 1);
    const Vec2 disk = sample_disk(u);
    const leaf::SpectralWalkEnd end = leaf::walk(lanes_.all(), hero, normalize(to_double(incident)), absorption_,
                                                 {place - static_cast<float>(hero), disk.x, disk.y}, rng);
    Scattered ray{to_float(end.wi), lobes_of(end.fate), {}};
    if (std::abs(ray.direction.z) < kLeastCosine) return ray;
    for (size_t i = 0; i < lanes_.count; ++i) ray.weight[lanes_.lane[i]] = static_cast<float>(end.weight[i]);
    return ray;
  }

  // The flags of a ray by its end: instruments count Rs, Rd and T by them.
  static Lobes lobes_of(leaf::Fate fate) {
    if (fate == leaf::Fate::surface) return Lobes::reflection | Lobes::glossy | Lobes::surface | Lobes::stochastic;
    const Lobes side = fate == leaf::Fate::reflected ? Lobes::reflection : Lobes::transmission;
    return side | Lobes::diffuse | Lobes::stochastic;
  }

  LeafLanes lanes_;
  leaf::Absorption absorption_;
  SurfaceLobe surface_;
};

/// The same leaf with the light's direction wi as incident direction: a walk from wi estimates the light along wo.
/// Walks cannot be made to end along wo, so directions are drawn from `pdf`, which is then exact.
class AbmFromLightBsdf final : public AbmBsdf {
 public:
  using AbmBsdf::AbmBsdf;

  Lobes flags() const override { return AbmBsdf::flags() | Lobes::from_light; }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const override { return leaf_f(wi, wo, rng); }

  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    if (wo.z == 0 || is_empty()) return {};
    const float share = surface_share(wo), reflected = (1 + share) / 2;
    const bool off_surface = uc < share, reflects = uc < reflected;
    Vec3 wi = off_surface ? surface().sample(wo, u, rng) : sample_cosine_hemisphere(u);
    if (!off_surface && (wo.z > 0) != reflects) wi.z = -wi.z;
    if (std::abs(wi.z) < kLeastCosine) return {};
    const Lobes side = reflects ? Lobes::reflection : Lobes::transmission;
    const Lobes lobe = off_surface ? Lobes::glossy | Lobes::surface : Lobes::diffuse;
    return BsdfSample{f(wo, wi, rng), wi, pdf(wo, wi), side | lobe | Lobes::stochastic};
  }
};

// Material "abm": random walks through the leaf's tissue. A hit makes one tissue for each active lane; all of them
// share the walk.
class Abm final : public Material, public FluorescentMaterial {
 public:
  explicit Abm(const Params& p)
      : leaf_(p),
        model_(leaf_.tissue()),
        absorption_(p.string("mode") == "analog" ? leaf::Absorption::analog : leaf::Absorption::weighted) {}

  // Tissues of a constant leaf are built once if paths carry fixed or listed wavelengths, else at each hit.
  void prepare(const Preparation& preparation) override {
    const WavelengthStrategy& wavelengths = preparation.wavelengths;
    leaf_.check_wavelengths(wavelengths);
    leaf_.log_difference(preparation.log);
    made_.clear();
    if (!leaf_.is_constant()) return;
    fixed_ = !wavelengths.fixed_nm().empty();
    for (const float nm : fixed_ ? wavelengths.fixed_nm() : wavelengths.listed_nm())
      made_.push_back({nm, model_.at(double(nm))});
  }

  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    const LeafLanes lanes = leaf_at(hit.at, lambda, arena);
    if (leaf_.incident() == Incident::light) return arena.make<AbmFromLightBsdf>(lanes, absorption_);
    return arena.make<AbmBsdf>(lanes, absorption_);
  }

  std::shared_ptr<const Fluorescence> fluorescence(const Preparation& preparation) const override {
    if (auto given = matrix_fluorescence(leaf_, preparation.log)) return given;
    leaf_.refuse_varying_fluorescence();
    return std::make_shared<const WalkedFluorescence>(leaf_, absorption_);
  }

 private:
  LeafLanes leaf_at(const TexturePoint& at, const SampledWavelengths& lambda, Arena& arena) const {
    LeafLanes lanes;
    if (leaf_.is_constant()) {
      for (int lane = 0; lane < lambda.count; ++lane)
        if (lambda.is_active(lane)) lanes.add(lane, constant_tissue(lambda, static_cast<size_t>(lane), arena));
      return lanes;
    }
    const leaf::InterfaceLobes& lobes = lobes_at(at, arena);
    const auto depth = leaf_.depth().at(at, lambda);
    for (int lane = 0; lane < lambda.count; ++lane)
      if (lambda.is_active(lane))
        lanes.add(lane, arena.make<Tissue>(model_.at(nm(lambda, lane), depth[static_cast<size_t>(lane)], lobes)));
    return lanes;
  }

  // `band` is a lane's index in the listed wavelengths; tissues at other wavelengths are made at the hit.
  const Tissue* constant_tissue(const SampledWavelengths& lambda, size_t lane, Arena& arena) const {
    // With fixed wavelengths tissues are indexed by lane, with listed ones by the index in the list.
    const size_t place = fixed_ ? lane : lambda.band[lane];
    if (place < made_.size() && made_[place].nm == lambda.nm[lane]) return &made_[place].tissue;
    return arena.make<Tissue>(model_.at(double(lambda.nm[lane])));
  }

  // Lobes at a point of the leaf; lobes of textured aspect ratios are built at each hit.
  const leaf::InterfaceLobes& lobes_at(const TexturePoint& at, Arena& arena) const {
    if (leaf_.aspects_are_constant()) return model_.lobes();
    leaf::LeafLobes lobes = model_.leaf_lobes();
    const auto replace = [&](const leaf::Lobe*& lobe, const LeafParams::Aspect& aspect) {
      if (aspect) lobe = arena.make<leaf::Lobe>(static_cast<double>(aspect->evaluate(at)));
    };
    replace(lobes.cuticle, leaf_.cuticle_aspect());
    replace(lobes.epidermis, leaf_.epidermis_aspect());
    replace(lobes.spongy, leaf_.spongy_aspect());
    replace(lobes.palisade, leaf_.palisade_aspect());
    return *arena.make<leaf::InterfaceLobes>(model_.arrange(lobes));
  }

  static double nm(const SampledWavelengths& lambda, int lane) { return lambda.nm[static_cast<size_t>(lane)]; }

  struct Made {
    float nm;
    Tissue tissue;
  };

  LeafParams leaf_;
  leaf::TissueModel model_;
  leaf::Absorption absorption_;
  std::vector<Made> made_;  ///< tissues of a constant leaf at fixed wavelengths (by lane) or listed ones
  bool fixed_ = false;
};

}  // namespace

extern const MaterialInfo abm_material{
    {"material", "abm", "Leaf by random walks through its cells (algorithmic BDF model).",
     "Baranoski and Rokne 1997; Baranoski 2006; Baranoski and Eng 2007", kAbm},
    make_material<Abm>,
    LeafModel{.reference = "abm",
              .is_exact = true,
              .is_noisy = true,
              .cost = 1.77,
              .accepts_wall_textures = true,
              .quiet = {"mode", "weighted"}}};

}  // namespace frond
