#include "render/film/work.h"

#include <algorithm>
#include <optional>
#include <tuple>

namespace frond {
namespace {

auto order_of(const WorkItem& a) {
  return std::tuple(a.pixels.y0, a.pixels.x0, a.pixels.y1, a.pixels.x1, a.samples.begin, a.samples.end);
}

/// Adds the samples of `whole` outside of `hole`, which lies inside it, to `rest`.
void add_rest(const WorkItem& whole, const WorkItem& hole, std::vector<WorkItem>& rest) {
  const auto add = [&rest](Crop pixels, SampleRange samples) {
    if (const WorkItem piece{pixels, samples}; !piece.empty()) rest.push_back(piece);
  };
  const Crop &w = whole.pixels, &h = hole.pixels;
  add({w.x0, w.y0, w.x1, h.y0}, whole.samples);
  add({w.x0, h.y1, w.x1, w.y1}, whole.samples);
  add({w.x0, h.y0, h.x0, h.y1}, whole.samples);
  add({h.x1, h.y0, w.x1, h.y1}, whole.samples);
  add(h, {whole.samples.begin, hole.samples.begin});
  add(h, {hole.samples.end, whole.samples.end});
}

/// Union of the two items if it is a single item.
std::optional<WorkItem> joined(const WorkItem& a, const WorkItem& b) {
  const Crop &p = a.pixels, &q = b.pixels;
  const bool same_columns = p.x0 == q.x0 && p.x1 == q.x1, same_rows = p.y0 == q.y0 && p.y1 == q.y1,
             same_samples = a.samples == b.samples;
  const auto touch = [](auto begin, auto end, auto other_begin, auto other_end) {
    return end == other_begin || other_end == begin;
  };
  const bool go_together =
      (same_columns && same_rows && touch(a.samples.begin, a.samples.end, b.samples.begin, b.samples.end)) ||
      (same_columns && same_samples && touch(p.y0, p.y1, q.y0, q.y1)) ||
      (same_rows && same_samples && touch(p.x0, p.x1, q.x0, q.x1));
  if (!go_together) return {};
  return WorkItem{{std::min(p.x0, q.x0), std::min(p.y0, q.y0), std::max(p.x1, q.x1), std::max(p.y1, q.y1)},
                  {std::min(a.samples.begin, b.samples.begin), std::max(a.samples.end, b.samples.end)}};
}

}  // namespace

WorkItem intersection(const WorkItem& a, const WorkItem& b) {
  return {{std::max(a.pixels.x0, b.pixels.x0), std::max(a.pixels.y0, b.pixels.y0), std::min(a.pixels.x1, b.pixels.x1),
           std::min(a.pixels.y1, b.pixels.y1)},
          {std::max(a.samples.begin, b.samples.begin), std::min(a.samples.end, b.samples.end)}};
}

std::vector<WorkItem> Coverage::missing(const WorkItem& item) const {
  std::vector<WorkItem> pieces;
  if (!item.empty()) pieces.push_back(item);
  for (const WorkItem& covered : items_) {
    std::vector<WorkItem> left;
    for (const WorkItem& piece : pieces)
      if (const WorkItem common = intersection(piece, covered); common.empty())
        left.push_back(piece);
      else
        add_rest(piece, common, left);
    pieces = std::move(left);
  }
  return pieces;
}

bool Coverage::add(const WorkItem& item) {
  if (item.empty()) return true;
  if (std::ranges::any_of(items_, [&](const WorkItem& other) { return !intersection(item, other).empty(); }))
    return false;
  WorkItem grown = item;
  for (auto other = items_.begin(); other != items_.end();)
    if (const auto both = joined(grown, *other)) {
      grown = *both;
      items_.erase(other);
      other = items_.begin();  // the larger item can be adjacent to earlier ones
    } else {
      ++other;
    }
  items_.insert(std::ranges::upper_bound(items_, order_of(grown), {}, order_of), grown);
  return true;
}

bool Coverage::has_all_of(const Coverage& other) const {
  return std::ranges::all_of(other.items_, [this](const WorkItem& item) { return missing(item).empty(); });
}

}  // namespace frond
