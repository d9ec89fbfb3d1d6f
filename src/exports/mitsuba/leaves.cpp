#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "exports/exported_bsdf.h"
#include "exports/mitsuba/materials.h"
#include "exports/mitsuba/textures.h"
#include "instruments/beam.h"
#include "leaf/plates/plate_leaf.h"
#include "leaf/tissue/leaf_numbers.h"

namespace frond::mitsuba {
namespace {

// Parameters of frond_leaf beside the numbers of a leaf.
constexpr std::array kWords{"specimen", "absorption", "incident"};
constexpr std::array kRefused{"pigments", "pigmentconcentrations", "specimenfile", "tablefile", "tableleaf"};

/// True if the list has the name.
bool contains(const auto& names, const std::string& name) { return std::ranges::find(names, name) != names.end(); }

/// Mitsuba renders no fluorescence.
void warn_of_fluorescence(Context& context, const ParsedPlugin& leaf) {
  if (const ParsedParam* given = fluorescence_of(leaf))
    context.warn(given->where, fmt::format("\"{}\" is left out: Mitsuba renders no fluorescence", given->name));
}

/// A hit on the front of a flat leaf, or at the texture coordinates of a texel.
Hit hit_at(Vec2 uv) {
  Hit hit = flat_hit();
  hit.at.uv = uv;
  return hit;
}

}  // namespace

/// Parameters of other leaf models than leaf_solved have no effect on the leaf itself, and are left out.
bool write_leaf(Context& context, Xml& xml, const Materials::Source& source) {
  const auto& [plugin, p, id, index] = source;
  bool is_refused = false;
  for (const ParsedParam& given : plugin.params) {
    if (!contains(kRefused, given.name)) continue;
    context.report_unsupported("materials", given.where,
                               fmt::format("\"{}\" has no equivalent in Mitsuba's frond_leaf", given.name), kStandIn);
    is_refused = true;
  }
  if (is_refused) return context.problems.empty() && write_stand_in(context, xml, source);
  if (plugin.name != "leaf_solved")
    context.warn(plugin.where,
                 fmt::format("\"{}\" becomes Mitsuba's frond_leaf, which is leaf_solved of the same leaf; "
                             "--swap \"*=leaf_solved\" renders it in frond",
                             plugin.name));
  warn_of_fluorescence(context, plugin);
  bool has_image = false;
  const Element bsdf(xml, "bsdf", {{"type", "frond_leaf"}, {"id", id}});
  if (context.spectra.variants() != Variants::spectral)
    xml.text("wavelengths", fmt::format("{:g}", fmt::join(context.spectra.wavelengths_nm(), ", ")));
  for (const ParsedParam& given : plugin.params) {
    const std::string& name = given.name;
    if (contains(kWords, name)) xml.text(name, p.string(name));
    if (name == "sieve") xml.flag(name, p.boolean(name));
    if (name == "tolerance") xml.number(name, p.real(name));
    if (leaf::find_plate_number(name)) xml.number(name, p.real(name));
    const leaf::LeafNumber* number = leaf::find_leaf_number(name);
    if (!number || number->action == leaf::LeafAction::emission) continue;
    FloatValue value;
    if (number->takes_texture)
      value = float_value(context, plugin, p, name);
    else
      value.constant = p.real(name);
    // Images change the optical depth alone (python/frond/mitsuba.py).
    if (value.image && !number->acts_by_depth()) {
      context.report_unsupported("textures", given.where,
                                 fmt::format("\"{}\" from an image has no equivalent in Mitsuba's frond_leaf", name),
                                 "its mean stands for it");
      value = {mean_of(*value.map)};
    }
    has_image |= value.image != nullptr;
    write_value(context, xml, name, value);
  }
  return has_image;
}

/// The material itself computes the shares, which depend on its angle of incidence. Where images vary it, its shares
/// are images with the texels of the largest one.
bool write_lambertian_leaf(Context& context, Xml& xml, const Materials::Source& source) {
  const auto& [plugin, p, id, index] = source;
  warn_of_fluorescence(context, plugin);
  std::vector<std::string_view> varied;
  for (const ParsedParam& given : plugin.params)
    if (given.type == "texture") varied.push_back(given.name);
  const TextureDescription* const image = common_image(context, plugin, p, varied);
  const std::shared_ptr<Material> material = context.resolver.material(index);
  material->prepare({context.spectra.strategy(), context.pool, context.log, context.cache});
  // f of a Lambertian leaf is a share over pi; frond_diffuse takes the side of the traced ray.
  const Vec3 above{0, 0, 1}, below{0, 0, -1};
  Arena arena;
  const auto share = [&, &material = *material](const Vec3& wo, const Vec3& wi, Vec2 uv) {
    return context.spectra.values([&](const SampledWavelengths& lambda) {
      arena.reset();
      RandomStream rng(0);
      const Bsdf* const bsdf = material.evaluate(hit_at(uv), lambda, arena);
      return bsdf->f(wo, wi, rng) * kPi;
    });
  };
  const Element bsdf(xml, "bsdf", {{"type", "frond_diffuse"}, {"id", id}});
  const auto write = [&](std::string_view name, const Vec3& wo, const Vec3& wi) {
    const auto at = [&](const TexturePoint& point) { return share(wo, wi, point.uv); };
    if (image)
      write_texels(context, xml, name, *image, at);
    else
      context.spectra.write(xml, name, varied.empty() ? at({}) : mean_over_uv(at));
  };
  write("reflectance", above, above);
  write("transmittance", above, below);
  write("back_reflectance", below, below);
  write("back_transmittance", below, above);
  return image != nullptr;
}

}  // namespace frond::mitsuba
