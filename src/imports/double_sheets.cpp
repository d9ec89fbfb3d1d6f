#include "imports/double_sheets.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <unordered_map>

#include "core/math/random.h"
#include "core/parallel.h"
#include "imports/hidden_triangles.h"

namespace frond {
namespace {

struct PointHash {
  size_t operator()(const Vec3d& p) const { return hash_bytes({reinterpret_cast<const char*>(&p), sizeof p}); }
};

/// Returns all triangles of the meshes, in their order. Equal positions have one number, of 0 and -0 too.
std::vector<SheetTriangle> all_triangles(const std::vector<PlantMesh>& meshes) {
  std::unordered_map<Vec3d, uint32_t, PointHash> vertex_of;
  const auto vertex = [&vertex_of](const Vec3d& p) {
    return vertex_of.emplace(p + Vec3d{0, 0, 0}, uint32_t(vertex_of.size())).first->second;
  };
  std::vector<SheetTriangle> all;
  for (const PlantMesh& mesh : meshes)
    for (const auto& t : mesh.triangles) {
      check_stop_now_and_then(all.size());
      SheetTriangle triangle{to_double(mesh.p[t[0]]), to_double(mesh.p[t[1]]), to_double(mesh.p[t[2]]), {}};
      const Vec3d n = cross(triangle.b - triangle.a, triangle.c - triangle.a);
      if (const double size = length(n); size > 0) triangle.normal = n / size;
      triangle.vertices = {vertex(triangle.a), vertex(triangle.b), vertex(triangle.c)};
      all.push_back(triangle);
    }
  return all;
}

/// Disjoint sets of triangles; the representative of a set is its first triangle.
class DisjointSets {
 public:
  explicit DisjointSets(size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t find_root(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(uint32_t a, uint32_t b) {
    a = find_root(a), b = find_root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> parent_;
};

/// Joins triangles that have an edge in common, are oriented alike there, and make an angle below 90 degrees: sheets.
/// The rim of a leaf that has thickness separates its faces.
DisjointSets connected_sheets(const std::vector<SheetTriangle>& triangles) {
  struct Edge {
    uint32_t from, to, triangle;
    bool is_reversed;
    auto ends() const { return std::pair(from, to); }
  };
  std::vector<Edge> edges;
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    const std::array<uint32_t, 3>& v = triangles[i].vertices;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t from = v[k], to = v[(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), i, from > to});
    }
  }
  check_stop();
  std::ranges::sort(edges, {}, &Edge::ends);
  DisjointSets sets(triangles.size());
  constexpr size_t kMostAtAnEdge = 8;
  for (size_t i = 0; i < edges.size(); ++i) {
    check_stop_now_and_then(i);
    for (size_t j = i + 1; j < edges.size() && j < i + kMostAtAnEdge && edges[i].ends() == edges[j].ends(); ++j) {
      const Vec3d &n = triangles[edges[i].triangle].normal, &other = triangles[edges[j].triangle].normal;
      if (edges[i].is_reversed != edges[j].is_reversed && dot(n, other) > 0)
        sets.unite(edges[i].triangle, edges[j].triangle);
    }
  }
  return sets;
}

}  // namespace

/// Of two sheets the one whose first triangle precedes the other's is kept. A second sheet has at least half of its
/// triangles behind others: leaves that touch or cross by chance have fewer.
std::optional<std::vector<DoubleSheet>> double_sheets(std::vector<PlantMesh>& meshes, double tolerance,
                                                      const std::vector<bool>& remove) {
  std::vector<SheetTriangle> triangles = all_triangles(meshes);
  DisjointSets sheets = connected_sheets(triangles);
  for (uint32_t j = 0; j < triangles.size(); ++j) triangles[j].sheet = sheets.find_root(j);
  const auto apart = hidden_distances(triangles, tolerance);
  if (!apart) return {};
  std::vector<std::pair<size_t, size_t>> covered(triangles.size());  // by first triangle of a sheet: covered, all
  for (size_t j = 0; j < triangles.size(); ++j) {
    auto& [hidden, all] = covered[triangles[j].sheet];
    hidden += (*apart)[j] < kNotHidden;
    ++all;
  }
  std::map<uint32_t, DoubleSheet> found;
  size_t j = 0;
  for (PlantMesh& mesh : meshes)
    std::erase_if(mesh.triangles, [&](const auto&) {
      const auto [hidden, all] = covered[triangles[j].sheet];
      const double distance = (*apart)[j++];
      if (2 * hidden < all) return false;
      DoubleSheet& sheet = found[mesh.material];
      sheet.material = mesh.material;
      ++sheet.triangles;
      if (distance > kCoincident * tolerance && distance < kNotHidden) sheet.apart = std::max(sheet.apart, distance);
      return bool(remove[mesh.material]);
    });
  std::erase_if(meshes, [](const PlantMesh& m) { return m.triangles.empty(); });
  std::vector<DoubleSheet> result;
  for (const auto& [material, sheet] : found) result.push_back(sheet);
  return result;
}

}  // namespace frond
