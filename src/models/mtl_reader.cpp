#include "models/mtl_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "models/obj_lines.h"

namespace frond {
namespace {

/// Treatment of a statement by the import.
enum class Use : uint8_t {
  color,     ///< the colour
  emission,  ///< Ke
  opacity,   ///< d
  clarity,   ///< Tr: 1 - d
  map,       ///< an image that is read
  inert,     ///< it does not change the look, or only beside another one that is named
  unless_0,  ///< lost unless all its numbers are 0
  unless_1,  ///< lost unless all its numbers are 1
  model,     ///< illum
  lost,
};

/// A statement of MTL, of Wavefront's definition or of the extensions for physically based materials.
struct MtlStatement {
  std::string_view keyword;  ///< in lower case; exporters write both
  Use use;
  std::string_view says = {};  ///< the loss, in messages
};
constexpr MtlStatement kStatements[] = {
    {"kd", Use::color},
    {"d", Use::opacity},
    {"tr", Use::clarity},
    {"ke", Use::emission},
    {"map_kd", Use::map},
    {"map_ke", Use::map},
    {"map_emissive", Use::map},
    {"map_d", Use::map},
    {"norm", Use::map},
    {"map_kn", Use::map},
    {"ka", Use::inert},  // there is no ambient light
    {"map_ka", Use::inert},
    {"ns", Use::inert},         // with Ks
    {"ni", Use::inert},         // with an illumination model that refracts
    {"sharpness", Use::inert},  // with refl
    {"pcr", Use::inert},        // with Pc
    {"anisor", Use::inert},     // with aniso
    {"map_aat", Use::inert},
    {"illum", Use::model},
    {"ks", Use::unless_0, "gloss"},
    {"tf", Use::unless_1, "transmission filter (Tf)"},
    {"pr", Use::unless_1, "gloss"},
    {"pm", Use::unless_0, "metalness (Pm)"},
    {"ps", Use::unless_0, "sheen (Ps)"},
    {"pc", Use::unless_0, "clear coat (Pc)"},
    {"aniso", Use::unless_0, "anisotropy (aniso)"},
    {"map_ks", Use::lost, "specular map"},
    {"map_ns", Use::lost, "map of gloss (map_Ns)"},
    {"map_bump", Use::lost, "height map"},
    {"bump", Use::lost, "height map"},
    {"map_disp", Use::lost, "displacement map"},
    {"disp", Use::lost, "displacement map"},
    {"decal", Use::lost, "decal"},
    {"refl", Use::lost, "reflection map (refl)"},
    {"map_refl", Use::lost, "reflection map (refl)"},
    {"map_pr", Use::lost, "roughness map"},
    {"map_pm", Use::lost, "metalness map"},
    {"map_ps", Use::lost, "sheen map"},
};

/// Option of an image.
struct MapOption {
  std::string_view name;
  int most_words;                   ///< that follow it; several words are numbers
  std::string_view no_effect = {};  ///< the value that changes nothing; "*": all
};
constexpr MapOption kOptions[] = {
    {"-clamp", 1, "off"},
    {"-blendu", 1, "on"},
    {"-blendv", 1, "on"},
    {"-cc", 1, "off"},
    {"-colorspace", 1, "sRGB"},
    {"-texres", 1, "*"},
    {"-boost", 1, "0"},
    {"-bm", 1, "1"},
    {"-imfchan", 1, ""},
    {"-type", 1, ""},
    {"-mm", 2, "0 1"},
    {"-o", 3},
    {"-s", 3},
    {"-t", 3, "0 0 0"},
};

/// Reads the statements one by one.
class MtlReader {
 public:
  MtlReader(const std::set<std::string>& used, ObjMaterials& materials, LossList& losses)
      : used_(used), materials_(materials), losses_(losses) {}

  /// Later statements of a material replace earlier ones, in another file too.
  void read(std::string_view text) {
    ObjLines lines(text, false);
    while (const auto s = lines.next()) {
      const std::string keyword = lower_case(s->keyword);
      split_words(s->rest, words_);
      if (keyword == "newmtl") {
        material_ =
            &materials_.by_name.try_emplace(std::string(s->rest), ImportedMaterial{.name = std::string(s->rest)})
                 .first->second;
        opacity_.reset();
      } else if (!material_) {
        losses_.add("statement before the first newmtl");
      } else {
        statement(*s, keyword);
      }
    }
  }

 private:
  /// Reads a statement of the current material.
  void statement(const ObjStatement& s, const std::string& keyword) {
    const auto* known = std::ranges::find(kStatements, keyword, &MtlStatement::keyword);
    if (known == std::end(kStatements))
      return record_loss("unknown statement \"" + std::string(s.keyword.substr(0, 40)) + "\"");
    const std::string says(known->says);
    switch (known->use) {
      case Use::color:
        return color(s, material_->color, 1);
      case Use::emission:
        return color(s, material_->emission, std::numeric_limits<float>::max());
      case Use::opacity:
      case Use::clarity:
        return opacity(known->use == Use::clarity);
      case Use::map:
        return map(s, keyword);
      case Use::inert:
        return;
      case Use::unless_0:
        if (!are_all(0)) record_loss(says);
        return;
      case Use::unless_1:
        if (!are_all(1)) record_loss(says);
        return;
      case Use::model:
        return model();
      case Use::lost:
        return record_loss(says);
    }
  }

  /// `is_shape`: any replacement of this material would lose it too.
  void record_loss(const std::string& what, bool is_shape = false) {
    if (used_.contains(material_->name)) losses_.add_for_material(material_->name, what, is_shape);
  }

  /// Whether the statement has the value that changes nothing.
  bool are_all(double value) const {
    return std::ranges::all_of(words_, [value](std::string_view word) { return number_of(word) == value; });
  }

