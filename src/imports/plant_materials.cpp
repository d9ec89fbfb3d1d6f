#include "imports/plant_materials.h"

#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "core/error.h"
#include "core/parallel.h"

namespace frond {
namespace {

/// Returns a name for a quoted string of a scene file.
std::string quotable(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ' || c == '"' || c == '\\') c = '_';
  return name.empty() ? "unnamed" : name;
}

/// Returns a parameter in the syntax of a scene file.
std::string parameter(const ParsedParam& p) {
  const std::string head = fmt::format("\"{} {}\" ", p.type, p.name);
  if (const auto* numbers = std::get_if<std::vector<double>>(&p.values))
    return head + fmt::format("[ {} ]", fmt::join(*numbers, " "));
  if (const auto* flags = std::get_if<std::vector<bool>>(&p.values)) return head + (flags->front() ? "true" : "false");
  std::vector<std::string> words = std::get<std::vector<std::string>>(p.values);
  for (std::string& word : words) {
    std::string escaped;
    for (const char c : word) escaped += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
    word = '"' + escaped + '"';
  }
  return head + fmt::format("[ {} ]", fmt::join(words, " "));
}

/// Writes the materials one by one.
class MaterialWriter {
 public:
  MaterialWriter(const std::vector<MaterialRule>& rules, PlantImages& images, const Log& log)
      : rules_(rules), images_(images), log_(log) {}

  void write(const ImportedMaterial& m, PlantMaterials& out) {
    const std::string& name = out.names.emplace_back(unique(quotable(m.name)));
    out.alpha.push_back(alpha_parameter(m, name));
    out.emission.push_back(emission(m, name));
    text_.clear();
    const auto rule =
        std::ranges::find_if(rules_, [&m](const MaterialRule& r) { return matches_pattern(r.pattern, m.name); });
    const std::string type =
        rule != rules_.end() ? write_ruled_material(*rule, m, name) : write_default_material(m, name);
    out.types.push_back(type);
    out.rules.push_back(rule != rules_.end() ? &*rule : nullptr);
    out.text += textures_ + fmt::format("MakeNamedMaterial \"{}\" \"string type\" \"{}\"{}\n", name, type, text_);
    textures_.clear();
    add_normal_map(m, out);
  }
  const LossList& losses() const { return losses_; }
  /// Throws InputError for a rule that no material has used.
  void check_rules(const ImportedScene& scene, const std::vector<bool>& used) const {
    for (const MaterialRule& rule : rules_) {
      if (used_rules_.contains(&rule)) continue;
      std::vector<std::string> names;
      for (size_t i = 0; i < used.size(); ++i)
        if (used[i]) names.push_back('"' + scene.materials[i].name + '"');
      fail({}, "{}: the model has no such material; its materials are {}", rule.text, fmt::join(names, ", "));
    }
  }

 private:
  std::string unique(const std::string& name) {
    std::string result = name;
    for (int i = 2; !names_.insert(result).second; ++i) result = fmt::format("{}-{}", name, i);
    return result;
  }

  std::string write_ruled_material(const MaterialRule& rule, const ImportedMaterial& m, const std::string& name) {
    used_rules_.insert(&rule);
    for (const ParsedParam& p : rule.material.params) text_ += "\n  " + parameter(p);
    for (const MappedParam& p : rule.mapped) {
      if (!images_.pixels(m.color_texture.image))
        fail({}, "{}: \"{}\" has no image of its colour, which \"{}\" would follow", rule.text, m.name, p.name);
      const std::string texture = name + "-" + p.name;
      add_texture(name + "-brightness", "float", grey_image(m.color_texture.image, m.name), m.color_texture, 1);
      textures_ += fmt::format(
          "Texture \"{}\" \"float\" \"mix\" \"float tex1\" {} \"float tex2\" {} \"texture amount\" \"{}-brightness\"\n",
          texture, p.at_black, p.at_white, name);
      text_ += fmt::format("\n  \"texture {}\" \"{}\"", p.name, texture);
    }
    return rule.material.name;
  }

