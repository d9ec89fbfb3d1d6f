#pragma once

#include <cstdint>
#include <string>

#include "core/build_record.h"
#include "core/camera.h"
#include "core/film.h"
#include "core/filter.h"
#include "core/integrator.h"
#include "core/light.h"
#include "core/material.h"
#include "core/sampler.h"
#include "core/shape.h"
#include "core/texture.h"
#include "core/wavelengths.h"

namespace frond {

/// Changes with the place or meaning of `interface_version` and `build` below: every frond must be able to read them.
inline constexpr uint32_t kPluginInterface = 2;

/// What a shared object offers, by the same records as the built-in tables. They must live as long as the library,
/// which is never unloaded.
struct PluginModule {
  uint32_t interface_version = kPluginInterface;
  BuildRecord build = {};  ///< leave both as they are
  std::span<const MaterialInfo* const> materials = {};
  std::span<const IntegratorInfo* const> integrators = {};
  std::span<const WavelengthsInfo* const> wavelengths = {};
  std::span<const CameraInfo* const> cameras = {};
  std::span<const SamplerInfo* const> samplers = {};
  std::span<const FilterInfo* const> filters = {};
  std::span<const FilmInfo* const> films = {};
  std::span<const ShapeInfo* const> shapes = {};
  std::span<const LightInfo* const> lights = {};
  std::span<const AreaLightInfo* const> area_lights = {};
  std::span<const FloatTextureInfo* const> float_textures = {};
  std::span<const SpectrumTextureInfo* const> spectrum_textures = {};
};

}  // namespace frond

/// The one function that a shared object defines for `frond --plugin`. It is called once, after loading.
extern "C" [[gnu::visibility("default")]] const frond::PluginModule* frond_plugin();
