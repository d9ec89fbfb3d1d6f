#include "imports/hidden_triangles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace frond {
namespace {

constexpr double kOpposite = -0.9;  ///< largest cosine of the normals of two sheets that face away from each other
constexpr double kSlack = 1e-3;     ///< of barycentric coordinates

/// Triangles with the same vertices in the same order, of which one is compared with others.
struct Group {
  uint32_t first = 0, end = 0;  ///< members in `Groups::members`, ascending by sheet
  Vec3d centroid = {};
  uint32_t least_sheet = 0, most_sheet = 0;
  // While the sheets before are visited in ascending order:
  uint32_t next = 0;            ///< first member whose distance is not known yet
  double nearest = kNotHidden;  ///< smallest distance to a triangle that hides the group
};

struct Groups {
  std::vector<Group> all;  ///< ascending by least sheet
  std::vector<uint32_t> members;
};

/// Triangles without area are in no group.
Groups grouped(const std::vector<SheetTriangle>& triangles) {
  Groups groups;
  for (uint32_t i = 0; i < triangles.size(); ++i)
    if (!(triangles[i].normal == Vec3d{})) groups.members.push_back(i);
  check_stop();
  std::ranges::sort(groups.members, {},
                    [&](uint32_t i) { return std::tuple(triangles[i].vertices, triangles[i].sheet, i); });
  check_stop();
  for (uint32_t at = 0; at < groups.members.size();) {
    const uint32_t i = groups.members[at];
    const SheetTriangle& t = triangles[i];
    Group group{.first = at, .centroid = (t.a + t.b + t.c) / 3.0, .least_sheet = t.sheet, .next = at};
    while (at < groups.members.size() && triangles[groups.members[at]].vertices == t.vertices)
      group.most_sheet = triangles[groups.members[at++]].sheet;
    group.end = at;
    groups.all.push_back(group);
  }
  check_stop();
  std::ranges::sort(groups.all, {}, [&](const Group& g) { return std::pair(g.least_sheet, groups.members[g.first]); });
  return groups;
}

/// Whether the projection of a point to the triangle's plane is inside it, up to rounding.
bool covers(const SheetTriangle& t, const Vec3d& p) {
  const auto side = [&](const Vec3d& a, const Vec3d& b) { return dot(cross(b - a, p - a), t.normal); };
  const double area = dot(cross(t.b - t.a, t.c - t.a), t.normal), slack = -kSlack * area;
  return side(t.a, t.b) >= slack && side(t.b, t.c) >= slack && side(t.c, t.a) >= slack;
}

/// Thrown when a search has made as many comparisons as it may.
struct TooManyComparisons {};

/// Finds the groups that a triangle may hide, in a tree of boxes around their centroids. It depends on no length: a
/// grid's cells would be too many for a triangle that is much larger than the others, or hold too many of them.
class SheetSearch {
 public:
  SheetSearch(const std::vector<SheetTriangle>& triangles, Groups& groups, double tolerance)
      : triangles_(triangles), groups_(groups), tolerance_(tolerance), order_(groups.all.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty()) build(0, uint32_t(order_.size()));
    comparisons_left_ = kMostComparisons + kMostPerTriangle * triangles.size();
  }

  /// Calls `act(group, distance)` for each group of a later sheet that faces away from `t`, a triangle of `sheet`, and
  /// has its centroid behind it.
  template <class Act>
  void visit(const SheetTriangle& t, uint32_t sheet, const Act& act) {
    if (!nodes_.empty()) visit(Query(t, sheet, tolerance_), 0, act);
  }

 private:
  static constexpr uint32_t kLeafSize = 8;
  /// Comparisons with boxes and triangles, of some 10 ns each. Leaves that do not overlap need some 100 a triangle.
  static constexpr uint64_t kMostComparisons = 10'000'000, kMostPerTriangle = 1000;

  /// Box around centroids, and one around the normals.
  struct Node {
    Vec3d least, most, least_normal, most_normal;
    uint32_t most_sheet = 0;
    uint32_t first = 0, end = 0;  ///< in `order_`
    uint32_t second_child = 0;    ///< the first one follows its parent; 0: a leaf
  };

  /// Half spaces that contain the centroids that the triangle may hide: by `covers`, by the distance behind it, and by
  /// its box.
  struct Query {
    Query(const SheetTriangle& t, uint32_t its_sheet, double tolerance) : triangle(t), sheet(its_sheet) {
      const double longest = std::max({length(t.b - t.a), length(t.c - t.b), length(t.a - t.c)});
      const double area = dot(cross(t.b - t.a, t.c - t.a), t.normal);
      // Rounding, of a difference of coordinates.
      const double rounding = 1e-12 * (largest_component(t.a) + longest + tolerance);
      edges = {cross(t.normal, t.b - t.a), cross(t.normal, t.c - t.b), cross(t.normal, t.a - t.c)};
      corners = {t.a, t.b, t.c};
      slack = kSlack * area + rounding * longest;
      behind_most = tolerance + rounding;
      behind_least = -kCoincident * tolerance - rounding;
      const double margin = tolerance + 4 * kSlack * longest + rounding;
      const Vec3d around{margin, margin, margin};
      least = componentwise_min(componentwise_min(t.a, t.b), t.c) - around;
      most = componentwise_max(componentwise_max(t.a, t.b), t.c) + around;
    }
    static double largest_component(const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

    /// Whether no centroid in the box can be hidden.
    bool excludes(const Node& node) const {
      if (node.most_sheet <= sheet) return true;
      if (node.least.x > most.x || node.least.y > most.y || node.least.z > most.z) return true;
      if (node.most.x < least.x || node.most.y < least.y || node.most.z < least.z) return true;
      // The smallest cosine of the triangle's normal with one of the box.
      if (dot(componentwise_min(product(triangle.normal, node.least_normal),
                                product(triangle.normal, node.most_normal)),
              Vec3d{1, 1, 1}) > kOpposite)
        return true;
      const Vec3d center = (node.least + node.most) / 2.0, half = (node.most - node.least) / 2.0;
      const double behind = dot(triangle.a - center, triangle.normal), reach = reach_along(half, triangle.normal);
      if (behind - reach > behind_most || behind + reach < behind_least) return true;
      for (size_t k = 0; k < 3; ++k)
        if (dot(center - corners[k], edges[k]) + reach_along(half, edges[k]) < -slack) return true;
      return false;
    }

    const SheetTriangle& triangle;
    uint32_t sheet;
    std::array<Vec3d, 3> edges, corners;  ///< directions into the triangle, perpendicular to its sides
    double slack, behind_least, behind_most;
    Vec3d least, most;
  };

