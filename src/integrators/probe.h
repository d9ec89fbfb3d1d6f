#pragma once

#include "core/bssrdf.h"
#include "core/world.h"
#include "integrators/path_state.h"

namespace frond {

/// Sampler dimensions of a segment and keys of its rays are those of a vertex with this bit in its index: no path has
/// as many vertices.
inline constexpr int kProbeVertex = 1 << 20;

/// Whether a path that meets a surface, seen along `wo`, and continues along `wi` enters the surface's material to
/// leave it by its BSSRDF. `materials` is empty in scenes without one, which then take no time.
inline bool enters_material(const SubsurfaceMaterials& materials, const SurfacePoint& point, const Vec3& wo,
                            const Vec3& wi) {
  return !materials.empty() && materials[point.material_id] && dot(wi, point.hit.shading.z) < 0 &&
         dot(wo, point.hit.shading.z) > 0;
}

/// Point at which a path leaves a material again.
struct MaterialExit {
  SurfacePoint point;
  SampledSpectrum weight;  ///< factor of the throughput
};

/// Finds the exit of a path that enters at a point with this BSSRDF: one intersection of a segment with surfaces of the
/// same material, whatever instance they belong to. `uc` and `u` sample the segment; `time`: of the path's rays. Adds
/// the number of rays to `rays`. Returns false if there is none.
bool find_exit(const World& world, const Bssrdf& bssrdf, uint32_t material_id, float uc, Vec2 u, VertexKey key,
               float time, uint64_t& rays, MaterialExit& exit);

}  // namespace frond
