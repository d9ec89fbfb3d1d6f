#include "textures/normal_map.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "image/rgb_file.h"
#include "textures/mip_map.h"

namespace frond {
namespace {

/// Whether the vector can be normalized.
bool is_usable(const Vec3& v) {
  const float square = dot(v, v);
  return square > 0 && std::isfinite(square);
}

/// Leaves the hit unchanged if the normal is invalid.
void set_normal(Hit& hit, const Vec3& n, const Vec3& dpdu, const Vec3& dpdv) {
  const Vec3 unit = normalize_any(n);
  if (!is_usable(unit) || !is_usable(dpdu) || !is_usable(dpdv)) return;
  hit.shading = Frame::along(dot(unit, hit.ng) < 0 ? -unit : unit, dpdu);
  hit.derivatives.dpdu = dpdu, hit.derivatives.dpdv = dpdv;
}

/// Removes the component along the shading normal.
Vec3 tangential(const Vec3& v, const Vec3& n) { return v - n * dot(n, v); }

/// Bump mapping: normals of the surface displaced along its normals by a texture (Blinn 1978; pbrt 4th ed., 10.5.3).
class BumpMap final : public NormalBend {
 public:
  explicit BumpMap(std::shared_ptr<const FloatTexture> displacement) : displacement_(std::move(displacement)) {}
  /// Differentiates the displacement by finite differences over the footprint.
  void bend(Hit& hit) const override {
    const Vec3 n = hit.shading.z, u = tangential(hit.derivatives.dpdu, n), v = tangential(hit.derivatives.dpdv, n);
    const float height = displacement_->evaluate(hit.at);
    const auto slope = [&](float dx, float dy, const Vec3& dp, Vec2 direction) {
      // Without a footprint, the step is pbrt-v4's, in units of (u, v).
      constexpr float kLeastStep = 0.0005f;
      const float half = 0.5f * (std::abs(dx) + std::abs(dy)),
                  step = half > 0 && std::isfinite(half) ? half : kLeastStep;
      TexturePoint beside = hit.at;
      beside.p += step * dp;
      beside.uv = beside.uv + direction * step;
      return (displacement_->evaluate(beside) - height) / step;
    };
    const TexturePoint& at = hit.at;
    const Vec3 dpdu = u + slope(at.duv_dx.x, at.duv_dy.x, u, {1, 0}) * n + height * hit.derivatives.dndu;
    const Vec3 dpdv = v + slope(at.duv_dx.y, at.duv_dy.y, v, {0, 1}) * n + height * hit.derivatives.dndv;
    set_normal(hit, cross(dpdu, dpdv), dpdu, dpdv);
  }

 private:
  std::shared_ptr<const FloatTexture> displacement_;
};

/// Normal mapping: normals from an image in the frame of the shading normal (z) and dpdu (x) (pbrt 4th ed., 10.5.2).
class NormalMap final : public NormalBend {
 public:
  explicit NormalMap(const ImageFile& file) : image_(file.image, {}, file.eight_bit, {}) {}
  /// The map is looked up without filtering, as in pbrt-v4.
  void bend(Hit& hit) const override {
    const Float4 c = image_.at({hit.at.uv, {}, {}});
    const Vec3 local = normalize_any(Vec3{2 * c[0] - 1, 2 * c[1] - 1, 2 * c[2] - 1});
    const SurfaceDerivatives& d = hit.derivatives;
    const Vec3 n = Frame::along(hit.shading.z, d.dpdu).to_world(local);
    const Vec3 u = normalize_any(tangential(d.dpdu, n)), v = normalize_any(cross(n, u));
    set_normal(hit, n, u * length(d.dpdu), v * length(d.dpdv));
  }

 private:
  MipMap image_;
};

constexpr Param kBends[] = {
    {.name = "displacement",
     .kind = ParamKind::float_texture,
     .default_value = 0.0,
     .doc = "Bump map: normals of the surface displaced by this height along them, in scene units."},
    {.name = "normalmap",
     .kind = ParamKind::string,
     .doc = "Image of normals in the frame of (u, v): 2 c - 1 of its linear R, G and B. Overrides \"displacement\"."},
};

bool is_bend_param(const ParsedParam& p) { return std::ranges::find(kBends, p.name, &Param::name) != std::end(kBends); }

/// Adapts a BSDF with another shading frame to the frame of its caller. The BSDF's own normal determines the sides of
/// directions.
class BentBsdf final : public Bsdf {
 public:
  BentBsdf(const Bsdf& bsdf, const Frame& outer, const Frame& bent)
      : bsdf_(bsdf), to_bent_{bent.to_local(outer.x), bent.to_local(outer.y), bent.to_local(outer.z)} {}

