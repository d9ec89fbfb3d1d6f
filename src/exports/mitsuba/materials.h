#pragma once

#include <map>

#include "exports/mitsuba/context.h"

namespace frond::mitsuba {

/// Writes materials as BSDFs. Both sides of frond's "diffuse" and "conductor" reflect, so they are inside "twosided".
class Materials {
 public:
  explicit Materials(Context& context) : context_(context) {}

  /// Writes the BSDF of a material of the description, unless it has been written. Throws InputError.
  void write(Xml& xml, size_t index);
  /// Returns the id of a written material.
  const std::string& id(size_t index) const { return ids_.at(index); }
  /// True if a written material has an image, which needs texture coordinates.
  bool has_image(size_t index) const { return with_image_.contains(index); }

  /// A material whose BSDF is written. The writers of materials.cpp's table return whether it has an image.
  struct Source {
    const ParsedPlugin& plugin;  ///< without normal and bump map
    const Params& p;
    const std::string& id;  ///< empty for the BSDF inside a normal map
    size_t index;           ///< in the description
  };
  using Write = bool (*)(Context&, Xml&, const Source&);

 private:
  void write_plain(Xml& xml, const ParsedPlugin& plugin, const std::string& id, size_t index);
  void write_bent(Xml& xml, const ParsedPlugin& bend, const ParsedPlugin& plugin, const std::string& id, size_t index);
  bool write_mix(Xml& xml, const Source& source);
  std::vector<size_t> parts_of(const ParsedPlugin& plugin) const;
  bool is_bent(size_t index) const;

  Context& context_;
  std::map<size_t, std::string> ids_;
  std::set<std::string> names_;
  std::set<size_t> with_image_;
};

// Writers of single materials. All throw InputError, and return whether the material has an image.

bool write_diffuse(Context& context, Xml& xml, const Materials::Source& source);
bool write_transmitting(Context& context, Xml& xml, const Materials::Source& source);
bool write_conductor(Context& context, Xml& xml, const Materials::Source& source);
bool write_dielectric(Context& context, Xml& xml, const Materials::Source& source);
bool write_interface(Context& context, Xml& xml, const Materials::Source& source);
/// Writes an isotropic tensor file as Mitsuba's BSDF "measured"; a stand-in for other measurements, and in mono
/// variants, which it is not for.
bool write_measured(Context& context, Xml& xml, const Materials::Source& source);
/// Writes a leaf as Mitsuba's plug-in frond_leaf, which is leaf_solved.
bool write_leaf(Context& context, Xml& xml, const Materials::Source& source);
/// Writes leaf_lambert as Mitsuba's plug-in frond_diffuse, with the shares of both sides.
bool write_lambertian_leaf(Context& context, Xml& xml, const Materials::Source& source);

/// Substitute for a material without an equivalent, as messages name it.
inline constexpr std::string_view kStandIn =
    "a Lambertian surface with its reflectance and transmittance at 8 degrees stands for it: its gloss is lost";
/// Writes a Lambertian reflector and transmitter with the material's reflectance and transmittance at 8 degrees,
/// averaged over its textures.
bool write_stand_in(Context& context, Xml& xml, const Materials::Source& source);
/// Returns whether a material reflects or transmits into single directions.
bool is_smooth(Context& context, const ParsedPlugin& plugin);

}  // namespace frond::mitsuba
