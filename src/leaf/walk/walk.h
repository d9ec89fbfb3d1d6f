#pragma once

#include <span>

#include "core/random.h"
#include "core/spectrum.h"
#include "core/vec.h"
#include "leaf/tissue/tissue.h"

namespace frond::leaf {

/// Random walks of light through a leaf (Baranoski and Rokne 1997; Baranoski 2006), at one wavelength or at several on
/// one walk. Directions are unit vectors in the leaf's frame, z the adaxial normal. wo points to where the traced ray
/// came from, wi to where it leaves to. Both want |z| > 0.

/// Increase with any change that may change results: tables on disk are kept by it.
inline constexpr int kWalkVersion = 2;

/// How the mesophyll absorbs: whole rays at random, or a share of each. The means agree. Weighted walks end by
/// roulette.
enum class Absorption : uint8_t { analog, weighted };

/// How a walk ended.
enum class Fate : uint8_t {
  absorbed,
  surface,      ///< reflected at its first event (Rs)
  reflected,    ///< came back out of the tissue (Rd)
  transmitted,  ///< left by the other side (T)
};

struct WalkEnd {
  Fate fate;
  Vec3d wi;       ///< unit
  double weight;  ///< 1 in analog walks; 0 where absorbed
};

/// Numbers for a walk's first event, for those who have better ones than a stream's.
struct FirstEvent {
  double branch;  ///< in [0, 1): reflected where below Fresnel's reflectance
  double x, y;    ///< a uniform point of the unit disk for the lobe's first try
};

WalkEnd walk(const Tissue& tissue, const Vec3d& wo, Absorption absorption, const FirstEvent& first, RandomStream& rng);
WalkEnd walk(const Tissue& tissue, const Vec3d& wo, Absorption absorption, RandomStream& rng);

using LaneValues = std::array<double, kLanes>;

struct SpectralWalkEnd {
  Fate fate;
  Vec3d wi;
  LaneValues weight;  ///< at most K at each of K wavelengths
};

/// One walk for 1 to kLanes wavelengths. `tissues` are of one leaf, and `hero` is one of them, drawn uniformly: then
/// the mean of each weight over any fate and directions is that of walks at its own wavelength, however the indices
/// differ.
SpectralWalkEnd walk(std::span<const Tissue* const> tissues, size_t hero, const Vec3d& wo, Absorption absorption,
                     const FirstEvent& first, RandomStream& rng);

/// f of light reflected at the outer surface, 1/sr: exact. 0 where wi is on the other side.
double surface_f(const Tissue& tissue, const Vec3d& wo, const Vec3d& wi);

/// f of light that has been inside, 1/sr: an unbiased estimate by one walk. Light leaves unperturbed through the outer
/// interface, but every direction inside an epidermis was drawn from a lobe: so the walk is connected to wi there, one
/// event before it would leave.
double estimate_subsurface_f(const Tissue& tissue, const Vec3d& wo, const Vec3d& wi, Absorption absorption,
                             RandomStream& rng);

/// The same at several wavelengths by one walk, as `walk` does it.
LaneValues estimate_subsurface_f(std::span<const Tissue* const> tissues, size_t hero, const Vec3d& wo, const Vec3d& wi,
                                 Absorption absorption, RandomStream& rng);

/// Fresnel reflectance of the outer surface, the same on both sides.
double surface_reflectance(const Tissue& tissue, double cos_theta);

}  // namespace frond::leaf
