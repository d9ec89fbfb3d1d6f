#include "imports/obj_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "imports/mtl_statements.h"
#include "imports/obj_lines.h"

namespace frond {
namespace {

[[noreturn]] void fail(size_t line, const std::string& problem) {
  throw std::runtime_error("line " + std::to_string(line) + ": " + problem);
}

std::string quoted(std::string_view word) { return '"' + std::string(word.substr(0, 40)) + '"'; }

/// Statements that are no polygons and no materials.
struct OtherStatement {
  std::string_view keyword;
  std::string_view says;  ///< empty: it does not change the look
};
constexpr OtherStatement kOthers[] = {
    {"p", "points (p)"},
    {"l", "lines (l)"},
    {"curv", "free-form curve (curv)"},
    {"curv2", "free-form curve (curv2)"},
    {"surf", "free-form surface (surf)"},
    {"bsp", "free-form surface (bsp)"},
    {"bzp", "free-form surface (bzp)"},
    {"cdc", "free-form curve (cdc)"},
    {"cdp", "free-form surface (cdp)"},
    {"usemap", "texture map (usemap)"},
    {"maplib", "texture maps (maplib)"},
    {"shadow_obj", "shadow object (shadow_obj)"},
    {"trace_obj", "reflected object (trace_obj)"},
    {"call", "file that another one includes (call)"},
    {"csh", "command (csh)"},
    // Parts of free-form elements, and how to divide them.
    {"vp", ""},
    {"cstype", ""},
    {"deg", ""},
    {"bmat", ""},
    {"step", ""},
    {"parm", ""},
    {"trim", ""},
    {"hole", ""},
    {"scrv", ""},
    {"sp", ""},
    {"end", ""},
    {"con", ""},
    {"ctech", ""},
    {"stech", ""},
    {"res", ""},
    {"mg", ""},
    // Hints for a renderer of 1990.
    {"lod", ""},
    {"usemtl", ""},  // without a name
    {"bevel", ""},
    {"c_interp", ""},
    {"d_interp", ""},
};

/// The library's name for the material of faces without one.
const std::string kDefault = "DefaultMaterial";

/// Corner of a face: vertex, texture coordinates, normal; from 1, 0: none.
using Corner = std::array<uint64_t, 3>;

/// Writes the statements of an OBJ file.
class ModelWriter {
 public:
  ModelWriter(std::string_view text, LossList& losses, std::set<std::string>& used)
      : text_(text), losses_(losses), used_(used) {}

  std::string write(const std::function<bool(const std::string&)>& is_usable) {
    count();
    ObjLines lines(text_, true);
    while (const auto s = lines.next()) {
      if (s->keyword == "v")
        vertex(*s);
      else if (s->keyword == "vt")
        numbers(*s, 1, 2, kTexture);  // the third is depth, of which images have none
      else if (s->keyword == "vn")
        numbers(*s, 3, 3, kNormal);
      else if (s->keyword == "f" || s->keyword == "fo")
        face(*s);
      else if (s->keyword == "usemtl" && !s->rest.empty())
        material(std::string(s->rest));
      else if (s->keyword == "mtllib")
        library(*s, is_usable);
      else if (s->keyword == "g" || s->keyword == "o")
        out_.append(s->keyword).append(" ").append(s->rest).append("\n");
      else if (s->keyword == "s")
        is_smooth_ = s->rest != "off" && s->rest != "0" && !s->rest.empty();
      else
        other(*s);
    }
    // The reader reads a material library at its statement, and assigns its last material to the faces that follow.
    constexpr size_t kLeastSize = 16;  // of a file, for the library
    std::string result = libraries_ + out_;
    result.resize(std::max(result.size(), kLeastSize), '\n');
    return result;
  }

 private:
  enum Kind : uint8_t { kVertex, kTexture, kNormal };

