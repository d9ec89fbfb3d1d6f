#pragma once

#include "core/camera.h"
#include "core/film.h"
#include "core/filter.h"
#include "core/integrator.h"
#include "core/light.h"
#include "core/material.h"
#include "core/medium.h"
#include "core/sampler.h"
#include "core/shape.h"
#include "core/texture.h"

namespace frond {

/// All plug-ins that a scene file can name. The parser's errors, `frond list`, `frond describe`, the documentation and
/// the tests use this list.
struct Registry {
  PluginTable<MaterialInfo> materials;
  PluginTable<IntegratorInfo> integrators;
  PluginTable<WavelengthsInfo> wavelengths;
  PluginTable<CameraInfo> cameras;
  PluginTable<FilmInfo> films;
  PluginTable<SamplerInfo> samplers;
  PluginTable<FilterInfo> filters;
  PluginTable<ShapeInfo> shapes;
  PluginTable<LightInfo> lights;
  PluginTable<AreaLightInfo> area_lights;
  PluginTable<FloatTextureInfo> float_textures;
  PluginTable<SpectrumTextureInfo> spectrum_textures;
  PluginTable<MediumInfo> media;
};

/// Returns all plug-ins in the order of the tables.
std::vector<const PluginInfo*> all_plugins(const Registry& registry);

/// Returns the plug-ins of scene/ and spectra/, with the given materials and integrators.
Registry make_registry(std::span<const MaterialInfo* const> materials,
                       std::span<const IntegratorInfo* const> integrators);

}  // namespace frond
