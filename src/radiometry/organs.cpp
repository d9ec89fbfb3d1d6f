#include "radiometry/organs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/math/random.h"
#include "core/stop.h"
#include "scene/geometry/shape_emitter.h"

namespace frond {
namespace {

/// Returns the root of an element of a forest, and shortens the path to it.
uint32_t root_of(std::vector<uint32_t>& parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Returns the connected part of each triangle, numbered in the order of the first triangles. Vertices are the same if
/// their positions are: files often repeat a vertex for each normal or texture coordinate.
std::vector<uint32_t> connected_parts(const TriangleMesh& mesh) {
  std::vector<uint32_t> parent(mesh.p.size()), order(mesh.p.size());
  std::iota(parent.begin(), parent.end(), 0u);
  std::iota(order.begin(), order.end(), 0u);
  const auto position = [&mesh](uint32_t i) { return std::array{mesh.p[i].x, mesh.p[i].y, mesh.p[i].z}; };
  std::ranges::sort(order, {}, position);
  const auto join = [&parent](uint32_t a, uint32_t b) { parent[root_of(parent, a)] = root_of(parent, b); };
  for (size_t i = 1; i < order.size(); ++i)
    if (position(order[i - 1]) == position(order[i])) join(order[i - 1], order[i]);
  for (const auto& [a, b, c] : mesh.triangles) join(a, b), join(b, c);
  constexpr uint32_t kNew = ~0u;
  std::vector<uint32_t> number(mesh.p.size(), kNew), parts;
  uint32_t count = 0;
  for (const auto& triangle : mesh.triangles) {
    uint32_t& part = number[root_of(parent, triangle[0])];
    if (part == kNew) part = count++;
    parts.push_back(part);
  }
  return parts;
}

/// Area and centre of a surface.
struct Extent {
  double area = 0;
  Vec3d center{};
};

/// Returns area and centre of a triangle under a map.
Extent extent_of(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t, const AffineMap& map) {
  const Vec3d a = to_double(map.point(mesh.p[t[0]])), b = to_double(map.point(mesh.p[t[1]])),
              c = to_double(map.point(mesh.p[t[2]]));
  return {length(cross(b - a, c - a)) / 2, (a + b + c) / 3};
}

/// Centre and normals of a primitive of an analytic shape.
class ShapePoints {
 public:
  ShapePoints(const AnalyticShape& shape, uint32_t primitive) {
    constexpr int kPoints = 987, kStep = 610;  // a Fibonacci lattice, nearly uniform over the area
    constexpr int kEach = 16;                  // point whose normal is kept
    Vec3d moment;
    double area = 0;
    for (int i = 0; i < kPoints; ++i) {
      const float u = (float(i) + 0.5f) / kPoints, v = (float((i * kStep) % kPoints) + 0.5f) / kPoints;
      const ShapePoint point = shape.sample(primitive, {u, v});
      moment += to_double(point.p) * point.area, area += point.area;
      if (i % kEach == 0) normals_.emplace_back(point.ng, point.area);
    }
    center_ = to_float(moment / area);
    for (auto& [normal, its_area] : normals_) its_area /= double(normals_.size());
  }
  /// Exact if the surface is flat, or if the map preserves angles.
  Extent under(const AffineMap& map) const {
    Extent extent{0, to_double(map.point(center_))};
    for (const auto& [normal, area] : normals_) extent.area += double(length(map.normal(normal))) * area;
    return extent;
  }

 private:
  Vec3 center_{};
  std::vector<std::pair<Vec3, double>> normals_;  ///< with their shares of the area
};

/// Returns the indices of a hit of this primitive.
GeometryHit hit_of(const Surface& surface, uint32_t primitive, uint64_t instance) {
  GeometryHit hit;
  hit.material = surface.material, hit.primitive = primitive, hit.instance = instance, hit.shape = &surface;
  return hit;
}

}  // namespace

template <class Visit>
void Organs::visit_primitives(const Visit& visit) const {
  std::map<std::pair<const Surface*, uint32_t>, ShapePoints> points;  // of analytic shapes
  StopPoll poll;
  scene_.geometry().visit_surfaces([&](const Surface& surface, const AffineMap& to_world, uint64_t instance) {
    const auto* mesh = std::get_if<MeshPtr>(&surface.geometry);
    for (uint32_t primitive = 0; primitive < primitives_of(surface.geometry); ++primitive) {
      poll();
      const uint64_t number_from_1 = number(hit_of(surface, primitive, instance));
      if (number_from_1 == 0) continue;
      const auto analytic = [&] {
        const AnalyticShape& shape = *std::get<AnalyticShapePtr>(surface.geometry);
        return points.try_emplace({&surface, primitive}, shape, primitive).first->second.under(to_world);
      };
      visit(surface, to_world, instance, primitive, number_from_1,
            mesh ? extent_of(**mesh, (*mesh)->triangles[primitive], to_world) : analytic());
    }
  });
}

/// Places are assigned at the first visit of a surface: Geometry visits the surfaces of one object one after another.
Organs::Organs(const Scene& scene, std::vector<std::string> material_names, OrganKind kind)
    : scene_(scene), material_names_(std::move(material_names)), kind_(kind) {
  const Geometry& geometry = scene.geometry();
  const uint64_t instances = geometry.instances();
  object_names_ = geometry.instance_names();
  uint64_t count = 0;
  if (kind == OrganKind::instance) {
    if (instances == 0) fail({}, "this scene has no instances of objects (ObjectInstance, Shape \"instances\")");
    count = instances;
  } else if (kind == OrganKind::material) {
    count = material_names_.size();
  } else {
    first_.resize(instances + 1);
    StopPoll poll;
    uint64_t last = ~uint64_t{0};
    geometry.visit_surfaces([&](const Surface& surface, const AffineMap&, uint64_t instance) {
      poll();
      if (instance != last) first_[instance] = count;
      last = instance;
      if (!places_.contains(&surface)) add_place(surface, count - first_[instance]);
      count += places_[&surface].count;
    });
  }
  centers_.resize(count), materials_.resize(count, kSeveral);
  if (kind != OrganKind::material) instances_.resize(count);
  std::vector<double> areas(count);
  visit_primitives(
      [&](const Surface& surface, const AffineMap&, uint64_t instance, uint32_t, uint64_t of, const Extent& extent) {
        const size_t organ = of - 1;
        if (areas[organ] == 0)
          materials_[organ] = surface.material;
        else if (materials_[organ] != surface.material)
          materials_[organ] = kSeveral;
        areas[organ] += extent.area;
        centers_[organ] += extent.center * extent.area;
        if (!instances_.empty()) instances_[organ] = instance;
      });
  for (size_t i = 0; i < count; ++i)
    if (areas[i] > 0) centers_[i] = centers_[i] / areas[i] + scene.origin();
  areas_.assign(areas.begin(), areas.end());
  // The areas of instances are those that measurements by instance have always stated.
  if (kind == OrganKind::instance) areas_ = geometry.areas();
}

void Organs::add_place(const Surface& surface, uint64_t first) {
  Place place{.first = first};
  const auto* mesh = std::get_if<MeshPtr>(&surface.geometry);
  if (kind_ == OrganKind::triangle) place.count = primitives_of(surface.geometry);
  if (kind_ == OrganKind::part && mesh) {
    place.parts = connected_parts(**mesh);
    place.count = place.parts.empty() ? 0 : std::ranges::max(place.parts) + uint64_t{1};
  }
  places_.emplace(&surface, std::move(place));
}

uint64_t Organs::number(const Surface& surface, uint64_t instance, uint32_t primitive) const {
  const Place& place = places_.find(&surface)->second;
  const uint64_t own = kind_ == OrganKind::triangle ? primitive : place.parts.empty() ? 0 : place.parts[primitive];
  return first_[instance] + place.first + own + 1;
}

/// Draws a point wherever the cumulative area of an organ passes a multiple of its share, from a random start.
void Organs::draw(size_t points, uint64_t key,
                  const std::function<void(const RandomSurfacePoint& point, uint64_t number)>& visit) const {
  std::vector<double> passed(size());  // number of points in the area before
  for (size_t i = 0; i < passed.size(); ++i) passed[i] = RandomStream(hash_key(key, uint64_t(i))).uniform_double();
  uint64_t index = 0;
  visit_primitives([&](const Surface& surface, const AffineMap& map, uint64_t, uint32_t primitive, uint64_t number,
                       const Extent& extent) {
    double& at = passed[number - 1];
    const double before = std::floor(at);
    if (extent.area > 0) at += double(points) * extent.area / double(areas_[number - 1]);
    if (std::floor(at) == before) return;
    const ShapeEmitter emitter(surface, {primitive, primitive + 1});
    for (auto left = int64_t(std::floor(at) - before); left > 0; --left) {
      RandomStream random(hash_key(key, index++, uint64_t{1}));
      const float u = random.uniform();
      visit(surface_point(emitter, {u, random.uniform()}, map), number);
    }
  });
}

std::string_view Organs::material(uint64_t number) const {
  const uint32_t material = materials_[number - 1];
  return material == kSeveral ? std::string_view() : std::string_view(material_names_[material]);
}

std::string_view Organs::name(uint64_t number) const {
  const uint64_t in = instance(number);
  if (in == 0) return material(number);
  const auto after = std::ranges::upper_bound(object_names_, in, {}, &std::pair<uint64_t, std::string>::first);
  return after == object_names_.begin() ? std::string_view() : std::string_view(std::prev(after)->second);
}

size_t Organs::visit_triangles(
    const std::function<void(const std::array<Vec3d, 3>& corners, uint64_t number)>& visit) const {
  size_t others = 0;
  StopPoll poll;
  scene_.geometry().visit_surfaces([&](const Surface& surface, const AffineMap& map, uint64_t instance) {
    const auto* mesh = std::get_if<MeshPtr>(&surface.geometry);
    others += mesh ? 0 : 1;
    if (!mesh) return;
    for (uint32_t i = 0; i < (*mesh)->triangles.size(); ++i) {
      poll();
      std::array<Vec3d, 3> corners;
      for (size_t k = 0; k < 3; ++k)
        corners[k] = to_double(map.point((*mesh)->p[(*mesh)->triangles[i][k]])) + scene_.origin();
      visit(corners, number(hit_of(surface, i, instance)));
    }
  });
  return others;
}

}  // namespace frond
