#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "exports/mitsuba/materials.h"
#include "exports/mitsuba/textures.h"

namespace frond::mitsuba {
namespace {

// Parameters of frond_leaf, by type; those of the first list may be images (python/frond/mitsuba.py).
constexpr std::array kContents{"thickness",    "mesophyllfraction", "chlorophylla", "chlorophyllb",
                               "carotenoids",  "protein",           "cellulose",    "lignin",
                               "anthocyanins", "brownpigments",     "drymatter",    "otherabsorption"};
constexpr std::array kNumbers{"cuticleaspect",  "epidermisaspect", "spongyaspect",
                              "palisadeaspect", "spongyshare",     "cuticlerefractivity"};
constexpr std::array kWords{"specimen", "absorption", "incident"};
constexpr std::array kRefused{"pigments", "pigmentconcentrations", "tablefile", "tableleaf"};

/// True if the list has the name.
bool contains(const auto& names, const std::string& name) { return std::ranges::find(names, name) != names.end(); }

}  // namespace

/// Parameters of other leaf models than leaf_solved have no effect on the leaf itself, and are left out.
bool write_leaf(Context& context, Xml& xml, const ParsedPlugin& plugin, const std::string& id) {
  const Params p(context.registry.materials.get(plugin.name, plugin.where), plugin, context.resolver);
  if (plugin.name != "leaf_solved")
    context.warn(plugin.where,
                 fmt::format("\"{}\" becomes Mitsuba's frond_leaf, which is leaf_solved of the same leaf; "
                             "--swap \"*=leaf_solved\" renders it in frond",
                             plugin.name));
  bool has_image = false;
  const Element bsdf(xml, "bsdf", {{"type", "frond_leaf"}, {"id", id}});
  if (context.spectra.variants() != Variants::spectral)
    xml.text("wavelengths", fmt::format("{:g}", fmt::join(context.spectra.wavelengths_nm(), ", ")));
  for (const ParsedParam& given : plugin.params) {
    const std::string& name = given.name;
    if (contains(kRefused, name)) fail(given.where, "\"{}\" has no equivalent in Mitsuba's frond_leaf", name);
    if (contains(kWords, name)) xml.text(name, p.string(name));
    if (name == "sieve") xml.flag(name, p.boolean(name));
    if (name == "tolerance") xml.number(name, p.real(name));
    if (name == "spongyshare" || name == "cuticlerefractivity") {
      xml.number(name, p.real(name));
    } else if (contains(kContents, name) || contains(kNumbers, name)) {
      const FloatValue value = float_value(context, plugin, p, name);
      if (value.image && contains(kNumbers, name))
        fail(given.where, "\"{}\" from an image has no equivalent in Mitsuba's frond_leaf", name);
      has_image |= value.image != nullptr;
      write_value(context, xml, name, value);
    }
  }
  return has_image;
}

/// The material itself computes the shares, which depend on its angle of incidence.
void write_lambertian_leaf(Context& context, Xml& xml, const ParsedPlugin& plugin, size_t index,
                           const std::string& id) {
  const Params p(context.registry.materials.get(plugin.name, plugin.where), plugin, context.resolver);
  for (const ParsedParam& given : plugin.params)
    if (given.type == "texture") fail(given.where, "a leaf_lambert with textures is not exported");
  const std::shared_ptr<Material> material = context.resolver.material(index);
  material->prepare({context.spectra.strategy(), context.pool, context.log, context.cache});
  // f of a Lambertian leaf is a share over pi; frond_diffuse takes the side of the traced ray.
  const Vec3 above{0, 0, 1}, below{0, 0, -1};
  const auto share = [&](const Vec3& wo, const Vec3& wi) {
    return context.spectra.values([&](const SampledWavelengths& lambda) {
      Arena arena;
      RandomStream rng(0);
      const Bsdf* bsdf = material->evaluate(Hit{}, lambda, arena);
      return bsdf->f(wo, wi, rng) * kPi;
    });
  };
  const Element bsdf(xml, "bsdf", {{"type", "frond_diffuse"}, {"id", id}});
  context.spectra.write(xml, "reflectance", share(above, above));
  context.spectra.write(xml, "transmittance", share(above, below));
  context.spectra.write(xml, "back_reflectance", share(below, below));
  context.spectra.write(xml, "back_transmittance", share(below, above));
}

}  // namespace frond::mitsuba
