#include "scene/geometry_builder.h"

#include <algorithm>
#include <map>

#include "core/stop.h"
#include "scene/format/known_names.h"
#include "scene/format/plugin_text.h"
#include "scene/leaf_models.h"

namespace frond {

extern const FloatTextureInfo instance_float_texture;

namespace {

/// Validates a mesh, because a plug-in's shape may return any data and Embree does not check it.
void check_made(const ShapeGeometry& geometry, const ShapeInfo& info, const Location& where) {
  const auto reject = [&](const std::string& what) { fail(where, "shape \"{}\" has a defect: {}", info.name, what); };
  const auto* pointer = std::get_if<MeshPtr>(&geometry);
  if (pointer ? !*pointer : !std::get<AnalyticShapePtr>(geometry)) reject("make() returned nothing");
  if (!pointer) return;
  const TriangleMesh& mesh = **pointer;
  const size_t vertices = mesh.p.size(), triangles = mesh.triangles.size();
  const auto fits = [](size_t size, size_t all) { return size == 0 || size == all; };
  if (!fits(mesh.n.size(), vertices) || !fits(mesh.uv.size(), vertices))
    reject(fmt::format("it has made a mesh of {} vertices with {} normals and {} texture coordinates", vertices,
                       mesh.n.size(), mesh.uv.size()));
  if (!fits(mesh.flipped.size(), triangles))
    reject(fmt::format("it has made a mesh of {} triangles, and says of {} whether they are turned", triangles,
                       mesh.flipped.size()));
  if (mesh.halves_from < triangles && (triangles - mesh.halves_from) % 2 != 0)
    reject(
        fmt::format("it has made a mesh of {} triangles, which from {} on are no pairs", triangles, mesh.halves_from));
  for (const auto& triangle : mesh.triangles)
    if (const uint32_t last = std::ranges::max(triangle); last >= vertices)
      reject(fmt::format("it has made a mesh of {} vertices with a triangle that names number {}", vertices, last));
}

/// Throws InputError for coordinates beyond kFarthest.
void check_extent(const ShapeGeometry& geometry, const Location& where) {
  const auto check = [&where](const Vec3& p) { check_coordinates(p, "this shape reaches to", where); };
  if (const auto* mesh = std::get_if<MeshPtr>(&geometry)) {
    std::for_each((*mesh)->p.begin(), (*mesh)->p.end(), check);
    return;
  }
  const AnalyticShape& shape = *std::get<AnalyticShapePtr>(geometry);
  for (unsigned i = 0; i < shape.count(); ++i) {
    check(shape.bounds(i).min);
    check(shape.bounds(i).max);
  }
}

/// Throws InputError for an area light on a shape that cannot be sampled.
void check_emitter(const ShapeGeometry& geometry, const Location& where) {
  if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry); shape && !(*shape)->cannot_emit().empty())
    fail(where, "this shape cannot give off light: {}; triangles can", (*shape)->cannot_emit());
}

/// Warns about duplicate faces, which leaf meshes often have for both sides: a light path would hit two leaves at once.
void warn_of_double_faces(const ShapeGeometry& geometry, const Location& where, const Log& log) {
  const auto* mesh = std::get_if<MeshPtr>(&geometry);
  if (!mesh) return;
  using Corners = std::array<std::array<float, 3>, 3>;
  std::vector<Corners> faces;
  faces.reserve((*mesh)->triangles.size());
  for (const auto& t : (*mesh)->triangles) {
    Corners& corners = faces.emplace_back();
    for (size_t k = 0; k < 3; ++k) corners[k] = {(*mesh)->p[t[k]].x, (*mesh)->p[t[k]].y, (*mesh)->p[t[k]].z};
    std::sort(corners.begin(), corners.end());
  }
  StopPoll poll;
  std::ranges::sort(faces, [&poll](const Corners& a, const Corners& b) {
    poll();
    return a < b;
  });
  const size_t doubles = std::ranges::unique(faces).size();
  if (doubles > 0)
    log.warn(where, fmt::format(
                        "{} of {} faces of this leaf lie on one another: every ray passes two leaves there; a leaf has "
                        "its two sides in one face",
                        doubles, (*mesh)->triangles.size()));
}

/// Converts shapes to surfaces and instances. Objects are ordered so that contained objects come first.
class GeometryBuilder {
 public:
  GeometryBuilder(const SceneDescription& description, const Registry& registry, SceneResolver& resolver,
                  Interval shutter, const ThreadPool& pool, const Log& log, Problems& problems)
      : description_(description),
        registry_(registry),
        resolver_(resolver),
        shutter_(shutter),
        pool_(pool),
        log_(log),
        problems_(problems) {
    for (size_t i = 0; i < description.objects.size(); ++i)
      if (!description.objects[i].name.empty()) by_name_.emplace(description.objects[i].name, i);
    visits_.resize(description.objects.size());
  }

