#pragma once

#include <cstdint>
#include <string>

#include "core/build_identity.h"
#include "core/camera.h"
#include "core/filter.h"
#include "core/integrator.h"
#include "core/material.h"
#include "core/sampler.h"
#include "core/texture.h"
#include "core/wavelengths.h"

namespace frond {

/// Changes with the place or meaning of `interface_version` and `build` below: every frond must be able to read them.
inline constexpr uint32_t kPluginInterface = 1;

#if !defined(_GLIBCXX_RELEASE)
#define FROND_STANDARD_LIBRARY "another standard library than libstdc++"
#elif defined(_GLIBCXX_DEBUG)
#define FROND_STANDARD_LIBRARY "libstdc++ in debug mode"
#elif !_GLIBCXX_USE_CXX11_ABI
#define FROND_STANDARD_LIBRARY "libstdc++ with the strings of C++03"
#else
#define FROND_STANDARD_LIBRARY "libstdc++"
#endif

/// The contracts are C++: two sides understand each other if they were compiled from the same headers and with the same
/// standard library.
#define FROND_PLUGIN_BUILD FROND_BUILD_IDENTITY " with " FROND_STANDARD_LIBRARY

/// What a shared object offers, by the same records as the built-in tables. They must live as long as the library,
/// which is never unloaded.
struct PluginModule {
  uint32_t interface_version = kPluginInterface;
  const char* build = FROND_PLUGIN_BUILD;  ///< leave both as they are
  std::span<const MaterialInfo* const> materials = {};
  std::span<const IntegratorInfo* const> integrators = {};
  std::span<const WavelengthsInfo* const> wavelengths = {};
  std::span<const CameraInfo* const> cameras = {};
  std::span<const SamplerInfo* const> samplers = {};
  std::span<const FilterInfo* const> filters = {};
  std::span<const FloatTextureInfo* const> float_textures = {};
  std::span<const SpectrumTextureInfo* const> spectrum_textures = {};
};

}  // namespace frond

/// The one function that a shared object defines for `frond --plugin`. It is called once, after loading.
extern "C" [[gnu::visibility("default")]] const frond::PluginModule* frond_plugin();
