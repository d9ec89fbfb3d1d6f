#include "exports/mitsuba/textures.h"

#include "image/image_file.h"
#include "scene/format/plugin_text.h"

namespace frond::mitsuba {
namespace {

/// Returns the texture that the parameter names, or nullptr. Throws InputError for one without an equivalent.
const TextureDescription* named_texture(const Context& context, const ParsedPlugin& plugin, const Params& p,
                                        std::string_view name, TextureDescription::Value value) {
  if (!p.is_texture(name)) return nullptr;
  const std::string& wanted = std::get<std::vector<std::string>>(find_param(plugin.params, name)->values).front();
  for (const TextureDescription& t : context.description.textures) {
    if (t.value != value || t.name != wanted) continue;
    if (t.plugin.name != "imagemap" && t.plugin.name != "constant")
      fail(t.plugin.where, "texture \"{}\" has no equivalent in Mitsuba: \"constant\" and \"imagemap\" have",
           t.plugin.name);
    return &t;
  }
  return nullptr;
}

/// Mapping of an "imagemap" texture, and the size of its image.
struct ImageFrame {
  double u_scale, v_scale, u_delta, v_delta;
  int width = 0, height = 0;
  std::string name, filter, wrap;

  /// Throws InputError for other mappings than uv, and for wrap modes that Mitsuba does not have.
  template <class Info>
  ImageFrame(Context& context, const TextureDescription& texture, const Info& info) {
    const Params p(info, texture.plugin, context.resolver);
    if (p.string("mapping") != "uv")
      fail(p.where("mapping"), "mapping \"{}\" has no equivalent in Mitsuba: \"uv\" has", p.string("mapping"));
    u_scale = p.real("uscale"), v_scale = p.real("vscale"), u_delta = p.real("udelta"), v_delta = p.real("vdelta");
    if (u_scale == 0 || v_scale == 0) fail(texture.plugin.where, "a scale of 0 has no equivalent in Mitsuba");
    wrap = p.string("wrap"), filter = p.string("filter");
    if (wrap != "repeat" && wrap != "clamp")
      fail(p.where("wrap"), "wrap \"{}\" has no equivalent in Mitsuba: repeat and clamp have", wrap);
    if (filter != "point")
      context.warn(texture.plugin.where, "Mitsuba interpolates images bilinearly and does not filter over the pixel");
    const Image image = read_image(p.file("filename"), p.where("filename")).image;
    width = image.width, height = image.height;
    name = p.file("filename").stem().string();
  }
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
    xml.text("wrap_mode", wrap);
    const Element transform(xml, "transform", {{"name", "to_uv"}});
    // A map of the plane, whose translation is in the fourth column.
    const std::string rows =
        fmt::format("{:.9g} 0 0 {:.9g} 0 {:.9g} 0 {:.9g} 0 0 1 0 0 0 0 1", u_scale, u_delta, -v_scale, 1 - v_delta);
    xml.element("matrix", {{"value", rows}});
  }
};

/// Calls `at` for the texture coordinates of each texel; it returns the values of all channels.
template <class At>
Image tabulated(const ImageFrame& frame, std::vector<std::string> channels, const At& at) {
  const size_t count = channels.size();
  Image image(frame.width, frame.height, std::move(channels));
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const std::vector<double> values = at(TexturePoint{.uv = frame.uv(x, y)});
      for (size_t c = 0; c < count; ++c) image.at(x, y, c) = float(values[c]);
    }
  return image;
}

}  // namespace

/// A texture "constant" is evaluated like a number.
SpectrumValue spectrum_value(Context& context, const ParsedPlugin& plugin, const Params& p, std::string_view name) {
  const auto texture = p.spectrum_texture(name);
  const auto* named = named_texture(context, plugin, p, name, TextureDescription::Value::spectrum);
  if (named && named->plugin.name == "imagemap") {
    if (context.spectra.variants() == Variants::spectral)
      fail(p.where(name), "images of colours are for mono and rgb variants: give one wavelength or three");
    return {{}, named, texture};
  }
  return {context.spectra.values([&](const auto& lambda) { return texture->evaluate({}, lambda); }), nullptr, texture};
}

/// As spectrum_value.
FloatValue float_value(Context& context, const ParsedPlugin& plugin, const Params& p, std::string_view name) {
  const auto texture = p.float_texture(name);
  const auto* named = named_texture(context, plugin, p, name, TextureDescription::Value::real);
  if (named && named->plugin.name == "imagemap") return {0, named, texture};
  return {double(texture->evaluate({})), nullptr, texture};
}

/// Texels are converted by frond, at the wavelengths of the export; Mitsuba reads them without conversion.
void write_value(Context& context, Xml& xml, std::string_view name, const SpectrumValue& value, double scale) {
  if (!value.image) {
    std::vector<double> scaled = value.constant;
    for (double& v : scaled) v *= scale;
    context.spectra.write(xml, name, scaled);
    return;
  }
  const ImageFrame frame(context, *value.image,
                         context.registry.spectrum_textures.get("imagemap", value.image->plugin.where));
  std::vector<std::string> channels{"R", "G", "B"};
  if (context.spectra.variants() == Variants::mono) channels = {"Y"};
  const Image image = tabulated(frame, channels, [&](const TexturePoint& at) {
    auto values = context.spectra.values([&](const auto& lambda) { return value.map->evaluate(at, lambda); });
    for (double& v : values) v *= scale;
    return values;
  });
  frame.write(xml, name, context.folder.add("textures", frame.name, image));
}

/// An image of one channel.
void write_value(Context& context, Xml& xml, std::string_view name, const FloatValue& value) {
  if (!value.image) {
    xml.number(name, value.constant);
    return;
  }
  const ImageFrame frame(context, *value.image,
                         context.registry.float_textures.get("imagemap", value.image->plugin.where));
  const Image image =
      tabulated(frame, {"Y"}, [&](const TexturePoint& at) { return std::vector{double(value.map->evaluate(at))}; });
  frame.write(xml, name, context.folder.add("textures", frame.name, image));
}

}  // namespace frond::mitsuba
