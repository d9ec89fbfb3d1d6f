#include "exports/mitsuba/materials.h"

#include <algorithm>
#include <cmath>

#include "exports/mitsuba/textures.h"
#include "scene/textures/normal_map.h"
#include "spectra/named.h"

namespace frond::mitsuba {
namespace {

constexpr double kSmooth = 1e-3;  // alpha below which frond takes a surface as smooth

/// Returns a name as an id: letters, digits and hyphens.
std::string plain(const std::string& name) {
  std::string out;
  for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
  return out;
}

}  // namespace

/// Ids have a prefix, because shapes have ids too.
void Materials::write(Xml& xml, size_t index) {
  if (ids_.contains(index)) return;
  const MaterialDescription& material = context_.description.materials[index];
  std::string id = material.name.empty() ? fmt::format("material-{}", index) : "material-" + plain(material.name);
  if (!names_.insert(id).second) names_.insert(id = fmt::format("{}-{}", id, index));
  // Entered first, so that a mixture that contains itself ends; the scene's check has refused it.
  ids_.emplace(index, id);
  if (!split_bend(material.plugin, true).params.empty())
    fail(material.plugin.where,
         "\"displacement\" and \"normalmap\" are not exported: Mitsuba's bump and normal maps "
         "differ from frond's; leave them out, or swap the material by --swap");
  write_plain(xml, material.plugin, id, index);
}

/// Materials that are not listed have no equivalent.
void Materials::write_plain(Xml& xml, const ParsedPlugin& plugin, const std::string& id, size_t index) {
  const std::string& name = plugin.name;
  const MaterialInfo& info = context_.registry.materials.get(name, plugin.where);
  const Params p(info, split_bend(plugin, false), context_.resolver);
  if (name == "diffuse") return write_diffuse(xml, plugin, p, id, index);
  if (name == "diffusetransmission") return write_transmitting(xml, plugin, p, id, index);
  if (name == "conductor") return write_conductor(xml, plugin, p, id);
  if (name == "dielectric" || name == "thindielectric") return write_dielectric(xml, plugin, p, id);
  if (name == "measured") return write_measured(context_, xml, p, id);
  if (name == "mix") return write_mix(xml, plugin, p, id, index);
  if (name == "interface") return xml.element("bsdf", {{"type", "null"}, {"id", id}});
  if (name == "leaf_lambert") return write_lambertian_leaf(context_, xml, plugin, index, id);
  if (name == "abm" || name == "leaf" || name == "leaf_simplified" || name == "leaf_solved") {
    if (write_leaf(context_, xml, plugin, id)) with_image_.insert(index);
    return;
  }
  fail(plugin.where,
       "material \"{}\" has no equivalent in Mitsuba: --swap replaces it, as in \"{}=diffuse,reflectance=0.5\"", name,
       context_.description.materials[index].name.empty() ? name : context_.description.materials[index].name);
}

/// Mitsuba's diffuse BSDF is black from behind.
void Materials::write_diffuse(Xml& xml, const ParsedPlugin& plugin, const Params& p, const std::string& id,
                              size_t index) {
  const SpectrumValue reflectance = spectrum_value(context_, plugin, p, "reflectance");
  if (reflectance.image) with_image_.insert(index);
  const Element both(xml, "bsdf", {{"type", "twosided"}, {"id", id}});
  const Element diffuse(xml, "bsdf", {{"type", "diffuse"}});
  write_value(context_, xml, "reflectance", reflectance);
}

/// A plug-in of frond.mitsuba, because Mitsuba has no diffuse transmission without other lobes.
void Materials::write_transmitting(Xml& xml, const ParsedPlugin& plugin, const Params& p, const std::string& id,
                                   size_t index) {
  SpectrumValue reflectance = spectrum_value(context_, plugin, p, "reflectance"),
                transmittance = spectrum_value(context_, plugin, p, "transmittance");
  const double scale = p.real("scale");
  if (reflectance.image || transmittance.image) {
    with_image_.insert(index);
    if (scale * double(reflectance.map->max_value() + transmittance.map->max_value()) > 1 + 1e-5)
      fail(plugin.where,
           "reflectance + transmittance exceeds 1: frond scales the sum down, which the export of images "
           "cannot");
  } else {
    // As frond: the sum is at most 1.
    for (size_t i = 0; i < reflectance.constant.size(); ++i) {
      const double sum = scale * (reflectance.constant[i] + transmittance.constant[i]);
      if (sum > 1) reflectance.constant[i] /= sum, transmittance.constant[i] /= sum;
    }
  }
  const Element bsdf(xml, "bsdf", {{"type", "frond_diffuse"}, {"id", id}});
  write_value(context_, xml, "reflectance", reflectance, scale);
  write_value(context_, xml, "transmittance", transmittance, scale);
}

/// Returns alpha; 0 if the surface is smooth. Throws InputError if it varies or differs along u and v.
double Materials::roughness(const ParsedPlugin& plugin, const Params& p) {
  const auto along = [&](std::string_view name) {
    const auto texture = p.float_texture(p.given(name) ? name : "roughness");
    if (!texture->is_constant()) fail(p.where(name), "a roughness from a texture is not exported");
    return texture->range().min;
  };
  const double u = along("uroughness"), v = along("vroughness");
  if (u != v) fail(plugin.where, "a roughness that differs along u and v is not exported");
  const double alpha = p.boolean("remaproughness") ? std::sqrt(std::max(0.0, u)) : u;
  if (alpha < kSmooth) return 0;
  context_.warn(plugin.where,
                "rough surfaces differ: Mitsuba multiplies the masking of both directions, frond correlates them");
  return alpha;
}

/// Both programs use the exact Fresnel reflectance of a metal.
void Materials::write_conductor(Xml& xml, const ParsedPlugin& plugin, const Params& p, const std::string& id) {
  const double alpha = roughness(plugin, p);
  std::vector<double> eta, k;
  if (p.given("reflectance")) {
    const SpectrumValue reflectance = spectrum_value(context_, plugin, p, "reflectance");
    if (reflectance.image) fail(p.where("reflectance"), "a conductor's reflectance from an image is not exported");
    // As frond: eta 1 and the k that gives the reflectance at normal incidence.
    for (const double given : reflectance.constant) {
      const double r = std::clamp(given, 0.0, 0.9999);
      eta.push_back(1), k.push_back(2 * std::sqrt(r / (1 - r)));
    }
  } else {
    const auto values = [&](std::string_view name, const char* copper) {
      const SpectrumPtr s = p.given(name) ? p.spectrum(name) : named_spectrum(copper, plugin.where);
      return context_.spectra.values([&](const auto& lambda) { return s->sample(lambda); });
    };
    eta = values("eta", "metal-Cu-eta"), k = values("k", "metal-Cu-k");
  }
  const Element both(xml, "bsdf", {{"type", "twosided"}, {"id", id}});
  const Element bsdf(xml, "bsdf", {{"type", alpha > 0 ? "roughconductor" : "conductor"}});
  context_.spectra.write_unbounded(xml, "eta", eta);
  context_.spectra.write_unbounded(xml, "k", k);
  if (alpha == 0) return;
  xml.text("distribution", "ggx");
  xml.number("alpha", alpha);
}

/// Mitsuba's dielectrics have one index for all wavelengths.
void Materials::write_dielectric(Xml& xml, const ParsedPlugin& plugin, const Params& p, const std::string& id) {
  const bool is_thin = plugin.name == "thindielectric";
  const double alpha = is_thin ? 0 : roughness(plugin, p);
  const SpectrumPtr spectrum = p.spectrum("eta");
  const std::vector<double> eta = context_.spectra.values([&](const auto& lambda) { return spectrum->sample(lambda); });
  const auto [least, most] = std::ranges::minmax(eta);
  if (most - least > 1e-6)
    fail(p.where("eta"), "dispersion is not exported: \"eta\" goes from {:g} to {:g}, Mitsuba takes one number", least,
         most);
  const Element bsdf(xml, "bsdf",
                     {{"type", is_thin     ? "thindielectric"
                               : alpha > 0 ? "roughdielectric"
                                           : "dielectric"},
                      {"id", id}});
  xml.number("int_ior", least == 0 ? 1 : least);  // 0 counts as 1, as in pbrt-v4
  xml.number("ext_ior", 1);
  if (alpha == 0) return;
  xml.text("distribution", "ggx");
  xml.number("alpha", alpha);
}

/// Returns whether a material reflects or transmits into single directions.
bool Materials::is_smooth(const ParsedPlugin& plugin) {
  if (plugin.name == "thindielectric" || plugin.name == "interface") return true;
  if (plugin.name != "conductor" && plugin.name != "dielectric") return false;
  const Params p(context_.registry.materials.get(plugin.name, plugin.where), split_bend(plugin, false),
                 context_.resolver);
  return roughness(plugin, p) == 0;
}

/// Mitsuba's weight is the share of the second BSDF, as frond's amount.
void Materials::write_mix(Xml& xml, const ParsedPlugin& plugin, const Params& p, const std::string& id, size_t index) {
  const auto& names =
      std::get<std::vector<std::string>>(std::ranges::find(plugin.params, "materials", &ParsedParam::name)->values);
  std::vector<size_t> parts;
  const auto& materials = context_.description.materials;
  for (const std::string& name : names) {
    const size_t part = size_t(std::ranges::find(materials, name, &MaterialDescription::name) - materials.begin());
    write(xml, part);
    if (has_image(part)) with_image_.insert(index);
    parts.push_back(part);
  }
  if (is_smooth(materials[parts[0]].plugin) || is_smooth(materials[parts[1]].plugin))
    fail(plugin.where,
         "a mixture with a smooth material is not exported: Mitsuba's blendbsdf adds the probability of a mirror "
         "direction to the density of the other BSDF");
  const FloatValue amount = float_value(context_, plugin, p, "amount");
  if (amount.image) with_image_.insert(index);
  const Element bsdf(xml, "bsdf", {{"type", "blendbsdf"}, {"id", id}});
  write_value(context_, xml, "weight", amount);
  for (const size_t part : parts) xml.reference(ids_.at(part));
}

}  // namespace frond::mitsuba
