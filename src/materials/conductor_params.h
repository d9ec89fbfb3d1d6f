#pragma once

#include "core/material.h"
#include "materials/lobes/conductor.h"
#include "spectra/check_range.h"
#include "spectra/named.h"
#include "spectra/wavelengths/fixed_wavelengths.h"

namespace frond {

/// Names of the parameters of a metal's optics, which differ between materials.
struct MetalNames {
  std::string_view eta, k, reflectance;
};

/// The parameters themselves.
constexpr std::array<Param, 3> metal_params(const MetalNames& names) {
  return {Param{.name = names.eta,
                .kind = ParamKind::unbounded,
                .doc = "Index of refraction; by default that of copper, \"metal-Cu-eta\"."},
          Param{.name = names.k,
                .kind = ParamKind::unbounded,
                .doc = "Index of absorption; by default that of copper, \"metal-Cu-k\"."},
          Param{.name = names.reflectance,
                .kind = ParamKind::spectrum_texture,
                .range = {0, 1},
                .doc = "Reflectance at normal incidence; replaces both indices."}};
}

/// Optical constants of a metal: complex index of refraction, or reflectance at normal incidence.
class Metal {
 public:
  /// Throws InputError if both reflectance and an index are given.
  Metal(const Params& p, const MetalNames& names) : names_(names), where_(p.where()) {
    const bool has_indices = p.given(names.eta) || p.given(names.k);
    if (p.given(names.reflectance)) {
      if (has_indices)
        fail(p.where(names.reflectance), "\"{}\" replaces \"{}\" and \"{}\": give either the first or the others",
             names.reflectance, names.eta, names.k);
      reflectance_ = p.spectrum_texture(names.reflectance);
      // Messages about the spectrum refer to the parameter, not to the material.
      where_ = p.where(names.reflectance);
      return;
    }
    eta_ = p.given(names.eta) ? p.spectrum(names.eta) : named_spectrum("metal-Cu-eta", where_);
    k_ = p.given(names.k) ? p.spectrum(names.k) : named_spectrum("metal-Cu-k", where_);
  }

  /// Throws InputError if a spectrum does not cover the wavelengths of the render.
  void prepare(const WavelengthStrategy& wavelengths) {
    if (reflectance_) return check_range(reflectance_->range_nm(), wavelengths, where_, names_.reflectance);
    check_range(*eta_, wavelengths, where_, names_.eta);
    check_range(*k_, wavelengths, where_, names_.k);
    // Fixed wavelengths are sampled once, not at each hit.
    eta_ = precompute_at(eta_, wavelengths.fixed_nm());
    k_ = precompute_at(k_, wavelengths.fixed_nm());
  }

  /// Indices relative to vacuum, at the wavelengths of a path.
  ConductorIndices at(const TexturePoint& point, const SampledWavelengths& lambda) const {
    if (reflectance_) return ConductorIndices::of_reflectance(reflectance_->evaluate(point, lambda));
    return {eta_->sample(lambda), k_->sample(lambda)};
  }

 private:
  MetalNames names_;
  Location where_;
  SpectrumPtr eta_, k_;
  std::shared_ptr<const SpectrumTexture> reflectance_;  ///< nullptr: eta_ and k_ are used
};

}  // namespace frond
