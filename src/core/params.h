#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/spectrum.h"
#include "core/vec.h"

namespace frond {

class FloatTexture;
class SpectrumTexture;
class Material;

/// What a parameter is to the plugin that declares it. The comment names the scene file's types that it accepts.
enum class ParamKind : uint8_t {
  boolean,           ///< bool
  integer,           ///< integer
  real,              ///< float
  string,            ///< string
  point2,            ///< point2
  vector2,           ///< vector2
  point3,            ///< point3, point
  vector3,           ///< vector3, vector
  normal3,           ///< normal3, normal
  illuminant,        ///< rgb, spectrum, blackbody: an emission
  albedo,            ///< rgb, spectrum: in [0, 1] at every wavelength
  unbounded,         ///< float, rgb, spectrum: at least 0 at every wavelength
  float_texture,     ///< float, texture
  spectrum_texture,  ///< rgb, spectrum, texture: in [0, 1]
  material,          ///< string: the name of a material
};

/// Unit of a number, as docs and messages print it; "" where it is a pure number.
using Unit = std::string_view;

/// Value where the scene gives none. An int stands for a number of any kind. monostate: there is none, and the plugin
/// asks `given` first.
using Default = std::variant<std::monostate, bool, int, double, std::string_view, std::array<double, 3>>;

inline constexpr Interval kAnyValue{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
inline constexpr Interval kAtLeastZero{0, std::numeric_limits<double>::infinity()};

/// One parameter, declared once. From this record come parsing, error messages, `frond describe` and the docs.
struct Param {
  std::string_view name;
  ParamKind kind;
  Default default_value = {};
  Unit unit = "";
  Interval range = kAnyValue;  ///< of each number; both ends allowed
  std::string_view doc;
  bool list = false;                               ///< any number of values, not one
  bool required = false;                           ///< the scene must give it
  std::span<const std::string_view> choices = {};  ///< of a string; empty: any
};

/// A parameter as a scene file has it: `"float roughness" [ 0.1 ]`.
struct ParsedParam {
  std::string type, name;
  Location where;        ///< of the quoted declaration
  Location value_where;  ///< of the first value
  std::variant<std::vector<double>, std::vector<std::string>, std::vector<bool>> values;
  bool may_be_unused = false;    ///< from an `Attribute`: for those plugins that declare it
  std::string color_space = {};  ///< of an rgb; empty: the scene's
};

/// A directive with a plugin's name and parameters: `Material "diffuse" ...`.
struct ParsedPlugin {
  std::string name;
  Location where;
  std::vector<ParsedParam> params;
};

/// What a spectrum says: how numbers and colours become one, and which are refused.
enum class SpectrumUse : uint8_t { illuminant, albedo, unbounded };

/// How parameter values that stand for something else are looked up; the scene's side of binding.
class ParamResolver {
 public:
  virtual ~ParamResolver() = default;
  virtual std::shared_ptr<const FloatTexture> float_texture(const std::string& name, const Location&) = 0;
  virtual std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string& name, const Location&) = 0;
  virtual std::shared_ptr<Material> material(const std::string& name, const Location&) = 0;
  /// From type "rgb", "spectrum", "blackbody" or "float".
  virtual SpectrumPtr spectrum(const ParsedParam&, SpectrumUse) = 0;
  /// A path in the scene file, relative to that file.
  virtual std::filesystem::path file(const std::string& name, const Location&) = 0;
  /// To the user: what is done is not quite what the scene asks for.
  virtual void warn(const Location&, std::string_view /*message*/) {}
};

struct PluginInfo;

/// What is wrong with the parameters that a plugin declares: a name that is there twice, a default that is of another
/// kind than the parameter, outside its range or none of its choices. Empty where they are right.
std::string declaration_problem(const PluginInfo& info);

/// A plugin's parameters, checked against its declaration: names, types, counts and ranges are right once this exists.
class Params {
 public:
  /// Throws InputError naming what is wrong and what would have been right.
  Params(const PluginInfo& info, const ParsedPlugin& parsed, ParamResolver& resolver);

  bool boolean(std::string_view name) const;
  int integer(std::string_view name) const;
  double real(std::string_view name) const;
  std::string string(std::string_view name) const;
  Vec2 vec2(std::string_view name) const;
  Vec3 vec3(std::string_view name) const;
  SpectrumPtr spectrum(std::string_view name) const;
  /// Refuses textures whose values leave the declared range.
  std::shared_ptr<const FloatTexture> float_texture(std::string_view name) const;
  std::shared_ptr<const SpectrumTexture> spectrum_texture(std::string_view name) const;
  std::filesystem::path file(std::string_view name) const;

  std::vector<double> reals(std::string_view name) const;  ///< also of points, flattened
  std::vector<int> integers(std::string_view name) const;
  std::vector<std::string> strings(std::string_view name) const;
  std::vector<Vec2> vec2s(std::string_view name) const;
  std::vector<Vec3> vec3s(std::string_view name) const;
  std::vector<std::shared_ptr<Material>> materials(std::string_view name) const;
  std::vector<std::shared_ptr<const FloatTexture>> float_textures(std::string_view name) const;
  std::vector<std::filesystem::path> files(std::string_view name) const;

  /// Whether the scene gives the parameter itself.
  bool given(std::string_view name) const;
  /// Whether it does so by the name of a texture.
  bool is_texture(std::string_view name) const;
  /// Where the parameter stands, or the directive if it is not given: for a plugin's own errors.
  Location where(std::string_view name) const;
  const Location& where() const { return parsed_.where; }
  std::string_view plugin() const;  ///< the plugin's name
  /// Tells the user, at the parameter, that what is done is not quite what the scene asks for.
  void warn(std::string_view name, std::string_view message) const { resolver_.warn(where(name), message); }
  /// Those that another plugin declares too, with `more` of its own, for a plugin that makes that one. They count as
  /// read.
  Params forwarded(const PluginInfo& to, const std::vector<ParsedParam>& more = {}) const;
  /// Declared parameters that nothing has read: a defect of the plugin, found by a test.
  std::vector<std::string_view> unread() const;

 private:
  struct Found {
    const Param& declared;
    const ParsedParam* parsed;
  };
  Found find(std::string_view name) const;
  void check(const Param& declared, const ParsedParam& parsed) const;

  const PluginInfo& info_;
  ParsedPlugin parsed_;
  ParamResolver& resolver_;
  mutable std::vector<bool> read_;
};

}  // namespace frond
