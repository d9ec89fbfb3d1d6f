#pragma once

#include <memory>
#include <optional>

#include "core/light.h"
#include "core/math/transform.h"
#include "core/params.h"

namespace frond {

/// Squared distance below which a point is taken to lie on the light itself; a division by it would overflow.
inline constexpr float kLeastSquare = 1e-30f;

inline constexpr Param kLightScale{
    .name = "scale", .kind = ParamKind::real, .default_value = 1.0, .range = kAtLeastZero, .doc = "Factor."};
inline constexpr Param kLightPower{.name = "power",
                                   .kind = ParamKind::real,
                                   .unit = "lm",
                                   .doc = "Total power, to which the light is scaled; 0 or less: not given."};

/// Returns the light's stated total, "power" or "illuminance". As in pbrt-v4, values <= 0 state none; they cause a
/// warning.
std::optional<double> stated_total(const Params& p, std::string_view name);

/// Returns "scale", times the factor that makes the total match the stated one, if any.
float light_scale(const Params& p, std::string_view total, double unit_total);

}  // namespace frond
