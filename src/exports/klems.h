#pragma once

#include <array>
#include <vector>

#include "exports/exported_bsdf.h"

namespace frond {

/// Klems's full basis: a hemisphere divided into 145 patches of about equal projected solid angle, the first around the
/// normal (Klems 1994, ASHRAE Transactions 100(1):1065-1072; LBNL/Klems Full in WINDOW 6).
class KlemsBasis {
 public:
  static constexpr size_t kPatches = 145;
  struct Ring {
    double theta_min_deg, theta_max_deg;
    int phis;  ///< number of patches in the ring; the first is centred on azimuth 0
  };
  static constexpr std::array<Ring, 9> kRings{{{0, 5, 1},
                                               {5, 15, 8},
                                               {15, 25, 16},
                                               {25, 35, 20},
                                               {35, 45, 24},
                                               {45, 55, 24},
                                               {55, 65, 24},
                                               {65, 75, 16},
                                               {75, 90, 12}}};

  /// A quadrature direction and its share of the patch's projected solid angle.
  struct Node {
    Vec3 w;  ///< z above 0
    double weight;
  };
  /// Returns nodes of Gauss's rule of this order in cos theta and azimuth. The weights of a patch sum to 1.
  static std::vector<Node> nodes(size_t patch, int order);
  /// Returns the integral of cos theta over the patch, sr.
  static double projected_solid_angle(size_t patch);
};

/// Side that the light is on. The front is the side of +z.
enum class LitSide : uint8_t { front, back };

/// f averaged over pairs of Klems patches.
///
/// With v(k) = (x, y, z) the direction of patch k of KlemsBasis, light leaves to the front along (x, y, z) and to the
/// back along (x, y, -z), and arrives from (-x, -y, z) or (-x, -y, -z). The mirror direction and the straight direction
/// of patch k are therefore patch k, as the format requires.
class KlemsMatrices {
 public:
  /// Integrates f over both patches with respect to projected solid angle. The order of Gauss's rule rises until two
  /// results agree: pi f within 2e-5 and 2e-4 of itself.
  KlemsMatrices(const ExportMaterial& material, const std::vector<double>& wavelengths_nm);

  /// Returns the mean f in 1/sr of an incident and an outgoing patch.
  double f(size_t wavelength, LitSide lit, bool reflected, size_t in, size_t out) const {
    return f_[place(wavelength, lit, reflected) + out * KlemsBasis::kPatches + in];
  }
  /// Returns the largest difference of the last two rules in pi f, over all wavelengths.
  double error() const { return error_; }
  /// Returns the number of pairs of patches for which the last two rules do not agree within the tolerance.
  size_t unconverged() const { return unconverged_; }

 private:
  /// Index of a matrix in f_.
  static size_t place(size_t wavelength, LitSide lit, bool reflected) {
    return ((wavelength * 2 + size_t(lit)) * 2 + (reflected ? 0 : 1)) * KlemsBasis::kPatches * KlemsBasis::kPatches;
  }

  std::vector<float> f_;
  double error_ = 0;
  size_t unconverged_ = 0;
};

}  // namespace frond
