#include "exports/mitsuba/textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/stop.h"
#include "image/image_file.h"
#include "scene/format/plugin_text.h"

namespace frond::mitsuba {
namespace {

using Value = TextureDescription::Value;

constexpr std::string_view kMean = "its mean stands for it";

const PluginInfo& info_of(const Context& context, const TextureDescription& texture) {
  if (texture.value == Value::real)
    return context.registry.float_textures.get(texture.plugin.name, texture.plugin.where);
  return context.registry.spectrum_textures.get(texture.plugin.name, texture.plugin.where);
}

/// Mapping of an "imagemap" texture, and the size of its image.
struct ImageFrame {
  double u_scale, v_scale, u_delta, v_delta;
  int width = 0, height = 0;
  std::string name, filter, wrap;

  ImageFrame(Context& context, const TextureDescription& texture) {
    const Params p(info_of(context, texture), texture.plugin, context.resolver);
    u_scale = p.real("uscale"), v_scale = p.real("vscale"), u_delta = p.real("udelta"), v_delta = p.real("vdelta");
    wrap = p.string("wrap"), filter = p.string("filter");
    const Image image = read_image(p.file("filename"), p.where("filename")).image;
    width = image.width, height = image.height;
    name = p.file("filename").stem().string();
  }
  bool has_same_mapping(const ImageFrame& b) const {
    return u_scale == b.u_scale && v_scale == b.v_scale && u_delta == b.u_delta && v_delta == b.v_delta &&
           wrap == b.wrap;
  }
  size_t texels() const { return size_t(width) * size_t(height); }
  /// Returns the surface's texture coordinates at the centre of a texel.
  Vec2 uv(int x, int y) const {
    const double s = (x + 0.5) / width, t = 1 - (y + 0.5) / height;
    return {float((s - u_delta) / u_scale), float((t - v_delta) / v_scale)};
  }
  /// Writes a bitmap. Mitsuba's v = 0 is the image's top.
  void write(Xml& xml, std::string_view property, const std::string& file) const {
    const Element texture(xml, "texture", {{"name", std::string(property)}, {"type", "bitmap"}});
    xml.text("filename", file);
    xml.flag("raw", true);
    xml.text("filter_type", filter == "point" ? "nearest" : "bilinear");
    xml.text("wrap_mode", wrap == "repeat" ? "repeat" : "clamp");
    const Element transform(xml, "transform", {{"name", "to_uv"}});
    // A map of the plane, whose translation is in the fourth column.
    const std::string rows =
        fmt::format("{:.9g} 0 0 {:.9g} 0 {:.9g} 0 {:.9g} 0 0 1 0 0 0 0 1", u_scale, u_delta, -v_scale, 1 - v_delta);
    xml.element("matrix", {{"value", rows}});
  }
};

/// Images that a texture consists of, and the first texture, if any, that is not a function of their values at one
/// point.
struct Parts {
  std::vector<const TextureDescription*> images;
  const TextureDescription* other = nullptr;
};

/// Adds the parts of the texture that the parameter names, if it names one. The scene's check has refused cycles.
void add_parts(const Context& context, const ParsedPlugin& plugin, const PluginInfo& info, std::string_view name,
               Parts& parts) {
  const ParsedParam* const given = find_param(plugin.params, name);
  const Param* const declared = find_param(info, name);
  if (!given || !declared || given->type != "texture") return;
  const Value value = declared->kind == ParamKind::float_texture ? Value::real : Value::spectrum;
  const std::string& wanted = std::get<std::vector<std::string>>(given->values).front();
  const auto found = std::ranges::find_if(
      context.description.textures, [&](const TextureDescription& t) { return t.value == value && t.name == wanted; });
  if (found == context.description.textures.end()) return;
  const std::string& type = found->plugin.name;
  if (type == "imagemap") {
    parts.images.push_back(&*found);
  } else if (type == "scale" || type == "mix") {
    for (const ParsedParam& inner : found->plugin.params)
      add_parts(context, found->plugin, info_of(context, *found), inner.name, parts);
  } else if (type != "constant" && !parts.other) {
    parts.other = &*found;
  }
}

/// Returns why the image has no equivalent, with the place; nullopt if it has one.
std::optional<std::pair<Location, std::string>> unsupported_reason(Context& context, const TextureDescription& image) {
  const Params p(info_of(context, image), image.plugin, context.resolver);
  if (const std::string mapping = p.string("mapping"); mapping != "uv")
    return {{p.where("mapping"), fmt::format("mapping \"{}\" has no equivalent in Mitsuba: \"uv\" has", mapping)}};
  if (p.real("uscale") == 0 || p.real("vscale") == 0)
    return {{image.plugin.where, "a scale of 0 has no equivalent in Mitsuba"}};
  if (const std::string wrap = p.string("wrap"); wrap != "repeat" && wrap != "clamp")
    return {{p.where("wrap"), fmt::format("wrap \"{}\" has no equivalent in Mitsuba: repeat and clamp have", wrap)}};
  return {};
}

/// A texture parameter as an image of Mitsuba: its texels, nullptr if it is constant; `is_mean`: it is reported, and
/// its mean stands for it.
struct Texels {
  const TextureDescription* image = nullptr;
  bool is_mean = false;
};

Texels texels_of(Context& context, const ParsedPlugin& plugin, const PluginInfo& info,
                 std::span<const std::string_view> names) {
  Parts parts;
  for (const std::string_view name : names) add_parts(context, plugin, info, name, parts);
  bool is_mean = false;
  const auto mean = [&](const Location& where, const std::string& why) {
    context.report_unsupported("textures", where, why, kMean);
    is_mean = true;
  };
  if (parts.other)
    mean(parts.other->plugin.where,
         fmt::format("texture \"{}\" has no equivalent in Mitsuba: \"constant\", \"imagemap\", and \"scale\" and "
                     "\"mix\" of them have",
                     parts.other->plugin.name));
  for (const TextureDescription* image : parts.images)
    if (const auto why = unsupported_reason(context, *image)) mean(why->first, why->second);
  if (is_mean || parts.images.empty()) return {nullptr, is_mean};
  const TextureDescription* largest = parts.images.front();
  for (const TextureDescription* image : parts.images) {
    const ImageFrame a(context, *largest), b(context, *image);
    if (!a.has_same_mapping(b)) {
      mean(image->plugin.where, "images with different mappings in one parameter have no equivalent in Mitsuba");
      return {nullptr, true};
    }
    if (b.texels() > a.texels()) largest = image;
  }
  if (ImageFrame(context, *largest).filter != "point")
    context.warn(largest->plugin.where, "Mitsuba interpolates images bilinearly and does not filter over the pixel");
  return {largest, false};
}

/// Calls `at` for the texture coordinates of each texel; it returns the values of all channels.
Image tabulated(const ImageFrame& frame, std::vector<std::string> channels, const ColorAt& at) {
  const size_t count = channels.size();
  Image image(frame.width, frame.height, std::move(channels));
  StopPoll poll;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      poll();
      const std::vector<double> values = at(TexturePoint{.uv = frame.uv(x, y)});
      for (size_t c = 0; c < count; ++c) image.at(x, y, c) = float(values[c]);
    }
  return image;
}

/// Images of colours have three channels, or one value.
bool has_colors(Context& context, const Location& where) {
  if (context.spectra.variants() != Variants::spectral) return true;
  context.report_unsupported("textures", where,
                             "images of colours are for mono and rgb variants: give one wavelength or three", kMean);
  return false;
}

}  // namespace

