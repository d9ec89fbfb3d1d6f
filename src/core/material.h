#pragma once

#include <filesystem>

#include "core/arena.h"
#include "core/bsdf.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/plugin.h"
#include "core/shared_work.h"
#include "core/texture.h"
#include "core/vec.h"
#include "core/wavelengths.h"

namespace frond {

/// How a surface's point and its shading normal change with (u, v).
struct SurfaceDerivatives {
  Vec3 dpdu{}, dpdv{}, dndu{}, dndv{};
};

/// What a material may know of the surface point that it is asked for.
struct Hit {
  Vec3 p;           ///< world space
  Vec3 ng;          ///< geometric normal, unit, on the surface's front (a leaf's adaxial side) whichever side was hit
  Frame shading;    ///< z: shading normal, in the hemisphere of ng
  TexturePoint at;  ///< what textures need
  float extent =
      0;  ///< largest coordinate that went into `p`: its rounding error is some units of this one's last place
  /// World space; set where the material needs details. There shading.x points along dpdu.
  SurfaceDerivatives derivatives{};
};

/// What a material gets to make itself ready once the scene is known, before the first path.
struct Preparation {
  const WavelengthStrategy& wavelengths;
  ThreadPool& pool;
  const Log& log;
  std::filesystem::path cache_dir;  ///< empty: keep nothing on disk
  SharedWork* shared = nullptr;     ///< what the scene's materials may have in common; nullptr: each works alone

  /// As SharedWork::get.
  template <class T, class Make>
  std::shared_ptr<const T> share(const std::string& key, const Make& make) const {
    return shared ? shared->get<T>(key, make) : std::make_shared<const T>(make());
  }
};

/// Textures and parameters in, a BSDF for one hit out.
class Material {
 public:
  virtual ~Material() = default;
  /// Heavy work that depends on the wavelengths (tables) belongs here. Throws InputError.
  virtual void prepare(const Preparation&) {}
  /// Thread-safe. The BSDF lives until the arena is reset; nullptr: the surface is not there, and rays go straight on.
  /// Shadow rays stop at it all the same, as in pbrt-v4: what lies behind is lit by scattered rays alone.
  virtual const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const = 0;
  /// Claims f(a, b) = f(b, a), as Bsdf says where light is refracted, and the laws hold it to that.
  virtual bool is_reciprocal() const { return false; }
  /// What it lets through may have been refracted: its BSDFs have an index_ratio other than 1.
  virtual bool refracts() const { return false; }
  /// Reads derivatives of the hit, or the direction of its shading.x. Textures say for themselves what they need.
  virtual bool needs_details() const { return false; }
  /// Counts as foliage in the foliar ratio.
  virtual bool is_leaf() const { return false; }
};

struct MaterialInfo : PluginInfo {
  std::unique_ptr<Material> (*make)(const Params&);
};

template <class T>
std::unique_ptr<Material> make_material(const Params& p) {
  return std::make_unique<T>(p);
}

}  // namespace frond
