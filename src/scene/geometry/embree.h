#pragma once

#include <array>
#include <cstdint>

#include "core/random.h"
#include "core/texture.h"
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

/// A row of some instances of objects.
struct Instance {
  const void* set;
  uint32_t row;
};

/// What is known of one ray of a query beside what Embree knows.
struct Lane {
  uint64_t key;
  Vec3 p;  ///< where the analytic shape that last reported a hit was met, in its object's space
  /// Instances, from outside in, of the nearest hit so far. How many the hit is in its instID[0] says (level_of).
  std::array<Instance, InstanceRows::kMost> hit;
};

/// A query's context: Embree's own first, so that a filter function gets ours by a cast.
struct Query {
#if FROND_EMBREE_MAJOR >= 4
  RTCRayQueryContext base;
  explicit Query(Lane* of) : lane(of) { rtcInitRayQueryContext(&base); }
#else
  RTCIntersectContext base;
  explicit Query(Lane* of) : lane(of) { rtcInitIntersectContext(&base); }
#endif
  Lane* lane;  ///< as many as the query has rays
  /// The instances, from outside in, that traversal is in.
  std::array<Instance, InstanceRows::kMost> inside;
  uint32_t depth = 0;

  void enter(const Instance& instance) {
    inside[depth] = instance;
    base.instID[0] = ++depth;
  }
  void leave() { base.instID[0] = --depth == 0 ? RTC_INVALID_GEOMETRY_ID : depth; }
  /// A key of the instance that traversal is in.
  uint64_t instance_key() const {
    uint64_t key = RTC_INVALID_GEOMETRY_ID;
    for (uint32_t i = 0; i < depth; ++i) key = hash_key(key, inside[i].row);
    return key;
  }
};

inline uint32_t level_of(const RTCHit& hit) { return hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? 0 : hit.instID[0]; }

#if FROND_EMBREE_MAJOR >= 4
template <class Arguments>
Arguments arguments_of(Query& query, void (*init)(Arguments*), RTCRayQueryFlags flags) {
  Arguments arguments;
  init(&arguments);
  arguments.context = &query.base;
  arguments.flags = flags;
  return arguments;
}
#endif

inline void intersect(RTCScene scene, RTCRayHit& ray, Query& query) {
#if FROND_EMBREE_MAJOR >= 4
  auto arguments = arguments_of(query, rtcInitIntersectArguments, RTC_RAY_QUERY_FLAG_INCOHERENT);
  rtcIntersect1(scene, &ray, &arguments);
#else
  rtcIntersect1(scene, &query.base, &ray);
#endif
}

/// Rays that go nearly the same way; those whose `valid` is not -1 are left alone.
inline void intersect(const int* valid, RTCScene scene, RTCRayHit8& rays, Query& query) {
#if FROND_EMBREE_MAJOR >= 4
  auto arguments = arguments_of(query, rtcInitIntersectArguments, RTC_RAY_QUERY_FLAG_COHERENT);
  rtcIntersect8(valid, scene, &rays, &arguments);
#else
  query.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &query.base, &rays);
#endif
}

/// Sets ray.tfar to minus infinity if anything is in the way.
inline void occluded(RTCScene scene, RTCRay& ray, Query& query) {
#if FROND_EMBREE_MAJOR >= 4
  auto arguments = arguments_of(query, rtcInitOccludedArguments, RTC_RAY_QUERY_FLAG_INCOHERENT);
  rtcOccluded1(scene, &ray, &arguments);
#else
  rtcOccluded1(scene, &query.base, &ray);
#endif
}

/// The same of rays that go nearly the same way.
inline void occluded(const int* valid, RTCScene scene, RTCRay8& rays, Query& query) {
#if FROND_EMBREE_MAJOR >= 4
  auto arguments = arguments_of(query, rtcInitOccludedArguments, RTC_RAY_QUERY_FLAG_COHERENT);
  rtcOccluded8(valid, scene, &rays, &arguments);
#else
  query.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(valid, scene, &query.base, &rays);
#endif
}

}  // namespace frond::embree
