#include <algorithm>
#include <cmath>

#include "scene/format/plugin_text.h"
#include "scene/origin.h"
#include "shapes/ply.h"

// Scene descriptions in coordinates relative to their origins (scene/origin.h).

namespace frond {
namespace {

bool is_points(const ParsedParam& p) {
  return (p.type == "point3" || p.type == "point") && std::holds_alternative<std::vector<double>>(p.values);
}

/// Whether a parameter has a point far from the origin.
bool has_far_point(const std::vector<ParsedParam>& params) {
  return std::ranges::any_of(params, [](const ParsedParam& p) {
    return is_points(p) &&
           std::ranges::any_of(std::get<std::vector<double>>(p.values), [](double x) { return std::abs(x) > kFar; });
  });
}

void subtract(const Vec3d& origin, ParsedParam& points) {
  auto& v = std::get<std::vector<double>>(points.values);
  for (size_t i = 0; i < v.size(); ++i) v[i] -= origin[int(i % 3)];
}

/// Makes all points of a plug-in relative to `origin`, including points that have their default.
void subtract(const Vec3d& origin, const PluginInfo* info, ParsedPlugin& plugin) {
  for (const Param& declared : info ? info->params : std::span<const Param>()) {
    const auto* value = std::get_if<std::array<double, 3>>(&declared.default_value);
    if (declared.kind != ParamKind::point3 || !value || find_param(plugin.params, declared.name)) continue;
    plugin.params.push_back({.type = "point3",
                             .name = std::string(declared.name),
                             .where = {},
                             .value_where = {},
                             .values = std::vector<double>(value->begin(), value->end())});
  }
  for (ParsedParam& p : plugin.params)
    if (is_points(p)) subtract(origin, p);
}

/// Transform to a space whose origin moves.
SceneTransform moved(const SceneTransform& t, const Vec3d& origin) {
  return origin == Vec3d{} ? t : SceneTransform(PreciseTransform::translate(-origin) * t.precise);
}

/// Transform from a space whose origin moves. Its inverse contains the camera's position and is the one that is
/// rounded.
SceneTransform moved_view(const SceneTransform& camera_from_world, const Vec3d& origin) {
  const PreciseTransform view = camera_from_world.precise * PreciseTransform::translate(origin);
  return {view.inverse().rounded().inverse(), view};
}

/// Moves a plug-in with its transform, which maps to a space with a new origin. Points that are far in the plug-in's
/// own space become relative to the point that is mapped to the origin: then nothing is lost when both are rounded.
void move(const Vec3d& origin, const PluginInfo* info, ParsedPlugin& plugin, SceneTransform& to_space) {
  to_space = moved(to_space, origin);
  if (!has_far_point(plugin.params)) return;
  const Vec3d near = to_space.precise.inverse_point({});
  if (!is_far(near) || !std::isfinite(largest_coordinate(near))) return;
  subtract(near, info, plugin);
  to_space = to_space.relative_to(near);
}

/// The vertices of a file are relative to its parameter "origin".
void move_file(const std::filesystem::path& path, ParsedPlugin& plugin, SceneTransform& to_space) {
  const auto sample = sample_ply(path);
  const ParsedParam* given = find_param(plugin.params, "origin");
  Vec3d origin{};
  if (given && is_points(*given) && std::get<std::vector<double>>(given->values).size() == 3) {
    const auto& v = std::get<std::vector<double>>(given->values);
    origin = {v[0], v[1], v[2]};
  }
  const Vec3d near = to_space.precise.inverse_point({});
  if (!sample || sample->points.empty() || !is_far(sample->points.front() - origin) || !is_far(near) ||
      !std::isfinite(largest_coordinate(near)))
    return;
  origin = origin + near;
  set_param(plugin.params, {.type = "point3",
                            .name = "origin",
                            .where = given ? given->where : Location{},
                            .value_where = given ? given->value_where : Location{},
                            .values = std::vector<double>{origin.x, origin.y, origin.z}});
  to_space = to_space.relative_to(near);
}

void move_shapes(const Vec3d& origin, const Registry& registry, const SceneSettings& settings,
                 std::vector<ShapeDescription>& shapes) {
  for (ShapeDescription& shape : shapes) {
    move(origin, registry.shapes.find(shape.plugin.name), shape.plugin, shape.world_from_object);
    const ParsedParam* file = find_param(shape.plugin.params, "filename");
    const auto* names = file ? std::get_if<std::vector<std::string>>(&file->values) : nullptr;
    if (shape.plugin.name == "plymesh" && names && names->size() == 1)
      move_file(settings.resolve(names->front(), file->value_where), shape.plugin, shape.world_from_object);
  }
}

/// Map between spaces whose origins move.
AffineMap moved(const PreciseTransform::Rows& m, const Vec3d& to, const Vec3d& from) {
  AffineMap map;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) map.rows[i][j] = float(m[i][j]);
    map.rows[i][3] = float(m[i][0] * from.x + m[i][1] * from.y + m[i][2] * from.z + (m[i][3] - to[int(i)]));
  }
  return map;
}

