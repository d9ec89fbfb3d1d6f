#include <algorithm>
#include <cmath>
#include <numbers>

#include "exports/mitsuba/materials.h"
#include "exports/mitsuba/textures.h"
#include "instruments/beam.h"
#include "spectra/named.h"
#include "textures/normal_map.h"

namespace frond::mitsuba {
namespace {

constexpr double kSmooth = 1e-3;  // alpha below which frond takes a surface as smooth

/// Returns alpha; 0 if the surface is smooth.
double roughness(Context& context, const ParsedPlugin& plugin, const Params& p) {
  const auto along = [&](std::string_view name) {
    const auto texture = p.float_texture(p.given(name) ? name : "roughness");
    if (texture->is_constant()) return texture->range().min;
    context.report_unsupported("materials", p.where(p.given(name) ? name : "roughness"),
                               "a roughness from a texture is not exported", "its mean stands for it");
    return mean_of(*texture);
  };
  double u = along("uroughness");
  const double v = along("vroughness");
  if (u != v) {
    context.report_unsupported("materials", plugin.where, "a roughness that differs along u and v is not exported",
                               "the geometric mean of both stands for it");
    u = std::sqrt(std::max(0., u) * std::max(0., v));
  }
  const double alpha = p.boolean("remaproughness") ? std::sqrt(std::max(0.0, u)) : u;
  if (alpha < kSmooth) return 0;
  context.warn(plugin.where,
               "rough surfaces differ: Mitsuba multiplies the masking of both directions, frond correlates them");
  return alpha;
}

}  // namespace

/// Mitsuba's diffuse BSDF is black from behind.
bool write_diffuse(Context& context, Xml& xml, const Materials::Source& source) {
  const SpectrumValue reflectance = spectrum_value(context, source.plugin, source.p, "reflectance");
  const Element both(xml, "bsdf", {{"type", "twosided"}, {"id", source.id}});
  const Element diffuse(xml, "bsdf", {{"type", "diffuse"}});
  write_value(context, xml, "reflectance", reflectance);
  return reflectance.image;
}

/// A plug-in of frond.mitsuba, because Mitsuba has no diffuse transmission without other lobes.
bool write_transmitting(Context& context, Xml& xml, const Materials::Source& source) {
  const auto& [plugin, p, id, index] = source;
  SpectrumValue reflectance = spectrum_value(context, plugin, p, "reflectance"),
                transmittance = spectrum_value(context, plugin, p, "transmittance");
  double scale = p.real("scale");
  const bool has_image = reflectance.image || transmittance.image;
  if (has_image) {
    const double most = scale * double(reflectance.map->max_value() + transmittance.map->max_value());
    if (most > 1 + 1e-5) {
      context.report_unsupported(
          "materials", plugin.where,
          "reflectance + transmittance exceeds 1: frond scales the sum down where it does, which the export "
          "of images cannot",
          "both are scaled down everywhere");
      scale /= most;
    }
  } else {
    // As frond: the sum is at most 1.
    for (size_t i = 0; i < reflectance.constant.size(); ++i) {
      const double sum = scale * (reflectance.constant[i] + transmittance.constant[i]);
      if (sum > 1) reflectance.constant[i] /= sum, transmittance.constant[i] /= sum;
    }
  }
  const Element bsdf(xml, "bsdf", {{"type", "frond_diffuse"}, {"id", id}});
  write_value(context, xml, "reflectance", reflectance, scale);
  write_value(context, xml, "transmittance", transmittance, scale);
  return has_image;
}

/// Both programs use the exact Fresnel reflectance of a metal.
bool write_conductor(Context& context, Xml& xml, const Materials::Source& source) {
  const auto& [plugin, p, id, index] = source;
  const double alpha = roughness(context, plugin, p);
  std::vector<double> eta, k;
  if (p.given("reflectance")) {
    SpectrumValue reflectance = spectrum_value(context, plugin, p, "reflectance");
    if (reflectance.image) {
      context.report_unsupported("materials", p.where("reflectance"),
                                 "a conductor's reflectance from an image is not exported", "its mean stands for it");
      reflectance.constant = mean_of(*reflectance.map, context.spectra);
    }
    // As frond: eta 1 and the k that gives the reflectance at normal incidence.
    for (const double given : reflectance.constant) {
      const double r = std::clamp(given, 0.0, 0.9999);
      eta.push_back(1), k.push_back(2 * std::sqrt(r / (1 - r)));
    }
  } else {
    const auto values = [&, &params = p, &where = plugin.where](std::string_view name, const char* copper) {
      const SpectrumPtr s = params.given(name) ? params.spectrum(name) : named_spectrum(copper, where);
      return context.spectra.values([&](const auto& lambda) { return s->sample(lambda); });
    };
    eta = values("eta", "metal-Cu-eta"), k = values("k", "metal-Cu-k");
  }
  const Element both(xml, "bsdf", {{"type", "twosided"}, {"id", id}});
  const Element bsdf(xml, "bsdf", {{"type", alpha > 0 ? "roughconductor" : "conductor"}});
  context.spectra.write_unbounded(xml, "eta", eta);
  context.spectra.write_unbounded(xml, "k", k);
  if (alpha == 0) return false;
  xml.text("distribution", "ggx");
  xml.number("alpha", alpha);
  return false;
}

/// Mitsuba's dielectrics have one index for all wavelengths.
bool write_dielectric(Context& context, Xml& xml, const Materials::Source& source) {
  const auto& [plugin, p, id, index] = source;
  const bool is_thin = plugin.name == "thindielectric";
  const double alpha = is_thin ? 0 : roughness(context, plugin, p);
  const SpectrumPtr spectrum = p.spectrum("eta");
  const std::vector<double> eta = context.spectra.values([&](const auto& lambda) { return spectrum->sample(lambda); });
  const auto [least, most] = std::ranges::minmax(eta);
  if (most - least > 1e-6)
    context.report_unsupported(
        "materials", p.where("eta"),
        fmt::format("dispersion is not exported: \"eta\" goes from {:g} to {:g}, Mitsuba takes one number", least,
                    most),
        "the middle of both is taken");
  const double index_of_refraction = (least + most) / 2;
  const Element bsdf(xml, "bsdf",
                     {{"type", is_thin     ? "thindielectric"
                               : alpha > 0 ? "roughdielectric"
                                           : "dielectric"},
                      {"id", id}});
  xml.number("int_ior", index_of_refraction == 0 ? 1 : index_of_refraction);  // 0 counts as 1, as in pbrt-v4
  xml.number("ext_ior", 1);
  if (alpha == 0) return false;
  xml.text("distribution", "ggx");
  xml.number("alpha", alpha);
  return false;
}

bool write_interface(Context&, Xml& xml, const Materials::Source& source) {
  xml.element("bsdf", {{"type", "null"}, {"id", source.id}});
  return false;
}

/// The mean over texture coordinates and wavelengths of each lane's albedo, by samples of the BSDF that are the same
/// for every run.
bool write_stand_in(Context& context, Xml& xml, const Materials::Source& source) {
  constexpr int kSamples = 4096;
  constexpr double kTheta = 8 * std::numbers::pi / 180;
  const std::shared_ptr<Material> material = context.resolver.material(source.index);
  material->prepare({context.spectra.strategy(), context.pool, context.log, context.cache});
  const auto share = [&](bool is_front, bool is_reflected) {
    const float side = is_front ? 1.f : -1.f;
    const Vec3 wo{float(std::sin(kTheta)), 0, side * float(std::cos(kTheta))};
    return context.spectra.values([&](const SampledWavelengths& lambda) {
      Arena arena;
      RandomStream rng(0);
      SampledSpectrum sum;
      for (int i = 0; i < kSamples; ++i) {
        arena.reset();
        Hit hit = flat_hit();
        hit.at.uv = {rng.uniform(), rng.uniform()};
        const Bsdf* const bsdf = material->evaluate(hit, lambda, arena);
        const float uc = rng.uniform(), u = rng.uniform(), v = rng.uniform();
        const auto s = bsdf ? bsdf->sample(wo, uc, {u, v}, rng) : std::nullopt;
        if (s && (s->wi.z * side > 0) == is_reflected) sum += s->f * (std::abs(s->wi.z) / s->pdf);
      }
      return sum * (1.f / kSamples);
    });
  };
  const Element bsdf(xml, "bsdf", {{"type", "frond_diffuse"}, {"id", source.id}});
  context.spectra.write(xml, "reflectance", share(true, true));
  context.spectra.write(xml, "transmittance", share(true, false));
  context.spectra.write(xml, "back_reflectance", share(false, true));
  context.spectra.write(xml, "back_transmittance", share(false, false));
  return false;
}

/// Roughness from textures is never smooth.
bool is_smooth(Context& context, const ParsedPlugin& plugin) {
  if (plugin.name == "thindielectric" || plugin.name == "interface") return true;
  if (plugin.name != "conductor" && plugin.name != "dielectric") return false;
  const Params p(context.registry.materials.get(plugin.name, plugin.where), split_bend(plugin, false),
                 context.resolver);
  return roughness(context, plugin, p) == 0;
}

}  // namespace frond::mitsuba