/// A texture "constant" is evaluated like a number.
SpectrumValue spectrum_value(Context& context, const ParsedPlugin& plugin, const Params& p, std::string_view name) {
  const auto texture = p.spectrum_texture(name);
  const Texels texels = texels_of(context, plugin, p.info(), std::array{name});
  if (texels.is_mean || (texels.image && !has_colors(context, p.where(name))))
    return {mean_of(*texture, context.spectra), nullptr, texture};
  if (texels.image) return {{}, texels.image, texture};
  return {context.spectra.values([&](const auto& lambda) { return texture->evaluate({}, lambda); }), nullptr, texture};
}

FloatValue float_value(Context& context, const ParsedPlugin& plugin, const Params& p, std::string_view name) {
  const auto texture = p.float_texture(name);
  const Texels texels = texels_of(context, plugin, p.info(), std::array{name});
  if (texels.is_mean) return {mean_of(*texture), nullptr, texture};
  if (texels.image) return {0, texels.image, texture};
  return {double(texture->evaluate({})), nullptr, texture};
}

const TextureDescription* common_image(Context& context, const ParsedPlugin& plugin, const Params& p,
                                       std::span<const std::string_view> names) {
  const Texels texels = texels_of(context, plugin, p.info(), names);
  if (!texels.image || !has_colors(context, p.where(names.front()))) return nullptr;
  return texels.image;
}

