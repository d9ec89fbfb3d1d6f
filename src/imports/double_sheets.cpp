#include "imports/double_sheets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "core/random.h"

namespace frond {
namespace {

struct Triangle {
  Vec3d a, b, c, normal;  ///< unit normal; 0 for a triangle without area
  uint32_t mesh = 0, index = 0;
};

std::vector<Triangle> all_triangles(const std::vector<PlantMesh>& meshes) {
  std::vector<Triangle> all;
  for (uint32_t m = 0; m < meshes.size(); ++m)
    for (uint32_t i = 0; i < meshes[m].triangles.size(); ++i) {
      const auto& t = meshes[m].triangles[i];
      Triangle triangle{.a = to_double(meshes[m].p[t[0]]),
                        .b = to_double(meshes[m].p[t[1]]),
                        .c = to_double(meshes[m].p[t[2]]),
                        .normal = {},
                        .mesh = m,
                        .index = i};
      const Vec3d n = cross(triangle.b - triangle.a, triangle.c - triangle.a);
      if (const double size = length(n); size > 0) triangle.normal = n / size;
      all.push_back(triangle);
    }
  return all;
}

/// Disjoint sets of triangles; the representative of a set is its first triangle.
class Sets {
 public:
  explicit Sets(size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t first(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = first(a), b = first(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> parent_;
};

struct PointHash {
  size_t operator()(const Vec3d& p) const { return hash_bytes({reinterpret_cast<const char*>(&p), sizeof p}); }
};

/// Joins triangles that have an edge in common, are oriented alike there, and make an angle below 90 degrees: sheets.
/// The rim of a leaf that has thickness separates its faces.
Sets connected_sheets(const std::vector<Triangle>& triangles) {
  struct Edge {
    uint32_t from, to, triangle;
    bool is_reversed;
    auto ends() const { return std::pair(from, to); }
  };
  std::unordered_map<Vec3d, uint32_t, PointHash> vertex_of;  // by exact position, + 0 makes one zero of two
  const auto vertex = [&vertex_of](const Vec3d& p) {
    return vertex_of.emplace(p + Vec3d{0, 0, 0}, uint32_t(vertex_of.size())).first->second;
  };
  std::vector<Edge> edges;
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const uint32_t v[] = {vertex(t.a), vertex(t.b), vertex(t.c)};
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t from = v[k], to = v[(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), i, from > to});
    }
  }
  std::ranges::sort(edges, {}, &Edge::ends);
  Sets sets(triangles.size());
  constexpr size_t kMostAtAnEdge = 8;
  for (size_t i = 0; i < edges.size(); ++i)
    for (size_t j = i + 1; j < edges.size() && j < i + kMostAtAnEdge && edges[i].ends() == edges[j].ends(); ++j) {
      const Vec3d &n = triangles[edges[i].triangle].normal, &other = triangles[edges[j].triangle].normal;
      if (edges[i].is_reversed != edges[j].is_reversed && dot(n, other) > 0)
        sets.join(edges[i].triangle, edges[j].triangle);
    }
  return sets;
}

/// Centroids of triangles in a grid of cubes.
class CentroidGrid {
 public:
  CentroidGrid(const std::vector<Triangle>& triangles, double cell) : cell_(cell) {
    for (uint32_t i = 0; i < triangles.size(); ++i) {
      const Triangle& t = triangles[i];
      cells_[key(at((t.a + t.b + t.c) / 3.0))].push_back(i);
    }
  }

  /// Calls `act` with the triangles whose centroid may be within `margin` of the triangle a, b, c. A large triangle is
  /// divided, so that the cells of its bounding box are not many more than those that it meets.
  template <class Act>
  void visit(const Vec3d& a, const Vec3d& b, const Vec3d& c, double margin, const Act& act, int depth = 0) const {
    const auto least = [&](double Vec3d::*x) { return std::min({a.*x, b.*x, c.*x}) - margin; };
    const auto most = [&](double Vec3d::*x) { return std::max({a.*x, b.*x, c.*x}) + margin; };
    const auto low = at({least(&Vec3d::x), least(&Vec3d::y), least(&Vec3d::z)}),
               high = at({most(&Vec3d::x), most(&Vec3d::y), most(&Vec3d::z)});
    constexpr double kMostCells = 256;
    constexpr int kDeepest = 10;
    const double count = double(high[0] - low[0] + 1) * double(high[1] - low[1] + 1) * double(high[2] - low[2] + 1);
    if (count > kMostCells && depth < kDeepest) {
      const Vec3d ab = (a + b) / 2.0, bc = (b + c) / 2.0, ca = (c + a) / 2.0;
      visit(a, ab, ca, margin, act, depth + 1);
      visit(ab, b, bc, margin, act, depth + 1);
      visit(ca, bc, c, margin, act, depth + 1);
      visit(ab, bc, ca, margin, act, depth + 1);
      return;
    }
    for (int64_t x = low[0]; x <= high[0]; ++x)
      for (int64_t y = low[1]; y <= high[1]; ++y)
        for (int64_t z = low[2]; z <= high[2]; ++z)
          if (const auto found = cells_.find(key({x, y, z})); found != cells_.end())
            for (const uint32_t i : found->second) act(i);
  }

