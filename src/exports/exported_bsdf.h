#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/material.h"
#include "core/parallel.h"

namespace frond {

/// What is exported: a material without a scene, whose f is exact and has no delta lobe, with air on both of its sides.
struct ExportMaterial {
  std::string label;  ///< the material's text
  /// The material, prepared for one to four wavelengths (nm). Throws InputError where its data do not reach them.
  std::function<std::shared_ptr<const Material>(const std::vector<double>&)> prepare;
  uint64_t seed;  ///< of all random numbers: another one for each material
  const ThreadPool& pool;
  const Log& log;
};

/// f of a material at one to four wavelengths, as a renderer sees it.
class ExportedBsdf {
 public:
  /// Throws InputError, which says what would be lost, for a material that is a random estimate, has a delta lobe or
  /// refracts light into another medium.
  ExportedBsdf(const ExportMaterial& material, std::vector<double> wavelengths_nm);

  const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
  const Material& material() const { return *material_; }

  /// For one thread at a time.
  class At {
   public:
    explicit At(const ExportedBsdf& bsdf);
    /// 1/sr, a lane for each wavelength: light comes from the direction `light`, and is seen from `seen`, both away
    /// from the surface. Nothing is scattered to or from the horizon.
    SampledSpectrum operator()(const Vec3& light, const Vec3& seen) const;
    const Bsdf& bsdf() const { return bsdf_; }

   private:
    Arena arena_;
    const Bsdf& bsdf_;
  };

 private:
  std::vector<double> wavelengths_nm_;
  std::shared_ptr<const Material> material_;
};

/// Runs of up to four wavelengths, in order.
std::vector<std::vector<double>> in_fours(const std::vector<double>& wavelengths_nm);

}  // namespace frond
