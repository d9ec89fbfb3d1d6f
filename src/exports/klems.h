#pragma once

#include <array>
#include <vector>

#include "exports/exported_bsdf.h"

namespace frond {

/// Klems's full basis: a hemisphere in 145 patches of about the same projected solid angle, the first about the normal
/// (Klems 1994, ASHRAE Transactions 100(1):1065-1072; its table as WINDOW 6 calls LBNL/Klems Full).
class KlemsBasis {
 public:
  static constexpr size_t kPatches = 145;
  struct Ring {
    double theta_min_deg, theta_max_deg;
    int phis;  ///< patches, the first centred on azimuth 0
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

  /// A direction and its share of a patch's projected solid angle.
  struct Node {
    Vec3 w;  ///< z above 0
    double weight;
  };
  /// Gauss's rule of that order in cos theta and in azimuth; the weights of a patch add up to 1.
  static std::vector<Node> nodes(size_t patch, int order);
  /// Integral of cos theta over the patch, sr.
  static double projected_solid_angle(size_t patch);
};

/// A side that light meets: front is that of +z.
enum class LitSide : uint8_t { front, back };

/// f averaged over pairs of Klems's patches.
///
/// Patch k about the direction v(k) of KlemsBasis: light leaves to the front along (x, y, z) of v(k), to the back along
/// (x, y, -z), and comes in from (-x, -y, z) or (-x, -y, -z); so the mirror direction, or the one straight on, of patch
/// k is patch k, as the format has it.
class KlemsMatrices {
 public:
  /// Integrates f over both patches with respect to projected solid angle, by Gauss's rules of rising order until two
  /// agree: pi f within 2e-5 and 2e-4 of itself.
  KlemsMatrices(const ExportMaterial& material, const std::vector<double>& wavelengths_nm);

  /// 1/sr.
  double f(size_t wavelength, LitSide lit, bool reflected, size_t in, size_t out) const {
    return f_[place(wavelength, lit, reflected) + out * KlemsBasis::kPatches + in];
  }
  /// By how much the last two rules differ at most, in pi f, over all wavelengths.
  double error() const { return error_; }
  /// Pairs of patches where the last two rules do not agree as asked.
  size_t unsettled() const { return unsettled_; }

 private:
  static size_t place(size_t wavelength, LitSide lit, bool reflected) {
    return ((wavelength * 2 + size_t(lit)) * 2 + (reflected ? 0 : 1)) * KlemsBasis::kPatches * KlemsBasis::kPatches;
  }

  std::vector<float> f_;
  double error_ = 0;
  size_t unsettled_ = 0;
};

}  // namespace frond
