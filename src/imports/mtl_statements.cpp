#include "imports/mtl_statements.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "imports/obj_lines.h"

namespace frond {
namespace {

/// Treatment of a statement by the import.
enum class Use : uint8_t {
  color,     ///< the colour
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
    {"map_kd", Use::map},
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
    {"ke", Use::unless_0, "emission"},
    {"tf", Use::unless_1, "transmission filter (Tf)"},
    {"pr", Use::unless_1, "gloss"},
    {"pm", Use::unless_0, "metalness (Pm)"},
    {"ps", Use::unless_0, "sheen (Ps)"},
    {"pc", Use::unless_0, "clear coat (Pc)"},
    {"aniso", Use::unless_0, "anisotropy (aniso)"},
    {"map_ks", Use::lost, "specular map"},
    {"map_ns", Use::lost, "map of gloss (map_Ns)"},
    {"map_ke", Use::lost, "emission map"},
    {"map_emissive", Use::lost, "emission map"},
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
  int most_words;              ///< that follow it; several words are numbers
  std::string_view no_effect;  ///< the value that changes nothing; "*": all
};
constexpr MapOption kOptions[] = {
    {"-clamp", 1, "off"}, {"-blendu", 1, "on"}, {"-blendv", 1, "on"}, {"-cc", 1, "off"}, {"-texres", 1, "*"},
    {"-boost", 1, "0"},   {"-bm", 1, "1"},      {"-imfchan", 1, ""},  {"-type", 1, ""},  {"-mm", 2, "0 1"},
    {"-o", 3, "0 0 0"},   {"-s", 3, "1 1 1"},   {"-t", 3, "0 0 0"},
};

/// Reads the statements one by one.
class MtlReader {
 public:
  MtlReader(const std::set<std::string>& used, LossList& losses, std::set<std::string>& defined)
      : used_(used), losses_(losses), defined_(defined) {}

  std::string read(std::string_view text) {
    ObjLines lines(text, false);
    while (const auto s = lines.next()) {
      const std::string keyword = lower_case(s->keyword);
      split_words(s->rest, words_);
      if (keyword == "newmtl") {
        name_ = std::string(s->rest);
        opacity_.reset();
        defined_.insert(name_);
        out_ += "newmtl " + name_ + "\n";
      } else if (defined_.empty()) {
        losses_.add("statement before the first newmtl");
      } else {
        statement(*s, keyword);
      }
    }
    return std::move(out_);
  }

 private:
  void statement(const ObjStatement& s, const std::string& keyword) {
    const auto* known = std::ranges::find(kStatements, keyword, &MtlStatement::keyword);
    if (known == std::end(kStatements))
      return record_loss("unknown statement \"" + std::string(s.keyword.substr(0, 40)) + "\"");
    const std::string says(known->says);
    switch (known->use) {
      case Use::color:
        return color();
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
    if (used_.contains(name_)) losses_.add_for_material(name_, what, is_shape);
  }

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
  void color() {
    std::vector<std::string> numbers;
    for (const std::string_view word : words_)
      if (number_of(word)) numbers.emplace_back(word);
    if (numbers.size() != words_.size() || numbers.empty() || numbers.size() > 3)
      return record_loss("colour that is not red, green and blue (Kd " +
                         std::string(words_.empty() ? "" : words_[0].substr(0, 20)) + ")");
    numbers.resize(3, numbers[0]);
    out_ += "Kd " + numbers[0] + " " + numbers[1] + " " + numbers[2] + "\n";
  }

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
    out_ += (is_clarity ? "Tr " : "d ") + std::string(words_[0]) + "\n";
  }

  /// The file's name follows the options and may contain blanks.
  void map(const ObjStatement& s, const std::string& keyword) {
    std::string_view rest = s.rest;
    bool is_clamped = false;
    for (size_t i = 0; i < words_.size() && words_[i].starts_with('-');) {
      const auto* option = std::ranges::find(kOptions, lower_case(words_[i]), &MapOption::name);
      if (option == std::end(kOptions)) break;  // a name that begins with -
      std::string value;
      int words = 0;
      for (++i; i < words_.size() && words < option->most_words; ++i, ++words) {
        if (words > 0 && !number_of(words_[i])) break;
        value += (words > 0 ? " " : "") + std::string(words_[i]);
      }
      rest = i < words_.size() ? s.rest.substr(size_t(words_[i].data() - s.rest.data())) : std::string_view();
      const bool is_read = option->name == "-clamp" && keyword.starts_with("map_") && keyword != "map_kn";
      if (is_read)
        is_clamped = value == "on";
      else if (!has_no_effect(*option, value, words) &&
               !(option->name == "-imfchan" && value == "m" && keyword == "map_d"))
        record_loss(keyword_text(s) + " " + std::string(option->name), true);
    }
    if (rest.empty()) return record_loss(keyword_text(s) + " without a file", true);
    out_ += keyword + (is_clamped ? " -clamp on " : " ") + std::string(rest) + "\n";
  }

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
  LossList& losses_;
  std::set<std::string>& defined_;
  std::string name_, out_;
  std::optional<double> opacity_;
  std::vector<std::string_view> words_;
};

}  // namespace

std::string read_statements(std::string_view text, const std::set<std::string>& used, LossList& losses,
                            std::set<std::string>& defined) {
  return MtlReader(used, losses, defined).read(text);
}

}  // namespace frond
