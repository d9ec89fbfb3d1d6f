#include "scene/format/description_builder.h"

#include <algorithm>
#include <cctype>

#include "core/log.h"
#include "core/math/motion.h"
#include "scene/format/known_names.h"
#include "scene/format/plugin_text.h"
#include "spectra/color/color_space.h"

namespace frond {
namespace {

/// Returns "file:line:column" for use within a message.
std::string place(const Location& where) {
  const std::string text = where.text();
  return text.substr(0, text.size() - std::min<size_t>(text.size(), 2));  // without ": "
}

/// Maps pbrt's older names of material "interface" to the current one.
ParsedPlugin with_name_of_interface(ParsedPlugin material) {
  if (material.name.empty() || material.name == "none") material.name = "interface";
  return material;
}

/// Moves parameter "string type" of MakeNamedMaterial or MakeNamedMedium to the plug-in's name.
ParsedPlugin typed_by_parameter(std::string_view directive, const std::string& name, ParsedPlugin plugin) {
  const auto type =
      std::find_if(plugin.params.begin(), plugin.params.end(), [](const ParsedParam& p) { return p.name == "type"; });
  if (type == plugin.params.end()) fail(plugin.where, "{} \"{}\" needs parameter \"string type\"", directive, name);
  if (type->type != "string") fail(type->where, "\"type\" is string, type {} was given", type->type);
  const auto& values = std::get<std::vector<std::string>>(type->values);
  if (values.size() != 1) fail(type->value_where, "\"type\" takes 1 value, {} given", values.size());
  plugin.name = values[0];
  plugin.where = type->value_where;
  plugin.params.erase(type);
  return plugin;
}

}  // namespace

/// Index 0 is pbrt's default material.
DescriptionBuilder::DescriptionBuilder(SceneDescription& scene, const Log& log) : scene_(scene), log_(log) {
  new_material({"", {"diffuse", {}, {}}});
}

/// Resets the transform. The current colour space becomes the film's, unless Film has already set it.
void DescriptionBuilder::world_begin(const Location& where) {
  if (in_world_) fail(where, "WorldBegin is given twice");
  in_world_ = true;
  if (!scene_.film.where.file) set_film_space();
  state_.transform = {};
  activate_transforms(ActiveTransforms::all);
  name_transform("world", where);
}

/// Name of the directive that opened a block, for messages.
std::string_view DescriptionBuilder::name_of(Opener opener) {
  constexpr std::array<std::string_view, 4> kNames{"AttributeBegin", "TransformBegin", "ObjectBegin", "Import"};
  return kNames[static_cast<size_t>(opener)];
}

/// Name of the directive that closes the block, for messages.
std::string_view DescriptionBuilder::ender_of(Opener opener) {
  constexpr std::array<std::string_view, 4> kNames{"AttributeEnd", "TransformEnd", "ObjectEnd", "the end of the file"};
  return kNames[static_cast<size_t>(opener)];
}

/// Missing names are reported only if all files could be read.
void DescriptionBuilder::finish(const Location& where, Problems& problems) {
  if (problems.empty()) {  // otherwise the missing item may have been in the unreadable part
    if (!in_world_) fail(where, "the file ends before WorldBegin");
    if (!saved_.empty())
      fail(saved_.back().where, "{} without {}", name_of(saved_.back().by), ender_of(saved_.back().by));
  }
  report_unknown_materials(problems);
  report_unknown_media(problems);
  std::vector<std::string_view> defined;
  for (const auto& [text, name] : objects_)
    if (name.is_defined) defined.push_back(text);
  for (const auto& [text, name] : objects_) {
    if (name.is_defined || scene_.may_be_unread(text)) continue;
    problems.attempt([&, &text = text, &name = name] {
      fail(name.first_use, "there is no object \"{}\"{}", text,
           defined.empty() ? "; ObjectBegin makes them" : suggested_name(scene_, text, defined));
    });
  }
}

/// Reports unknown materials. As in pbrt, a name that no shape uses is only a warning.
void DescriptionBuilder::report_unknown_materials(Problems& problems) {
  std::vector<bool> is_used(scene_.materials.size(), false);
  const auto use = [&](const std::vector<ShapeDescription>& shapes) {
    for (const ShapeDescription& shape : shapes) is_used[shape.material] = true;
  };
  use(scene_.shapes);
  for (const ObjectDescription& object : scene_.objects) use(object.shapes);
  std::vector<std::string_view> defined;
  for (const auto& [text, name] : materials_)
    if (name.is_defined) defined.push_back(text);
  for (const auto& [text, name] : materials_) {
    if (name.is_defined) continue;
    const std::string message =
        fmt::format("there is no named material \"{}\"{}", text,
                    defined.empty() ? "; MakeNamedMaterial makes them" : suggested_name(scene_, text, defined));
    scene_.materials[name.index] = {"", {"diffuse", name.first_use, {}}};
    if (scene_.may_be_unread(text)) continue;
    if (is_used[name.index])
      problems.add(InputError(name.first_use, message));
    else
      log_.warn(name.first_use, message + "; no shape needs it");
  }
}

/// Reports unknown media that a shape or the camera has.
void DescriptionBuilder::report_unknown_media(Problems& problems) {
  std::vector<bool> is_used(scene_.media.size(), false);
  const auto use = [&is_used](const std::optional<size_t>& medium) {
    if (medium) is_used[*medium] = true;
  };
  for (const MediumPair& pair : scene_.medium_interfaces) use(pair.inside), use(pair.outside);
  use(scene_.camera_medium);
  std::vector<std::string_view> defined;
  for (const auto& [text, name] : media_)
    if (name.is_defined) defined.push_back(text);
  for (const auto& [text, name] : media_) {
    if (name.is_defined) continue;
    scene_.media[name.index].plugin = {"homogeneous", name.first_use, {}};
    if (scene_.may_be_unread(text)) continue;
    const std::string message =
        fmt::format("there is no medium \"{}\"{}", text,
                    defined.empty() ? "; MakeNamedMedium makes them" : suggested_name(scene_, text, defined));
    if (is_used[name.index])
      problems.add(InputError(name.first_use, message));
    else
      log_.warn(name.first_use, message + "; no shape needs it");
  }
}

/// Saves the state and the coordinate systems, which the imported file may change.
void DescriptionBuilder::import_begin(const Location& where) {
  if (!in_world_) fail(where, "Import belongs after WorldBegin");
  push(Opener::import, where);
  saved_.back().coordinate_systems = scene_.coordinate_systems;
}

/// Restores the state saved by import_begin. Blocks that the file left open are errors.
void DescriptionBuilder::import_end() {
  while (saved_.back().by != Opener::import) {
    const Saved open = std::move(saved_.back());
    saved_.pop_back();
    if (saved_.back().by == Opener::import) {  // only the outermost import is reported
      scene_.coordinate_systems = std::move(saved_.back().coordinate_systems);
      pop();
      fail(open.where, "{} without {}", name_of(open.by), ender_of(open.by));
    }
  }
  scene_.coordinate_systems = std::move(saved_.back().coordinate_systems);
  pop();
}

/// Names are matched as in pbrt: case, - and _ are ignored.
void DescriptionBuilder::option(ParsedParam param) {
  std::string name;
  for (const char c : param.name)
    if (c != '-' && c != '_') name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  param.name = std::move(name);
  set_param(scene_.options, std::move(param));
}

/// Also defines the coordinate system "camera", from the current transform.
void DescriptionBuilder::camera(ParsedPlugin plugin) {
  if (!state_.transform.is_valid()) fail(plugin.where, "the camera's transform cannot be inverted");
  set_option_plugin(&SceneDescription::camera, "Camera", std::move(plugin));
  scene_.camera_from_world = state_.transform;
  scene_.camera_medium = state_.media.outside;
  scene_.coordinate_systems["camera"] = state_.transform.inverse();
}

void DescriptionBuilder::set_option_plugin(ParsedPlugin SceneSettings::*option, std::string_view directive,
                                           ParsedPlugin plugin) {
  ParsedPlugin& slot = scene_.*option;
  if (slot.where.file)
    log_.warn(plugin.where, fmt::format("this {} takes the place of that at {}", directive, place(slot.where)));
  slot = std::move(plugin);
}

void DescriptionBuilder::film(ParsedPlugin plugin) {
  set_option_plugin(&SceneDescription::film, "Film", std::move(plugin));
  set_film_space();
}

void DescriptionBuilder::set_film_space() {
  scene_.color_space = state_.color_space;
  scene_.color_space_where = state_.color_space_where;
}

/// Throws InputError for an unknown name.
void DescriptionBuilder::color_space(const std::string& name, const Location& where) {
  state_.color_space = frond::color_space(name, where).name;
  state_.color_space_where = where;
}

/// A parameter has the colour space of the graphics state at its directive.
void DescriptionBuilder::note_color_space(std::vector<ParsedParam>& params) const {
  for (ParsedParam& p : params)
    if (p.type == "rgb") p.color_space = state_.color_space;
}

void DescriptionBuilder::transform_times(double start, double end, const Location& where) {
  if (!(start < end)) fail(where, "TransformTimes {:g} {:g}: the end comes after the start", start, end);
  scene_.transform_times = {start, end};
}

void DescriptionBuilder::warn_if_moving(std::string_view what, const Location& where) const {
  if (state_.transform.moves())
    log_.warn(where, fmt::format("{} does not move: its place is that of the start, as in pbrt-v4", what));
}

/// An unknown name is a warning, as in pbrt; the transform is unchanged.
void DescriptionBuilder::recall_transform(const std::string& name, const Location& where) {
  const auto& systems = scene_.coordinate_systems;
  if (const auto found = systems.find(name); found != systems.end()) {
    state_.transform = found->second;
    return;
  }
  std::vector<std::string_view> names;
  for (const auto& [known, transform] : systems) names.push_back(known);
  log_.warn(where, fmt::format("unknown coordinate system \"{}\"{}; the transform stays as it is", name,
                               suggested_name(scene_, name, names)));
}

/// Warns once: files written for pbrt-v3 expect the material to be kept.
void DescriptionBuilder::transform_begin(const Location& where) {
  if (!has_warned_of_transform_begin_)
    log_.warn(
        where,
        "TransformBegin saves all that AttributeBegin does, the material too, as in pbrt-v4: TransformEnd brings it "
        "back");
  has_warned_of_transform_begin_ = true;
  push(Opener::transform, where);
}

/// An end without a beginning is a warning, as in pbrt.
void DescriptionBuilder::end(std::string_view directive, std::string_view beginner, const Location& where) {
  if (saved_.empty() || saved_.back().by == Opener::import)
    return log_.warn(where, fmt::format("{} without {} is left out", directive, beginner));
  const Saved& last = saved_.back();
  if (last.by == Opener::object) fail(where, "{} while the ObjectBegin at {} is open", directive, place(last.where));
  pop();
}

/// Later values of the same parameter replace earlier ones.
void DescriptionBuilder::attribute(const std::string& target, const Location& where, std::vector<ParsedParam> params) {
  const auto found = std::find(kTargets.begin(), kTargets.end(), target);
  if (found == kTargets.end())
    fail(where, "unknown target \"{}\" of Attribute{}", target, suggestion(target, {kTargets.begin(), kTargets.end()}));
  if (has_too_many_copies_) return;
  if (state_.defaults.use_count() > 1) {
    for (const auto& list : *state_.defaults)
      for (const ParsedParam& p : list) limit_attribute_copies(p, where);
    state_.defaults = std::make_shared<Defaults>(*state_.defaults);
  }
  auto& defaults = (*state_.defaults)[static_cast<size_t>(found - kTargets.begin())];
  note_color_space(params);
  for (ParsedParam& param : params) {
    param.may_be_unused = true;
    scene_.attributes.emplace(std::pair(target, param.name), param.where);
    set_param(defaults, std::move(param));
  }
}

/// Appends the defaults of Attribute for parameters that the plug-in does not give itself.
ParsedPlugin DescriptionBuilder::with_defaults(ParsedPlugin plugin, Target target) {
  note_color_space(plugin.params);
  const size_t own = plugin.params.size();
  for (const ParsedParam& p : (*state_.defaults)[static_cast<size_t>(target)]) {
    const auto own_end = plugin.params.begin() + static_cast<std::ptrdiff_t>(own);
    if (std::any_of(plugin.params.begin(), own_end, [&](const ParsedParam& given) { return given.name == p.name; }))
      continue;
    limit_attribute_copies(p, plugin.where);
    if (!has_too_many_copies_) plugin.params.push_back(p);
  }
  return plugin;
}

void DescriptionBuilder::limit_attribute_copies(const ParsedParam& param, const Location& where) {
  constexpr size_t kMost = size_t{512} << 20;
  if (has_too_many_copies_) return;
  copied_bytes_ += sizeof param + std::visit([](const auto& v) { return v.size() * sizeof v[0]; }, param.values);
  if (copied_bytes_ <= kMost) return;
  has_too_many_copies_ = scene_.is_incomplete = true;
  fail(where, "parameters by Attribute take more than {} MB in all; give them to the shapes that need them",
       kMost >> 20);
}

/// Returns the index of the new material.
size_t DescriptionBuilder::new_material(MaterialDescription material) {
  scene_.materials.push_back(std::move(material));
  return scene_.materials.size() - 1;
}

/// Returns the entry of a name. A first use before the definition creates an undefined material.
DescriptionBuilder::Name& DescriptionBuilder::material_called(const std::string& name, const Location& where) {
  if (const auto found = materials_.find(name); found != materials_.end()) return found->second;
  return materials_.emplace(name, Name{new_material({name, {}}), where}).first->second;
}

/// Returns the entry of a name, which may be used before its ObjectBegin.
DescriptionBuilder::Name& DescriptionBuilder::object_called(const std::string& name, const Location& where) {
  if (const auto found = objects_.find(name); found != objects_.end()) return found->second;
  scene_.objects.push_back({name, {}, {}, {}});
  return objects_.emplace(name, Name{scene_.objects.size() - 1, where}).first->second;
}

void DescriptionBuilder::material(ParsedPlugin plugin) {
  state_.material = new_material({"", with_defaults(with_name_of_interface(std::move(plugin)), Target::material)});
}

void DescriptionBuilder::named_material(const std::string& name, const Location& where) {
  state_.material = material_called(name, where).index;
}

/// Fills the entry that earlier uses of the name refer to.
void DescriptionBuilder::make_named_material(const std::string& name, ParsedPlugin plugin) {
  const Location where = plugin.where;
  Name& entry = material_called(name, where);
  if (entry.is_defined) fail(where, "material \"{}\" is defined again", name);
  plugin = with_name_of_interface(typed_by_parameter("MakeNamedMaterial", name, std::move(plugin)));
  entry.is_defined = true;
  scene_.materials[entry.index].plugin = with_defaults(std::move(plugin), Target::material);
}

/// Returns the index of a name, which may be used before its MakeNamedMedium; nullopt for the empty name.
std::optional<size_t> DescriptionBuilder::medium_called(const Quoted& name) {
  if (name.text.empty()) return {};
  if (const auto found = media_.find(name.text); found != media_.end()) return found->second.index;
  scene_.media.push_back({name.text, {}, {}});
  return media_.emplace(name.text, Name{scene_.media.size() - 1, name.where}).first->second.index;
}

void DescriptionBuilder::medium_interface(const Quoted& inside, const Quoted& outside) {
  const std::optional<size_t> in = medium_called(inside);
  state_.media = {in, medium_called(outside)};
}

/// As in pbrt, a shape with the same medium on both sides leaves rays in the medium in which they are.
uint32_t DescriptionBuilder::current_interface() {
  if (state_.media.inside == state_.media.outside) return 0;
  auto& pairs = scene_.medium_interfaces;
  const auto known = std::find(pairs.begin(), pairs.end(), state_.media);
  const auto index = size_t(known - pairs.begin());
  if (known == pairs.end()) pairs.push_back(state_.media);
  return uint32_t(index) + 1;
}

/// The current transformation defines the medium's space.
void DescriptionBuilder::make_named_medium(const std::string& name, ParsedPlugin plugin) {
  const Location where = plugin.where;
  const size_t index = *medium_called({name, where});
  if (media_.at(name).is_defined) fail(where, "medium \"{}\" is defined again", name);
  plugin = typed_by_parameter("MakeNamedMedium", name, std::move(plugin));
  if (!state_.transform.is_valid()) fail(where, "the medium's transform cannot be inverted");
  media_.at(name).is_defined = true;
  warn_if_moving("a medium", where);
  scene_.media[index] = {name, with_defaults(std::move(plugin), Target::medium), state_.transform.start};
}

/// float and spectrum textures have separate names, as in pbrt.
void DescriptionBuilder::texture(const Quoted& name, const Quoted& value, ParsedPlugin plugin) {
  using Value = TextureDescription::Value;
  if (value.text != "float" && value.text != "spectrum")
    fail(value.where, "unknown kind of texture \"{}\"{}", value.text, suggestion(value.text, {"float", "spectrum"}));
  const Value kind = value.text == "float" ? Value::real : Value::spectrum;
  const auto [known, is_new] = textures_.emplace(std::pair(kind, name.text), name.where);
  if (!is_new)
    fail(name.where, "{} texture \"{}\" is defined again; first at {}", value.text, name.text, place(known->second));
  warn_if_moving("a texture", name.where);
  scene_.textures.push_back({name.text, kind, with_defaults(std::move(plugin), Target::texture),
                             state_.transform.is_valid() ? state_.transform.start : SceneTransform()});
}

/// AreaLightSource "" ends the emission of subsequent shapes.
void DescriptionBuilder::area_light(ParsedPlugin plugin) {
  if (plugin.name.empty()) return state_.area_light.reset();
  scene_.area_lights.push_back(with_defaults(std::move(plugin), Target::light));
  state_.area_light = scene_.area_lights.size() - 1;
}

/// Shapes under a singular transform have no volume and are dropped.
void DescriptionBuilder::shape(ParsedPlugin plugin) {
  if (!state_.transform.is_valid()) return;
  std::optional<size_t> area_light = state_.area_light;
  if (area_light && state_.open_object) {
    log_.warn(plugin.where,
              fmt::format("shapes in objects give off no light, as in pbrt-v4; the area light of {} is in "
                          "force here",
                          place(scene_.area_lights[*area_light].where)));
    area_light.reset();
  }
  if (area_light && scene_.materials[state_.material].plugin.name == "interface") {
    log_.warn(plugin.where, "the area light does not shine: with material \"interface\" there is no surface");
    area_light.reset();
  }
  const bool moves = state_.transform.moves();
  if (area_light && moves) fail(plugin.where, "a shape that moves cannot give off light: area lights stand still");
  const Location where = plugin.where;
  ShapeDescription made{with_defaults(std::move(plugin), Target::shape),
                        moves ? SceneTransform() : state_.transform.start,
                        state_.reverse_orientation,
                        state_.material,
                        area_light,
                        current_interface()};
  if (moves) {
    const auto object = uint32_t(scene_.objects.size());
    scene_.objects.push_back({"", where, {std::move(made)}, {}});
    add_instance(object, where);
  } else {
    (state_.open_object ? scene_.objects[*state_.open_object].shapes : scene_.shapes).push_back(std::move(made));
  }
}

/// Lights are never part of instances, as in pbrt.
void DescriptionBuilder::light(ParsedPlugin plugin) {
  if (!state_.transform.is_valid()) return;
  if (state_.open_object)
    log_.warn(plugin.where, "a light inside an object is not part of its instances: it shines once");
  warn_if_moving("a light", plugin.where);
  scene_.lights.push_back({with_defaults(std::move(plugin), Target::light), state_.transform.start});
}

/// Objects cannot be defined within objects; instances may be nested.
void DescriptionBuilder::object_begin(const std::string& name, const Location& where) {
  if (state_.open_object)
    fail(where, "ObjectBegin inside object \"{}\"; ObjectInstance places one object in another",
         scene_.objects[*state_.open_object].name);
  Name& entry = object_called(name, where);
  ObjectDescription& object = scene_.objects[entry.index];
  if (entry.is_defined) fail(where, "object \"{}\" is defined again; first at {}", name, place(object.where));
  entry.is_defined = true;
  object.where = where;
  open_object(entry.index, where);
}

void DescriptionBuilder::refused_object_begin(const Location& where) {
  if (!in_world_) return;
  scene_.objects.push_back({"", where, {}, {}});
  open_object(scene_.objects.size() - 1, where);
}

void DescriptionBuilder::open_object(size_t index, const Location& where) {
  push(Opener::object, where);
  state_.open_object = index;
}

/// Restores the state of ObjectBegin, as pbrt does.
void DescriptionBuilder::object_end(const Location& where) {
  if (!state_.open_object) {
    const std::string message = "ObjectEnd without ObjectBegin";
    if (scene_.is_incomplete) throw Consequence(where, message);
    fail(where, "{}", message);
  }
  if (const Saved& last = saved_.back(); last.by != Opener::object)
    fail(where, "ObjectEnd while the {} at {} is open", name_of(last.by), place(last.where));
  pop();
}

/// Inside an object, the instance becomes part of that object.
void DescriptionBuilder::object_instance(const std::string& name, const Location& where) {
  if (!state_.transform.is_valid()) return;
  add_instance(uint32_t(object_called(name, where).index), where);
}

void DescriptionBuilder::add_instance(uint32_t object, const Location& where) {
  const auto check = [&where](const std::string& problem) {
    if (!problem.empty()) fail(where, "this instance is not possible: {}", problem);
  };
  const AffineMap map{state_.transform.start.rows()};
  check(problem_of(map));
  InstanceList& list = open_instances();
  if (state_.transform.moves()) {
    const AffineMap end{state_.transform.end->rows()};
    check(problem_of(end));
    check(problem_of_motion(map, end));
    list.moving.push_back(
        {object, map, end, {state_.transform.start.precise.rows(), state_.transform.end->precise.rows()}, where});
  } else {
    list.add(object, state_.transform.start);
  }
}

}  // namespace frond
