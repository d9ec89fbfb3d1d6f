#include "scene/origin.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "scene/format/plugin_text.h"
#include "scene/geometry/instance_table.h"
#include "shapes/ply.h"

namespace frond {
namespace {

/// A position of a shape or an instance, its extent from there, and its weight in the choice of the origin.
struct Anchor {
  Vec3d p;
  double extent = 0, weight = 1;
  bool shines = false;  ///< a light, which may be small beside its distance
};

/// An axis-aligned box; empty by default.
struct Box {
  Vec3d min{INFINITY, INFINITY, INFINITY}, max{-INFINITY, -INFINITY, -INFINITY};
  void add(const Vec3d& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
};

/// Returns a bound of the factor of lengths.
double stretch(const PreciseTransform::Rows& m) {
  double largest = 0;
  for (const auto& row : m) largest = std::max(largest, std::hypot(row[0], row[1], row[2]));
  return largest;
}

Vec3d point(const PreciseTransform::Rows& m, const Vec3d& p) {
  const auto row = [&](size_t i) { return m[i][0] * p.x + m[i][1] * p.y + m[i][2] * p.z + m[i][3]; };
  return {row(0), row(1), row(2)};
}

/// Returns the value that half of the weight is below.
template <class Value>
double weighted_median(const std::vector<Anchor>& anchors, const Value& value) {
  std::vector<std::pair<double, double>> values;  // and weights
  double left = 0;
  for (const Anchor& a : anchors) values.emplace_back(value(a), a.weight), left += a.weight / 2;
  std::ranges::sort(values);
  for (const auto& [x, weight] : values)
    if ((left -= weight) <= 0) return x;
  return values.empty() ? 0 : values.back().first;
}

Vec3d weighted_median(const std::vector<Anchor>& anchors) {
  return {weighted_median(anchors, [](const Anchor& a) { return a.p.x; }),
          weighted_median(anchors, [](const Anchor& a) { return a.p.y; }),
          weighted_median(anchors, [](const Anchor& a) { return a.p.z; })};
}

/// The content of the world or of an object.
struct Space {
  Vec3d origin{}, middle{};
  double extent = 0;  ///< distance from the middle within which the content lies, without what is very wide
  double weight = 0;
};

class OriginFinder {
 public:
  OriginFinder(const SceneDescription& description, const Log& log) : description_(description), log_(log) {
    objects_.resize(description.objects.size());
    is_open_.resize(description.objects.size());
  }

  SceneOrigins find() {
    SceneOrigins origins;
    for (size_t i = 0; i < objects_.size(); ++i) origins.objects.push_back(object(i).origin);
    std::vector<Anchor> anchors = anchors_of(description_.shapes, description_.instances);
    origins.world = space_of(anchors).origin;
    warn_of_rounding(anchors, origins.world);
    origins.move_something = has_far_points_ || origins.world != Vec3d{} ||
                             std::ranges::any_of(origins.objects, [](const Vec3d& o) { return o != Vec3d{}; });
    return origins;
  }

 private:
  static constexpr size_t kMostAnchors = 1 << 16;  ///< of one list of instances

  /// An object that contains itself, which is an error, is empty here.
  const Space& object(size_t index) {
    static const Space kNothing;
    if (is_open_[index]) return kNothing;
    if (!objects_[index]) {
      is_open_[index] = true;
      const ObjectDescription& object = description_.objects[index];
      std::vector<Anchor> anchors = anchors_of(object.shapes, object.instances);
      objects_[index] = space_of(anchors);
      is_open_[index] = false;
    }
    return *objects_[index];
  }

  std::vector<Anchor> anchors_of(const std::vector<ShapeDescription>& shapes, const InstanceList& instances) {
    std::vector<Anchor> anchors;
    for (const ShapeDescription& shape : shapes) add(shape, anchors);
    const size_t count = instances.objects.size(), step = count / kMostAnchors + 1;
    for (size_t i = 0; i < count; i += step) {
      add(instances.precise.empty() ? precise_rows((*instances.maps)[i]) : instances.precise[i], instances.objects[i],
          double(step), anchors);
    }
    for (const MovingInstance& moving : instances.moving) add(moving.precise[0], moving.object, 1, anchors);
    return anchors;
  }

  /// Adds an instance.
  void add(const PreciseTransform::Rows& map, size_t index, double count, std::vector<Anchor>& anchors) {
    const Space& content = object(index);
    anchors.push_back({point(map, content.middle), content.extent * stretch(map), content.weight * count});
  }

  void add(const ShapeDescription& shape, std::vector<Anchor>& anchors) {
    const std::vector<ParsedParam>& params = shape.plugin.params;
    if (shape.plugin.name == "instances") return add_table(shape, anchors);
    constexpr std::string_view kSizes[] = {"radius", "height", "zmin", "zmax"};  // of quadrics
    Box box;
    double weight = 0, radius = 0;
    if (shape.plugin.name == "plymesh") {
      if (const auto sample = sample_ply(path_of(params, "filename"))) {
        for (const Vec3d& p : sample->points) box.add(p - point_of(params, "origin"));
        weight = double(sample->vertices);
      }
    } else {
      for (const ParsedParam& p : params) {
        const auto* v = std::get_if<std::vector<double>>(&p.values);
        if (!v) continue;
        if (v->size() == 1 && std::ranges::find(kSizes, p.name) != std::end(kSizes))
          radius = std::max(radius, std::abs((*v)[0]));
        if (p.type != "point3" && p.type != "point") continue;
        for (size_t i = 0; i + 2 < v->size(); i += 3) box.add({(*v)[i], (*v)[i + 1], (*v)[i + 2]});
        weight += double(v->size() / 3);
      }
    }
    if (!(box.min.x <= box.max.x)) box.add({}), weight = 1;
    const PreciseTransform::Rows& rows = shape.world_from_object.precise.rows();
    const Vec3d half = (box.max - box.min) / 2.0, middle = box.min + half;
    has_far_points_ = has_far_points_ || is_far(box.min) || is_far(box.max);
    anchors.push_back(
        {point(rows, middle), (length(half) + radius) * stretch(rows), weight, shape.area_light.has_value()});
  }

