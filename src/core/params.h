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
#include "core/math/vec.h"
#include "core/spectrum.h"
#include "core/units/quantity.h"

namespace frond {

class FloatTexture;
class SpectrumTexture;
class Material;

/// Kind of a parameter. The comments list the types that a scene file can give for it.
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
  rgb,               ///< rgb: colours, such as a grid's
  float_texture,     ///< float, texture
  spectrum_texture,  ///< rgb, spectrum, texture: in [0, 1]
  material,          ///< string: the name of a material
};

/// Unit of a number as documentation and messages print it; empty for a dimensionless number.
using Unit = std::string_view;

/// Default value of a parameter. An int is a default of any numeric kind. With monostate there is no default: the
/// plug-in must check Params::given before it reads the parameter.
using Default = std::variant<std::monostate, bool, int, double, std::string_view, std::array<double, 3>>;

/// Ranges for Param::range.
inline constexpr Interval kAnyValue{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
inline constexpr Interval kAtLeastZero{0, std::numeric_limits<double>::infinity()};

/// Declaration of a parameter. The scene reader, error messages, `frond describe` and docs/plugins.md use it.
struct Param {
  std::string_view name;
  ParamKind kind;
  Default default_value = {};
  Unit unit = "";
  Interval range = kAnyValue;  ///< allowed values of each number, ends included
  std::string_view doc;
  bool list = false;                                    ///< takes any number of values instead of one
  bool required = false;                                ///< an error if the scene does not give it
  PhysicalQuantity quantity = PhysicalQuantity::other;  ///< for a warning if numbers are probably in another unit
  std::span<const std::string_view> choices = {};       ///< allowed strings; empty: any string
  bool in_place_of_others = false;                      ///< as a file is: sweeps over all parameters leave it out
};

/// Parameter as a scene file gives it: `"float roughness" [ 0.1 ]`.
struct ParsedParam {
  std::string type, name;
  Location where;        ///< position of the quoted declaration
  Location value_where;  ///< position of the first value
  std::variant<std::vector<double>, std::vector<std::string>, std::vector<bool>> values;
  bool may_be_unused = false;    ///< given by an `Attribute` directive: ignored by plug-ins that do not declare it
  std::string color_space = {};  ///< colour space of an rgb value; empty: the scene's
};

/// Directive with a plug-in's name and parameters: `Material "diffuse" ...`.
struct ParsedPlugin {
  std::string name;
  Location where;
  std::vector<ParsedParam> params;
};

/// Use of a spectrum. It decides how numbers and RGB colours are converted to a spectrum and which values are errors.
enum class SpectrumUse : uint8_t { illuminant, albedo, unbounded };

/// Resolves parameter values that refer to textures, materials, spectra and files of a scene; the scene reader
/// implements it. All functions throw InputError.
class ParamResolver {
 public:
  virtual ~ParamResolver() = default;
  /// The texture or material of this name; not null.
  virtual std::shared_ptr<const FloatTexture> float_texture(const std::string& name, const Location&) = 0;
  virtual std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string& name, const Location&) = 0;
  virtual std::shared_ptr<Material> material(const std::string& name, const Location&) = 0;
  /// Spectrum of a parameter of type rgb, spectrum, blackbody or float.
  virtual SpectrumPtr spectrum(const ParsedParam&, SpectrumUse) = 0;
  /// Path of a file; `name` is relative to the scene file.
  virtual std::filesystem::path file(const std::string& name, const Location&) = 0;
  /// Warns the user that the result deviates from what the scene states.
  virtual void warn(const Location&, std::string_view /*message*/) {}
};

struct PluginInfo;

/// Describes the first error in a plug-in's declaration of parameters: a duplicate name, or a default that has the
/// wrong kind, lies outside the range or is not among the choices. Empty if there is no error.
std::string declaration_problem(const PluginInfo& info);

/// Parameter values of one plug-in. The constructor checks names, types, counts and ranges against the declaration.
///
/// Each function reads a parameter by name and returns the value of the scene, or else the default. A parameter that is
/// not declared, or has neither a value nor a default of the kind, is a defect of the plug-in: std::logic_error. A list
/// without value and default is empty. Values that refer to textures, spectra, materials and files are resolved by
/// `resolver`, which must outlive the object and throws InputError. Not thread-safe.
class Params {
 public:
  /// Throws InputError with the error and the allowed values.
  Params(const PluginInfo& info, const ParsedPlugin& parsed, ParamResolver& resolver);

  bool boolean(std::string_view name) const;
  int integer(std::string_view name) const;
  double real(std::string_view name) const;
  std::string string(std::string_view name) const;
  Vec2 vec2(std::string_view name) const;
  Vec3 vec3(std::string_view name) const;
  SpectrumPtr spectrum(std::string_view name) const;
  /// Texture of a parameter; a constant one if its value is a number. Throws InputError if the texture's values lie
  /// outside the declared range; for a parameter without a unit that is only partly so, clamps them and warns.
  std::shared_ptr<const FloatTexture> float_texture(std::string_view name) const;
  std::shared_ptr<const SpectrumTexture> spectrum_texture(std::string_view name) const;
  std::filesystem::path file(std::string_view name) const;

  std::vector<double> reals(std::string_view name) const;  ///< of points and vectors: all coordinates in one list
  std::vector<int> integers(std::string_view name) const;
  /// Colour space of a parameter of type rgb; empty: the scene's.
  std::string color_space(std::string_view name) const;
  std::vector<std::string> strings(std::string_view name) const;
  std::vector<Vec2> vec2s(std::string_view name) const;
  std::vector<Vec3> vec3s(std::string_view name) const;
  std::vector<std::shared_ptr<Material>> materials(std::string_view name) const;
  std::vector<std::shared_ptr<const FloatTexture>> float_textures(std::string_view name) const;
  std::vector<std::filesystem::path> files(std::string_view name) const;

  /// True if the scene gives the parameter.
  bool given(std::string_view name) const;
  /// True if the scene gives the name of a texture.
  bool is_texture(std::string_view name) const;
  /// Position of the parameter's first value, or of the directive if it is not given; for errors of the plug-in.
  Location where(std::string_view name) const;
  /// Position of the directive.
  const Location& where() const { return parsed_.where; }
  std::string_view plugin() const;  ///< name of the plug-in
  const PluginInfo& info() const { return info_; }
  /// Warns the user, at the position of the parameter, that the result deviates from what the scene states.
  void warn(std::string_view name, std::string_view message) const { resolver_.warn(where(name), message); }
  /// Parameters for the plug-in `to`, which this one makes: `more`, and all given parameters that both declare. The
  /// latter count as read. Throws InputError.
  Params forwarded(const PluginInfo& to, const std::vector<ParsedParam>& more = {}) const;
  /// Declared parameters that have not been read, which is a defect of the plug-in; a test checks the built-in ones.
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
