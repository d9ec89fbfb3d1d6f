#pragma once

#include <span>

#include "core/math/random.h"
#include "core/math/vec.h"
#include "core/spectrum.h"
#include "leaf/tissue/tissue.h"

namespace frond::leaf {

/// Random walks of light through a leaf (Baranoski and Rokne 1997; Baranoski 2006), at one wavelength or at several on
/// one walk. Directions are unit vectors in the leaf's frame, z the adaxial normal. wo points to where the traced ray
/// came from, wi to where it leaves to. Both require |z| > 0.

/// Version of the walk. Increase with any change that may change results: tables on disk are stored under it.
inline constexpr int kWalkVersion = 2;

/// Absorption in the mesophyll: of whole rays at random (analog), or of a share of each ray (weighted). The means
/// agree. Weighted walks end by Russian roulette.
enum class Absorption : uint8_t { analog, weighted };

/// How a walk ended.
enum class Fate : uint8_t {
  absorbed,
  surface,      ///< reflected at its first event (Rs)
  reflected,    ///< reflected after it was inside the tissue (Rd)
  transmitted,  ///< left by the other side (T)
};

/// Result of a walk.
struct WalkEnd {
  Fate fate;
  Vec3d wi;       ///< unit
  double weight;  ///< 1 in analog walks; 0 if absorbed
};

/// Random numbers for a walk's first event, for callers with a better source than a stream (a low-discrepancy sampler).
struct FirstEvent {
  double branch;  ///< in [0, 1): the ray is reflected if below Fresnel's reflectance
  double x, y;    ///< uniform point of the unit disk for the first draw from the lobe
};

WalkEnd walk(const Tissue& tissue, const Vec3d& wo, Absorption absorption, const FirstEvent& first, RandomStream& rng);
WalkEnd walk(const Tissue& tissue, const Vec3d& wo, Absorption absorption, RandomStream& rng);

using LaneValues = std::array<double, kLanes>;

/// Result of a walk at several wavelengths.
struct SpectralWalkEnd {
  Fate fate;
  Vec3d wi;
  LaneValues weight;  ///< at most K at each of K wavelengths
};

/// One walk for 1 to kLanes wavelengths. `tissues` are of one leaf; `hero` is the index of one of them, drawn
/// uniformly. Then the mean of each weight over any fate and directions equals the mean of walks at its own wavelength,
/// however the indices of refraction differ (hero wavelengths, Wilkie et al. 2014).
SpectralWalkEnd walk(std::span<const Tissue* const> tissues, size_t hero, const Vec3d& wo, Absorption absorption,
                     const FirstEvent& first, RandomStream& rng);

/// Returns f of light reflected at the outer surface, 1/sr: exact; 0 if wi is on the other side.
double surface_f(const Tissue& tissue, const Vec3d& wo, const Vec3d& wi);

/// Returns f of light that has been inside, 1/sr: an unbiased estimate by one walk. Light leaves unperturbed through
/// the outer interface, but every direction inside an epidermis is drawn from a lobe: so the walk is connected to wi
/// there, one event before it would leave.
double estimate_subsurface_f(const Tissue& tissue, const Vec3d& wo, const Vec3d& wi, Absorption absorption,
                             RandomStream& rng);

/// The same at several wavelengths by one walk, as in `walk`.
LaneValues estimate_subsurface_f(std::span<const Tissue* const> tissues, size_t hero, const Vec3d& wo, const Vec3d& wi,
                                 Absorption absorption, RandomStream& rng);

/// Fresnel reflectance of the outer surface, the same on both sides; cos_theta > 0.
double surface_reflectance(const Tissue& tissue, double cos_theta);

}  // namespace frond::leaf
