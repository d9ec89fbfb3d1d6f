#pragma once

#include <filesystem>
#include <optional>

#include "core/arena.h"
#include "core/bsdf.h"
#include "core/log.h"
#include "core/math/vec.h"
#include "core/parallel.h"
#include "core/plugin.h"
#include "core/shared_work.h"
#include "core/texture.h"
#include "core/wavelengths.h"

namespace frond {

/// Partial derivatives of a surface's position and shading normal with respect to the texture coordinates (u, v).
struct SurfaceDerivatives {
  Vec3 dpdu{}, dpdv{}, dndu{}, dndv{};
};

/// Point of a surface at which a material is evaluated; positions and directions are in world space.
struct Hit {
  Vec3 p;
  Vec3 ng;          ///< geometric normal, unit, on the front (a leaf's adaxial side) whichever side was hit
  Frame shading;    ///< z is the shading normal, in the hemisphere of ng
  TexturePoint at;  ///< argument for textures
  /// Bound of the coordinates that entered the computation of `p`, along `ng`; its float spacing bounds the error of
  /// `p` along `ng`.
  float extent = 0;
  /// Set only for a material whose `needs_details` is true; then shading.x points along dpdu.
  SurfaceDerivatives derivatives{};
};

/// Arguments of Material::prepare.
struct Preparation {
  const WavelengthStrategy& wavelengths;
  ThreadPool& pool;
  const Log& log;
  std::filesystem::path cache_dir;  ///< folder for tables on disk; empty: store nothing on disk
  SharedWork* shared = nullptr;     ///< results shared by the scene's materials; nullptr: nothing is shared

  /// See SharedWork::get; calls `make` if nothing is shared.
  template <class T, class Make>
  std::shared_ptr<const T> share(const std::string& key, const Make& make) const {
    return shared ? shared->get<T>(key, make) : std::make_shared<const T>(make());
  }
};

/// Material: evaluates its textures at a surface point and makes a BSDF.
class Material {
 public:
  virtual ~Material() = default;
  /// Called after the scene is read and before the first path. Computes tables that depend on the wavelengths, and
  /// checks that the material's data cover them (check_range). Throws InputError.
  virtual void prepare(const Preparation&) {}
  /// Returns the BSDF at a hit, allocated in `arena`; it is valid until the arena is reset. With nullptr, as for pbrt's
  /// interface material, a ray continues without scattering; as in pbrt-v4, shadow rays of `path` are blocked, so that
  /// only scattered rays light the surfaces behind, and shadow rays of `volpath` pass. Thread-safe.
  virtual const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const = 0;
  /// True if all BSDFs of the material are reciprocal, as class Bsdf defines it; the laws test this.
  virtual bool is_reciprocal() const { return false; }
  /// True if its BSDFs can have an index_ratio other than 1.
  virtual bool refracts() const { return false; }
  /// True if the material reads `derivatives` or the direction of shading.x of a hit. Its textures report their needs
  /// separately.
  virtual bool needs_details() const { return false; }
};

/// Statements of a leaf material about itself. The models of `leaf`, the selection, comparisons, swaps of all leaves
/// and tables follow from these statements (scene/leaf_models.h).
struct LeafModel {
  /// Table in a file that the material reads by its parameter kTableFile.
  enum class Table : uint8_t {
    none,
    shares,  ///< reflectance and transmittance by angle and wavelength, as CSV
    modes,   ///< modes of a BSDF, as CSV or as FILE.leaf
  };
  /// Parameter with which the material has the same mean and less noise.
  struct Variant {
    std::string_view parameter, value;
  };

  static constexpr std::string_view kTableFile = "tablefile";

  std::string_view reference = {};  ///< leaf model that this one approximates or equals; its own name: a reference
  bool is_exact = false;            ///< the mean of its BSDF is the mean of the reference's
  bool is_noisy = false;            ///< its BSDF is a random estimate
  double cost = 0;  ///< CPU time of a path, with `quiet`, relative to leaf_lambert (docs/selection.md); above 0
  bool accepts_wall_textures = false;  ///< textures may give the aspect ratios of inner walls
  Table table = Table::none;
  Variant quiet = {};    ///< empty: none
  bool is_open = false;  ///< no model: the renderer replaces it by one; then no other member has a meaning
};

/// Plug-in record of a material.
struct MaterialInfo : PluginInfo {
  /// Returns a material, not null. Throws InputError.
  std::unique_ptr<Material> (*make)(const Params&);
  /// Statements of a leaf material; nullopt: the material is no leaf. Hits of leaves count in the foliar ratio.
  std::optional<LeafModel> leaf = {};
};

/// `make` of a material class T with a constructor T(const Params&).
template <class T>
std::unique_ptr<Material> make_material(const Params& p) {
  return std::make_unique<T>(p);
}

}  // namespace frond