void move_instances(const Vec3d& origin, const std::vector<ObjectDescription>& objects, InstanceList& list) {
  const auto stays = [&](uint32_t object) { return origin == Vec3d{} && objects[object].origin == Vec3d{}; };
  for (MovingInstance& m : list.moving) {
    if (stays(m.object)) continue;
    m.start = moved(m.precise[0], origin, objects[m.object].origin);
    m.end = moved(m.precise[1], origin, objects[m.object].origin);
  }
  if (std::ranges::all_of(list.objects, stays)) return;
  auto maps = std::make_shared<std::vector<AffineMap>>(*list.maps);
  for (size_t i = 0; i < maps->size(); ++i) {
    const uint32_t object = list.objects[i];
    if (stays(object)) continue;
    (*maps)[i] =
        moved(list.precise.empty() ? precise_rows((*maps)[i]) : list.precise[i], origin, objects[object].origin);
  }
  list.maps = std::move(maps);
}

/// A planar mapping takes its offset in double precision. The noise and the cubes of other textures have a period of
/// 256 in each octave's space, so that whole periods are subtracted. A mapping around an axis is not periodic and keeps
/// its position.
void move_texture(const Vec3d& origin, TextureDescription& texture) {
  constexpr double kPeriod = 256;
  ParsedPlugin& plugin = texture.plugin;
  texture.world_from_texture = moved(texture.world_from_texture, origin);
  Vec3d near = texture.world_from_texture.precise.inverse_point({});
  if (!is_far(near) || !std::isfinite(largest_coordinate(near))) return;
  const auto numbers = [&plugin](std::string_view name, std::vector<double> otherwise) {
    const ParsedParam* p = find_param(plugin.params, name);
    const auto* v = p ? std::get_if<std::vector<double>>(&p->values) : nullptr;
    return v && v->size() == otherwise.size() ? *v : otherwise;
  };
  const ParsedParam* mapping = find_param(plugin.params, "mapping");
  const auto* word = mapping ? std::get_if<std::vector<std::string>>(&mapping->values) : nullptr;
  const std::string kind = word && word->size() == 1 ? word->front() : "";
  if (kind == "spherical" || kind == "cylindrical") return;
  if (kind == "planar") {
    const ParsedParam* wrap = find_param(plugin.params, "wrap");
    const auto* wrapped = wrap ? std::get_if<std::vector<std::string>>(&wrap->values) : nullptr;
    const bool repeats = !wrapped || (wrapped->size() == 1 && wrapped->front() == "repeat");
    for (const auto& [axis, delta, e] :
         {std::tuple{"v1", "udelta", std::vector<double>{1, 0, 0}}, {"v2", "vdelta", std::vector<double>{0, 1, 0}}}) {
      const std::vector<double> v = numbers(axis, e);
      double offset = numbers(delta, {0})[0] + dot(Vec3d{v[0], v[1], v[2]}, near);
      if (repeats) offset = std::remainder(offset, 2);  // squares and dots repeat after 2, images after 1
      set_param(plugin.params, parsed_numbers("float", delta, {offset}));
    }
  } else {
    near = {kPeriod * std::round(near.x / kPeriod), kPeriod * std::round(near.y / kPeriod),
            kPeriod * std::round(near.z / kPeriod)};
  }
  texture.world_from_texture = texture.world_from_texture.relative_to(near);
}