  /// Returns the path of the image of the mean of the linear channels of a colour.
  std::string grey_image(int32_t image, const std::string& name) {
    std::string& path = brightness_[image];
    if (!path.empty()) return path;
    const ImageFile& file = *images_.pixels(image);
    const size_t channels = file.image.channels.size() < 3 ? 1 : 3;
    std::vector<float> values;
    for (int y = 0; y < file.image.height; ++y) {
      check_stop();
      for (int x = 0; x < file.image.width; ++x) {
        float sum = 0;
        for (size_t c = 0; c < channels; ++c)
          sum += file.is_encoded ? to_linear(file.image.at(x, y, c)) : file.image.at(x, y, c);
        values.push_back(std::clamp(sum / float(channels), 0.f, 1.f));
      }
    }
    return path =
               images_.write_grey_image(file.image.width, file.image.height, std::move(values), name + "-brightness");
  }

  /// Diffuse, metal or clear: glTF's alpha is the square of its roughness.
  std::string write_default_material(const ImportedMaterial& m, const std::string& name) {
    const std::string roughness =
        fmt::format("\n  \"float roughness\" {} \"bool remaproughness\" false", m.roughness * m.roughness);
    if (m.ior > 0) {
      text_ += fmt::format("\n  \"float eta\" {}", m.ior);
      if (m.thickness <= 0) return "thindielectric";
      text_ += roughness;
      return "dielectric";
    }
    if (m.transmission > 0) return write_transmitting_material(m, name);
    text_ += "\n  " + color(m, "reflectance", m.color, m.color_texture, name + "-color");
    if (m.metalness < 0.5f) return "diffuse";
    text_ += roughness;
    return "conductor";
  }

  /// Of the light, a share is transmitted, in a colour of its own, and the rest reflected; an image may be a factor of
  /// the share.
  std::string write_transmitting_material(const ImportedMaterial& m, const std::string& name) {
    const auto factor = [&](std::array<float, 3> c, float by) {
      for (float& v : c) v *= by;
      return c;
    };
    const ImageFile* share = images_.pixels(m.transmission_texture.image);
    const auto mapping = mapping_of(m, m.transmission_texture, "image of the transmission");
    const bool has_map = share && mapping && share->image.channels.size() % 2 == 0;
    const float reflected = has_map ? 1 : 1 - m.transmission, transmitted = has_map ? 1 : m.transmission;
    const std::string r =
        color(m, has_map ? "tex1" : "reflectance", factor(m.color, reflected), m.color_texture, name + "-color");
    const std::string t = color(m, has_map ? "tex2" : "transmittance", factor(m.transmitted, transmitted),
                                m.transmitted_texture, name + "-transmitted");
    if (!has_map) {
      text_ += "\n  " + r + "\n  " + t;
      return "diffusetransmission";
    }
    const std::string path = opacity_image(m.transmission_texture.image, false, m.name + "-transmission",
                                           [&m](float v) { return v * m.transmission; });
    add_texture(name + "-share", "float", path, m.transmission_texture, 1, *mapping);
    const auto mix = [&](const char* which, const std::string& inputs) {
      textures_ += fmt::format("Texture \"{}-{}\" \"spectrum\" \"mix\" {} \"texture amount\" \"{}-share\"\n", name,
                               which, inputs, name);
      text_ += fmt::format("\n  \"texture {}\" \"{}-{}\"", which, name, which);
    };
    mix("reflectance", r + " \"rgb tex2\" [ 0 0 0 ]");
    mix("transmittance", "\"rgb tex1\" [ 0 0 0 ] " + t);
    return "diffusetransmission";
  }

  /// Returns the directive of an emission. An area light has an image or a colour.
  std::string emission(const ImportedMaterial& m, const std::string& name) {
    if (!m.is_emitter()) return {};
    const std::string sides = m.has_two_sides ? " \"bool twosided\" true" : "";
    const auto [r, g, b] = m.emission;
    if (m.emission_texture.image < 0)
      return fmt::format("  AreaLightSource \"diffuse\" \"rgb L\" [ {} {} {} ]{}\n", r, g, b, sides);
    if (!images_.pixels(m.emission_texture.image)) return {};
    if (!m.emission_texture.shares_uv(m.uv_texture())) {
      losses_.add_for_material(m.name, "emission by an image with texture coordinates of its own");
      return {};
    }
    const auto [path, scale] = factored(m.emission_texture.image, m.emission, name + "-emission");
    return fmt::format("  AreaLightSource \"diffuse\" \"string filename\" \"{}\" \"float scale\" {}{}\n", path, scale,
                       sides);
  }

