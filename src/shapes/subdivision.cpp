#include "shapes/subdivision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/stop.h"

namespace frond {
namespace {

constexpr uint32_t kNone = UINT32_MAX;

/// Edge 3 f + k of face f leads from its corner k to the next one.
uint32_t next(uint32_t edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }
uint32_t previous(uint32_t edge) { return edge % 3 == 0 ? edge + 2 : edge - 1; }

/// Triangles with adjacency. Positions are double, because they are averaged repeatedly.
class ControlMesh {
 public:
  using Faces = std::vector<std::array<uint32_t, 3>>;

  ControlMesh(std::vector<Vec3d> p, Faces faces) : p_(std::move(p)), faces_(std::move(faces)) { connect(); }

  const Faces& faces() const { return faces_; }
  /// The reason why the mesh has no limit surface; "" if it has one.
  const std::string& problem() const { return problem_; }

  /// Returns the mesh after one subdivision step: moved vertices, and new ones on the edges.
  ControlMesh refined() const {
    StopPoll poll;  // each step takes four times as long as the one before
    std::vector<Vec3d> p(p_.size());
    for (uint32_t v = 0; v < p_.size(); ++v) {
      poll();
      p[v] = is_boundary(v) ? weighted_boundary_sum(v, 1. / 8) : weighted_ring_sum(v, [](size_t n) { return beta(n); });
    }
    std::vector<uint32_t> middles(opposite_.size(), kNone);
    for (uint32_t e = 0; e < opposite_.size(); ++e) {
      poll();
      if (middles[e] != kNone) continue;
      middles[e] = uint32_t(p.size());
      if (opposite_[e] != kNone) middles[opposite_[e]] = middles[e];
      p.push_back(edge_point(e));
    }
    Faces faces;
    faces.reserve(4 * faces_.size());
    for (uint32_t f = 0; f < faces_.size(); ++f) {
      const auto& [a, b, c] = faces_[f];
      const uint32_t ab = middles[3 * size_t(f)], bc = middles[3 * size_t(f) + 1], ca = middles[3 * size_t(f) + 2];
      faces.insert(faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    return {std::move(p), std::move(faces)};
  }

  /// Moves vertices to the limit surface, and computes their normals.
  void move_to_limit_surface(TriangleMesh& result) const {
    StopPoll poll;
    std::vector<Vec3d> limit(p_.size());
    for (uint32_t v = 0; v < p_.size(); ++v) {
      poll();
      limit[v] = is_boundary(v) ? weighted_boundary_sum(v, 1. / 5)
                                : weighted_ring_sum(v, [](size_t n) { return 1 / (double(n) + 3 / (8 * beta(n))); });
    }
    for (uint32_t v = 0; v < p_.size(); ++v) {
      poll();
      result.p.push_back(to_float(limit[v]));
      result.n.push_back(to_float(normalize_any(normal(v, limit))));
    }
    result.triangles = faces_;
  }

 private:
  /// Weight of each neighbour of an interior vertex: Loop 1987, with the weights of Warren 1995, as in pbrt-v4.
  static double beta(size_t valence) { return valence == 3 ? 3. / 16 : 3. / (8 * double(valence)); }
  uint32_t start_of(uint32_t edge) const { return faces_[edge / 3][edge % 3]; }
  uint32_t end_of(uint32_t edge) const { return start_of(next(edge)); }
  /// `v` must be used by a face.
  bool is_boundary(uint32_t v) const { return is_boundary_[v]; }

  /// Finds opposite half-edges by sorting. An edge with more than two faces is an error.
  void connect() {
    struct Edge {
      uint32_t low, high, edge;
      bool is_same(const Edge& e) const { return low == e.low && high == e.high; }
    };
    const auto edges = uint32_t(3 * faces_.size());
    std::vector<Edge> all;
    all.reserve(edges);
    for (uint32_t e = 0; e < edges; ++e) {
      const uint32_t low = std::min(start_of(e), end_of(e)), high = std::max(start_of(e), end_of(e));
      if (low == high) {
        problem_ = fmt::format("face {} has vertex {} twice", e / 3, low);
        return;
      }
      all.push_back({low, high, e});
    }
    StopPoll poll;
    std::ranges::sort(all, [&poll](const Edge& a, const Edge& b) {
      poll();
      return std::tie(a.low, a.high, a.edge) < std::tie(b.low, b.high, b.edge);
    });
    opposite_.assign(edges, kNone);
    first_.assign(p_.size(), kNone);
    is_boundary_.assign(p_.size(), false);
    for (size_t i = 0; i < all.size(); ++i) {
      if (i + 1 == all.size() || !all[i].is_same(all[i + 1])) continue;
      const Edge &a = all[i], &b = all[++i];
      if (i + 1 < all.size() && all[i + 1].is_same(a)) {
        problem_ = fmt::format("more than two faces share the edge from vertex {} to {}", a.low, a.high);
        return;
      }
      if (start_of(a.edge) == start_of(b.edge)) {
        problem_ = fmt::format("faces {} and {} wind the opposite way about: both go from vertex {} to {}", a.edge / 3,
                               b.edge / 3, start_of(a.edge), end_of(a.edge));
        return;
      }
      opposite_[a.edge] = b.edge, opposite_[b.edge] = a.edge;
    }
    find_first_edges();
  }

  /// For boundary vertices, chooses the edge along the boundary, from which all faces of the vertex can be visited.
  void find_first_edges() {
    std::vector<uint32_t> count(p_.size(), 0);
    for (uint32_t e = 0; e < opposite_.size(); ++e) {
      const uint32_t v = start_of(e);
      ++count[v];
      if (opposite_[e] == kNone) {
        is_boundary_[v] = true;
        first_[v] = e;
      } else if (first_[v] == kNone) {
        first_[v] = e;
      }
    }
    StopPoll poll;
    for (uint32_t v = 0; v < p_.size(); ++v) {
      poll();
      size_t reached = 0;
      if (first_[v] != kNone) for_each_edge(v, [&](uint32_t) { ++reached; });
      if (reached == count[v]) continue;
      problem_ = fmt::format("the faces at vertex {} do not hang together: they touch there alone", v);
      return;
    }
  }

  /// Calls `visit` for the edges that start at a vertex, in order around it.
  template <class Visit>
  void for_each_edge(uint32_t v, const Visit& visit) const {
    uint32_t e = first_[v];
    do {
      visit(e);
      e = opposite_[previous(e)];
    } while (e != kNone && e != first_[v]);
  }

  /// Returns the neighbours in order; for boundary vertices from one end to the other.
  std::vector<uint32_t> ring(uint32_t v) const {
    std::vector<uint32_t> ring;
    if (first_[v] == kNone) return ring;
    uint32_t last = kNone;
    for_each_edge(v, [&](uint32_t e) {
      ring.push_back(end_of(e));
      last = e;
    });
    if (is_boundary(v)) ring.push_back(start_of(previous(last)));
    return ring;
  }

  template <class Weight>
  Vec3d weighted_ring_sum(uint32_t v, const Weight& weight) const {
    const std::vector<uint32_t> around = ring(v);
    if (around.empty()) return p_[v];
    const double w = weight(around.size());
    Vec3d sum = p_[v] * (1 - double(around.size()) * w);
    for (const uint32_t i : around) sum += p_[i] * w;
    return sum;
  }
  /// Boundary rule: weights the two neighbours along the boundary.
  Vec3d weighted_boundary_sum(uint32_t v, double weight) const {
    const std::vector<uint32_t> around = ring(v);
    return p_[v] * (1 - 2 * weight) + (p_[around.front()] + p_[around.back()]) * weight;
  }
  /// Position of the new vertex on an edge; on the boundary, its midpoint.
  Vec3d edge_point(uint32_t e) const {
    const Vec3d &a = p_[start_of(e)], &b = p_[end_of(e)];
    if (opposite_[e] == kNone) return (a + b) * 0.5;
    return (a + b) * (3. / 8) + (p_[start_of(previous(e))] + p_[start_of(previous(opposite_[e]))]) * (1. / 8);
  }

  /// Returns the weight of neighbour i of n in the inward tangent of a boundary vertex.
  static double tangent_weight(size_t i, size_t n) {
    static constexpr double kOfFew[3][4] = {{1, 1}, {0, 1, 0}, {-1, 2, 2, -1}};
    if (n <= 4) return kOfFew[n - 2][i];
    const double angle = std::numbers::pi / double(n - 1);
    return i == 0 || i == n - 1 ? -std::sin(angle) : 2 * (1 - std::cos(angle)) * std::sin(double(i) * angle);
  }

  /// Returns the normal from two tangents, which are weighted sums of the vectors to the neighbours; not normalized. As
  /// in pbrt-v4 it points to the side from which faces wind clockwise, which becomes the front.
  Vec3d normal(uint32_t v, const std::vector<Vec3d>& limit) const {
    const std::vector<uint32_t> around = ring(v);
    const size_t n = around.size();
    Vec3d a, b;
    for (size_t i = 0; i < n; ++i) {
      const Vec3d way = limit[around[i]] - limit[v];
      const double turn = 2 * std::numbers::pi * double(i) / double(n);
      a += way * (is_boundary(v) ? (i == n - 1 ? 1. : i == 0 ? -1. : 0.) : std::sin(turn));
      b += way * (is_boundary(v) ? tangent_weight(i, n) : std::cos(turn));
    }
    return cross(a, b);
  }

  std::vector<Vec3d> p_;
  Faces faces_;
  std::vector<uint32_t> opposite_;  ///< by edge: the opposite half-edge; kNone on the boundary
  std::vector<uint32_t> first_;     ///< by vertex: an edge that starts there; kNone: unused
  std::vector<bool> is_boundary_;
  std::string problem_;
};

}  // namespace

std::string subdivide(const std::vector<Vec3>& cage, const std::vector<std::array<uint32_t, 3>>& faces, int levels,
                      TriangleMesh& result) {
  std::vector<uint32_t> place(cage.size(), kNone);
  std::vector<Vec3d> p;
  std::vector<std::array<uint32_t, 3>> used = faces;
  for (auto& face : used)
    for (uint32_t& v : face) {
      if (place[v] == kNone) {
        place[v] = uint32_t(p.size());
        p.push_back(to_double(cage[v]));
      }
      v = place[v];
    }
  ControlMesh mesh(std::move(p), std::move(used));
  if (!mesh.problem().empty()) return mesh.problem();
  for (int level = 0; level < levels; ++level) mesh = mesh.refined();
  mesh.move_to_limit_surface(result);
  return "";
}

}  // namespace frond
