#include "scene/description_builder.h"

#include <algorithm>

#include "core/log.h"

namespace frond {
namespace {

/// "file:line:column" in the middle of a message.
std::string place(const Location& where) {
  const std::string text = where.text();
  return text.substr(0, text.size() - std::min<size_t>(text.size(), 2));  // without ": "
}

std::string_view opener(bool by_object) { return by_object ? "ObjectBegin" : "AttributeBegin"; }

/// pbrt's way to say that a surface is only the border of a medium.
void check_not_interface(const ParsedPlugin& material) {
  if (material.name.empty() || material.name == "interface")
    fail(material.where, "material \"{}\" of pbrt-v4 is not supported yet: there are no media", material.name);
}

/// Takes "string type" out of the parameters of MakeNamedMaterial and makes it the plugin's name.
ParsedPlugin typed_by_parameter(const std::string& name, ParsedPlugin plugin) {
  const auto type =
      std::find_if(plugin.params.begin(), plugin.params.end(), [](const ParsedParam& p) { return p.name == "type"; });
  if (type == plugin.params.end()) fail(plugin.where, "MakeNamedMaterial \"{}\" needs parameter \"string type\"", name);
  if (type->type != "string") fail(type->where, "\"type\" is string, a {} was given", type->type);
  const auto& values = std::get<std::vector<std::string>>(type->values);
  if (values.size() != 1) fail(type->value_where, "\"type\" takes 1 value, {} given", values.size());
  plugin.name = values[0];
  plugin.where = type->value_where;
  plugin.params.erase(type);
  return plugin;
}

}  // namespace

DescriptionBuilder::DescriptionBuilder(SceneDescription& scene, const Log& log) : scene_(scene), log_(log) {
  new_material({"", {"diffuse", {}, {}}});
}

void DescriptionBuilder::world_begin(const Location& where) {
  if (in_world_) fail(where, "WorldBegin is given twice");
  in_world_ = true;
  state_.transform = Transform();
  name_transform("world", where);
}

void DescriptionBuilder::finish(const Location& where) {
  if (!in_world_) fail(where, "the file ends before WorldBegin");
  if (!saved_.empty()) {
    const Saved& open = saved_.back();
    fail(open.where, "{} without {}", opener(open.by_object), open.by_object ? "ObjectEnd" : "AttributeEnd");
  }
  const auto check_defined = [](const Names& names, std::string_view kind, std::string_view maker) {
    const Name* unknown = nullptr;
    std::string_view unknown_name;
    std::vector<std::string_view> defined;
    for (const auto& [text, name] : names) {
      if (name.is_defined)
        defined.push_back(text);
      else if (!unknown || name.index < unknown->index)
        unknown = &name, unknown_name = text;
    }
    if (unknown)
      fail(unknown->first_use, "there is no {} \"{}\"{}", kind, unknown_name,
           defined.empty() ? fmt::format("; {} makes them", maker) : suggestion(unknown_name, defined));
  };
  check_defined(materials_, "named material", "MakeNamedMaterial");
  check_defined(objects_, "object", "ObjectBegin");
}

void DescriptionBuilder::camera(ParsedPlugin plugin) {
  set_option_plugin(&SceneDescription::camera, "Camera", std::move(plugin));
  scene_.camera_from_world = state_.transform;
  scene_.coordinate_systems["camera"] = state_.transform.inverse();
}

void DescriptionBuilder::set_option_plugin(ParsedPlugin SceneSettings::*option, std::string_view directive,
                                           ParsedPlugin plugin) {
  ParsedPlugin& slot = scene_.*option;
  if (slot.where.file)
    log_.warn(plugin.where, fmt::format("this {} takes the place of that at {}", directive, place(slot.where)));
  slot = std::move(plugin);
}

void DescriptionBuilder::color_space(const std::string& name, const Location& where) {
  if (in_world_ && name != scene_.color_space) fail(where, "ColorSpace after WorldBegin is not supported yet");
  scene_.color_space = name;
  scene_.color_space_where = where;
}

void DescriptionBuilder::concat(const Transform& transform, std::string_view directive, const Location& where) {
  state_.transform = state_.transform * transform;
  if (!state_.transform.is_valid())
    fail(where, "after this {} the transform cannot be inverted: its scale is too small or too large", directive);
}

void DescriptionBuilder::recall_transform(const std::string& name, const Location& where) {
  const auto& systems = scene_.coordinate_systems;
  if (const auto found = systems.find(name); found != systems.end()) return set_transform(found->second);
  std::vector<std::string_view> names;
  for (const auto& [known, transform] : systems) names.push_back(known);
  fail(where, "unknown coordinate system \"{}\"{}", name, suggestion(name, names));
}

void DescriptionBuilder::attribute_begin(const Location& where) { push(false, where); }
void DescriptionBuilder::attribute_end(const Location& where) { pop(false, where); }

void DescriptionBuilder::pop(bool by_object, const Location& where) {
  const std::string_view ender = by_object ? "ObjectEnd" : "AttributeEnd";
  if (saved_.empty()) fail(where, "{} without {}", ender, opener(by_object));
  const Saved& last = saved_.back();
  if (last.by_object != by_object)
    fail(where, "{} while the {} at {} is open", ender, opener(last.by_object), place(last.where));
  state_ = std::move(saved_.back().state);
  saved_.pop_back();
}

void DescriptionBuilder::attribute(const std::string& target, const Location& where, std::vector<ParsedParam> params) {
  if (target == "medium") fail(where, "attributes of media of pbrt-v4 are not supported yet");
  const auto found = std::find(kTargets.begin(), kTargets.end(), target);
  if (found == kTargets.end())
    fail(where, "unknown target \"{}\" of Attribute{}", target, suggestion(target, {kTargets.begin(), kTargets.end()}));
  auto& defaults = state_.defaults[static_cast<size_t>(found - kTargets.begin())];
  for (ParsedParam& param : params) {
    param.may_be_unused = true;
    std::erase_if(defaults, [&](const ParsedParam& older) { return older.name == param.name; });
    defaults.push_back(std::move(param));
  }
}

ParsedPlugin DescriptionBuilder::with_defaults(ParsedPlugin plugin, Target target) const {
  const size_t own = plugin.params.size();
  for (const ParsedParam& p : state_.defaults[static_cast<size_t>(target)]) {
    const auto own_end = plugin.params.begin() + static_cast<std::ptrdiff_t>(own);
    if (std::none_of(plugin.params.begin(), own_end, [&](const ParsedParam& given) { return given.name == p.name; }))
      plugin.params.push_back(p);
  }
  return plugin;
}

size_t DescriptionBuilder::new_material(MaterialDescription material) {
  scene_.materials.push_back(std::move(material));
  return scene_.materials.size() - 1;
}

DescriptionBuilder::Name& DescriptionBuilder::material_called(const std::string& name, const Location& where) {
  if (const auto found = materials_.find(name); found != materials_.end()) return found->second;
  return materials_.emplace(name, Name{new_material({name, {}}), where}).first->second;
}

DescriptionBuilder::Name& DescriptionBuilder::object_called(const std::string& name, const Location& where) {
  if (const auto found = objects_.find(name); found != objects_.end()) return found->second;
  scene_.objects.push_back({name, {}, {}, {}});
  return objects_.emplace(name, Name{scene_.objects.size() - 1, where}).first->second;
}

void DescriptionBuilder::material(ParsedPlugin plugin) {
  check_not_interface(plugin);
  state_.material = new_material({"", with_defaults(std::move(plugin), Target::material)});
}

void DescriptionBuilder::named_material(const std::string& name, const Location& where) {
  state_.material = material_called(name, where).index;
}

void DescriptionBuilder::make_named_material(const std::string& name, ParsedPlugin plugin) {
  const Location where = plugin.where;
  Name& entry = material_called(name, where);
  if (entry.is_defined) fail(where, "material \"{}\" is defined again", name);
  entry.is_defined = true;
  plugin = with_defaults(typed_by_parameter(name, std::move(plugin)), Target::material);
  check_not_interface(plugin);
  scene_.materials[entry.index].plugin = std::move(plugin);
}

void DescriptionBuilder::texture(const Quoted& name, const Quoted& value, ParsedPlugin plugin) {
  using Value = TextureDescription::Value;
  if (plugin.name == "ptex")
    fail(plugin.where, "texture \"ptex\" of pbrt-v4 is not supported: Ptex files hold a picture for each face");
  if (value.text != "float" && value.text != "spectrum")
    fail(value.where, "unknown kind of texture \"{}\"{}", value.text, suggestion(value.text, {"float", "spectrum"}));
  const Value kind = value.text == "float" ? Value::real : Value::spectrum;
  const auto [known, is_new] = textures_.emplace(std::pair(kind, name.text), name.where);
  if (!is_new)
    fail(name.where, "{} texture \"{}\" is defined again; first at {}", value.text, name.text, place(known->second));
  scene_.textures.push_back({name.text, kind, with_defaults(std::move(plugin), Target::texture), state_.transform});
}

void DescriptionBuilder::area_light(ParsedPlugin plugin) {
  if (plugin.name.empty()) return state_.area_light.reset();
  if (open_object_) fail(plugin.where, "area lights inside objects are not supported yet");
  scene_.area_lights.push_back(with_defaults(std::move(plugin), Target::light));
  state_.area_light = scene_.area_lights.size() - 1;
}

void DescriptionBuilder::shape(ParsedPlugin plugin) {
  if (open_object_ && state_.area_light)
    fail(plugin.where, "area lights inside objects are not supported yet; that of {} is in force here",
         place(scene_.area_lights[*state_.area_light].where));
  auto& shapes = open_object_ ? scene_.objects[*open_object_].shapes : scene_.shapes;
  shapes.push_back({with_defaults(std::move(plugin), Target::shape), state_.transform, state_.reverse_orientation,
                    state_.material, state_.area_light});
}

void DescriptionBuilder::light(ParsedPlugin plugin) {
  if (open_object_) log_.warn(plugin.where, "a light inside an object is not part of its instances: it shines once");
  scene_.lights.push_back({with_defaults(std::move(plugin), Target::light), state_.transform});
}

void DescriptionBuilder::object_begin(const std::string& name, const Location& where) {
  if (open_object_)
    fail(where, "ObjectBegin inside object \"{}\"; ObjectInstance places one object in another",
         scene_.objects[*open_object_].name);
  Name& entry = object_called(name, where);
  ObjectDescription& object = scene_.objects[entry.index];
  if (entry.is_defined) fail(where, "object \"{}\" is defined again; first at {}", name, place(object.where));
  entry.is_defined = true;
  object.where = where;
  open_object_ = entry.index;
  push(true, where);
}

void DescriptionBuilder::object_end(const Location& where) {
  if (!open_object_) fail(where, "ObjectEnd without ObjectBegin");
  pop(true, where);
  open_object_.reset();
}

void DescriptionBuilder::object_instance(const std::string& name, const Location& where) {
  const AffineMap map{state_.transform.rows()};
  if (const std::string problem = problem_of(map); !problem.empty())
    fail(where, "this copy is not possible: {}", problem);
  const auto object = uint32_t(object_called(name, where).index);
  CopyList& copies = open_object_ ? scene_.objects[*open_object_].copies : scene_.copies;
  copies.maps->push_back(map);
  copies.objects.push_back(object);
}

}  // namespace frond
