#pragma once

#include <optional>
#include <string>
#include <vector>

#include "instruments/errors/statistics.h"
#include "radiometry/brf.h"
#include "radiometry/organs.h"
#include "render/session.h"
#include "scene/geometry/surface_points.h"

namespace frond {

/// Returns the flags of the materials whose surfaces count as leaves, by index: the materials with these names, or
/// without names all leaf models. Throws InputError for an unknown name, and if no material counts.
std::vector<uint8_t> counted_materials(const SceneDescription& description, const std::vector<std::string>& names,
                                       const Registry& registry);

/// Returns how often a point of the scene is in the vertical column of the target: 0 or 1, or in a periodic scene the
/// number of its repetitions there.
double count_in_column(const Scene& scene, const Target& target, const Vec3& p);

/// Returns whether light from the direction `w`, a unit vector toward it, reaches a point of a surface.
bool is_sunlit(const Scene& scene, const Hit& hit, const Vec3& w, uint64_t key);
inline bool is_sunlit(const Scene& scene, const RandomSurfacePoint& point, const Vec3& w, uint64_t key) {
  return is_sunlit(scene, {.p = point.p, .ng = point.ng, .shading = {}, .at = {}, .extent = point.extent}, w, key);
}

/// One-sided area of leaves, in scene units squared.
struct LeafArea {
  MeanError all, sunlit, shaded;
};

/// Measures the area of the surfaces of the flagged materials at this number of random points, in the column of the
/// target, or without one of all surfaces. `sun`: direction toward the sun; nullopt: the sunlit area is unknown, NaN.
LeafArea leaf_area(const Scene& scene, const std::optional<Target>& target, std::span<const uint8_t> is_leaf,
                   const std::optional<Vec3>& sun, size_t points, ThreadPool& pool);

/// Returns the sunlit share of the area of each organ, measured at this number of points of each. The error of a share
/// of 0 or 1 is that of half a point; NaN: the organ has no area.
std::vector<MeanError> sunlit_shares(const Scene& scene, const Organs& organs, const Vec3& sun, size_t points,
                                     ThreadPool& pool);

}  // namespace frond