 private:
  using Cell = std::array<int64_t, 3>;
  Cell at(const Vec3d& p) const {
    return {int64_t(std::floor(p.x / cell_)), int64_t(std::floor(p.y / cell_)), int64_t(std::floor(p.z / cell_))};
  }
  /// Different cells may have one key: the triangles are tested anyway.
  static uint64_t key(const Cell& cell) {
    return hash_bytes({reinterpret_cast<const char*>(cell.data()), sizeof cell});
  }

  double cell_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
};

/// Whether the projection of a point to the triangle's plane is inside it, up to rounding.
bool covers(const Triangle& t, const Vec3d& p) {
  const auto side = [&](const Vec3d& a, const Vec3d& b) { return dot(cross(b - a, p - a), t.normal); };
  const double area = dot(cross(t.b - t.a, t.c - t.a), t.normal), slack = -1e-3 * area;
  return side(t.a, t.b) >= slack && side(t.b, t.c) >= slack && side(t.c, t.a) >= slack;
}

/// Returns the median of the triangles' longest sides.
double median_side(const std::vector<Triangle>& triangles) {
  std::vector<double> sides;
  for (const Triangle& t : triangles)
    sides.push_back(std::max({length(t.b - t.a), length(t.c - t.b), length(t.a - t.c)}));
  std::ranges::nth_element(sides, sides.begin() + ptrdiff_t(sides.size() / 2));
  return sides[sides.size() / 2];
}

}  // namespace

/// Of two sheets the one whose first triangle precedes the other's is kept. A second sheet has at least half of its
/// triangles behind others: leaves that touch or cross by chance have fewer.
std::vector<DoubleSheet> double_sheets(std::vector<PlantMesh>& meshes, double tolerance,
                                       const std::vector<bool>& remove) {
  const std::vector<Triangle> triangles = all_triangles(meshes);
  if (triangles.size() < 2) return {};
  Sets sheets = connected_sheets(triangles);
  std::vector<double> apart(triangles.size(), -1);  // -1: not a second sheet
  const CentroidGrid grid(triangles, std::max(2 * tolerance, median_side(triangles)));
  constexpr double kOpposite = -0.9, kCoincident = 0.01;
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    if (t.normal == Vec3d{}) continue;
    const uint32_t sheet = sheets.first(i);
    grid.visit(t.a, t.b, t.c, tolerance, [&](uint32_t j) {
      const Triangle& other = triangles[j];
      if (sheets.first(j) <= sheet || dot(t.normal, other.normal) > kOpposite) return;
      const Vec3d centroid = (other.a + other.b + other.c) / 3.0;
      const double behind = dot(t.a - centroid, t.normal);  // of t, which faces away
      if (behind > tolerance || behind < -kCoincident * tolerance || !covers(t, centroid)) return;
      const double distance = std::max(behind, 0.0);
      apart[j] = apart[j] < 0 ? distance : std::min(apart[j], distance);
    });
  }
  std::vector<std::pair<size_t, size_t>> covered(triangles.size());  // by first triangle of a sheet: covered, all
  for (uint32_t j = 0; j < triangles.size(); ++j) {
    auto& [hidden, all] = covered[sheets.first(j)];
    hidden += apart[j] >= 0;
    ++all;
  }
  std::map<uint32_t, DoubleSheet> found;
  std::vector<std::vector<bool>> dropped(meshes.size());
  for (uint32_t j = 0; j < triangles.size(); ++j) {
    const auto [hidden, all] = covered[sheets.first(j)];
    if (2 * hidden < all) continue;
    const uint32_t mesh = triangles[j].mesh, material = meshes[mesh].material;
    DoubleSheet& sheet = found[material];
    sheet.material = material;
    ++sheet.triangles;
    if (apart[j] > kCoincident * tolerance) sheet.apart = std::max(sheet.apart, apart[j]);
    if (!remove[material]) continue;
    dropped[mesh].resize(meshes[mesh].triangles.size());
    dropped[mesh][triangles[j].index] = true;
  }
  for (size_t m = 0; m < meshes.size(); ++m) {
    size_t i = 0;
    if (!dropped[m].empty()) std::erase_if(meshes[m].triangles, [&](const auto&) { return bool(dropped[m][i++]); });
  }
  std::erase_if(meshes, [](const PlantMesh& m) { return m.triangles.empty(); });
  std::vector<DoubleSheet> result;
  for (const auto& [material, sheet] : found) result.push_back(sheet);
  return result;
}

}  // namespace frond
