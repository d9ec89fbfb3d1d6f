#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>

#include "leaf/lobe.h"

namespace frond::leaf {

/// How the cells of a leaf are layered (Baranoski 2006; Baranoski and Eng 2007).
enum class Structure : uint8_t {
  bifacial,   ///< palisade cells above, spongy cells below, an air space under both
  unifacial,  ///< one kind of mesophyll on both sides of an air space, whose place varies from ray to ray
};

/// A leaf in the terms of its biology.
struct TissueParams {
  Structure structure = Structure::bifacial;
  double thickness_m = 0;
  double mesophyll_fraction = 0;  ///< of the thickness, in [0, 1]: the part that absorbs
  /// Concentrations in the mesophyll, kg/m^3.
  double chlorophyll_a = 0, chlorophyll_b = 0, carotenoids = 0, protein = 0, cellulose = 0, lignin = 0;
  /// Aspect ratios: of the cuticle's undulations and of cell caps. They are the exponents of the lobes.
  double cuticle_aspect = 0, epidermis_aspect = 0, spongy_aspect = 0, palisade_aspect = 0;
  bool sieve_and_detour = false;  ///< the later form of Beer's law, with cos(cos theta) for cos theta
};

/// A leaf measured by botanists, ready to use.
struct Specimen {
  std::string_view name, doc;
  TissueParams params;
};
std::span<const Specimen> specimens();
/// nullptr where there is none of that name.
const Specimen* find_specimen(std::string_view name);

/// Of the mesophyll, 1/m.
double absorption_coefficient(const TissueParams& params, double lambda_nm);

/// A leaf at one wavelength, as a ray meets it. Interfaces 0 to 5 count from the adaxial side. Medium i lies above
/// interface i: 0 is the air over the leaf, 6 the air under it.
struct Tissue {
  static constexpr size_t kInterfaces = 6, kMedia = 7, kBeneath = 6;

  std::array<double, kMedia> n;              ///< refractive indices
  std::array<double, kMedia> optical_depth;  ///< of a straight way through; where the air space moves, of both together
  /// [interface][ray goes up][refracted]; nullptr: the ideal direction is kept.
  std::array<std::array<std::array<const Lobe*, 2>, 2>, kInterfaces> lobes;
  /// The air space (medium 3) lies anywhere in the mesophyll: media 2 and 4 share the depth as p to 1 - p, p uniform.
  bool air_space_moves;
  bool sieve_and_detour;
  std::shared_ptr<const void> owner;  ///< of the lobes

  double n_cuticle() const { return n[1]; }
  const Lobe& surface_lobe() const { return *lobes[0][0][0]; }
};

/// A leaf at all wavelengths. Cheap to copy.
class TissueModel {
 public:
  explicit TissueModel(const TissueParams& params);

  const TissueParams& params() const { return params_; }
  /// lambda_nm within kConstantsRange_nm.
  Tissue at(double lambda_nm) const;

 private:
  struct Lobes {
    Lobe cuticle, epidermis, spongy, palisade;
  };

  TissueParams params_;
  std::shared_ptr<const Lobes> lobes_;
};

/// Share of light that the mesophyll lets through, for a ray at |cos| `c` from the normal: Beer's law.
inline double survival(double optical_depth, double c, bool sieve_and_detour) {
  return optical_depth > 0 ? std::exp(-optical_depth / (sieve_and_detour ? std::cos(c) : c)) : 1;
}

}  // namespace frond::leaf
