#include "scene/resolver.h"

#include <limits>

#include "core/bssrdf.h"
#include "core/messages/problems.h"
#include "scene/format/known_names.h"
#include "scene/scene_options.h"
#include "spectra/analytic.h"
#include "spectra/beyond_data.h"
#include "spectra/check_range.h"
#include "spectra/cie.h"
#include "spectra/color/color_space.h"
#include "spectra/color/rgb_upsampling.h"
#include "spectra/named.h"
#include "spectra/spd_file.h"
#include "spectra/tabulated.h"
#include "spectra/wavelengths/fixed_wavelengths.h"
#include "textures/normal_map.h"

namespace frond {
namespace {

const std::vector<double>& numbers(const ParsedParam& p) { return std::get<std::vector<double>>(p.values); }

/// Returns a spectrum by name, as "stdillum-D65", or from a file.
SpectrumPtr spectrum_of_name(const ParsedParam& p, const SceneSettings& description) {
  const auto& words = std::get<std::vector<std::string>>(p.values);
  if (words.size() != 1) fail(p.value_where, "\"{}\" takes one spectrum, {} names given", p.name, words.size());
  return named_or_read_spectrum(words[0], description.resolve(words[0], p.value_where), p.value_where);
}

/// Limits the nesting of references; each level can double the cost of a lookup.
void check_depth(size_t levels, const Location& where) {
  constexpr size_t kDeepest = 16;
  if (levels > kDeepest) fail(where, "textures and materials are nested more than {} deep", kDeepest);
}

/// Throws InputError for other numbers of values.
Triple rgb_of(const ParsedParam& p) {
  const auto& v = numbers(p);
  if (v.size() != 3) fail(p.value_where, "\"{}\" takes 3 values as rgb, {} given", p.name, v.size());
  return {v[0], v[1], v[2]};
}

/// A second value, the scale of older files, is accepted and ignored.
SpectrumPtr blackbody_of(const ParsedParam& p) {
  const auto& v = numbers(p);
  if (v.empty() || v.size() > 2)
    fail(p.value_where, "\"{}\" takes one temperature in kelvin, {} values given", p.name, v.size());
  return std::make_shared<BlackbodySpectrum>(v[0], p.value_where);
}

/// Throws InputError for a negative value.
SpectrumPtr constant_of(const ParsedParam& p) {
  const auto& v = numbers(p);
  if (v.size() != 1) fail(p.value_where, "\"{}\" takes one value as float, {} given", p.name, v.size());
  if (!(v[0] >= 0)) fail(p.value_where, "\"{}\" is {}, below 0", p.name, v[0]);
  if (!(v[0] <= double(std::numeric_limits<float>::max())))
    fail(p.value_where, "\"{}\" is {}, larger than any float", p.name, v[0]);
  return std::make_shared<ConstantSpectrum>(float(v[0]));
}

/// Normalizes an emission to luminance 1. Throws InputError for a spectrum without luminance.
SpectrumPtr normalized(SpectrumPtr s, const ParsedParam& p) {
  if (s->max_value() > 0 && !(photometric(*s) > 0))
    fail(p.value_where, "\"{}\" has no luminance between 360 and 830 nm, by which emissions are scaled", p.name);
  return unit_luminance(std::move(s));
}

}  // namespace

SceneResolver::SceneResolver(const SceneSettings& description, const Registry& registry,
                             const WavelengthStrategy& wavelengths, const Log& log)
    : description_(description),
      registry_(registry),
      wavelengths_(wavelengths),
      color_space_(color_space(description.color_space, description.color_space_where)),
      log_(log),
      extends_spectra_(read_options(description).extends_spectra) {}

SceneResolver::~SceneResolver() = default;

/// Creates an object that may refer to others, and records whether one of them needs derivatives.
template <class Make>
auto SceneResolver::make(const std::string& key, const Make& make, bool& needs_details) {
  in_progress_.insert(key);
  needs_details_.push_back(false);
  const auto leave = [&] {
    needs_details = needs_details_.back();
    needs_details_.pop_back();
    in_progress_.erase(key);
  };
  try {
    auto result = make();
    leave();
    needs_details = needs_details || result->needs_details();
    return result;
  } catch (...) {  // further objects are created after an error
    leave();
    throw;
  }
}

/// Propagates the flag to the referring object.
void SceneResolver::propagate_needs(bool needs_details) {
  if (needs_details && !needs_details_.empty()) needs_details_.back() = true;
}

template <class Texture, class Info>
std::shared_ptr<const Texture> SceneResolver::texture(const std::string& name, const Location& where,
                                                      TextureDescription::Value value, const PluginTable<Info>& table,
                                                      MadeTextures<Texture>& made) {
  if (const auto it = made.find(name); it != made.end()) {
    propagate_needs(it->second.needs_details);
    return it->second.texture;
  }
  bool has_other_kind = false;
  std::vector<std::string_view> names;
  for (const TextureDescription& t : description_.textures) {
    if (t.value != value && t.name == name) has_other_kind = true;
    if (t.value != value) continue;
    names.push_back(t.name);
    if (t.name != name) continue;
    const std::string key = std::string(table.kind()) + ' ' + name;
    if (in_progress_.contains(key)) fail(where, "texture \"{}\" refers to itself", name);
    check_depth(in_progress_.size() + 1, where);
    const Info& info = table.get(t.plugin.name, t.plugin.where);
    bool needs_details = false;
    std::shared_ptr<const Texture> result = make(
        key,
        [&] {
          return make_checked(info, t.plugin.where, [&] {
            return info.make(Params(info, t.plugin, *this), {t.world_from_texture, &shared_});
          });
        },
        needs_details);
    propagate_needs(needs_details);
    made.emplace(name, MadeTexture<Texture>{result, needs_details});
    return result;
  }
  if (has_other_kind)
    fail(where, "there is no {} \"{}\": \"{}\" is a {}", table.kind(), name, name,
         value == TextureDescription::Value::real ? "spectrum texture" : "float texture");
  fail_unknown(table.kind(), name, names, where);
}

void SceneResolver::fail_unknown(std::string_view kind, const std::string& name,
                                 const std::vector<std::string_view>& names, const Location& where) const {
  const std::string message =
      fmt::format("there is no {} \"{}\"{}", kind, name, suggested_name(description_, name, names));
  if (description_.may_be_unread(name)) throw Consequence(where, message);
  fail(where, "{}", message);
}

std::shared_ptr<const FloatTexture> SceneResolver::float_texture(const std::string& name, const Location& where) {
  return texture(name, where, TextureDescription::Value::real, registry_.float_textures, float_textures_);
}

std::shared_ptr<const SpectrumTexture> SceneResolver::spectrum_texture(const std::string& name, const Location& where) {
  return texture(name, where, TextureDescription::Value::spectrum, registry_.spectrum_textures, spectrum_textures_);
}

/// Also finds materials by the names that MakeNamedMaterial defines later in the file.
std::shared_ptr<Material> SceneResolver::material(const std::string& name, const Location& where) {
  std::vector<std::string_view> names;
  for (size_t i = 0; i < description_.materials.size(); ++i) {
    const std::string& candidate = description_.materials[i].name;
    if (candidate.empty()) continue;
    if (candidate != name) {
      names.push_back(candidate);
      continue;
    }
    if (in_progress_.contains("material " + name)) fail(where, "material \"{}\" refers to itself", name);
    check_depth(in_progress_.size(), where);
    auto made = material(i);
    if (dynamic_cast<const SubsurfaceMaterial*>(made.get()))
      fail(where,
           "\"{}\" is a \"{}\", which no other material can contain: light under its surface needs the whole body",
           name, description_.materials[i].plugin.name);
    const auto& bend = materials_.at(i).bend;
    return bend ? bent_material(std::move(made), bend) : made;
  }
  fail_unknown("material", name, names, where);
}

/// Creates the material on first use.
std::shared_ptr<Material> SceneResolver::material(size_t index) {
  if (const auto it = materials_.find(index); it != materials_.end()) {
    propagate_needs(it->second.needs_details);
    return it->second.material;
  }
  const MaterialDescription& m = description_.materials[index];
  const MaterialInfo& info = registry_.materials.get(m.plugin.name, m.plugin.where);
  MadeMaterial made;
  made.material = make(
      "material " + m.name,
      [&] {
        made.bend = make_normal_bend(m.plugin, *this);
        return make_checked(info, m.plugin.where,
                            [&] { return info.make(Params(info, split_bend(m.plugin, false), *this)); });
      },
      made.needs_details);
  if (made.bend) made.needs_details = true;
  propagate_needs(made.needs_details);
  return materials_.emplace(index, made).first->second.material;
}

/// Extends data that do not cover the render's wavelengths: with the scene's option "extendspectra" by their first and
/// last values. Without, in an image of colours, within the visible range: by 0 as in pbrt-v4, or by their last value
/// if 0 is invalid, as for an index of refraction. Spectra of bands are not extended, because measured values would be
/// wrong.
SpectrumPtr SceneResolver::extended(SpectrumPtr s, const ParsedParam& p, SpectrumUse use) {
  const Interval data_nm = s->range_nm(), needed_nm = wavelengths_.range_nm();
  const auto reaches = [needed_nm](Interval nm) { return nm.contains(needed_nm.min) && nm.contains(needed_nm.max); };
  const bool is_known = reaches(data_nm), is_held = extends_spectra_ || use == SpectrumUse::unbounded;
  if (!is_known && !extends_spectra_ && wavelengths_.film_space().empty()) {
    if (use == SpectrumUse::illuminant) return s;  // check_light_range refuses it, and names lights that reach further
    fail(p.value_where,
         "\"{}\" is known from {:g} to {:g} nm, the bands need {} to {} nm; Option \"bool extendspectra\" true takes "
         "the values at the ends",
         p.name, data_nm.min, data_nm.max, needed_nm.min, needed_nm.max);
  }
  if (!extends_spectra_ && use != SpectrumUse::illuminant &&
      (data_nm.max < needed_nm.min || data_nm.min > needed_nm.max))
    fail(p.value_where, "\"{}\" is known from {:g} to {:g} nm alone, the render needs {} to {} nm", p.name, data_nm.min,
         data_nm.max, needed_nm.min, needed_nm.max);
  if (extends_spectra_) s = beyond_data(std::move(s), Beyond::held, needed_nm);
  s = beyond_data(std::move(s), is_held ? Beyond::held : Beyond::zero, kCieRange_nm);
  if (!is_known && reaches(s->range_nm()))
    warn(p.value_where, fmt::format("\"{}\" is known from {:g} to {:g} nm, the render needs {} to {} nm: {}", p.name,
                                    data_nm.min, data_nm.max, needed_nm.min, needed_nm.max,
                                    is_held ? "beyond, its last value is taken" : "it is 0 beyond, as in pbrt-v4"));
  return s;
}

void SceneResolver::warn(const Location& where, std::string_view message) {
  if (warned_.insert(where.text() + std::string(message)).second) log_.warn(where, message);
}

void SceneResolver::warn_of_clamping(const ParsedParam& p, double most) {
  constexpr double kLargestFraction = 2;
  warn(p.value_where,
       fmt::format("\"{}\" goes up to {:.6g}, a reflectance lies in 0 to 1: it is clamped{}", p.name, most,
                   most > kLargestFraction && most <= 100 ? "; are these percent? Divide them by 100" : ""));
}

/// Returns a reflectance with channels clamped to 1, as in pbrt-v4.
Triple SceneResolver::clamped_rgb(const ParsedParam& p) {
  Triple rgb = rgb_of(p);
  const double most = std::max({rgb[0], rgb[1], rgb[2]});
  if (!(most > 1)) return rgb;
  warn_of_clamping(p, most);
  for (double& v : rgb) v = std::min(v, 1.0);
  return rgb;
}

/// Converts the value by type: rgb, blackbody, a number, sampled pairs, a name, or a file.
SpectrumPtr SceneResolver::spectrum(const ParsedParam& p, SpectrumUse use) {
  const bool emission = use == SpectrumUse::illuminant;
  SpectrumPtr s;
  if (p.type == "rgb") {
    const ColorSpace& space = p.color_space.empty() ? color_space_ : color_space(p.color_space, p.where);
    s = emission                        ? rgb_illuminant(space, rgb_of(p), p.value_where)
        : use == SpectrumUse::unbounded ? rgb_unbounded(space, rgb_of(p), p.value_where)
                                        : rgb_albedo(space, clamped_rgb(p), p.value_where,
                                                     [&](const std::string& message) { warn(p.value_where, message); });
  } else if (p.type == "float") {
    s = constant_of(p);
  } else {
    if (p.type == "blackbody") {
      s = blackbody_of(p);
      if (numbers(p).size() == 2)
        warn(p.value_where,
             fmt::format("a blackbody has one value, its temperature: the second, {}, has no effect", numbers(p)[1]));
    } else {
      s = extended(std::holds_alternative<std::vector<double>>(p.values) ? make_tabulated(numbers(p), p.value_where)
                                                                         : spectrum_of_name(p, description_),
                   p, use);
    }
    if (emission) s = normalized(s, p);
  }
  if (emission)
    check_light_range(*s, wavelengths_, p.value_where, p.name);
  else
    check_range(*s, wavelengths_, p.value_where, p.name);
  if (use == SpectrumUse::albedo && s->max_value() > 1) {
    warn_of_clamping(p, double(s->max_value()));
    s = std::make_shared<ClampedSpectrum>(std::move(s));
  }
  return precompute_at(std::move(s), wavelengths_.fixed_nm());
}

std::filesystem::path SceneResolver::file(const std::string& name, const Location& where) {
  return description_.resolve(name, where);
}

}  // namespace frond
