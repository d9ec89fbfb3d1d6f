#include "models/obj_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "imports/node_map.h"
#include "models/mtl_reader.h"
#include "models/normal_map_sides.h"
#include "models/obj_geometry.h"
#include "models/obj_lines.h"

namespace frond {
namespace {

/// Throws an error with the line of the file.
[[noreturn]] void fail(size_t line, const std::string& problem) {
  throw std::runtime_error("line " + std::to_string(line) + ": " + problem);
}

std::string quoted(std::string_view word) { return '"' + std::string(word.substr(0, 40)) + '"'; }

/// Statements that are no polygons and no materials, and change the look.
struct OtherStatement {
  std::string_view keyword, says;
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
};
/// Statements without effect: parts of free-form elements, and how to divide them; hints for a renderer of 1990; usemtl
/// without a name.
constexpr std::string_view kInert[] = {"vp",   "cstype", "deg", "bmat",   "step",  "parm",     "trim",
                                       "hole", "scrv",   "sp",  "end",    "con",   "ctech",    "stech",
                                       "res",  "mg",     "lod", "usemtl", "bevel", "c_interp", "d_interp"};

/// The material of faces without one.
const std::string kDefault = "DefaultMaterial";

/// Reads the statements of an OBJ file one by one.
class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& name, FileSource& files)
      : text_(text), name_(name), files_(files) {}

  ImportedScene read() {
    count();
    ObjLines lines(text_, true);
    while (const auto s = lines.next()) statement(*s);
    if (faces_.empty()) throw std::runtime_error("it has no triangles");
    read_materials();
    add_meshes();
    scene_.losses = losses_.all();
    return std::move(scene_);
  }

 private:
  /// Keywords of OBJ are in lower case.
  void statement(const ObjStatement& s) {
    split_words(s.rest, words_);
    if (s.keyword == "v")
      vertex(s);
    else if (s.keyword == "vt")
      values_[kTexture].push_back(numbers(s, 1, 2));  // the third is depth, of which images have none
    else if (s.keyword == "vn")
      values_[kNormal].push_back(numbers(s, 3, 3));
    else if (s.keyword == "f" || s.keyword == "fo")
      face(s);
    else if (s.keyword == "usemtl" && !s.rest.empty())
      material_ = std::string(s.rest);
    else if (s.keyword == "mtllib")
      library(s);
    else if (s.keyword == "g" || s.keyword == "o")
      object_ = std::string(s.rest);
    else if (s.keyword == "s")
      is_smooth_ = s.rest != "off" && s.rest != "0" && !s.rest.empty();
    else
      other(s);
  }

  /// A face may name vertices that follow it.
  void count() {
    ObjLines lines(text_, true);
    while (const auto s = lines.next()) {
      total_[kVertex] += s->keyword == "v";
      total_[kTexture] += s->keyword == "vt";
      total_[kNormal] += s->keyword == "vn";
    }
  }

  /// Returns the first of the words, which are numbers. `vt` may have one number only.
  std::array<double, 3> numbers(const ObjStatement& s, size_t least, size_t most) const {
    if (words_.size() < least)
      fail(s.line,
           quoted(s.keyword) + " needs " + std::to_string(least) + " numbers, it has " + std::to_string(words_.size()));
    std::array<double, 3> values{};
    for (size_t i = 0; i < words_.size() && i < most; ++i) {
      const auto value = number_of(words_[i]);
      if (!value || !std::isfinite(*value)) fail(s.line, quoted(words_[i]) + " is no number");
      values[i] = *value;
    }
    return values;
  }

  /// x y z, x y z w, or x y z and a colour; white has no effect.
  void vertex(const ObjStatement& s) {
    constexpr size_t kWithWeight = 4, kWithColor = 6, kWithAlpha = 7;
    std::array<double, 3> p = numbers(s, 3, 3);
    if (words_.size() == kWithColor || words_.size() == kWithAlpha) {
      has_colors_ = has_colors_ ||
                    std::any_of(words_.begin() + 3, words_.end(), [](std::string_view w) { return number_of(w) != 1; });
    } else if (words_.size() > kWithWeight) {
      losses_.add("further numbers of vertices (v)");
    } else if (words_.size() == kWithWeight) {
      const auto weight = number_of(words_[3]);
      if (!weight) fail(s.line, quoted(words_[3]) + " is no number");
      if (*weight == 0) fail(s.line, "the weight of the vertex is 0");
      for (double& x : p) x /= *weight;
    }
    values_[kVertex].push_back(p);
    if (has_colors_ && !is_color_named_) losses_.add("vertex colours");
    is_color_named_ = has_colors_;
  }

