#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "core/math/float4.h"
#include "core/units/interval.h"

namespace frond {

/// Largest number of wavelengths that one path carries.
inline constexpr int kLanes = 4;

/// Values of a spectral quantity at the wavelengths of one path, one for each lane. Unused lanes hold 0. It is one SIMD
/// register, so that functions pass it in a register.
struct SampledSpectrum {
  Float4 v{};

  constexpr SampledSpectrum() = default;
  constexpr explicit SampledSpectrum(float s) : v{s, s, s, s} {}
  constexpr explicit SampledSpectrum(Float4 lanes) : v(lanes) {}
  float operator[](int i) const { return v[i]; }
  float& operator[](int i) { return reinterpret_cast<float*>(&v)[i]; }

  SampledSpectrum& operator+=(const SampledSpectrum& b) { return v += b.v, *this; }
  SampledSpectrum& operator*=(const SampledSpectrum& b) { return v *= b.v, *this; }
  SampledSpectrum& operator*=(float s) { return v *= s, *this; }
  friend SampledSpectrum operator+(SampledSpectrum a, const SampledSpectrum& b) { return a += b; }
  friend SampledSpectrum operator*(SampledSpectrum a, const SampledSpectrum& b) { return a *= b; }
  friend SampledSpectrum operator*(SampledSpectrum a, float s) { return a *= s; }
  friend SampledSpectrum operator*(float s, SampledSpectrum a) { return a *= s; }
  friend bool operator==(const SampledSpectrum& a, const SampledSpectrum& b) { return are_equal(a.v, b.v); }

  /// Largest lane.
  float max() const { return std::max({v[0], v[1], v[2], v[3]}); }
  bool is_black() const { return are_equal(v, Float4{}); }
  /// Returns whether every lane is finite and not negative.
  bool is_physical() const { return are_finite_and_not_negative(v); }
};

/// Wavelengths of one path, one for each lane. BSDFs and textures need only compute active lanes. Lanes from `count` on
/// are never active; the integrator deactivates a lane whose throughput has become 0.
struct SampledWavelengths {
  std::array<float, kLanes> nm{};
  std::array<float, kLanes> pdf{};  ///< probability density per nm; 1 if the wavelengths are fixed or a band's
  std::array<bool, kLanes> active{};
  /// Lane that continues where lanes part, as in refraction by a dispersive glass; uniform over the lanes in use, by
  /// the number that chose the wavelengths. -1: the BSDF draws a lane.
  int8_t hero = -1;
  int count = 0;                        ///< number of lanes in use
  std::array<uint16_t, kLanes> band{};  ///< index of each lane's band, if the strategy has bands

  bool is_active(int lane) const { return active[static_cast<size_t>(lane)]; }
  /// Deactivates the lanes in which `throughput` is 0.
  void retire_black_lanes(const SampledSpectrum& throughput) {
    using Byte4 = signed char __attribute__((vector_size(4)));
    const Byte4 kept = __builtin_convertvector(throughput.v != 0, Byte4);
    active = std::bit_cast<std::array<bool, kLanes>>(std::bit_cast<Byte4>(active) & kept);
  }
};

/// Mean over the lanes in use.
inline float mean(const SampledSpectrum& s, const SampledWavelengths& lambda) {
  return (s.v[0] + s.v[1] + s.v[2] + s.v[3]) / static_cast<float>(lambda.count);
}

/// Function of wavelength; its user defines the unit. Outside `range_nm` the value at the nearest end is returned; a
/// material or light rejects a render with wavelengths outside the range before the first path (check_range).
/// Thread-safe.
class Spectrum {
 public:
  virtual ~Spectrum() = default;
  /// Value at the wavelength `lambda_nm`.
  virtual float at(float lambda_nm) const = 0;
  /// Wavelengths (nm) for which there are data.
  virtual Interval range_nm() const = 0;
  /// Upper bound of the values.
  virtual float max_value() const = 0;

  /// Values at the wavelengths of a path. Classes evaluated at every hit override it: one virtual call, not four.
  virtual SampledSpectrum sample(const SampledWavelengths& lambda) const { return sample_lanes(*this, lambda); }

 protected:
  /// Calls `at` of class T for each lane; if T is final, the calls are not virtual.
  template <class T>
  static SampledSpectrum sample_lanes(const T& spectrum, const SampledWavelengths& lambda) {
    SampledSpectrum s;
    for (int i = 0; i < lambda.count; ++i) s[i] = spectrum.at(lambda.nm[static_cast<size_t>(i)]);
    return s;
  }
};
using SpectrumPtr = std::shared_ptr<const Spectrum>;

}  // namespace frond
