#pragma once

#include <cstdint>
#include <vector>

#include "core/film.h"

namespace frond {

/// Range of sample indices of a pixel: begin <= index < end.
struct SampleRange {
  uint64_t begin = 0, end = 0;

  bool empty() const { return begin >= end; }
  uint64_t count() const { return empty() ? 0 : end - begin; }
  friend bool operator==(const SampleRange&, const SampleRange&) = default;
};

/// Range of samples of a rectangle of pixels. The resulting film does not depend on how a render is divided into work
/// items, on their order, or on the machines that render them.
struct WorkItem {
  Crop pixels;
  SampleRange samples;

  bool empty() const { return pixels.width() <= 0 || pixels.height() <= 0 || samples.empty(); }
  uint64_t paths() const {
    return empty() ? 0 : uint64_t(pixels.width()) * uint64_t(pixels.height()) * samples.count();
  }
  friend bool operator==(const WorkItem&, const WorkItem&) = default;
};

/// Samples in both items; empty if there are none.
WorkItem intersection(const WorkItem& a, const WorkItem& b);

/// Set of samples, as disjoint work items; adjacent items are joined.
class Coverage {
 public:
  /// Adds the samples of an item. Returns false, without a change, if the set already contains some of them.
  bool add(const WorkItem& item);
  /// Samples of `item` that the set does not contain, as disjoint items.
  std::vector<WorkItem> missing(const WorkItem& item) const;

  const std::vector<WorkItem>& items() const { return items_; }
  /// True if both contain the same samples. Their items can differ, as they depend on the order of additions.
  friend bool operator==(const Coverage& a, const Coverage& b) { return a.has_all_of(b) && b.has_all_of(a); }

 private:
  bool has_all_of(const Coverage& other) const;

  std::vector<WorkItem> items_;  ///< sorted
};

}  // namespace frond