  /// Throws all errors after all shapes have been built.
  std::shared_ptr<const Geometry> build() {
    ObjectParts world;
    problems_.attempt([&] {
      for (size_t i = 0; i < description_.objects.size(); ++i) visit(i);
      world = parts_of(description_.shapes, description_.instances);
      (void)levels_in(world);
    });
    problems_.check();
    return std::make_shared<const Geometry>(std::move(objects_), std::move(world), pool_.size());
  }

 private:
  /// State of an object of the description, and its index in building order.
  struct Visit {
    bool is_open = false;
    std::optional<uint32_t> place = {};
  };

  /// Builds an object after the objects that it contains. Returns its index. Throws InputError for a cycle.
  uint32_t visit(size_t index) {
    const ObjectDescription& object = description_.objects[index];
    if (visits_[index].is_open) fail(object.where, "object \"{}\" holds an instance of itself", object.name);
    if (!visits_[index].place) {
      if (++open_ > InstanceRows::kMost + 1) reject_nesting(object);  // one more if the outermost is not placed
      visits_[index].is_open = true;
      ObjectParts parts = parts_of(object.shapes, object.instances);
      parts.name = object.name;
      visits_[index] = {false, uint32_t(objects_.size())};
      built_.push_back({index, levels_in(parts)});
      objects_.push_back(std::move(parts));
      --open_;
    }
    return *visits_[index].place;
  }

  /// Number of levels of instances in an object. Throws InputError, at an object, if they are too many.
  size_t levels_in(const ObjectParts& parts) const {
    size_t levels = 0;
    for (const Instances& instances : parts.instances)
      for (const uint32_t place : instances.objects) {
        levels = std::max(levels, built_[place].levels + 1);
        if (levels > InstanceRows::kMost) reject_nesting(description_.objects[built_[place].index]);
      }
    return levels;
  }

  [[noreturn]] static void reject_nesting(const ObjectDescription& object) {
    fail(object.where, "instances of objects are nested more than {} deep in object \"{}\"", InstanceRows::kMost,
         object.name);
  }

  /// Builds the shapes and instances of an object or of the world.
  ObjectParts parts_of(const std::vector<ShapeDescription>& shapes, const InstanceList& set) {
    ObjectParts parts;
    for (const ShapeDescription& shape : shapes) {
      check_stop();
      problems_.attempt([&] { add(shape, parts); });
    }
    if (!set.moving.empty()) parts.instances.push_back(moving_instances(set.moving));
    if (set.objects.empty()) return parts;
    Instances instances{.table = std::make_shared<const InstanceTable>(set.maps)};
    const bool is_one = std::ranges::all_of(set.objects, [&](uint32_t o) { return o == set.objects.front(); });
    for (const uint32_t object : std::span(set.objects).first(is_one ? 1 : set.objects.size()))
      instances.objects.push_back(visit(object));
    parts.instances.push_back(std::move(instances));
    return parts;
  }

  Instances moving_instances(const std::vector<MovingInstance>& moving) {
    auto starts = std::make_shared<std::vector<AffineMap>>();
    Instances instances;
    for (const MovingInstance& i : moving) {
      const Motion& motion = instances.motions.emplace_back(i.start, i.end, shutter_);
      starts->push_back(motion.at(0));
      instances.objects.push_back(visit(i.object));
    }
    instances.table = std::make_shared<const InstanceTable>(std::move(starts));
    if (std::ranges::all_of(instances.motions, &Motion::is_still)) instances.motions.clear();
    return instances;
  }

  /// Creates one shape, which may be a surface or a table of instances.
  void add(const ShapeDescription& shape, ObjectParts& parts) {
    const Location& where = shape.plugin.where;
    const ShapeInfo& info = registry_.shapes.get(shape.plugin.name, where);
    const Params params(info, shape.plugin, resolver_);
    MadeShape made = make_checked(info, where, [&] {
      return info.make(params, {shape.world_from_object, shape.reverse_orientation});
    });
    if (const auto* set = std::get_if<ObjectInstances>(&made))
      parts.instances.push_back(instances(*set, shape, params));
    else
      for (ShapeGeometry& geometry : std::get<std::vector<ShapeGeometry>>(made))
        parts.surfaces.push_back(surface(std::move(geometry), info, shape, params));
  }

  /// Checks a created shape. A constant alpha of 1 is dropped, so that Embree needs no filter callback.
  Surface surface(ShapeGeometry geometry, const ShapeInfo& info, const ShapeDescription& shape, const Params& params) {
    const Location& where = shape.plugin.where;
    check_made(geometry, info, where);
    Surface result{.geometry = std::move(geometry),
                   .material = uint32_t(shape.material),
                   .alpha = nullptr,
                   .medium_interface = shape.medium_interface};
    check_extent(result.geometry, where);
    if (const Param* declared = find_param(info, kAlphaParam.name); declared && declared->kind == kAlphaParam.kind)
      if (const auto alpha = params.float_texture("alpha"); !alpha->is_constant() || alpha->range().min < 1)
        result.alpha = alpha;
    if (shape.area_light) {
      check_emitter(result.geometry, where);
      result.area_light = uint32_t(*shape.area_light);
    }
    (void)resolver_.material(shape.material);  // created on first use
    if (is_leaf_[shape.material]) warn_of_double_faces(result.geometry, where, log_);
    return result;
  }

