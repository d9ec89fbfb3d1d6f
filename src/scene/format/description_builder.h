#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/messages/problems.h"
#include "scene/format/description.h"

namespace frond {

/// A quoted string of the scene file, with its location.
struct Quoted {
  std::string text;
  Location where;
};

/// Executes the directives of a scene file: maintains the graphics state (transform, material, ...) and appends to the
/// description. All methods throw InputError for directives that are invalid in the current state.
class DescriptionBuilder {
 public:
  DescriptionBuilder(SceneDescription& scene, const Log& log);

  bool in_world() const { return in_world_; }
  bool is_incomplete() const { return scene_.is_incomplete; }
  void world_begin(const Location& where);
  /// Ends the main file: reports open blocks and unknown names to `problems`. `where` is the end of the file.
  void finish(const Location& where, Problems& problems);

  // Import: the file starts with the current state; its changes are discarded at its end.
  void import_begin(const Location& where);
  void import_end();

  // Options
  void camera(ParsedPlugin plugin);
  void film(ParsedPlugin plugin);
  void set_option_plugin(ParsedPlugin SceneSettings::*option, std::string_view directive, ParsedPlugin plugin);
  void option(ParsedParam param);
  void color_space(const std::string& name, const Location& where);

  // Transforms
  /// Multiplies the active transforms from the right, as pbrt does.
  void concat(const SceneTransform& transform, std::string_view directive, const Location& where) {
    change_transform([&transform](const SceneTransform& t) { return t * transform; }, directive, where);
  }
  void set_transform(const SceneTransform& transform, std::string_view directive, const Location& where) {
    change_transform([&transform](const SceneTransform&) { return transform; }, directive, where);
  }
  void name_transform(const std::string& name, const Location&) { scene_.coordinate_systems[name] = state_.transform; }
  void recall_transform(const std::string& name, const Location& where);
  void activate_transforms(ActiveTransforms active) { state_.active = active; }
  void transform_times(double start, double end, const Location& where);

  // Graphics state
  void attribute_begin(const Location& where) { push(Opener::attribute, where); }
  void attribute_end(const Location& where) { end("AttributeEnd", "AttributeBegin", where); }
  /// Same as AttributeBegin, material included, as in pbrt-v4.
  void transform_begin(const Location& where);
  void transform_end(const Location& where) { end("TransformEnd", "TransformBegin", where); }
  void attribute(const std::string& target, const Location& where, std::vector<ParsedParam> params);
  /// The setting is part of the graphics state.
  void reverse_orientation() { state_.reverse_orientation = !state_.reverse_orientation; }
  void material(ParsedPlugin plugin);
  void named_material(const std::string& name, const Location& where);
  void area_light(ParsedPlugin plugin);
  /// Names may be empty: vacuum.
  void medium_interface(const Quoted& inside, const Quoted& outside);

  // Things of the scene
  void make_named_material(const std::string& name, ParsedPlugin plugin);
  void make_named_medium(const std::string& name, ParsedPlugin plugin);
  void texture(const Quoted& name, const Quoted& value, ParsedPlugin plugin);
  void shape(ParsedPlugin plugin);
  void light(ParsedPlugin plugin);
  void object_begin(const std::string& name, const Location& where);
  /// Replaces an invalid ObjectBegin: everything up to its ObjectEnd is added to an object without a name.
  void refused_object_begin(const Location& where);
  void object_end(const Location& where);
  void object_instance(const std::string& name, const Location& where);

 private:
  /// Kinds of plug-ins with defaults by `Attribute`, in the order of kTargets.
  enum class Target : uint8_t { shape, light, material, texture, medium };
  static constexpr std::array<std::string_view, 5> kTargets{"shape", "light", "material", "texture", "medium"};

  /// Parameters by Attribute, for each target.
  using Defaults = std::array<std::vector<ParsedParam>, kTargets.size()>;

  struct State {
    MovingTransform transform;
    ActiveTransforms active = ActiveTransforms::all;
    bool reverse_orientation = false;
    size_t material = 0;
    std::optional<size_t> area_light;
    MediumPair media;
    std::optional<size_t> open_object;
    std::string color_space = "srgb";
    Location color_space_where;
    std::shared_ptr<Defaults> defaults = std::make_shared<Defaults>();  ///< shared by states, and copied to be changed
  };
  enum class Opener : uint8_t { attribute, transform, object, import };
  struct Saved {
    Opener by;
    Location where;
    State state;
    std::map<std::string, MovingTransform> coordinate_systems;  ///< before an import
  };
  /// A name that may be used before its definition.
  struct Name {
    size_t index;
    Location first_use;
    bool is_defined = false;
  };
  using Names = std::map<std::string, Name, std::less<>>;

  template <class Change>
  void change_transform(const Change& change, std::string_view directive, const Location& where);
  /// Warns if the current transform moves: `what` does not.
  void warn_if_moving(std::string_view what, const Location& where) const;
  InstanceList& open_instances() {
    return state_.open_object ? scene_.objects[*state_.open_object].instances : scene_.instances;
  }
  /// Adds an instance at the current transform.
  void add_instance(uint32_t object, const Location& where);

  static std::string_view name_of(Opener opener);
  static std::string_view ender_of(Opener opener);
  void push(Opener by, const Location& where) { saved_.push_back({by, where, state_, {}}); }
  void pop() { state_ = std::move(saved_.back().state), saved_.pop_back(); }
  /// As in pbrt, AttributeEnd also closes TransformBegin, and TransformEnd AttributeBegin.
  void end(std::string_view directive, std::string_view beginner, const Location& where);
  void report_unknown_materials(Problems& problems);
  void report_unknown_media(Problems& problems);
  std::optional<size_t> medium_called(const Quoted& name);
  uint32_t current_interface();
  ParsedPlugin with_defaults(ParsedPlugin plugin, Target target);
  /// Counts a copy of a parameter by Attribute. Beyond a limit of all copies it throws InputError once; no further ones
  /// are made.
  void limit_attribute_copies(const ParsedParam& param, const Location& where);
  void note_color_space(std::vector<ParsedParam>& params) const;
  /// Sets the film's colour space to the current one.
  void set_film_space();
  void open_object(size_t index, const Location& where);
  size_t new_material(MaterialDescription material);
  Name& material_called(const std::string& name, const Location& where);
  Name& object_called(const std::string& name, const Location& where);

  SceneDescription& scene_;
  const Log& log_;
  State state_;
  std::vector<Saved> saved_;
  size_t copied_bytes_ = 0;  ///< of parameters by Attribute
  bool has_too_many_copies_ = false;
  bool in_world_ = false;
  bool has_warned_of_transform_begin_ = false;
  Names materials_, objects_, media_;
  std::map<std::pair<TextureDescription::Value, std::string>, Location> textures_;
};

/// As in pbrt, a singular transform is not an error: shapes under it have no volume.
template <class Change>
void DescriptionBuilder::change_transform(const Change& change, std::string_view directive, const Location& where) {
  const bool was_valid = state_.transform.is_valid();
  state_.transform.apply(state_.active, change);
  if (was_valid && !state_.transform.is_valid())
    log_.warn(where,
              fmt::format("after this {} the transform cannot be inverted: shapes, lights and instances under it are "
                          "left out",
                          directive));
}

}  // namespace frond