  static Vec3d product(const Vec3d& a, const Vec3d& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  static Vec3d componentwise_min(const Vec3d& a, const Vec3d& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
  }
  static Vec3d componentwise_max(const Vec3d& a, const Vec3d& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
  }
  static double reach_along(const Vec3d& half, const Vec3d& v) {
    return half.x * std::abs(v.x) + half.y * std::abs(v.y) + half.z * std::abs(v.z);
  }
  const Vec3d& normal_of(const Group& group) const { return triangles_[groups_.members[group.first]].normal; }

  uint32_t build(uint32_t first, uint32_t end) {
    check_stop_now_and_then(nodes_.size());
    const auto index = uint32_t(nodes_.size());
    const Group& one = groups_.all[order_[first]];
    Node node{one.centroid, one.centroid, normal_of(one), normal_of(one), 0, first, end};
    for (uint32_t i = first; i < end; ++i) {
      const Group& group = groups_.all[order_[i]];
      node.least = componentwise_min(node.least, group.centroid);
      node.most = componentwise_max(node.most, group.centroid);
      node.least_normal = componentwise_min(node.least_normal, normal_of(group));
      node.most_normal = componentwise_max(node.most_normal, normal_of(group));
      node.most_sheet = std::max(node.most_sheet, group.most_sheet);
    }
    nodes_.push_back(node);
    if (end - first <= kLeafSize) return index;
    const Vec3d size = node.most - node.least;
    double Vec3d::*const axis = size.x >= size.y && size.x >= size.z ? &Vec3d::x
                                : size.y >= size.z                   ? &Vec3d::y
                                                                     : &Vec3d::z;
    const uint32_t middle = first + (end - first) / 2;
    std::nth_element(
        order_.begin() + first, order_.begin() + middle, order_.begin() + end,
        [&](uint32_t i, uint32_t j) { return groups_.all[i].centroid.*axis < groups_.all[j].centroid.*axis; });
    build(first, middle);
    nodes_[index].second_child = build(middle, end);
    return index;
  }

  template <class Act>
  void visit(const Query& query, uint32_t index, const Act& act) {
    const Node& node = nodes_[index];
    count_comparisons(1);
    if (query.excludes(node)) return;
    if (node.second_child > 0) {
      visit(query, index + 1, act);
      visit(query, node.second_child, act);
      return;
    }
    count_comparisons(node.end - node.first);
    for (uint32_t i = node.first; i < node.end; ++i) {
      Group& group = groups_.all[order_[i]];
      const SheetTriangle& t = query.triangle;
      if (group.most_sheet <= query.sheet || dot(t.normal, normal_of(group)) > kOpposite) continue;
      const double behind = dot(t.a - group.centroid, t.normal);  // of t, which faces away
      if (behind > tolerance_ || behind < -kCoincident * tolerance_ || !covers(t, group.centroid)) continue;
      act(group, std::max(behind, 0.0));
    }
  }

  void count_comparisons(uint64_t comparisons) {
    if (comparisons > comparisons_left_) throw TooManyComparisons();
    if (comparisons_left_ / 1'000'000 != (comparisons_left_ - comparisons) / 1'000'000) check_stop();
    comparisons_left_ -= comparisons;
  }

  const std::vector<SheetTriangle>& triangles_;
  Groups& groups_;
  double tolerance_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
  uint64_t comparisons_left_ = 0;
};

}  // namespace

/// Groups are visited in the order of their sheets. A group has members of several sheets: a member can be hidden by
/// earlier sheets only, which have been visited before.
std::optional<std::vector<double>> hidden_distances(const std::vector<SheetTriangle>& triangles, double tolerance) {
  std::vector<double> distances(triangles.size(), kNotHidden);
  Groups groups = grouped(triangles);
  const auto settle = [&](Group& group, uint32_t sheet) {
    for (; group.next < group.end && triangles[groups.members[group.next]].sheet <= sheet; ++group.next)
      distances[groups.members[group.next]] = group.nearest;
  };
  SheetSearch search(triangles, groups, tolerance);
  try {
    for (size_t i = 0; i < groups.all.size(); ++i) {
      const uint32_t sheet = groups.all[i].least_sheet;
      search.visit(triangles[groups.members[groups.all[i].first]], sheet, [&](Group& group, double distance) {
        settle(group, sheet);
        group.nearest = std::min(group.nearest, distance);
      });
    }
  } catch (const TooManyComparisons&) {
    return {};
  }
  for (Group& group : groups.all) settle(group, std::numeric_limits<uint32_t>::max());
  return distances;
}

}  // namespace frond