  /// Illumination models up to 2 differ in gloss, which Ks states.
  void model() {
    const std::optional<double> value = words_.empty() ? std::nullopt : number_of(words_[0]);
    if (!value || *value > 2 || *value < 0)
      record_loss("reflection or refraction (illum " + std::string(words_.empty() ? "" : words_[0].substr(0, 10)) +
                  ")");
  }

  /// One number is a grey.
  void color(const ObjStatement& s, std::array<float, 3>& to, float most) {
    std::vector<float> values;
    for (const std::string_view word : words_)
      if (const auto value = number_of(word)) values.push_back(std::clamp(float(*value), 0.f, most));
    if (values.size() != words_.size() || values.empty() || values.size() > 3)
      return record_loss("colour that is not red, green and blue (" + keyword_text(s) + " " +
                         std::string(words_.empty() ? "" : words_[0].substr(0, 20)) + ")");
    values.resize(3, values[0]);
    to = {values[0], values[1], values[2]};
  }

  /// d and Tr of one material state the same number twice.
  void opacity(bool is_clarity) {
    const bool is_halo = !words_.empty() && words_[0] == "-halo";
    if (is_halo) {
      record_loss("opacity by direction (d -halo)", true);
      words_.erase(words_.begin());
    }
    const std::optional<double> value = words_.empty() ? std::nullopt : number_of(words_[0]);
    if (!value || !std::isfinite(*value)) return record_loss("opacity that is no number", true);
    const double opacity = is_clarity ? 1 - *value : *value;
    if (opacity_ && std::abs(*opacity_ - opacity) > 1e-3)
      record_loss("the first of two opacities (d, Tr) that differ", true);
    opacity_ = opacity;
    material_->opacity = std::clamp(float(opacity), 0.f, 1.f);
  }

  /// The file's name follows the options and may contain blanks.
  void map(const ObjStatement& s, const std::string& keyword) {
    std::string_view rest = s.rest;
    const bool is_normal = keyword == "norm" || keyword == "map_kn";
    ImportedTexture texture;
    float bump = 1;
    for (size_t i = 0; i < words_.size() && words_[i].starts_with('-');) {
      const auto* option = std::ranges::find(kOptions, lower_case(words_[i]), &MapOption::name);
      if (option == std::end(kOptions)) break;  // a name that begins with -
      std::string value;
      std::array<float, 3> numbers = option->name == "-s" ? std::array{1.f, 1.f, 1.f} : std::array{0.f, 0.f, 0.f};
      int words = 0;
      for (++i; i < words_.size() && words < option->most_words; ++i, ++words) {
        const auto number = number_of(words_[i]);
        if (words > 0 && !number) break;
        numbers[size_t(words)] = float(number.value_or(0));
        value += (words > 0 ? " " : "") + std::string(words_[i]);
      }
      rest = i < words_.size() ? s.rest.substr(size_t(words_[i].data() - s.rest.data())) : std::string_view();
      if (option->name == "-s") {
        texture.to_image[0] = numbers[0], texture.to_image[4] = numbers[1];
      } else if (option->name == "-o") {
        texture.to_image[2] = numbers[0], texture.to_image[5] = numbers[1];
      } else if (option->name == "-bm" && is_normal) {
        bump = numbers[0];
      } else if (option->name == "-clamp" && !is_normal) {
        texture.wrap = value == "on" ? ImportedTexture::Wrap::clamp : ImportedTexture::Wrap::repeat;
      } else if (!has_no_effect(*option, value, words) &&
                 !(option->name == "-imfchan" && value == "m" && keyword == "map_d")) {
        record_loss(keyword_text(s) + " " + std::string(option->name), true);
      }
    }
    if (rest.empty()) return record_loss(keyword_text(s) + " without a file", true);
    texture.image = image_index(std::string(rest));
    if (is_normal) material_->normal_scale = {bump, bump};
    (is_normal             ? material_->normal_texture
     : keyword == "map_d"  ? material_->opacity_texture
     : keyword == "map_kd" ? material_->color_texture
                           : material_->emission_texture) = texture;
  }

  /// Returns the index of an image; each name has one.
  int32_t image_index(const std::string& name) {
    std::vector<ImportedImage>& images = materials_.images;
    const auto index = size_t(std::ranges::find(images, name, &ImportedImage::name) - images.begin());
    if (index == images.size()) images.push_back({name, {}, {}});
    return int32_t(index);
  }

  /// Returns the keyword as it is written, for messages.
  static std::string keyword_text(const ObjStatement& s) { return std::string(s.keyword.substr(0, 40)); }

  /// Numbers that are not given have their default.
  static bool has_no_effect(const MapOption& option, const std::string& value, int words) {
    if (option.no_effect == "*" || value == option.no_effect) return true;
    if (option.most_words == 1)
      return !option.no_effect.empty() && number_of(value) && number_of(value) == number_of(option.no_effect);
    std::vector<std::string_view> given, defaults;
    split_words(value, given);
    split_words(option.no_effect, defaults);
    for (size_t i = 0; i < size_t(words); ++i)
      if (number_of(given[i]) != number_of(defaults[i])) return false;
    return true;
  }

  const std::set<std::string>& used_;
  ObjMaterials& materials_;
  LossList& losses_;
  ImportedMaterial* material_ = nullptr;  ///< of the last newmtl
  std::optional<double> opacity_;
  std::vector<std::string_view> words_;
};

}  // namespace

void read_mtl(std::string_view text, const std::set<std::string>& used, ObjMaterials& materials, LossList& losses) {
  MtlReader(used, materials, losses).read(text);
}

}  // namespace frond
