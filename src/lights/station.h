#pragma once

#include <optional>

#include "core/params.h"

namespace frond {

/// Irradiances of a horizontal plane, W m^-2, from 300 to 2500 nm.
struct SplitIrradiance {
  double direct, diffuse;
};

/// Parameters of a weather station's irradiances.
inline constexpr Param kGlobalIrradiance{
    .name = "globalirradiance",
    .kind = ParamKind::real,
    .unit = "W/m^2",
    .range = kAtLeastZero,
    .doc =
        "Measured global irradiance of a horizontal plane (GHI), to which sun and sky are scaled. Of global, "
        "diffuse and direct normal irradiance two are needed; with one alone the clear sky's split is kept."};
inline constexpr Param kDiffuseIrradiance{.name = "diffuseirradiance",
                                          .kind = ParamKind::real,
                                          .unit = "W/m^2",
                                          .range = kAtLeastZero,
                                          .doc = "Measured diffuse irradiance of a horizontal plane (DHI)."};
inline constexpr Param kDirectNormalIrradiance{.name = "directnormalirradiance",
                                               .kind = ParamKind::real,
                                               .unit = "W/m^2",
                                               .range = kAtLeastZero,
                                               .doc = "Measured irradiance of the sun on a plane that faces it (DNI)."};

/// Returns the measured irradiances of the parameters, completed by those of the model; nullopt if none is given.
/// `sine`: of the sun's elevation, above 0. `most_direct_normal`: W m^-2, above which what is left is diffuse. Throws
/// InputError for values that contradict each other or the model.
std::optional<SplitIrradiance> measured_irradiance(const Params& p, const SplitIrradiance& model, double sine,
                                                   double most_direct_normal);

}  // namespace frond
