#pragma once

#include <functional>

#include "core/bsdf.h"
#include "exports/exported_bsdf.h"
#include "tests/support/input_error.h"

namespace frond {

/// A material whose f is an arbitrary function of the directions of view and of light.
class Planted {
 public:
  using F = std::function<float(const Vec3& seen, const Vec3& light)>;

  explicit Planted(F f, Lobes flags = Lobes::reflection | Lobes::transmission, float index_ratio = 1)
      : material_(std::make_shared<PlantedMaterial>(PlantedBsdf{std::move(f), flags, index_ratio})) {}

  ExportMaterial exported() const {
    return {"planted", [this](const std::vector<double>&) { return material_; }, 0, pool_, silent_log()};
  }

 private:
  class PlantedBsdf final : public Bsdf {
   public:
    PlantedBsdf(F f, Lobes flags, float index_ratio) : f_(std::move(f)), flags_(flags), index_ratio_(index_ratio) {}
    Lobes flags() const override { return flags_; }
    SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
      return SampledSpectrum(f_(wo, wi));
    }
    std::optional<BsdfSample> sample(const Vec3&, float, Vec2, RandomStream&) const override { return {}; }
    float pdf(const Vec3&, const Vec3&) const override { return 0; }
    SampledSpectrum index_ratio() const override { return SampledSpectrum(index_ratio_); }

   private:
    F f_;
    Lobes flags_;
    float index_ratio_;
  };
  class PlantedMaterial final : public Material {
   public:
    explicit PlantedMaterial(PlantedBsdf bsdf) : bsdf_(std::move(bsdf)) {}
    const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena&) const override { return &bsdf_; }

   private:
    PlantedBsdf bsdf_;
  };

  std::shared_ptr<const Material> material_;
  ThreadPool pool_{2};
};

}  // namespace frond