  /// Returns the path of an image times a colour, and a factor that its values need: the largest of the colour.
  std::pair<std::string, float> factored(int32_t image, const std::array<float, 3>& color, const std::string& name) {
    const auto [r, g, b] = color;
    const float most = std::max({r, g, b});
    const bool is_grey = most - std::min({r, g, b}) <= 1e-3f * most;
    return {is_grey ? images_.original(image) : images_.tinted_image(image, {r / most, g / most, b / most}, name),
            most};
  }

  /// Returns the parameter of a colour, or of the texture of an image that it is a factor of.
  std::string color(const ImportedMaterial& m, const char* parameter, const std::array<float, 3>& factor,
                    const ImportedTexture& texture, const std::string& name) {
    const auto [r, g, b] = factor;
    const auto mapping = mapping_of(m, texture, "image of the colour");
    if (!images_.pixels(texture.image) || !mapping) return fmt::format("\"rgb {}\" [ {} {} {} ]", parameter, r, g, b);
    const auto [path, scale] = factored(texture.image, factor, name);
    add_texture(name, "spectrum", path, texture, scale < 0.999f ? scale : 1, *mapping);
    return fmt::format("\"texture {}\" \"{}\"", parameter, name);
  }

  /// Returns the parameters that map the coordinates of the meshes of a material to those of a texture. If there are
  /// none, which is a loss, returns nothing.
  std::optional<std::string> mapping_of(const ImportedMaterial& m, const ImportedTexture& texture,
                                        const std::string& what) {
    const ImportedTexture& base = m.uv_texture();
    if (texture.image < 0 || texture.shares_uv(base)) return "";
    const auto &a = texture.to_image, &b = base.to_image;
    const float determinant = b[0] * b[4] - b[1] * b[3];
    const std::array<float, 4> inverse{b[4], -b[1], -b[3], b[0]};
    std::array<float, 6> map{};
    for (size_t row = 0; row < 2; ++row) {
      for (size_t column = 0; column < 2; ++column)
        map[3 * row + column] = (a[3 * row] * inverse[column] + a[3 * row + 1] * inverse[2 + column]) / determinant;
      map[3 * row + 2] = a[3 * row + 2] - map[3 * row] * b[2] - map[3 * row + 1] * b[5];
    }
    constexpr float kRounding = 1e-5f;
    if (texture.uv_set == base.uv_set && determinant != 0 && std::max(std::abs(map[1]), std::abs(map[3])) < kRounding)
      return fmt::format(" \"float uscale\" {} \"float udelta\" {} \"float vscale\" {} \"float vdelta\" {}", map[0],
                         map[2], map[4], map[5]);
    losses_.add_for_material(m.name, what + " with texture coordinates of its own", true);
    return {};
  }

  void add_texture(const std::string& name, const char* kind, const std::string& path, const ImportedTexture& use,
                   float scale, std::string more = "") {
    if (use.wrap == ImportedTexture::Wrap::clamp) more += " \"string wrap\" \"clamp\"";
    if (use.wrap == ImportedTexture::Wrap::mirror)
      log_.warn({}, fmt::format("texture \"{}\" is mirrored beyond its edges: it is repeated instead", name));
    if (scale != 1) more += fmt::format(" \"float scale\" {}", scale);
    if (std::string_view(kind) == "float") more += " \"string encoding\" \"linear\"";
    textures_ +=
        fmt::format("Texture \"{}\" \"{}\" \"imagemap\" \"string filename\" \"{}\"{}\n", name, kind, path, more);
  }

  /// Opacity of a texel: alpha of the image, or the mean of its channels if it is an opacity map without alpha.
  static float opacity_at(const Image& image, int x, int y, bool is_opacity_map) {
    const size_t channels = image.channels.size();
    if (channels == 2 || channels == 4) return image.at(x, y, channels - 1);
    if (!is_opacity_map) return 1;
    float sum = 0;
    for (size_t c = 0; c < channels; ++c) sum += image.at(x, y, c);
    return sum / float(channels);
  }