/// Texels are converted by frond, at the wavelengths of the export; Mitsuba reads them without conversion.
void write_texels(Context& context, Xml& xml, std::string_view name, const TextureDescription& image,
                  const ColorAt& at) {
  const ImageFrame frame(context, image);
  std::vector<std::string> channels{"R", "G", "B"};
  if (context.spectra.variants() == Variants::mono) channels = {"Y"};
  frame.write(xml, name, context.folder.add("textures", frame.name, tabulated(frame, channels, at)));
}

void write_value(Context& context, Xml& xml, std::string_view name, const SpectrumValue& value, double scale) {
  const auto scaled = [scale](std::vector<double> values) {
    for (double& v : values) v *= scale;
    return values;
  };
  if (!value.image) return context.spectra.write(xml, name, scaled(value.constant));
  write_texels(context, xml, name, *value.image, [&](const TexturePoint& at) {
    return scaled(context.spectra.values([&](const auto& lambda) { return value.map->evaluate(at, lambda); }));
  });
}

/// An image of one channel.
void write_value(Context& context, Xml& xml, std::string_view name, const FloatValue& value) {
  if (!value.image) return xml.number(name, value.constant);
  const ImageFrame frame(context, *value.image);
  const Image image =
      tabulated(frame, {"Y"}, [&](const TexturePoint& at) { return std::vector{double(value.map->evaluate(at))}; });
  frame.write(xml, name, context.folder.add("textures", frame.name, image));
}

/// frond looks normals up at the surface's (u, v), bilinearly, with repetition.
void write_normals(Context& context, Xml& xml, std::string_view name, const std::filesystem::path& file,
                   const Image& image) {
  const Element texture(xml, "texture", {{"name", std::string(name)}, {"type", "bitmap"}});
  xml.text("filename", context.folder.add("textures", file.stem().string(), image));
  xml.flag("raw", true);
  const Element transform(xml, "transform", {{"name", "to_uv"}});
  xml.element("matrix", {{"value", "1 0 0 0 0 -1 0 1 0 0 1 0 0 0 0 1"}});
}

/// Points of an additive recurrence, which fill the square evenly (Roberts 2018).
std::vector<double> mean_over_uv(const ColorAt& at) {
  constexpr int kPoints = 4096;
  constexpr float kSpace = 100;  // scene units, for textures that vary in space
  std::vector<double> sums;
  for (int i = 0; i < kPoints; ++i) {
    const auto place = [i](double step) { return float(std::fmod(0.5 + i * step, 1)); };
    const Vec2 uv{place(0.7548776662466927), place(0.5698402909980532)};
    const std::vector<double> values = at(TexturePoint{.uv = uv, .p = {kSpace * uv.x, kSpace * uv.y, 0}});
    sums.resize(values.size());
    for (size_t c = 0; c < values.size(); ++c) sums[c] += values[c] / kPoints;
  }
  return sums;
}

double mean_of(const FloatTexture& texture) {
  return mean_over_uv([&](const TexturePoint& at) { return std::vector{double(texture.evaluate(at))}; }).front();
}

std::vector<double> mean_of(const SpectrumTexture& texture, const Spectra& spectra) {
  return mean_over_uv([&](const TexturePoint& at) {
    return spectra.values([&](const auto& lambda) { return texture.evaluate(at, lambda); });
  });
}

}  // namespace frond::mitsuba
