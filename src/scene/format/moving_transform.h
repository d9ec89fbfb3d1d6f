#pragma once

#include <optional>

#include "scene/format/scene_transform.h"

namespace frond {

/// Transforms that directives change: ActiveTransform.
enum class ActiveTransforms : uint8_t { all, start, end };

/// A transform at the start and at the end of a motion (TransformTimes).
struct MovingTransform {
  SceneTransform start;
  std::optional<SceneTransform> end = {};  ///< empty: as `start`; nothing moves

  bool moves() const { return end.has_value(); }
  const SceneTransform& at_end() const { return end ? *end : start; }
  bool is_valid() const { return start.is_valid() && at_end().is_valid(); }
  MovingTransform inverse() const { return {start.inverse(), end ? std::optional(end->inverse()) : std::nullopt}; }
  /// Replaces the active transforms by change(transform).
  template <class Change>
  void apply(ActiveTransforms active, const Change& change) {
    if (!moves() && active == ActiveTransforms::all) {
      start = change(start);
      return;
    }
    SceneTransform last = at_end();
    if (active != ActiveTransforms::end) start = change(start);
    if (active != ActiveTransforms::start) last = change(last);
    end = last == start ? std::nullopt : std::optional(last);
  }
};

}  // namespace frond