  void add_table(const ShapeDescription& shape, std::vector<Anchor>& anchors) {
    const std::string name = text_of(shape.plugin.params, "object");
    const auto& objects = description_.objects;
    const auto placed = std::ranges::find(objects, name, &ObjectDescription::name);
    const auto sample = sample_instance_table(path_of(shape.plugin.params, "filename"));
    if (placed == objects.end() || name.empty() || !sample || sample->maps.empty()) return;
    const PreciseTransform& placement = shape.world_from_object.precise;
    for (const PreciseTransform::Rows& map : sample->maps)
      add((placement * PreciseTransform(map)).rows(), size_t(placed - objects.begin()),
          double(sample->rows) / double(sample->maps.size()), anchors);
  }

  /// A single point; 0 if it is not given.
  static Vec3d point_of(const std::vector<ParsedParam>& params, std::string_view name) {
    const ParsedParam* p = find_param(params, name);
    const auto* v = p ? std::get_if<std::vector<double>>(&p->values) : nullptr;
    return v && v->size() == 3 ? Vec3d{(*v)[0], (*v)[1], (*v)[2]} : Vec3d{};
  }

  static std::string text_of(const std::vector<ParsedParam>& params, std::string_view name) {
    const ParsedParam* p = find_param(params, name);
    const auto* words = p ? std::get_if<std::vector<std::string>>(&p->values) : nullptr;
    return words && words->size() == 1 ? words->front() : "";
  }

  std::filesystem::path path_of(const std::vector<ParsedParam>& params, std::string_view name) const {
    const ParsedParam* p = find_param(params, name);
    return p ? description_.resolve(text_of(params, name), p->value_where) : std::filesystem::path();
  }

  /// A space has its origin where nearly all of its content is. Very wide content, such as a ground, counts only if
  /// there is nothing else.
  static Space space_of(std::vector<Anchor>& anchors) {
    constexpr double kWide = 1000, kFewNear = 0.01;
    std::erase_if(anchors, [](const Anchor& a) { return !std::isfinite(a.weight * largest_coordinate(a.p)); });
    std::vector<Anchor> compact;
    std::ranges::copy_if(anchors, std::back_inserter(compact), [](const Anchor& a) { return a.extent <= kWide; });
    if (compact.empty()) compact = anchors;
    const auto is_near = [](const Anchor& a) { return largest_coordinate(a.p) <= kFar + a.extent; };
    Space space;
    double near = 0;
    for (const Anchor& a : compact) space.weight += a.weight, near += is_near(a) ? a.weight : 0;
    if (space.weight > 0 && near <= kFewNear * space.weight) {
      std::erase_if(compact, is_near);
      const Vec3d median = weighted_median(compact);
      const Vec3d whole = Vec3d{std::round(median.x), std::round(median.y), std::round(median.z)} + Vec3d{};  // no -0
      if (is_far(whole)) space.origin = whole;
    }
    space.middle = weighted_median(compact);
    for (const Anchor& a : compact)
      space.extent = std::max(space.extent, std::min(length(a.p - space.middle) + a.extent, kWide));
    return space;
  }

  /// Positions far from the origin of a scene that lies elsewhere: rays leave a surface at 2^-17 of the coordinates.
  void warn_of_rounding(const std::vector<Anchor>& anchors, const Vec3d& origin) const {
    constexpr double kVisible = 1. / 256;
    const Anchor* farthest = nullptr;
    size_t count = 0;
    for (const Anchor& a : anchors) {
      const double distance = largest_coordinate(a.p - origin);
      if (a.shines || !(a.extent > 0) || !is_far(a.p - origin) || float_spacing(distance) < kVisible * a.extent)
        continue;
      ++count;
      if (!farthest || distance > largest_coordinate(farthest->p - origin)) farthest = &a;
    }
    if (!farthest) return;
    log_.warn({},
              fmt::format("{} of {} shapes and instances are small beside their distance from the others: one is at "
                          "({:.10g}, {:.10g}, {:.10g}), where coordinates are rounded to steps of {:g}, the scene's "
                          "origin is ({:.10g}, {:.10g}, {:.10g})",
                          count, anchors.size(), farthest->p.x, farthest->p.y, farthest->p.z,
                          float_spacing(largest_coordinate(farthest->p - origin)), origin.x, origin.y, origin.z));
  }

  const SceneDescription& description_;
  const Log& log_;
  std::vector<std::optional<Space>> objects_;
  std::vector<bool> is_open_;  ///< by object: its content is being looked at
  bool has_far_points_ = false;
};

}  // namespace

SceneOrigins find_origins(const SceneDescription& description, const Log& log) {
  return OriginFinder(description, log).find();
}

}  // namespace frond