  /// A face may name vertices that follow it.
  void count() {
    ObjLines lines(text_, true);
    while (const auto s = lines.next()) {
      total_[kVertex] += s->keyword == "v";
      total_[kTexture] += s->keyword == "vt";
      total_[kNormal] += s->keyword == "vn";
    }
  }

  /// Appends the first of the words, which are numbers. `vt` may have one number only.
  void append_numbers(const ObjStatement& s, size_t least, size_t most) {
    if (words_.size() < least)
      fail(s.line,
           quoted(s.keyword) + " needs " + std::to_string(least) + " numbers, it has " + std::to_string(words_.size()));
    out_.append(s.keyword);
    for (size_t i = 0; i < words_.size() && i < most; ++i) {
      if (!number_of(words_[i])) fail(s.line, quoted(words_[i]) + " is no number");
      out_.append(" ").append(words_[i]);
    }
    if (least == 1 && words_.size() == 1) out_.append(" 0");
    out_.append("\n");
  }

  void numbers(const ObjStatement& s, size_t least, size_t most, Kind kind) {
    split_words(s.rest, words_);
    append_numbers(s, least, most);
    ++seen_[kind];
  }

  /// x y z, x y z w, or x y z and a colour; white has no effect.
  void vertex(const ObjStatement& s) {
    split_words(s.rest, words_);
    constexpr size_t kWithWeight = 4, kWithColor = 6, kWithAlpha = 7;
    if (words_.size() == kWithColor || words_.size() == kWithAlpha) {
      if (std::any_of(words_.begin() + 3, words_.end(), [](std::string_view w) { return number_of(w) != 1; }))
        ++colors_;
      words_.resize(3);
    } else if (words_.size() > kWithWeight) {
      losses_.add("further numbers of vertices (v)");
      words_.resize(3);
    } else if (words_.size() == kWithWeight && number_of(words_[3]) == 0) {
      fail(s.line, "the weight of the vertex is 0");
    }
    append_numbers(s, 3, kWithWeight);
    ++seen_[kVertex];
    if (colors_ == 1) losses_.add("vertex colours"), ++colors_;
  }

  /// Returns the index, from 1, that a word of a face names; 0 if the file has no such element.
  uint64_t index(const ObjStatement& s, std::string_view word, Kind kind) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value == 0)
      fail(s.line, quoted(word) + " is no index: they are numbers from 1 or below 0");
    const int64_t from_one = value > 0 ? value : int64_t(seen_[kind]) + 1 + value;
    return from_one >= 1 && from_one <= int64_t(total_[kind]) ? uint64_t(from_one) : 0;
  }

  Corner corner(const ObjStatement& s, std::string_view word) {
    Corner corner{};
    for (size_t kind = 0; kind < 3; ++kind) {
      const size_t end = std::min(word.find('/'), word.size());
      const std::string_view part = word.substr(0, end);
      if (!part.empty()) corner[kind] = index(s, part, Kind(kind));
      if (kind == kVertex && corner[0] == 0)
        fail(s.line, "the face has vertex " + quoted(part) + ", which the file does not have");
      if (!part.empty() && corner[kind] == 0) lacking_[kind] = true;  // of an index that the file does not have
      word.remove_prefix(std::min(end + 1, word.size()));
    }
    if (!word.empty()) fail(s.line, "a corner of a face has up to three indices");
    return corner;
  }