  /// Tables are shared between shapes that name the same file.
  Instances instances(const ObjectInstances& set, const ShapeDescription& shape, const Params& params) {
    if (shape.area_light)
      fail(shape.plugin.where, "instances of objects cannot emit light: area lights inside objects are not supported");
    const auto object = by_name_.find(set.object);
    if (object == by_name_.end()) fail_unknown(set.object, params.where("object"));
    const TableOrigins origins =
        origins_of(shape.world_from_object.precise, description_.objects[object->second].origin);
    auto& table = tables_[{set.table, origins}];
    if (!table) {
      table = std::make_shared<const InstanceTable>(set.table, params.where("filename"), pool_, origins);
      warn_of_steps(*table, params);
    }
    const Transform placement = shape.world_from_object.relative_to(table->origin());
    Instances result{.table = table, .objects = {visit(object->second)}, .placement = {placement.rows()}};
    result.is_placed = !(placement == Transform());
    if (const std::string problem = problem_of(result.placement); !problem.empty())
      fail(shape.plugin.where, "these instances are not possible: {}", problem);
    return result;
  }

  /// Warns of a table whose 32-bit floats have rounded positions that far from the origin.
  static void warn_of_steps(const InstanceTable& table, const Params& params) {
    constexpr double kLargest = 1. / 256;
    if (table.step() >= kLargest)
      params.warn("filename",
                  fmt::format("its positions are 32-bit floats up to {:.3g} units from the origin, where their "
                              "step is {:g} units; \"transform\" may hold 64-bit floats (<f8)",
                              table.step() * (1 << 23), table.step()));
  }

  /// Throws InputError with the nearest object name.
  [[noreturn]] void fail_unknown(const std::string& object, const Location& where) const {
    std::vector<std::string_view> names;
    for (const auto& [name, place] : by_name_) names.push_back(name);
    fail(where, "there is no object \"{}\"{}", object,
         names.empty() ? "; ObjectBegin makes them" : suggested_name(description_, object, names));
  }

  const SceneDescription& description_;
  const Registry& registry_;
  const std::vector<uint8_t> is_leaf_ = leaf_flags(description_, registry_);  ///< by material
  SceneResolver& resolver_;
  const Interval shutter_;
  const ThreadPool& pool_;
  const Log& log_;
  Problems& problems_;
  /// Objects in building order: index in the description, and levels of instances inside.
  struct Built {
    size_t index, levels;
  };
  std::vector<Built> built_;
  size_t open_ = 0;  ///< objects that are being visited, each inside the one before
  std::map<std::string, size_t, std::less<>> by_name_;
  std::map<std::pair<std::filesystem::path, TableOrigins>, std::shared_ptr<const InstanceTable>> tables_;
  std::vector<Visit> visits_;
  std::vector<ObjectParts> objects_;
};

}  // namespace

void check_coordinates(const Vec3& p, std::string_view what, const Location& where) {
  const bool is_within = std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
  if (!is_within)  // also false for NaN
    fail(where, "{} ({:g}, {:g}, {:g}): {:g} units from the origin is the limit", what, p.x, p.y, p.z, kFarthest);
}

std::shared_ptr<const Geometry> build_geometry(const SceneDescription& description, const Registry& registry,
                                               SceneResolver& resolver, Interval shutter, const ThreadPool& pool,
                                               const Log& log, Problems& problems) {
  return GeometryBuilder(description, registry, resolver, shutter, pool, log, problems).build();
}

/// The range of a texture is compared with the range of the columns of that name.
void check_instance_textures(const SceneSettings& description, const Geometry& geometry, const Log& log) {
  const std::vector<InstanceColumn> columns = geometry.columns();
  std::vector<std::string_view> names;
  for (const InstanceColumn& c : columns) names.push_back(c.name);
  for (const TextureDescription& texture : description.textures) {
    if (texture.plugin.name != instance_float_texture.name) continue;
    const ParsedParam& name = *find_param(texture.plugin.params, "column");  // required, with a single value
    const std::string& wanted = std::get<std::vector<std::string>>(name.values).front();
    const auto column = std::ranges::find(columns, wanted, &InstanceColumn::name);
    if (column == columns.end())
      fail(name.value_where, "no table of instances has a column \"{}\"{}", wanted,
           names.empty() ? ": none has any numbers beside \"transform\"" : suggestion(wanted, names));
    const auto& range = std::get<std::vector<double>>(find_param(texture.plugin.params, "range")->values);
    if (column->range.min < range[0] || column->range.max > range[1])
      log.warn(name.value_where,
               fmt::format("column \"{}\" goes from {:g} to {:g}: what is beyond \"range\" is taken as its ends",
                           wanted, column->range.min, column->range.max));
  }
}

}  // namespace frond
