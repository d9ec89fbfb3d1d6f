#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/params.h"
#include "scene/math/affine_map.h"

namespace frond {

/// A scene file as plain data: names are resolved to places in the lists below, nothing is built. In every ParsedPlugin
/// `where` is the place of the plugin's quoted name; it is empty for plugins that the file leaves to their defaults.

struct MaterialDescription {
  std::string name;     ///< of MakeNamedMaterial; empty for `Material`
  ParsedPlugin plugin;  ///< "string type" of MakeNamedMaterial is its name and no parameter
};

struct TextureDescription {
  enum class Value : uint8_t { real, spectrum };
  std::string name;
  Value value;
  ParsedPlugin plugin;
  Transform world_from_texture;
};

struct ShapeDescription {
  ParsedPlugin plugin;
  Transform world_from_object;
  bool reverse_orientation = false;
  size_t material = 0;               ///< in SceneDescription::materials
  std::optional<size_t> area_light;  ///< in SceneDescription::area_lights
};

struct LightDescription {
  ParsedPlugin plugin;
  Transform world_from_light;
};

/// ObjectInstance by ObjectInstance: there may be very many.
struct InstanceList {
  std::shared_ptr<std::vector<AffineMap>> maps = std::make_shared<std::vector<AffineMap>>();
  std::vector<uint32_t> objects = {};  ///< in SceneDescription::objects
};

/// ObjectBegin ... ObjectEnd. A point of a shape lands in the world by its own transform, then by the instance's.
struct ObjectDescription {
  std::string name;
  Location where;
  std::vector<ShapeDescription> shapes;
  InstanceList instances;
};

/// What a scene file says but for the shapes, which may be large, and what overrides have made of it
/// (scene/overrides.h).
struct SceneSettings {
  // Options, with what holds where the file says nothing.
  ParsedPlugin camera{"perspective", {}, {}};
  ParsedPlugin film{"rgb", {}, {}};
  ParsedPlugin sampler{"paddedsobol", {}, {}};
  ParsedPlugin integrator{"path", {}, {}};
  ParsedPlugin filter{"gaussian", {}, {}};
  std::string color_space = "srgb";  ///< of the film; an rgb has its own
  Location color_space_where;
  /// `Option "type name" value`; without a type it follows from the value: bool, integer, float or string.
  std::vector<ParsedParam> options;
  std::optional<uint64_t> seed;  ///< of all random numbers; empty: that of the options, or else the sampler's own
  bool is_quick = false;         ///< a first look: half the film's resolution, a sixteenth of the samples
  Transform camera_from_world;

  std::map<std::string, Transform> coordinate_systems;  ///< "camera", "world" and the file's own
  std::vector<TextureDescription> textures;             ///< in the file's order; names are unique for each value type
  std::vector<MaterialDescription> materials;           ///< the first is what holds before any `Material`: "diffuse"

  std::vector<std::filesystem::path> files;  ///< the main file and what it includes, in the order of reading
  uint64_t content_hash = 0;                 ///< over the bytes of `files`, in order
  std::vector<LightDescription> lights;
  std::vector<ParsedPlugin> area_lights;

  /// What `Attribute` gives defaults of, (target, name) of each parameter and where the first stands.
  std::map<std::pair<std::string, std::string>, Location> attributes;

  /// What directives that could not be read would have given a name to: what misses it is no error of its own.
  std::set<std::string, std::less<>> unread;
  bool is_incomplete = false;  ///< a file that another one includes could not be read: any name may have been there
  bool may_be_unread(std::string_view name) const { return is_incomplete || unread.contains(name); }

  /// A file name in the scene as a path: relative to the main file, as in pbrt, or else to the file that names it, or
  /// else to where the program runs, which a name on the command line is relative to first. Backslashes are as good as
  /// slashes where no file is called so.
  std::filesystem::path resolve(const std::string& name, const Location& where) const;
};

struct SceneDescription : SceneSettings {
  std::vector<ShapeDescription> shapes;
  std::vector<ObjectDescription> objects;
  InstanceList instances;
};

}  // namespace frond
