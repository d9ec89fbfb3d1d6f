#include "lights/station.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace frond {
namespace {

/// Differences of measured irradiances below this are noise: in W m^-2, and as a share of the global irradiance.
constexpr double kNoise = 5, kRelativeNoise = 0.01;

/// Returns the sun's irradiance of a horizontal plane as a difference of measured values: 0 if it is below 0 by noise.
/// Throws InputError for the parameter `name` if it is less.
double difference(const Params& p, std::string_view name, double global, double other, const char* what) {
  const double rest = global - other;
  if (rest < -(kNoise + kRelativeNoise * global))
    fail(p.where(name), "{} is {:.5g} W/m^2 of a horizontal plane, more than \"globalirradiance\" {:.5g}", what, other,
         global);
  return std::max(0.0, rest);
}

}  // namespace

std::optional<SplitIrradiance> measured_irradiance(const Params& p, const SplitIrradiance& model, double sine,
                                                   double most_direct_normal) {
  const auto value = [&p](std::string_view name) { return p.given(name) ? std::optional(p.real(name)) : std::nullopt; };
  const auto global = value(kGlobalIrradiance.name), diffuse = value(kDiffuseIrradiance.name),
             normal = value(kDirectNormalIrradiance.name);
  if (!global && !diffuse && !normal) return {};
  if (p.given("illuminance"))
    fail(p.where("illuminance"), "\"illuminance\" and measured irradiances exclude each other");
  const std::string_view first = global    ? kGlobalIrradiance.name
                                 : diffuse ? kDiffuseIrradiance.name
                                           : kDirectNormalIrradiance.name;
  SplitIrradiance split{};
  if (global && diffuse && normal && std::abs(*global - *diffuse - *normal * sine) > kNoise + kRelativeNoise * *global)
    fail(p.where(first),
         "\"globalirradiance\" {:.5g} is not \"diffuseirradiance\" {:.5g} plus \"directnormalirradiance\" {:.5g} times "
         "the sine of the sun's elevation, {:.4g}, which is {:.5g} W/m^2: two of the three suffice",
         *global, *diffuse, *normal, sine, *diffuse + *normal * sine);
  if (normal && diffuse) {
    split = {*normal * sine, *diffuse};
  } else if (global && diffuse) {
    split = {difference(p, kDiffuseIrradiance.name, *global, *diffuse, "\"diffuseirradiance\""), *diffuse};
  } else if (global && normal) {
    split = {*normal * sine, difference(p, kDirectNormalIrradiance.name, *global, *normal * sine,
                                        "the sun's part of \"directnormalirradiance\"")};
  } else {  // one alone: the model's split
    const double of_model = global ? model.direct + model.diffuse : diffuse ? model.diffuse : model.direct;
    const double measured = global ? *global : diffuse ? *diffuse : *normal * sine;
    if (measured > 0 && !(of_model > 0))
      fail(p.where(first), "\"{}\" is {:.5g} W/m^2, but this sky has no such light to scale", first, measured);
    const double factor = measured > 0 ? measured / of_model : 0;
    split = {model.direct * factor, model.diffuse * factor};
  }
  if (split.direct > most_direct_normal * sine) {
    p.warn(first, fmt::format("the sun's direct normal irradiance would be {:.5g} W/m^2, above the {:.5g} W/m^2 "
                              "outside of the atmosphere: the rest counts as diffuse; are the sun's position and the "
                              "values those of one time?",
                              split.direct / sine, most_direct_normal));
    split.diffuse += split.direct - most_direct_normal * sine;
    split.direct = most_direct_normal * sine;
  }
  if (!(model.direct > 0) && split.direct > 0) {
    if (split.direct > kNoise + kRelativeNoise * (split.direct + split.diffuse))
      fail(p.where(first), "the sun gives {:.5g} W/m^2 of the measured light, but this sky has no sun", split.direct);
    split = {0, split.diffuse + split.direct};
  }
  if (split.diffuse > 0 && !(model.diffuse > 0))
    fail(p.where(first), "{:.5g} W/m^2 of the measured light are diffuse, but this sky has no diffuse light",
         split.diffuse);
  return split;
}

}  // namespace frond
