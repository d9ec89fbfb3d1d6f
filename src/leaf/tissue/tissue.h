#pragma once

#include <array>
#include <memory>
#include <vector>

#include "leaf/tissue/lobe.h"
#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// Lobes of a leaf's walls. Not owned.
struct LeafLobes {
  const Lobe *cuticle, *epidermis, *spongy, *palisade;
};

/// Lobes by [interface][ray goes up][refracted]; nullptr: the ideal direction is kept.
using InterfaceLobes = std::array<std::array<std::array<const Lobe*, 2>, 2>, 6>;

/// A leaf at one wavelength as a stack of media and interfaces. Interfaces 0 to 5 count from the adaxial side. Medium i
/// lies above interface i: 0 is the air over the leaf, 6 the air under it, both of index 1; the epidermes, media 1 and
/// 5, are alike, and so are both parts of a mesophyll in which the air space moves. The lobes belong to the TissueModel
/// that made it.
struct Tissue {
  static constexpr size_t kInterfaces = std::tuple_size_v<InterfaceLobes>, kMedia = 7, kBeneath = 6;

  std::array<double, kMedia> n;              ///< refractive indices
  std::array<double, kMedia> optical_depth;  ///< along the normal; where the air space moves, of both parts together
  const InterfaceLobes* lobes;               ///< not owned
  /// The air space (medium 3) lies anywhere in the mesophyll: media 2 and 4 share the depth as p to 1 - p, p uniform.
  bool air_space_moves;
  bool sieve_and_detour;

  /// Optical depth of the whole mesophyll along the normal.
  double mesophyll_depth() const { return air_space_moves ? optical_depth[2] : optical_depth[2] + optical_depth[4]; }
  /// Index of the cuticle, which is the epidermis's.
  double n_cuticle() const { return n[1]; }
  /// Lobe of a ray that meets the interface going up or down; nullptr: none.
  const Lobe* lobe(size_t interface, bool up, bool refracted) const { return (*lobes)[interface][up][refracted]; }
  /// Lobe of the outer surface's reflection.
  const Lobe& surface_lobe() const { return *lobe(0, false, false); }
};

/// A leaf at all wavelengths. Must outlive the tissues that it makes; copies share its lobes.
class TissueModel {
 public:
  explicit TissueModel(const TissueParams& params);

  const TissueParams& params() const { return params_; }
  LeafLobes leaf_lobes() const& { return {&lobes_->cuticle, &lobes_->epidermis, &lobes_->spongy, &lobes_->palisade}; }
  const InterfaceLobes& lobes() const& { return lobes_->at_interfaces; }
  /// Returns other lobes in the arrangement of this leaf's structure.
  InterfaceLobes arrange(const LeafLobes& lobes) const;

  /// Returns the leaf at lambda_nm, within kConstantsRange_nm. Fast enough for the render loop.
  Tissue at(double lambda_nm) const&;
  Tissue at(double lambda_nm) && = delete;
  /// The same with another optical depth of the mesophyll and other lobes, for leaves that vary over their surface.
  Tissue at(double lambda_nm, double optical_depth, const InterfaceLobes& lobes) const;

 private:
  struct Lobes {
    TabulatedLobe cuticle, epidermis, spongy, palisade;
    InterfaceLobes at_interfaces{};
  };
  /// Everything that depends on the wavelength.
  struct Optics {
    double n_cuticle, n_mesophyll, n_antidermal_wall, depth;
  };
  Optics optics_at(double lambda_nm) const;
  Tissue build(const Optics& optics, const InterfaceLobes& lobes) const;

  TissueParams params_;
  std::shared_ptr<Lobes> lobes_;
  std::vector<Optics> optics_;  ///< at kAbsorptionGrid; linear in between, like the constants
};

/// Returns the optical depth along a ray at |cos| `c` from the normal, as in `survival`.
inline double path_depth(double optical_depth, double c, bool sieve_and_detour) {
  return optical_depth / (sieve_and_detour ? std::cos(c) : c);
}

/// Returns the share of light that the mesophyll transmits, for a ray at |cos| `c` from the normal: Beer's law; with
/// the sieve and detour effects cos(c) replaces c (Baranoski and Eng 2007).
inline double survival(double optical_depth, double c, bool sieve_and_detour) {
  return optical_depth > 0 ? std::exp(-path_depth(optical_depth, c, sieve_and_detour)) : 1;
}

}  // namespace frond::leaf
