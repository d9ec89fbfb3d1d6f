#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/material.h"
#include "core/parallel.h"

namespace frond {

/// The material to export: without a scene, with an exact f and no delta lobe, in air on both sides.
struct ExportMaterial {
  std::string label;  ///< name and parameters
  /// Returns the material, prepared for one to four wavelengths (nm). Throws InputError if its data do not cover them.
  std::function<std::shared_ptr<const Material>(const std::vector<double>&)> prepare;
  uint64_t seed;  ///< differs between materials
  const ThreadPool& pool;
  const Log& log;
};

/// Rendered f of a material at one to four wavelengths.
class ExportedBsdf {
 public:
  /// Throws InputError for a material that is a random estimate, has a delta lobe, or refracts light into another
  /// medium. The message names what the export would lose.
  ExportedBsdf(const ExportMaterial& material, std::vector<double> wavelengths_nm);

  const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
  const Material& material() const { return *material_; }

  /// Evaluator with its own memory, for one thread.
  class At {
   public:
    explicit At(const ExportedBsdf& bsdf);
    /// Returns f in 1/sr, one lane for each wavelength, for light from direction `light` seen from direction `seen`;
    /// both point away from the surface. Returns 0 if either is on the horizon.
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

/// Splits wavelengths into groups of up to four, in order.
std::vector<std::vector<double>> split_into_lanes(const std::vector<double>& wavelengths_nm);

/// Returns the parameter with which a leaf fluoresces, which exported files do not hold; nullptr: none.
const ParsedParam* fluorescence_of(const ParsedPlugin& leaf);

}  // namespace frond
