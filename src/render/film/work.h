#pragma once

#include <cstdint>
#include <vector>

#include "core/film.h"

namespace frond {

/// Samples of a pixel, by their indices; the end is not in it.
struct SampleRange {
  uint64_t begin = 0, end = 0;

  bool empty() const { return begin >= end; }
  uint64_t count() const { return empty() ? 0 : end - begin; }
  friend bool operator==(const SampleRange&, const SampleRange&) = default;
};

/// Some samples of some pixels. Work items can be done in any order, on any machine, in parts of any shape: the film
/// that comes out is the same.
struct WorkItem {
  Crop pixels;
  SampleRange samples;

  bool empty() const { return pixels.width() <= 0 || pixels.height() <= 0 || samples.empty(); }
  uint64_t paths() const {
    return empty() ? 0 : uint64_t(pixels.width()) * uint64_t(pixels.height()) * samples.count();
  }
  friend bool operator==(const WorkItem&, const WorkItem&) = default;
};

/// What both have.
WorkItem intersection(const WorkItem& a, const WorkItem& b);

/// Items that have nothing in common with each other; neighbours are put together.
class Coverage {
 public:
  /// False, and nothing changes, where some of it is covered already.
  bool add(const WorkItem& item);
  /// What of `item` is not covered, in pieces.
  std::vector<WorkItem> missing(const WorkItem& item) const;

  const std::vector<WorkItem>& items() const { return items_; }
  /// Whether both cover the same: in which pieces hangs on the order in which they came.
  friend bool operator==(const Coverage& a, const Coverage& b) { return a.has_all_of(b) && b.has_all_of(a); }

 private:
  bool has_all_of(const Coverage& other) const;

  std::vector<WorkItem> items_;  ///< sorted
};

}  // namespace frond
