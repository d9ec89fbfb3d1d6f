#pragma once

#include <array>
#include <cstdint>
#include <exception>

#include "core/math/random.h"
#include "core/math/vec.h"
#include "core/texture.h"

// The only file that depends on Embree's version: 3 and 4 differ in include paths, in the default ray mask and in how a
// query's context is passed.
#if FROND_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#elif FROND_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#error "Who includes this links frond_embree, which says the version"
#endif

namespace frond::embree {

/// A level of instancing: a row of a set of instances.
struct Instance {
  const void* set;
  uint32_t row;
};

/// State of one ray of a query, in addition to Embree's.
struct Lane {
  uint64_t key;
  Vec3 p;  ///< last hit reported by an analytic shape, in its object's space
  /// Instances of the nearest hit so far, outermost first. Their number is stored in the hit's instID[0] (level_of).
  std::array<Instance, InstanceRows::kMost> hit;
};

/// Context of a query. Embree's context is the first member, so that filter functions can cast to Query.
struct Query {
#if FROND_EMBREE_MAJOR >= 4
  RTCRayQueryContext base;
  explicit Query(Lane* of) : lane(of) { rtcInitRayQueryContext(&base); }
#else
  RTCIntersectContext base;
  explicit Query(Lane* of) : lane(of) { rtcInitIntersectContext(&base); }
#endif
  Lane* lane;  ///< array with one element for each ray of the query
  /// Instances that traversal is currently inside, outermost first.
  std::array<Instance, InstanceRows::kMost> inside;
  uint32_t depth = 0;
  std::exception_ptr error = {};  ///< of a plug-in in a callback: Embree would lose it

  /// Rethrows the error of a callback.
  void check() const {
    if (error) [[unlikely]]
      std::rethrow_exception(error);
  }
  /// Enters an instance. The depth is stored in instID[0], which Embree copies into hits.
  void enter(const Instance& instance) {
    inside[depth] = instance;
    base.instID[0] = ++depth;
  }
  void leave() { base.instID[0] = --depth == 0 ? RTC_INVALID_GEOMETRY_ID : depth; }
  /// Returns a key of the current instance path.
  uint64_t instance_key() const {
    uint64_t key = RTC_INVALID_GEOMETRY_ID;
    for (uint32_t i = 0; i < depth; ++i) key = hash_key(key, inside[i].row);
    return key;
  }
};

/// Number of instance levels of a hit.
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

/// Traces a single ray.
inline void intersect(RTCScene scene, RTCRayHit& ray, Query& query) {
#if FROND_EMBREE_MAJOR >= 4
  auto arguments = arguments_of(query, rtcInitIntersectArguments, RTC_RAY_QUERY_FLAG_INCOHERENT);
  rtcIntersect1(scene, &ray, &arguments);
#else
  rtcIntersect1(scene, &query.base, &ray);
#endif
  query.check();
}

/// Traces a coherent packet; rays whose `valid` is not -1 are ignored.
inline void intersect(const int* valid, RTCScene scene, RTCRayHit8& rays, Query& query) {
#if FROND_EMBREE_MAJOR >= 4
  auto arguments = arguments_of(query, rtcInitIntersectArguments, RTC_RAY_QUERY_FLAG_COHERENT);
  rtcIntersect8(valid, scene, &rays, &arguments);
#else
  query.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &query.base, &rays);
#endif
  query.check();
}

/// Sets ray.tfar to minus infinity if the ray is occluded.
inline void occluded(RTCScene scene, RTCRay& ray, Query& query) {
#if FROND_EMBREE_MAJOR >= 4
  auto arguments = arguments_of(query, rtcInitOccludedArguments, RTC_RAY_QUERY_FLAG_INCOHERENT);
  rtcOccluded1(scene, &ray, &arguments);
#else
  rtcOccluded1(scene, &query.base, &ray);
#endif
  query.check();
}

/// Same for a packet. Shadow rays to an area light spread: Embree traces such rays faster if they are not called
/// coherent, and parallel ones as fast (docs/internals.md, "Bundles").
inline void occluded(const int* valid, RTCScene scene, RTCRay8& rays, Query& query) {
#if FROND_EMBREE_MAJOR >= 4
  auto arguments = arguments_of(query, rtcInitOccludedArguments, RTC_RAY_QUERY_FLAG_INCOHERENT);
  rtcOccluded8(valid, scene, &rays, &arguments);
#else
  query.base.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcOccluded8(valid, scene, &query.base, &rays);
#endif
  query.check();
}

}  // namespace frond::embree
