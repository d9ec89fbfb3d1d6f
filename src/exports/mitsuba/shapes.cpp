#include "exports/mitsuba/shapes.h"

#include <algorithm>
#include <cmath>

#include "exports/mitsuba/textures.h"
#include "scene/format/plugin_text.h"
#include "shapes/ply_writer.h"

namespace frond::mitsuba {
namespace {

/// Instances of instances are written one by one; more than these are most likely a mistake.
constexpr size_t kMostInstances = 10'000'000;

constexpr AffineMap kIdentity{{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};

/// Applies `b` first.
AffineMap product(const AffineMap& a, const AffineMap& b) {
  AffineMap result{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j) {
      double sum = j == 3 ? double(a.rows[i][3]) : 0;
      for (size_t k = 0; k < 3; ++k) sum += double(a.rows[i][k]) * double(b.rows[k][j]);
      result.rows[i][j] = float(sum);
    }
  return result;
}

/// Returns a mesh of patches that are parallelograms, where patches and triangles have the same points and texture
/// coordinates. Others are reported.
TriangleMesh parallelograms(Context& context, const Params& p, const ShapePlacement& placement) {
  if (p.given("N"))
    context.report_unsupported("shapes", p.where("N"), "a bilinear mesh with normals is not exported",
                               "they are left out");
  const std::vector<Vec3> corners = p.vec3s("P");
  std::vector<int> indices = p.integers("indices");
  if (indices.empty()) indices = {0, 1, 2, 3};
  const std::vector<Vec2> uv = p.vec2s("uv");
  TriangleMesh mesh;
  for (size_t i = 0; i < indices.size(); i += 4) {
    const auto corner = [&](size_t k) { return size_t(indices[i + k]); };
    const Vec3 a = corners[corner(0)], b = corners[corner(1)], c = corners[corner(2)], d = corners[corner(3)];
    if (length((a + d) - (b + c)) > 1e-6f * length(d - a))
      context.report_unsupported("shapes", p.where("P"),
                                 "a bilinear patch that is no parallelogram has no equivalent in Mitsuba",
                                 "two triangles stand for it");
    const auto first = uint32_t(mesh.p.size());
    for (size_t k = 0; k < 4; ++k) {
      mesh.p.push_back(placement.to_scene.point(corners[corner(k)]));
      mesh.uv.push_back(uv.empty() ? Vec2{float(k % 2), float(k / 2)} : uv[corner(k)]);
    }
    mesh.triangles.push_back({first, first + 1, first + 3});
    mesh.triangles.push_back({first, first + 3, first + 2});
  }
  orient_mesh(mesh, placement);
  return mesh;
}

}  // namespace

/// XML has all digits of the floats.
Transform::RowsDouble rows_of(const AffineMap& map) {
  Transform::RowsDouble rows{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j) rows[i][j] = double(map.rows[i][j]);
  return rows;
}

Transform::RowsDouble in_units(Transform::RowsDouble rows, double units) {
  for (auto& row : rows)
    for (double& v : row) v *= units;
  return rows;
}

/// Objects are made once, whether they have instances or not: errors in unused ones are reported too.
Shapes::Shapes(Context& context, Materials& materials) : context_(context), materials_(materials) {
  const SceneDescription& description = context.description;
  for (const ObjectDescription& object : description.objects)
    objects_.push_back(parts_of(object.shapes, object.instances));
  world_ = parts_of(description.shapes, description.instances);
  bounds_ = world_.bounds;
  for (const Placed& placed : world_.instances) place(placed, kIdentity, 0);
}

/// Makes shapes as the scene builder does.
Shapes::Parts Shapes::parts_of(const std::vector<ShapeDescription>& shapes, const InstanceList& instances) {
  Parts parts;
  for (const ShapeDescription& shape : shapes) context_.problems.attempt([&] { add(shape, parts); });
  for (const Surface& surface : parts.surfaces)
    if (const auto* mesh = std::get_if<MeshPtr>(&surface.geometry)) {
      for (const Vec3& point : (*mesh)->p) parts.bounds.add(point);
    } else {
      const AnalyticShape& shape = *std::get<AnalyticShapePtr>(surface.geometry);
      for (unsigned i = 0; i < shape.count(); ++i)
        parts.bounds.add(shape.bounds(i).min), parts.bounds.add(shape.bounds(i).max);
    }
  for (const MovingInstance& moving : instances.moving) {
    context_.report_unsupported("shapes", moving.where,
                                "what moves has no equivalent in Mitsuba, where all shapes stand still",
                                "it stands where it is when the shutter opens");
    parts.instances.push_back({moving.object, moving.start});
  }
  for (size_t i = 0; i < instances.objects.size(); ++i)
    parts.instances.push_back({instances.objects[i], (*instances.maps)[i]});
  return parts;
}

/// A shape that has no equivalent is reported, and left out.
void Shapes::add(const ShapeDescription& shape, Parts& parts) {
  const Location& where = shape.plugin.where;
  const std::string& name = shape.plugin.name;
  const ShapeInfo& info = context_.registry.shapes.get(name, where);
  const Params p(info, shape.plugin, context_.resolver);
  const ShapePlacement placement{shape.world_from_object, shape.reverse_orientation};
  if (name == "bilinearmesh") {
    parts.surfaces.push_back({&shape, std::make_shared<const TriangleMesh>(parallelograms(context_, p, placement))});
    return;
  }
  MadeShape made = make_checked(info, where, [&] { return info.make(p, placement); });
  if (const auto* set = std::get_if<ObjectInstances>(&made)) return add_table(*set, shape, p, parts);
  for (ShapeGeometry& geometry : std::get<std::vector<ShapeGeometry>>(made)) {
    if (!std::holds_alternative<MeshPtr>(geometry)) {
      const auto why = unsupported_reason(shape, p);
      if (why) context_.report_unsupported("shapes", why->first, why->second, "it is left out");
      if (why) return;
    }
    parts.surfaces.push_back({&shape, std::move(geometry)});
  }
}

/// Returns why a shape that is no mesh has no equivalent, with the place: whole spheres, disks and cylinders under a
/// similarity have one.
std::optional<std::pair<Location, std::string>> Shapes::unsupported_reason(const ShapeDescription& shape,
                                                                           const Params& p) {
  const std::string& name = shape.plugin.name;
  const Location& where = shape.plugin.where;
  if (name != "sphere" && name != "disk" && name != "cylinder")
    return {{where, fmt::format("shape \"{}\" has no equivalent in Mitsuba: meshes, spheres, disks and cylinders have",
                                name)}};
  if (p.real("phimax") != 360)
    return {{p.where("phimax"), fmt::format("part of a {} has no equivalent in Mitsuba", name)}};
  if (!AffineMap{shape.world_from_object.rows()}.area_scale())
    return {
        {where, fmt::format("a {} whose transform stretches it has no equivalent in Mitsuba: rotations and scalings "
                            "have",
                            name)}};
  if (name == "disk" && p.real("innerradius") != 0)
    return {{p.where("innerradius"), "a ring has no equivalent in Mitsuba"}};
  const double radius = p.real("radius");
  if (name == "sphere" &&
      ((p.given("zmin") && p.real("zmin") > -radius) || (p.given("zmax") && p.real("zmax") < radius)))
    return {{p.where("zmin"), "part of a sphere has no equivalent in Mitsuba"}};
  return {};
}

/// Columns of the table have no equivalent; textures that read them are rejected.
void Shapes::add_table(const ObjectInstances& set, const ShapeDescription& shape, const Params& p, Parts& parts) {
  const auto& objects = context_.description.objects;
  const auto object = std::ranges::find(objects, set.object, &ObjectDescription::name);
  const InstanceTable table(set.table, p.where("filename"), context_.pool,
                            origins_of(shape.world_from_object.precise, object->origin));
  const AffineMap placement{shape.world_from_object.relative_to(table.origin()).rows()};
  for (size_t row = 0; row < table.size(); ++row)
    parts.instances.push_back({size_t(object - objects.begin()), product(placement, table.map(row))});
}

/// Mitsuba has no instances of shape groups that contain instances.
void Shapes::place(const Placed& placed, const AffineMap& world, size_t depth) {
  const AffineMap map = product(world, placed.map);
  const Parts& parts = objects_[placed.object];
  if (!parts.surfaces.empty()) {
    if (placed_.size() == kMostInstances)
      fail(context_.description.objects[placed.object].where,
           "the scene has more than {} instances, nested ones included: Mitsuba's file would be too large",
           kMostInstances);
    placed_.push_back({placed.object, map});
    for (const Vec3& corner : parts.bounds.corners()) bounds_.add(map.point(corner));
  }
  for (const Placed& inner : parts.instances) place(inner, map, depth + 1);
}

/// References in the file follow definitions.
void Shapes::write_materials(Xml& xml) {
  const auto write = [&](const std::vector<Surface>& surfaces) {
    for (const Surface& s : surfaces) materials_.write(xml, s.shape->material);
  };
  for (const Parts& object : objects_) write(object.surfaces);
  write(world_.surfaces);
}

/// Objects without an instance are left out, as in frond.
void Shapes::write(Xml& xml) {
  const auto write_all = [&](const std::vector<Surface>& surfaces, bool is_in_world) {
    for (const Surface& s : surfaces) context_.problems.attempt([&] { write_surface(xml, s, is_in_world); });
  };
  write_all(world_.surfaces, true);
  std::vector<bool> is_placed(objects_.size());
  for (const Placed& placed : placed_) is_placed[placed.object] = true;
  for (size_t i = 0; i < objects_.size(); ++i) {
    if (!is_placed[i]) continue;
    xml.comment("object " + context_.description.objects[i].name);
    const Element group(xml, "shape", {{"type", "shapegroup"}, {"id", fmt::format("object-{}", i)}});
    write_all(objects_[i].surfaces, false);
  }
  for (const Placed& placed : placed_) {
    const Element instance(xml, "shape", {{"type", "instance"}});
    xml.matrix("to_world", in_units(rows_of(placed.map), context_.units));
    xml.reference(fmt::format("object-{}", placed.object));
  }
}

/// Surfaces of objects keep frond's units; their instances scale them.
void Shapes::write_surface(Xml& xml, const Surface& surface, bool is_in_world) {
  if (const auto* mesh = std::get_if<MeshPtr>(&surface.geometry))
    write_mesh(xml, surface, **mesh, is_in_world);
  else
    write_quadric(xml, surface, is_in_world);
}

/// The file has the mesh as frond renders it: oriented, with unit normals.
void Shapes::write_mesh(Xml& xml, const Surface& surface, const TriangleMesh& mesh, bool is_in_world) {
  const ShapeDescription& shape = *surface.shape;
  const bool has_alpha_image =
      find_param(shape.plugin.params, "alpha") && find_param(shape.plugin.params, "alpha")->type == "texture";
  if (mesh.uv.empty() && (materials_.has_image(shape.material) || has_alpha_image))
    context_.report_unsupported("shapes", shape.plugin.where,
                                "a mesh with images needs texture coordinates: Mitsuba's default differs from frond's",
                                "its images lie on it differently");
  if (mesh.triangles.empty()) return;
  const Element element(xml, "shape", {{"type", "ply"}});
  const ParsedParam* file = find_param(shape.plugin.params, "filename");
  std::string name = "mesh";
  if (file) name = std::filesystem::path(std::get<std::vector<std::string>>(file->values).front()).stem().string();
  xml.text("filename", context_.folder.add("meshes", name, "ply", ply_file(mesh)));
  if (mesh.n.empty()) xml.flag("face_normals", true);
  if (is_in_world && context_.units != 1) xml.matrix("to_world", in_units(rows_of(kIdentity), context_.units));
  write_appearance(xml, surface);
}

/// Whole spheres, disks and cylinders under a similarity; others are not among the surfaces.
void Shapes::write_quadric(Xml& xml, const Surface& surface, bool is_in_world) {
  const ShapeDescription& shape = *surface.shape;
  const std::string& name = shape.plugin.name;
  const Location& where = shape.plugin.where;
  const Params p(context_.registry.shapes.get(name, where), shape.plugin, context_.resolver);
  const double radius = p.real("radius");
  if (materials_.has_image(shape.material))
    context_.report_unsupported(
        "shapes", where,
        fmt::format("images on a {} are not exported: its texture coordinates differ in Mitsuba", name),
        "they lie on it differently");
  const AffineMap map{shape.world_from_object.rows()};
  const bool is_flipped = shape.reverse_orientation != shape.world_from_object.swaps_handedness();
  Transform::RowsDouble rows = rows_of(map);
  const Element element(xml, "shape", {{"type", name}});
  if (name == "disk") {
    // Mitsuba's disk has radius 1, and its front faces +z. A flipped disk has y and z reversed.
    const double turn = is_flipped ? -1 : 1, height = p.real("height");
    for (auto& row : rows) {
      row[3] += row[2] * height;
      row[0] *= radius, row[1] *= radius * turn, row[2] *= radius * turn;
    }
  } else {
    if (name == "sphere") {
      xml.number("radius", radius);
    } else {
      xml.number("radius", radius);
      xml.point("p0", {0, 0, float(std::min(p.real("zmin"), p.real("zmax")))});
      xml.point("p1", {0, 0, float(std::max(p.real("zmin"), p.real("zmax")))});
    }
    xml.flag("flip_normals", is_flipped);
  }
  xml.matrix("to_world", is_in_world ? in_units(rows, context_.units) : rows);
  write_appearance(xml, surface);
}

/// Material, inside a mask if the surface has alpha, and emission.
void Shapes::write_appearance(Xml& xml, const Surface& surface) {
  const ShapeDescription& shape = *surface.shape;
  const ShapeInfo& info = context_.registry.shapes.get(shape.plugin.name, shape.plugin.where);
  const Params p(info, shape.plugin, context_.resolver);
  FloatValue alpha = float_value(context_, shape.plugin, p, "alpha");
  if (alpha.image && !std::holds_alternative<MeshPtr>(surface.geometry)) {
    context_.report_unsupported("shapes", p.where("alpha"), "an image as alpha is exported for meshes only",
                                "its mean stands for it");
    alpha = {mean_of(*alpha.map)};
  }
  bool is_opaque = !alpha.image && alpha.constant == 1;
  if (shape.area_light && !is_opaque) {
    context_.report_unsupported("lights", p.where("alpha"),
                                "an area light with alpha is not exported: it differs in Mitsuba",
                                "its surface is opaque");
    is_opaque = true;
  }
  if (is_opaque) {
    xml.reference(materials_.id(shape.material));
  } else {
    const Element mask(xml, "bsdf", {{"type", "mask"}});
    write_value(context_, xml, "opacity", alpha);
    xml.reference(materials_.id(shape.material));
  }
  if (shape.area_light) write_area_light(xml, shape);
}

/// Lights of one directive are written once for each shape.
void Shapes::write_area_light(Xml& xml, const ShapeDescription& shape) {
  const ParsedPlugin& plugin = context_.description.area_lights[*shape.area_light];
  if (plugin.name != "diffuse") {
    context_.report_unsupported("lights", plugin.where,
                                fmt::format("area light \"{}\" has no equivalent in Mitsuba", plugin.name),
                                "its surface does not emit");
    return;
  }
  const Params p(context_.registry.area_lights.get(plugin.name, plugin.where), plugin, context_.resolver);
  const auto report = [&](std::string_view name, const std::string& what, std::string_view instead) {
    context_.report_unsupported("lights", p.where(name), what, instead);
  };
  if (p.given("filename"))
    report("filename", "the image of an area light is not exported", "its surface emits as a white image would");
  if (p.boolean("twosided"))
    report("twosided", "an area light of both sides has no equivalent in Mitsuba", "its front emits");
  if (p.given("power") && p.real("power") > 0)
    report("power", "the \"power\" of an area light is not exported: \"L\" and \"scale\" are",
           "it is ignored: the light's brightness differs");
  const SpectrumPtr spectrum = p.spectrum("L");
  const auto values = context_.spectra.values([&](const auto& lambda) { return spectrum->sample(lambda); });
  const Element emitter(xml, "emitter", {{"type", "area"}});
  context_.spectra.write(xml, "radiance", context_.spectra.emission(values, p.real("scale") * context_.exposure));
}

}  // namespace frond::mitsuba