/// The target of camera "distant" is a rectangle of its space.
void move_target(ParsedPlugin& camera, MovingTransform& camera_from_world) {
  if (camera.name != "distant" || camera_from_world.moves()) return;
  const auto target = std::ranges::find(camera.params, std::string_view("target"), &ParsedParam::name);
  if (target == camera.params.end()) return;
  auto* v = std::get_if<std::vector<double>>(&target->values);
  if (!v || v->size() != 5) return;
  const Vec3d near = camera_from_world.start.precise.point({});
  if (!is_far({(*v)[0], (*v)[2], (*v)[4]}) || !is_far(near)) return;
  const double by[] = {near.x, near.x, near.y, near.y, near.z};
  for (size_t i = 0; i < 5; ++i) (*v)[i] -= by[i];
  camera_from_world.start = SceneTransform(PreciseTransform::translate(-near) * camera_from_world.start.precise);
}

void move_settings(const Vec3d& origin, const Registry& registry, SceneSettings& settings) {
  if (origin != Vec3d{}) {
    MovingTransform& view = settings.camera_from_world;
    view.start = moved_view(view.start, origin);
    if (view.end) view.end = moved_view(*view.end, origin);
    for (TextureDescription& texture : settings.textures) move_texture(origin, texture);
  }
  move_target(settings.camera, settings.camera_from_world);
  for (LightDescription& light : settings.lights) {
    const auto portal = std::ranges::find(light.plugin.params, std::string_view("portal"), &ParsedParam::name);
    if (portal != light.plugin.params.end() && is_points(*portal)) {  // in world space
      subtract(origin, *portal);
      light.world_from_light = moved(light.world_from_light, origin);
    } else {
      move(origin, registry.lights.find(light.plugin.name), light.plugin, light.world_from_light);
    }
  }
  for (MediumDescription& medium : settings.media)
    move(origin, registry.media.find(medium.plugin.name), medium.plugin, medium.world_from_medium);
}

}  // namespace

SceneDescription moved_to(const SceneOrigins& origins, SceneDescription description, const Registry& registry) {
  move_settings(origins.world, registry, description);
  auto& objects = description.objects;
  for (size_t i = 0; i < origins.objects.size(); ++i) objects[i].origin = origins.objects[i];
  move_shapes(origins.world, registry, description, description.shapes);
  move_instances(origins.world, objects, description.instances);
  for (ObjectDescription& object : objects) {
    move_shapes(object.origin, registry, description, object.shapes);
    move_instances(object.origin, objects, object.instances);
  }
  return description;
}

std::optional<SceneDescription> moved_to_origins(const SceneDescription& description, const Registry& registry,
                                                 const Log& log, const Vec3d* known, Vec3d& world) {
  const SceneOrigins origins = known ? SceneOrigins{*known, {}, *known != Vec3d{}} : find_origins(description, log);
  world = origins.world;
  if (!origins.move_something) return {};
  if (!known && world != Vec3d{})
    log.info(
        fmt::format("the scene is far from the origin of its coordinates: positions are kept relative to ({:.10g}, "
                    "{:.10g}, {:.10g})",
                    world.x, world.y, world.z));
  return moved_to(origins, description, registry);
}

}  // namespace frond
