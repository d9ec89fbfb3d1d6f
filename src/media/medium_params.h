#pragma once

#include <optional>

#include "core/medium.h"
#include "core/params.h"

namespace frond {

/// Parameters that several media share. "unit" is the scene's unit of length.
inline constexpr Param kSigmaA{.name = "sigma_a",
                               .kind = ParamKind::unbounded,
                               .default_value = 1.0,
                               .unit = "1/unit",
                               .doc = "Absorption coefficient."};
inline constexpr Param kSigmaS{.name = "sigma_s",
                               .kind = ParamKind::unbounded,
                               .default_value = 1.0,
                               .unit = "1/unit",
                               .doc = "Scattering coefficient."};
inline constexpr Param kMediumScale{.name = "scale",
                                    .kind = ParamKind::real,
                                    .default_value = 1.0,
                                    .range = kAtLeastZero,
                                    .doc = "Factor of both coefficients."};
inline constexpr Param kMeanCosine{.name = "g",
                                   .kind = ParamKind::real,
                                   .default_value = 0.0,
                                   .range = {-1, 1},
                                   .doc = "Mean cosine of the phase function (Henyey-Greenstein); above 0: forward."};
/// The box and the grid of values are in medium space: the space of the directive MakeNamedMedium.
inline constexpr Param kBoxLow{.name = "p0",
                               .kind = ParamKind::point3,
                               .default_value = std::array<double, 3>{0, 0, 0},
                               .doc = "Corner of the box that the medium fills."};
inline constexpr Param kBoxHigh{.name = "p1",
                                .kind = ParamKind::point3,
                                .default_value = std::array<double, 3>{1, 1, 1},
                                .doc = "Opposite corner."};
inline constexpr Param kGridX{
    .name = "nx", .kind = ParamKind::integer, .default_value = 1, .range = {1, 1 << 20}, .doc = "Values along x."};
inline constexpr Param kGridY{
    .name = "ny", .kind = ParamKind::integer, .default_value = 1, .range = {1, 1 << 20}, .doc = "Values along y."};
inline constexpr Param kGridZ{
    .name = "nz", .kind = ParamKind::integer, .default_value = 1, .range = {1, 1 << 20}, .doc = "Values along z."};
inline constexpr Param kMediumEmission{
    .name = "Le",
    .kind = ParamKind::illuminant,
    .doc = "Emission, of luminance 1; the medium emits sigma_a Le for each unit of length."};
inline constexpr Param kTemperatureScale{.name = "temperaturescale",
                                         .kind = ParamKind::real,
                                         .default_value = 1.0,
                                         .doc = "Factor of temperatures, after the offset."};
inline constexpr Param kTemperatureOffset{
    .name = "temperatureoffset", .kind = ParamKind::real, .default_value = 0.0, .doc = "Subtracted from temperatures."};
inline constexpr Param kTemperatureCutoff{
    .name = "temperaturecutoff", .kind = ParamKind::real, .doc = "Older name of temperatureoffset."};

/// Absorption and scattering coefficients of a medium of density 1.
class Coefficients {
 public:
  Coefficients(SpectrumPtr sigma_a, SpectrumPtr sigma_s, double scale)
      : sigma_a_(std::move(sigma_a)), sigma_s_(std::move(sigma_s)), scale_(float(scale)) {}
  /// From parameters "sigma_a", "sigma_s" and, if the plug-in declares it, "scale".
  explicit Coefficients(const Params& p);

  /// Absorption coefficient, 1/unit.
  SampledSpectrum sigma_a(const SampledWavelengths& lambda) const { return sigma_a_->sample(lambda) * scale_; }
  /// Scattering coefficient, 1/unit.
  SampledSpectrum sigma_s(const SampledWavelengths& lambda) const { return sigma_s_->sample(lambda) * scale_; }
  /// Extinction coefficient, absorption plus scattering, 1/unit.
  SampledSpectrum sigma_t(const SampledWavelengths& lambda) const {
    return (sigma_a_->sample(lambda) + sigma_s_->sample(lambda)) * scale_;
  }

 private:
  SpectrumPtr sigma_a_, sigma_s_;
  float scale_;
};

/// Thermal emission of a temperature in a grid. As in pbrt-v4 the blackbody's maximum is 1, and nothing is emitted at
/// 100 K or less.
class Temperature {
 public:
  /// From parameters "temperatureoffset" (or "temperaturecutoff") and "temperaturescale".
  explicit Temperature(const Params& p);
  /// Returns the spectrum of a blackbody at the temperature (value - offset) scale, K; its maximum is 1.
  SampledSpectrum emission(float value, const SampledWavelengths& lambda) const;

 private:
  float offset_, scale_;
};

/// Box of parameters "p0" and "p1". Throws InputError if it is empty.
MediumBox medium_box(const Params& p, const Transform& world_from_medium);

/// Size of a grid, "nx", "ny" and "nz". Throws InputError unless the list `name` has as many values, each of `unit`
/// numbers.
std::array<int, 3> grid_size(const Params& p, std::string_view name, size_t unit = 1);

}  // namespace frond
