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

struct MediumInfo;  // core/medium.h

/// Version of the first two members of PluginModule, by which frond decides whether it can load a shared object. It
/// changes if their position or meaning changes.
inline constexpr uint32_t kPluginInterface = 2;

/// Plug-ins of a shared object, with the same records as the built-in ones. The records must have static storage
/// duration; frond never unloads a shared object. Leave the first two members at their defaults.
struct PluginModule {
  uint32_t interface_version = kPluginInterface;
  BuildRecord build = {};
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
  std::span<const MediumInfo* const> media = {};
};

}  // namespace frond

/// Function that a shared object must define for `frond --plugin`. It is called once, after loading, and returns a
/// module with static storage duration.
extern "C" [[gnu::visibility("default")]] const frond::PluginModule* frond_plugin();