  /// An opacity map that is the image of the colour, and has no alpha, is a mistake of the exporter.
  std::string alpha_parameter(const ImportedMaterial& m, const std::string& name) {
    using Alpha = ImportedMaterial::Alpha;
    if (m.alpha == Alpha::opaque) return {};
    const auto cut = [&m](float v) { return m.alpha == Alpha::mask ? (v >= m.cutoff ? 1.f : 0.f) : v; };
    const bool is_map = images_.pixels(m.opacity_texture.image) && m.opacity_texture.image != m.color_texture.image;
    const auto mapping = mapping_of(m, is_map ? m.opacity_texture : m.color_texture, "image of the opacity");
    const ImportedTexture& use = is_map ? m.opacity_texture : m.color_texture;
    const float opacity = cut(m.opacity);
    const auto [path, is_new] =
        opacities_.try_emplace({use.image, is_map, m.opacity, m.alpha == Alpha::mask ? m.cutoff : -1.f});
    if (is_new && opacity > 0)
      path->second = opacity_image(use.image, is_map, m.name + "-alpha", [&](float v) { return cut(m.opacity * v); });
    if (mapping && !path->second.empty()) {
      add_texture(name + "-alpha", "float", path->second, use, 1, *mapping);
      return fmt::format(" \"texture alpha\" \"{}-alpha\"", name);
    }
    if (opacity <= 0) log_.warn({}, fmt::format("material \"{}\" has opacity 0: it is invisible", m.name));
    return opacity < 1 ? fmt::format(" \"float alpha\" {}", opacity) : std::string();
  }

  /// Returns the path of the image of an opacity, which `map` changes, or an empty one if it is 1 everywhere.
  template <class Map>
  std::string opacity_image(int32_t image, bool is_map, const std::string& name, const Map& map) {
    const ImageFile* file = images_.pixels(image);
    if (!file) return {};
    std::vector<float> values;
    for (int y = 0; y < file->image.height; ++y) {
      check_stop();
      for (int x = 0; x < file->image.width; ++x) values.push_back(map(opacity_at(file->image, x, y, is_map)));
    }
    if (values.size() <= 1 || std::ranges::none_of(values, [](float v) { return v < 1; })) return {};
    return images_.write_grey_image(file->image.width, file->image.height, std::move(values), name);
  }

  void add_normal_map(const ImportedMaterial& m, PlantMaterials& out) {
    if (!images_.pixels(m.normal_texture.image)) return;
    if (!m.normal_texture.shares_uv(m.uv_texture()))
      return losses_.add_for_material(m.name, "normal map with texture coordinates of its own", true);
    const std::string path = images_.normal_image(m.normal_texture.image, m.normal_scale, m.name + "-normals");
    out.text.insert(out.text.size() - 1, fmt::format("\n  \"string normalmap\" \"{}\"", path));
  }

  const std::vector<MaterialRule>& rules_;
  PlantImages& images_;
  const Log& log_;
  LossList losses_;
  std::string text_, textures_;
  std::set<std::string> names_;
  std::map<std::tuple<int32_t, bool, float, float>, std::string> opacities_;  ///< image, kind, factor, cutoff; paths
  std::map<int32_t, std::string> brightness_;                                 ///< by image: paths
  std::set<const MaterialRule*> used_rules_;
};

}  // namespace

bool matches_pattern(const std::string& pattern, const std::string& name) {
  return fnmatch(pattern.c_str(), name.c_str(), FNM_CASEFOLD | FNM_NOESCAPE) == 0;
}

PlantMaterials plant_materials(const ImportedScene& scene, const std::vector<bool>& used,
                               const std::vector<MaterialRule>& rules, PlantImages& images, const Log& log) {
  PlantMaterials out;
  MaterialWriter writer(rules, images, log);
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (used[i]) {
      writer.write(scene.materials[i], out);
    } else {
      out.names.push_back(scene.materials[i].name);
      out.types.emplace_back();
      out.rules.emplace_back();
      out.alpha.emplace_back();
      out.emission.emplace_back();
    }
  }
  writer.check_rules(scene, used);
  out.losses = writer.losses();
  return out;
}

}  // namespace frond
