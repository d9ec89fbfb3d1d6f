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

 private:
  void write_plain(Xml& xml, const ParsedPlugin& plugin, const std::string& id, size_t index);
  void write_diffuse(Xml& xml, const ParsedPlugin& plugin, const Params& p, const std::string& id, size_t index);
  void write_transmitting(Xml& xml, const ParsedPlugin& plugin, const Params& p, const std::string& id, size_t index);
  void write_conductor(Xml& xml, const ParsedPlugin& plugin, const Params& p, const std::string& id);
  void write_dielectric(Xml& xml, const ParsedPlugin& plugin, const Params& p, const std::string& id);
  void write_mix(Xml& xml, const ParsedPlugin& plugin, const Params& p, const std::string& id, size_t index);
  bool is_smooth(const ParsedPlugin& plugin);
  double roughness(const ParsedPlugin& plugin, const Params& p);

  Context& context_;
  std::map<size_t, std::string> ids_;
  std::set<std::string> names_;
  std::set<size_t> with_image_;
};

/// Writes an isotropic tensor file as Mitsuba's BSDF "measured". Throws InputError for other measurements, and for mono
/// variants, which it is not for.
void write_measured(Context& context, Xml& xml, const Params& p, const std::string& id);
/// Writes a leaf as Mitsuba's plug-in frond_leaf, which is leaf_solved. Returns whether it has an image.
bool write_leaf(Context& context, Xml& xml, const ParsedPlugin& plugin, const std::string& id);
/// Writes leaf_lambert as Mitsuba's plug-in frond_diffuse, with the shares of both sides.
void write_lambertian_leaf(Context& context, Xml& xml, const ParsedPlugin& plugin, size_t index, const std::string& id);

}  // namespace frond::mitsuba
