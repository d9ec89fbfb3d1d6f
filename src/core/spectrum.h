#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "core/float4.h"

namespace frond {

/// Wavelengths that one path carries at most.
inline constexpr int kLanes = 4;

/// A quantity at the wavelengths of one path, lane by lane. Unused lanes hold 0. One register, so that functions hand
/// it on in one.
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

  float max() const { return std::max({v[0], v[1], v[2], v[3]}); }
  bool is_black() const { return are_equal(v, Float4{}); }
};

struct Interval {
  double min, max;
  constexpr bool contains(double x) const { return x >= min && x <= max; }  // false for NaN
};

/// The wavelengths (nm) of one path. A lane takes part while it is active: lanes beyond the strategy's count never are,
/// and the integrator retires a lane whose throughput has fallen to zero, so that nobody works for it.
struct SampledWavelengths {
  std::array<float, kLanes> nm{};
  std::array<float, kLanes> pdf{};  ///< density per nm; 1 for wavelengths that are fixed or a band's
  std::array<bool, kLanes> active{};
  int count = 0;                        ///< lanes in use
  std::array<uint16_t, kLanes> band{};  ///< of the strategy, where it has bands

  bool is_active(int lane) const { return active[static_cast<size_t>(lane)]; }
  void retire_black_lanes(const SampledSpectrum& throughput) {
    for (size_t i = 0; i < kLanes; ++i) active[i] = active[i] && throughput.v[i] != 0;
  }
};

/// Mean over the lanes in use.
inline float mean(const SampledSpectrum& s, const SampledWavelengths& lambda) {
  return (s.v[0] + s.v[1] + s.v[2] + s.v[3]) / static_cast<float>(lambda.count);
}

/// A function of wavelength, in whatever unit its user says. Total: outside `range_nm` the nearest end holds, and
/// whoever sets up a render refuses wavelengths outside the range before the first path (check_range).
class Spectrum {
 public:
  virtual ~Spectrum() = default;
  virtual float at(float lambda_nm) const = 0;
  /// Wavelengths (nm) for which the data stand.
  virtual Interval range_nm() const = 0;
  virtual float max_value() const = 0;

  /// At the wavelengths of a path. What is asked for at every hit does it in one call.
  virtual SampledSpectrum sample(const SampledWavelengths& lambda) const { return sample_by(*this, lambda); }

 protected:
  /// By `at` of the class that is named, without a call where that is final.
  template <class T>
  static SampledSpectrum sample_by(const T& spectrum, const SampledWavelengths& lambda) {
    SampledSpectrum s;
    for (int i = 0; i < lambda.count; ++i) s[i] = spectrum.at(lambda.nm[static_cast<size_t>(i)]);
    return s;
  }
};
using SpectrumPtr = std::shared_ptr<const Spectrum>;

}  // namespace frond
