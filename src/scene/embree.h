#pragma once

#include <cstdint>

#include "core/vec.h"

// The one place that knows which Embree this is: 3 and 4 differ in includes, in the default ray mask and in how a
// query's context is passed.
#if FROND_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#elif FROND_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#error "Who includes this links frond_embree, which says the version"
#endif

namespace frond::embree {

/// A query's context: Embree's own first, so that a filter function gets ours by a cast.
struct Query {
#if FROND_EMBREE_MAJOR >= 4
  RTCRayQueryContext base;
  explicit Query(uint64_t random_key) : key(random_key) { rtcInitRayQueryContext(&base); }
#else
  RTCIntersectContext base;
  explicit Query(uint64_t random_key) : key(random_key) { rtcInitIntersectContext(&base); }
#endif
  uint64_t key;
  Vec3 p{};  ///< where the analytic shape that last reported a hit was met, in its group's space
};

inline void intersect(RTCScene scene, RTCRayHit& ray, Query& query) {
#if FROND_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query.base;
  rtcIntersect1(scene, &ray, &arguments);
#else
  rtcIntersect1(scene, &query.base, &ray);
#endif
}

/// Sets ray.tfar to minus infinity if anything is in the way.
inline void occluded(RTCScene scene, RTCRay& ray, Query& query) {
#if FROND_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.base;
  rtcOccluded1(scene, &ray, &arguments);
#else
  rtcOccluded1(scene, &query.base, &ray);
#endif
}

}  // namespace frond::embree
