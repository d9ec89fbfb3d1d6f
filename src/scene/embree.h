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
  Vec3 p{};  ///< where the analytic shape that last reported a hit was met, in its object's space

  /// A row of some copies of objects.
  struct Copy {
    const void* copies;
    uint32_t row;
  };
  /// The copies, from outside in, that traversal is in, and those of the nearest hit so far. How many the hit is in its
  /// instID[0] says (level_of).
  std::array<Copy, InstanceRows::kMost> inside, hit;
  uint32_t depth = 0;

  void enter(const Copy& copy) {
    inside[depth] = copy;
    base.instID[0] = ++depth;
  }
  void leave() { base.instID[0] = --depth == 0 ? RTC_INVALID_GEOMETRY_ID : depth; }
  /// A key of the copy that traversal is in.
  uint64_t place() const {
    uint64_t place = RTC_INVALID_GEOMETRY_ID;
    for (uint32_t i = 0; i < depth; ++i) place = hash_key(place, inside[i].row);
    return place;
  }
};

inline uint32_t level_of(const RTCHit& hit) { return hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? 0 : hit.instID[0]; }

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
