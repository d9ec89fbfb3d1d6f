#pragma once

#include <memory>
#include <optional>

#include "core/light.h"
#include "core/params.h"
#include "core/transform.h"

namespace frond {

/// Squared distance below which a point on a surface counts as the light's own: what divides by it would overflow.
inline constexpr float kLeastSquare = 1e-30f;

inline constexpr Param kLightScale{
    .name = "scale", .kind = ParamKind::real, .default_value = 1.0, .range = kAtLeastZero, .doc = "Factor."};
inline constexpr Param kLightPower{.name = "power",
                                   .kind = ParamKind::real,
                                   .unit = "lm",
                                   .doc = "Total power, in place of the light's own; 0 or less states none."};

/// What the scene says of a light's total, "power" or "illuminance". As in pbrt-v4 0 or less states none; a warning
/// tells.
std::optional<double> stated_total(const Params& p, std::string_view name);

/// "scale", times what makes the light's total match where the scene states one.
float light_scale(const Params& p, std::string_view total, double unit_total);

}  // namespace frond