  void face(const ObjStatement& s) {
    split_words(s.rest, words_);
    lacking_ = {};
    corners_.clear();
    for (const std::string_view word : words_) corners_.push_back(corner(s, word));
    if (corners_.size() < 3) return losses_.add("face of fewer than 3 corners" + first(kShort, s));
    std::array<bool, 3> has{};
    for (size_t kind = 1; kind < 3; ++kind) {
      has[kind] = std::ranges::all_of(corners_, [kind](const Corner& c) { return c[kind] > 0; });
      const char* what = kind == kTexture ? "texture coordinates (vt)" : "normals (vn)";
      if (lacking_[kind])
        losses_.add(std::string(what) + " that the file does not have" + first(kind, s));
      else if (!has[kind] && std::ranges::any_of(corners_, [kind](const Corner& c) { return c[kind] > 0; }))
        losses_.add(std::string(what) + " at some corners of a face only" + first(kind, s));
    }
    if (is_smooth_ && !has[kNormal] && total_[kNormal] == 0 && !is_smooth_named_) {
      losses_.add("smoothing groups (s) without normals");
      is_smooth_named_ = true;
    }
    // A face without a material has none of the libraries'.
    if (!has_material_) material(kDefault);
    if (!material_.empty()) used_.insert(std::exchange(material_, {}));
    out_.append("f");
    for (const Corner& c : corners_) {
      out_.append(" ").append(std::to_string(c[0]));
      if (has[kTexture]) out_.append("/").append(std::to_string(c[1]));
      if (has[kNormal]) out_.append(has[kTexture] ? "/" : "//").append(std::to_string(c[2]));
    }
    out_.append("\n");
  }

  /// Returns the place of the first loss of a kind, for the message about all losses of the kind.
  std::string first(size_t kind, const ObjStatement& s) {
    if (first_[kind] == 0) first_[kind] = s.line;
    return ", first in line " + std::to_string(first_[kind]);
  }

  void material(const std::string& name) {
    has_material_ = true;
    out_.append("usemtl ").append(name).append("\n");
    material_ = name;
  }

  /// One file whose name may have blanks, or several.
  void library(const ObjStatement& s, const std::function<bool(const std::string&)>& is_usable) {
    // Each file once.
    const auto add = [&](const std::string& name) {
      if (libraries_seen_.insert(name).second) libraries_.append("mtllib ").append(name).append("\n");
    };
    split_words(s.rest, words_);
    const std::string whole(s.rest);
    const auto is_word_usable = [&](std::string_view word) { return is_usable(std::string(word)); };
    if (whole.empty()) return;
    if (words_.size() > 1 && std::ranges::all_of(words_, is_word_usable)) {
      for (const std::string_view word : words_) add(std::string(word));
    } else {
      add(whole);  // the library says if there is no such file, and takes MODEL.mtl
    }
  }

  void other(const ObjStatement& s) {
    const auto* known = std::ranges::find(kOthers, s.keyword, &OtherStatement::keyword);
    if (known == std::end(kOthers))
      losses_.add("unknown statement " + quoted(s.keyword));
    else if (!known->says.empty())
      losses_.add(std::string(known->says));
  }

  static constexpr size_t kShort = 0;

  std::string_view text_;
  LossList& losses_;
  std::set<std::string>& used_;
  std::array<uint64_t, 3> total_{}, seen_{};  ///< of the file, and up to here
  std::array<bool, 3> lacking_{};             ///< kinds that a face names and the file does not have
  std::array<size_t, 3> first_{};             ///< lines of the first losses of faces
  std::string out_, libraries_;
  std::set<std::string> libraries_seen_;  ///< names of material files
  std::vector<std::string_view> words_;
  std::vector<Corner> corners_;
  std::string material_;  ///< until it has a face
  uint64_t colors_ = 0;
  bool is_smooth_ = false, is_smooth_named_ = false, has_material_ = false;
};

}  // namespace

std::string ObjText::model(std::string_view text, const std::function<bool(const std::string&)>& is_usable) {
  return ModelWriter(text, losses_, used_).write(is_usable);
}

std::string ObjText::materials(std::string_view text) { return read_statements(text, used_, losses_, defined_); }

std::vector<ImportedLoss> ObjText::losses() const {
  LossList all = losses_;
  for (const std::string& name : used_)
    if (!defined_.contains(name) && name != kDefault)
      all.add_for_material(name, "colour, which no material file states,");
  return all.all();
}

}  // namespace frond
