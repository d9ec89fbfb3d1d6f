#pragma once

#include <array>

#include "radiometry/brf.h"
#include "render/session.h"

namespace frond {

/// Leaves for which nothing is said of their incident direction are made to keep energy: reciprocal, or where they
/// cannot be, with the light's direction for incident, which is noisier.
void keep_energy(SceneDescription& description, const Registry& registry);

/// What radiometry asks of a scene that was made for images: leaves for which nothing is said are reciprocal, or take
/// the light's direction for incident where they cannot be; paths end by roulette alone, unless `keeps_depth`; the
/// period and the wavelengths, a PluginText of `bands`, are those asked for. Throws InputError.
void prepare_for_radiometry(const Registry& registry, const std::string& wavelengths,
                            const std::optional<std::array<double, 2>>& period, bool keeps_depth,
                            SceneDescription& description);

/// A measurement in words: with the scene's own identity all that decides its figures. `what`: its kind, and whatever
/// else it asks for.
std::string measurement_text(const std::string& what, const std::optional<Target>& target,
                             const std::optional<std::array<double, 2>>& period);

/// One period, or all that stands in the scene, at its top.
Target default_target(const Scene& scene);

/// How far along a direction, whose cosine with +z is given, a ray that passes the target begins: above all that stands
/// in the scene, and not on it.
double distance_above(const Scene& scene, const Target& target, double cosine);

}  // namespace frond