  /// Returns the index, from 1, that a word of a face names; 0 if the file has no such element.
  uint64_t index(const ObjStatement& s, std::string_view word, ObjKind kind) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value == 0)
      fail(s.line, quoted(word) + " is no index: they are numbers from 1 or below 0");
    const int64_t from_one = value > 0 ? value : int64_t(values_[kind].size()) + 1 + value;
    return from_one >= 1 && from_one <= int64_t(total_[kind]) ? uint64_t(from_one) : 0;
  }

  /// Returns the indices of a word of a face: v, v/vt, v//vn or v/vt/vn.
  ObjCorner corner(const ObjStatement& s, std::string_view word) {
    ObjCorner corner{};
    for (size_t kind = 0; kind < 3; ++kind) {
      const size_t end = std::min(word.find('/'), word.size());
      const std::string_view part = word.substr(0, end);
      if (!part.empty()) corner[kind] = index(s, part, ObjKind(kind));
      if (kind == kVertex && corner[0] == 0)
        fail(s.line, "the face has vertex " + quoted(part) + ", which the file does not have");
      if (!part.empty() && corner[kind] == 0) lacking_[kind] = true;  // of an index that the file does not have
      word.remove_prefix(std::min(end + 1, word.size()));
    }
    if (!word.empty()) fail(s.line, "a corner of a face has up to three indices");
    return corner;
  }

  /// Texture coordinates and normals count if all corners have them.
  void face(const ObjStatement& s) {
    lacking_ = {};
    corners_.clear();
    for (const std::string_view word : words_) corners_.push_back(corner(s, word));
    if (corners_.size() < 3) return losses_.add("face of fewer than 3 corners" + first(kShort, s));
    std::array<bool, 3> has{};
    for (size_t kind = 1; kind < 3; ++kind) {
      has[kind] = std::ranges::all_of(corners_, [kind](const ObjCorner& c) { return c[kind] > 0; });
      const char* what = kind == kTexture ? "texture coordinates (vt)" : "normals (vn)";
      if (lacking_[kind])
        losses_.add(std::string(what) + " that the file does not have" + first(kind, s));
      else if (!has[kind] && std::ranges::any_of(corners_, [kind](const ObjCorner& c) { return c[kind] > 0; }))
        losses_.add(std::string(what) + " at some corners of a face only" + first(kind, s));
    }
    if (is_smooth_ && !has[kNormal] && total_[kNormal] == 0 && !is_smooth_named_) {
      losses_.add("smoothing groups (s) without normals");
      is_smooth_named_ = true;
    }
    ObjFaces& faces = faces_[{object_index(), material_, has[kTexture], has[kNormal]}];
    for (ObjCorner c : corners_) {
      for (size_t kind = 1; kind < 3; ++kind) c[kind] = has[kind] ? c[kind] : 0;
      const auto [known, is_new] = faces.index.try_emplace(c, uint32_t(faces.vertices.size()));
      if (is_new) faces.vertices.push_back(c);
      faces.corners.push_back(known->second);
    }
    faces.sizes.push_back(uint32_t(corners_.size()));
    used_.insert(material_);
  }

  /// Returns the node of the current group or object: each name once.
  uint32_t object_index() {
    const auto [known, is_new] = objects_.try_emplace(object_, uint32_t(scene_.nodes.size()));
    if (is_new) scene_.nodes.push_back({.name = object_, .to_parent = NodeMap().m});
    return known->second;
  }

  /// Returns the place of the first loss of a kind, for the message about all losses of the kind.
  std::string first(size_t kind, const ObjStatement& s) {
    if (first_[kind] == 0) first_[kind] = s.line;
    return ", first in line " + std::to_string(first_[kind]);
  }

  /// One file whose name may have blanks, or several; each once.
  void library(const ObjStatement& s) {
    const auto add = [this](const std::string& name) {
      if (std::ranges::find(libraries_, name) == libraries_.end()) libraries_.push_back(name);
    };
    const auto has = [this](std::string_view word) { return files_.has(std::string(word)); };
    if (words_.size() > 1 && !has(s.rest) && std::ranges::any_of(words_, has))
      for (const std::string_view word : words_) add(std::string(word));
    else if (!s.rest.empty())
      add(std::string(s.rest));
  }

  /// Names what is not read.
  void other(const ObjStatement& s) {
    const auto* known = std::ranges::find(kOthers, s.keyword, &OtherStatement::keyword);
    if (known != std::end(kOthers))
      losses_.add(std::string(known->says));
    else if (std::ranges::find(kInert, s.keyword) == std::end(kInert))
      losses_.add("unknown statement " + quoted(s.keyword));
  }

  /// A missing file is a warning; MODEL.mtl is taken in its place.
  void read_materials() {
    ObjMaterials materials;
    constexpr size_t kMostWarnings = 20, kLongest = 200;
    for (size_t i = 0; i < libraries_.size(); ++i) try {
        read_mtl(files_.content(libraries_[i]), used_, materials, losses_);
      } catch (const std::runtime_error& error) {
        if (scene_.warnings.size() < kMostWarnings)
          scene_.warnings.push_back("\"" + libraries_[i].substr(0, kLongest) + "\" is not read: " + error.what());
        const std::string own = std::filesystem::path(name_).replace_extension(".mtl").string();
        if (files_.has(own) && std::ranges::find(libraries_, own) == libraries_.end()) libraries_.push_back(own);
      }
    scene_.images = std::move(materials.images);
    for (const std::string& name : used_) {
      const auto found = materials.by_name.find(name);
      if (found == materials.by_name.end() && name != kDefault)
        losses_.add_for_material(name, "colour, which no material file states,");
      ImportedMaterial m = found == materials.by_name.end() ? ImportedMaterial{.name = name} : found->second;
      // The image replaces the colour, which exporters set to any value beside an image, black too.
      if (m.color_texture.image >= 0) m.color = {1, 1, 1};
      if (m.emission_texture.image >= 0 && !m.is_emitter()) m.emission = {1, 1, 1};
      by_name_[name] = uint32_t(scene_.materials.size());
      scene_.materials.push_back(std::move(m));
    }
  }

  /// A mesh for each object and material: what its faces have is known at the end of the file.
  void add_meshes() {
    scene_.origin = obj_origin(values_[kVertex]);
    for (const auto& [key, faces] : faces_) {
      const auto& [object, material, has_uv, has_normal] = key;
      ImportedMesh mesh{.name = scene_.nodes[object].name, .material = by_name_.at(material)};
      add_geometry(faces, values_, has_uv, has_normal, scene_, mesh);
      add_by_side(std::move(mesh), {}, scene_, scene_.nodes[object].meshes);
    }
  }

  static constexpr size_t kShort = 0;
  using Key = std::tuple<uint32_t, std::string, bool, bool>;  ///< object, material, with texture coordinates, normals

  std::string_view text_;
  const std::string& name_;
  FileSource& files_;
  ImportedScene scene_;
  LossList losses_;
  std::array<uint64_t, 3> total_{};     ///< elements of the file
  ObjElements values_;                  ///< up to here
  std::array<bool, 3> lacking_{};       ///< kinds that a face names and the file does not have
  std::array<size_t, 3> first_{};       ///< lines of the first losses of faces
  std::vector<std::string> libraries_;  ///< names of material files
  std::vector<std::string_view> words_;
  std::vector<ObjCorner> corners_;
  std::string object_, material_ = kDefault;
  std::map<Key, ObjFaces> faces_;
  std::map<std::string, uint32_t> objects_, by_name_;  ///< nodes; materials
  std::set<std::string> used_;                         ///< names of materials
  bool is_smooth_ = false, is_smooth_named_ = false, has_colors_ = false, is_color_named_ = false;
};

}  // namespace

ImportedScene read_obj(std::string_view text, const std::string& name, FileSource& files) {
  return ObjReader(text, name, files).read();
}

}  // namespace frond
