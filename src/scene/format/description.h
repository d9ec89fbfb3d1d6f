#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/math/affine_map.h"
#include "core/params.h"
#include "scene/format/moving_transform.h"

namespace frond {

/// A scene file as plain data. Names are resolved to indices into the lists below; no object is created. `where` of a
/// ParsedPlugin is the location of its quoted name; it is empty for defaults.

/// A material of the scene file.
struct MaterialDescription {
  std::string name;     ///< name of MakeNamedMaterial; empty for `Material`
  ParsedPlugin plugin;  ///< for MakeNamedMaterial its name is the value of "string type"

  /// The name in results: that of MakeNamedMaterial, or the plug-in's.
  const std::string& shown_name() const { return name.empty() ? plugin.name : name; }
};

/// A texture of the scene file.
struct TextureDescription {
  enum class Value : uint8_t { real, spectrum };
  std::string name;
  Value value;
  ParsedPlugin plugin;
  SceneTransform world_from_texture;
};

/// A medium of the scene file.
struct MediumDescription {
  std::string name;
  ParsedPlugin plugin;  ///< its name is the value of "string type"
  SceneTransform world_from_medium;
};

/// Media on the two sides of a shape: indices in SceneDescription::media; empty: vacuum.
struct MediumPair {
  std::optional<size_t> inside, outside;
  friend bool operator==(const MediumPair&, const MediumPair&) = default;
};

/// A shape with its graphics state.
struct ShapeDescription {
  ParsedPlugin plugin;
  SceneTransform world_from_object;
  bool reverse_orientation = false;
  size_t material = 0;               ///< index in SceneDescription::materials
  std::optional<size_t> area_light;  ///< index in SceneDescription::area_lights
  uint32_t medium_interface = 0;     ///< 1 + index in SceneDescription::medium_interfaces; 0: no change of medium
};

/// A light that is not an area light.
struct LightDescription {
  ParsedPlugin plugin;
  SceneTransform world_from_light;
};

/// An instance that moves. A moving shape is stored as a moving instance of an object that contains this shape alone.
struct MovingInstance {
  uint32_t object;  ///< index in SceneDescription::objects
  AffineMap start, end;
  std::array<PreciseTransform::Rows, 2> precise;  ///< of start and end
  Location where;
};

/// Instances by ObjectInstance, in compact form because there may be many millions.
struct InstanceList {
  std::shared_ptr<std::vector<AffineMap>> maps = std::make_shared<std::vector<AffineMap>>();
  std::vector<uint32_t> objects = {};  ///< index in SceneDescription::objects, by instance
  std::vector<MovingInstance> moving = {};
  /// Empty, or `maps` in double precision, as soon as one of them places an object far from the origin.
  std::vector<PreciseTransform::Rows> precise = {};

  void add(uint32_t object, const SceneTransform& map);
};

/// ObjectBegin ... ObjectEnd, or a moving shape, without a name. A point of a shape is transformed by the shape's
/// transform, then by the instance's.
struct ObjectDescription {
  std::string name;
  Location where;
  std::vector<ShapeDescription> shapes;
  InstanceList instances;
  Vec3d origin = {};  ///< subtracted from the object's coordinates: moved_to_origins
};

/// Content of a scene file except shapes, which may be large, with overrides applied (scene/overrides.h).
struct SceneSettings {
  // Options, initialized with their defaults.
  ParsedPlugin camera{"perspective", {}, {}};
  ParsedPlugin film{"rgb", {}, {}};
  ParsedPlugin sampler{"lattice", {}, {}};
  ParsedPlugin integrator{"path", {}, {}};
  ParsedPlugin filter{"gaussian", {}, {}};
  std::string color_space = "srgb";  ///< of the film; parameters of type rgb store their own
  Location color_space_where;
  /// `Option "type name" value`. A missing type is derived from the value: bool, integer, float or string.
  std::vector<ParsedParam> options;
  std::optional<uint64_t> seed;  ///< overrides the seed of Options and of the sampler
  bool is_quick = false;         ///< preview: half the film's resolution, a sixteenth of the samples
  MovingTransform camera_from_world;
  std::array<double, 2> transform_times{0, 1};  ///< of the start and the end of all motion, s

  std::map<std::string, MovingTransform> coordinate_systems;  ///< "camera", "world" and those that the file defines
  std::vector<TextureDescription> textures;                   ///< in file order; names are unique for each value type
  std::vector<MaterialDescription> materials;  ///< index 0 is the default before any `Material`: "diffuse"

  std::vector<MediumDescription> media;       ///< names are unique
  std::vector<MediumPair> medium_interfaces;  ///< those of shapes, each with two different media
  std::optional<size_t> camera_medium;        ///< in which camera rays begin
  /// Whether a shape or the camera has a medium.
  bool has_media() const { return !medium_interfaces.empty() || camera_medium.has_value(); }

  std::vector<std::filesystem::path> files;  ///< the main file and included files, in reading order
  uint64_t content_hash = 0;                 ///< hash of the bytes of `files`, in order
  std::vector<LightDescription> lights;
  std::vector<ParsedPlugin> area_lights;

  /// Defaults set by `Attribute`: (target, parameter name), with the first location.
  std::map<std::pair<std::string, std::string>, Location> attributes;

  /// Names that unreadable directives would have defined: a missing name among them is not a second error.
  std::set<std::string, std::less<>> unread;
  bool has_errors = false;     ///< the files have errors: what the scene lacks may stand in these lines
  bool is_incomplete = false;  ///< an included file could not be read: it may have defined any name
  bool may_be_unread(std::string_view name) const { return is_incomplete || unread.contains(name); }

  /// Resolves a file name: relative to the main file as in pbrt, else relative to the file that contains the name, else
  /// relative to the working directory. A name given on the command line is relative to the working directory first.
  /// Backslashes are taken as slashes if no such file exists. A file outside the scene's folder that the scene names is
  /// marked as foreign (core/messages/excerpt.h).
  std::filesystem::path resolve(const std::string& name, const Location& where) const;
};

/// A complete scene file.
struct SceneDescription : SceneSettings {
  std::vector<ShapeDescription> shapes;
  std::vector<ObjectDescription> objects;
  InstanceList instances;
};

}  // namespace frond
