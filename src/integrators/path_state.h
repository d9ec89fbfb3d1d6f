#pragma once

#include "core/math/random.h"
#include "core/math/ray.h"
#include "integrators/light_selector.h"

namespace frond {

/// Uses of random streams at one path vertex.
enum class Use : uint64_t {
  ray,
  shadow_ray,
  light_bsdf,
  bsdf,
  roulette,
  albedo,
  count,
  medium = count,  ///< at vertices that take one sample of each
};

/// Key of the random numbers of one vertex: of its rays, and of its streams by use.
struct VertexKey {
  uint64_t value;

  /// For one of several samples or rays, by its index `which`. The step differs from that of a stream's counter, so
  /// that streams do not overlap.
  uint64_t key(Use use, int which = 0) const {
    return value + (uint64_t(use) + uint64_t(which) * uint64_t(Use::count)) * 0xd1342543de82ef95ull;
  }
  RandomStream stream(Use use, int which = 0) const { return RandomStream(key(use, which)); }
};

/// Key of a vertex of a path, by its index along the path.
inline VertexKey vertex_key(uint64_t path_key, uint64_t vertex) { return {hash_key(path_key, vertex)}; }

/// State of a path.
struct Path {
  Ray ray;
  SampledWavelengths lambda;
  SampledSpectrum throughput;
  /// Density of the last direction, 1/sr, for MIS with light sampling: the sum over the rays that the last vertex
  /// scattered; infinite if no light sample competes.
  float scatter_pdf;
  float light_samples;   ///< number of light samples at the last vertex, for MIS
  int scattered_rays;    ///< number of rays that the current vertex scatters
  float split_weight;    ///< factor on the radiance along the path: 1 / (number of rays scattered by its first vertex)
  float eta_scale;       ///< factor by which refraction alone has divided the throughput
  int depth;             ///< scattering events so far
  bool any_nonspecular;  ///< one of them was not specular
  bool is_exit;          ///< the current vertex is where the path leaves a material with a BSSRDF
  LightSelector::LitPoint previous;  ///< the last vertex
  VertexKey key;                     ///< of the current vertex
};

}  // namespace frond
