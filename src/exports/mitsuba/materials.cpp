#include "exports/mitsuba/materials.h"

#include <algorithm>

#include "exports/mitsuba/textures.h"
#include "image/rgb_file.h"
#include "scene/format/plugin_text.h"
#include "textures/normal_map.h"

namespace frond::mitsuba {
namespace {

/// Materials that Mitsuba, or frond's plug-ins for it, can have; "mix" is written by Materials.
struct Row {
  std::string_view name;
  Materials::Write write;
};
constexpr Row kRows[] = {
    {"diffuse", write_diffuse},
    {"diffusetransmission", write_transmitting},
    {"conductor", write_conductor},
    {"dielectric", write_dielectric},
    {"thindielectric", write_dielectric},
    {"measured", write_measured},
    {"interface", write_interface},
    {"leaf_lambert", write_lambertian_leaf},
    {"abm", write_leaf},
    {"leaf", write_leaf},
    {"leaf_simplified", write_leaf},
    {"leaf_solved", write_leaf},
};
constexpr std::string_view kMix = "mix";

/// Returns a name as an id: letters, digits and hyphens.
std::string to_id(const std::string& name) {
  std::string out;
  for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
  return out;
}

}  // namespace

/// Ids have a prefix, because shapes have ids too. Parts of a mixture precede it.
void Materials::write(Xml& xml, size_t index) {
  if (ids_.contains(index)) return;
  const MaterialDescription& material = context_.description.materials[index];
  std::string id = material.name.empty() ? fmt::format("material-{}", index) : "material-" + to_id(material.name);
  if (!names_.insert(id).second) names_.insert(id = fmt::format("{}-{}", id, index));
  // Entered first, so that a mixture that contains itself ends; the scene's check has refused it.
  ids_.emplace(index, id);
  for (const size_t part : parts_of(material.plugin)) write(xml, part);
  context_.problems.attempt([&] {
    const ParsedPlugin plugin = split_bend(material.plugin, false), bend = split_bend(material.plugin, true);
    if (bend.params.empty())
      write_plain(xml, plugin, id, index);
    else
      write_bent(xml, bend, plugin, id, index);
  });
}

void Materials::write_plain(Xml& xml, const ParsedPlugin& plugin, const std::string& id, size_t index) {
  const Params p(context_.registry.materials.get(plugin.name, plugin.where), plugin, context_.resolver);
  const Source source{plugin, p, id, index};
  const auto* const row = std::ranges::find(kRows, plugin.name, &Row::name);
  bool has_image = false;
  if (plugin.name == kMix) {
    has_image = write_mix(xml, source);
  } else if (row != std::end(kRows)) {
    has_image = row->write(context_, xml, source);
  } else {
    const std::string& name = context_.description.materials[index].shown_name();
    if (context_.report_unsupported(
            "materials", plugin.where,
            fmt::format("material \"{}\" has no equivalent in Mitsuba (--swap \"{}=diffuse,reflectance=0.5\" "
                        "replaces it)",
                        plugin.name, name),
            kStandIn))
      has_image = write_stand_in(context_, xml, source);
  }
  if (has_image) with_image_.insert(index);
}

/// Mitsuba's maps have frond's frame: the shading normal and dp/du. They are around "twosided", which would mirror them
/// on the back.
void Materials::write_bent(Xml& xml, const ParsedPlugin& bend, const ParsedPlugin& plugin, const std::string& id,
                           size_t index) {
  const Params p(normal_bend_params, bend, context_.resolver);
  const bool is_map = p.given("normalmap") && !p.string("normalmap").empty();
  FloatValue height;
  if (!is_map && p.given("displacement")) height = float_value(context_, bend, p, "displacement");
  if (!is_map && !height.image) return write_plain(xml, plugin, id, index);
  if (std::ranges::any_of(parts_of(plugin), [this](size_t part) { return is_bent(part); })) {
    context_.report_unsupported("materials", bend.where,
                                "a normal or bump map of a mixture whose materials have such maps too is "
                                "not exported",
                                "the mixture's own is left out");
    return write_plain(xml, plugin, id, index);
  }
  with_image_.insert(index);
  context_.warn(
      p.where(is_map ? "normalmap" : "displacement"),
      "Mitsuba drops light on the other side of the surface than of its mapped normal, which frond keeps: steep "
      "maps are darker there");
  const Element outer(xml, "bsdf", {{"type", is_map ? "normalmap" : "bumpmap"}, {"id", id}});
  if (is_map) {
    write_normals(context_, xml, "normalmap", p.file("normalmap"), read_rgb(p, "normalmap").image);
    // As in frond, which keeps all energy of the BSDF: no shadowing between facets, no flipped normals.
    xml.flag("use_shadowing_function", false);
    xml.flag("flip_invalid_normals", false);
  } else {
    context_.warn(p.where("displacement"),
                  "bump maps differ: Mitsuba takes the slope at a point, frond over the pixel's footprint");
    write_value(context_, xml, "map", height);
    xml.number("scale", context_.units);
  }
  write_plain(xml, plugin, "", index);
}

/// Returns the materials of a mixture, by index; none for others.
std::vector<size_t> Materials::parts_of(const ParsedPlugin& plugin) const {
  std::vector<size_t> parts;
  const ParsedParam* const names = plugin.name == kMix ? find_param(plugin.params, "materials") : nullptr;
  if (!names) return parts;
  const auto& materials = context_.description.materials;
  for (const std::string& name : std::get<std::vector<std::string>>(names->values))
    parts.push_back(size_t(std::ranges::find(materials, name, &MaterialDescription::name) - materials.begin()));
  return parts;
}

bool Materials::is_bent(size_t index) const {
  const ParsedPlugin& plugin = context_.description.materials[index].plugin;
  return !split_bend(plugin, true).params.empty() ||
         std::ranges::any_of(parts_of(plugin), [this](size_t part) { return is_bent(part); });
}

/// Mitsuba's weight is the share of the second BSDF, as frond's amount.
bool Materials::write_mix(Xml& xml, const Source& source) {
  const std::vector<size_t> parts = parts_of(source.plugin);
  const auto& materials = context_.description.materials;
  FloatValue amount = float_value(context_, source.plugin, source.p, "amount");
  if (const ParsedParam* const select = find_param(source.plugin.params, "select"))
    context_.report_unsupported("materials", select->where, "\"select\" of a mixture has no equivalent in Mitsuba",
                                "a blend of its first two materials stands for it");
  if (std::ranges::any_of(parts, [&](size_t part) { return is_smooth(context_, materials[part].plugin); })) {
    context_.report_unsupported(
        "materials", source.plugin.where,
        "a mixture with a smooth material is not exported: Mitsuba's blendbsdf adds the probability of a "
        "mirror direction to the density of the other BSDF",
        "the material of the larger share stands for it");
    const double share = amount.image ? mean_of(*amount.map) : amount.constant;
    amount = {share < 0.5 ? 0. : 1.};
  }
  const Element bsdf(xml, "bsdf", {{"type", "blendbsdf"}, {"id", source.id}});
  write_value(context_, xml, "weight", amount);
  for (const size_t i : {size_t(0), std::min<size_t>(1, parts.size() - 1)}) xml.reference(ids_.at(parts[i]));
  return amount.image || std::ranges::any_of(parts, [this](size_t part) { return has_image(part); });
}

}  // namespace frond::mitsuba
