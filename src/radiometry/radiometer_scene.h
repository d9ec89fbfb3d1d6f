#pragma once

#include <array>

#include "radiometry/brf.h"
#include "render/session.h"

namespace frond {

/// Makes leaves without a stated incident direction conserve energy: reciprocal where the model supports it, otherwise
/// with the light's direction as incident, which is noisier.
void keep_energy(SceneDescription& description, const Registry& registry);

/// Prepares an image's scene for radiometry: applies keep_energy, ends paths by Russian roulette only unless
/// `keeps_depth`, scatters one ray at each hit and states roulette unless the integrator does, and sets the period and
/// the wavelengths (a PluginText of `bands`). Throws InputError, also if bands of fluorescence are not what is
/// measured.
void prepare_for_radiometry(const Registry& registry, const std::string& wavelengths,
                            const std::optional<std::array<double, 2>>& period, bool keeps_depth,
                            SceneDescription& description, bool fluorescence = false);

/// Throws InputError at a material with a BSSRDF, whose light paths of flux do not follow.
void refuse_subsurface(const LoadedScene& loaded);

/// Returns the first light of a scene without a unit, whose energies are in units of the scene; nullptr if there is
/// none. The light "sky" keeps the unit of its data, W and m; its illuminance has none. Lamps have one if their power
/// is stated in W or umol/s.
const ParsedPlugin* light_without_unit(const SceneDescription& description);

/// Returns a text that identifies a measurement together with the scene's own identity. `what`: its kind and other
/// parameters.
std::string measurement_text(const std::string& what, const std::optional<Target>& target,
                             const std::optional<std::array<double, 2>>& period);

/// Targets are in the coordinates of the scene file, as the user gives them, not relative to Scene::origin.

/// Returns one period, or the scene's bounds, at the scene's top. Warns if these bounds are mostly empty ground, with
/// the rectangle around all else.
Target default_target(const Scene& scene, const Log& log);
/// Throws InputError for a target too far away for Embree, or beside the bounds of a scene that is not periodic.
void check_target(const Scene& scene, const Target& target);

/// Returns the materials of surfaces, without those that have none, as "interface".
std::vector<uint32_t> reflectors_of(const Scene& scene);
/// Returns the one-sided areas of materials by index, NaN for those of instances: their areas are measured one by one.
std::vector<double> areas_of_materials(const Geometry& geometry, size_t materials);

/// Returns the least z of the scene.
double bottom_of(const Scene& scene);

/// Returns the distance from the target along a direction, whose cosine with +z is given, to a point above the whole
/// scene. Rays through the target start there.
double distance_above(const Scene& scene, const Target& target, double cosine);

}  // namespace frond