  Lobes flags() const override { return bsdf_.flags(); }
  /// The ratio of cosines corrects for the geometry term of the outer frame.
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const override {
    if (wi.z == 0) return {};
    const Vec3 i = to_bent_.to_world(wi);
    return bsdf_.f(to_bent_.to_world(wo), i, rng) * std::abs(i.z / wi.z);
  }
  /// Transforms the sampled direction and its value to the outer frame.
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    auto s = bsdf_.sample(to_bent_.to_world(wo), uc, u, rng);
    if (!s) return s;
    const Vec3 wi = to_bent_.to_local(s->wi);
    if (wi.z == 0) return {};
    s->f *= std::abs(s->wi.z / wi.z);
    s->wi = wi;
    return s;
  }
  /// Solid angle is invariant under rotation: densities need no correction.
  float pdf(const Vec3& wo, const Vec3& wi) const override {
    return bsdf_.pdf(to_bent_.to_world(wo), to_bent_.to_world(wi));
  }
  SampledSpectrum index_ratio() const override { return bsdf_.index_ratio(); }
  /// Weights are shares of the incident light, which do not depend on the frame.
  void scatter(const Vec3& incident, RandomStream& rng, std::span<Scattered> rays) const override {
    bsdf_.scatter(to_bent_.to_world(incident), rng, rays);
    for (Scattered& ray : rays) ray.direction = to_bent_.to_local(ray.direction);
  }

 private:
  const Bsdf& bsdf_;
  Frame to_bent_;  ///< axes of the outer frame in the bent one
};

/// Material with a normal map of its own.
class BentMaterial final : public Material {
 public:
  BentMaterial(std::shared_ptr<Material> material, std::shared_ptr<const NormalBend> bend)
      : material_(std::move(material)), bend_(std::move(bend)) {}
  void prepare(const Preparation& preparation) override { material_->prepare(preparation); }
  /// The BSDF's frame is that of the hit before it was bent, as the caller expects.
  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    Hit bent = hit;
    bend_->bend(bent);
    const Bsdf* const bsdf = material_->evaluate(bent, lambda, arena);
    return bsdf ? arena.make<BentBsdf>(*bsdf, hit.shading, bent.shading) : nullptr;
  }
  bool needs_details() const override { return true; }
  bool refracts() const override { return material_->refracts(); }

 private:
  std::shared_ptr<Material> material_;
  std::shared_ptr<const NormalBend> bend_;
};

}  // namespace

extern const PluginInfo normal_bend_params{"material", "", "Normal and bump maps of any material.", "pbrt-v4", kBends};

ParsedPlugin split_bend(const ParsedPlugin& material, bool of_bend) {
  ParsedPlugin part = material;
  std::erase_if(part.params, [of_bend](const ParsedParam& p) { return is_bend_param(p) != of_bend; });
  return part;
}

std::shared_ptr<const NormalBend> make_normal_bend(const ParsedPlugin& material, ParamResolver& resolver) {
  if (std::ranges::none_of(material.params, is_bend_param)) return nullptr;
  const Params p(normal_bend_params, split_bend(material, true), resolver);
  if (p.given("normalmap") && !p.string("normalmap").empty()) {
    if (p.given("displacement")) p.warn("displacement", "\"normalmap\" is given too: this is ignored, as in pbrt-v4");
    return std::make_shared<NormalMap>(read_rgb(p, "normalmap"));
  }
  if (!p.given("displacement")) return nullptr;
  const auto displacement = p.float_texture("displacement");
  return displacement->is_constant() ? nullptr : std::make_shared<BumpMap>(displacement);
}

std::shared_ptr<Material> bent_material(std::shared_ptr<Material> material, std::shared_ptr<const NormalBend> bend) {
  return std::make_shared<BentMaterial>(std::move(material), std::move(bend));
}

}  // namespace frond
