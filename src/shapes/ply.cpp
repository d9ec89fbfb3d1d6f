#include "shapes/ply.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "core/math/precise_transform.h"
#include "core/messages/excerpt.h"
#include "core/stop.h"
#include "shapes/ply_header.h"
#include "shapes/ply_source.h"
#include "system/file_bytes.h"
#include "system/gzip.h"

namespace frond {
namespace {

/// Slot of a vertex property: x y z, nx ny nz, u v; or none.
constexpr size_t kSlots = 8, kNoSlot = kSlots;

/// Returns the slot of a property name. Several names of texture coordinates are in use.
size_t slot_of(std::string_view name) {
  constexpr std::string_view kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
  for (size_t i = 0; i < std::size(kNames); ++i)
    if (name == kNames[i]) return i;
  if (name == "u" || name == "s" || name == "texture_u" || name == "texture_s") return 6;
  if (name == "v" || name == "t" || name == "texture_v" || name == "texture_t") return 7;
  return kNoSlot;
}

/// Slots that the vertices of a file fill: complete groups only, each from the first property with such a name.
struct VertexLayout {
  std::vector<size_t> slots;  ///< by property
  bool has_normals = false, has_uv = false;

  /// Incomplete groups of normals or texture coordinates are dropped.
  explicit VertexLayout(const PlyElement& element) {
    std::array<bool, kSlots + 1> filled{};
    for (const PlyProperty& p : element.properties) {
      size_t slot = p.count_type ? kNoSlot : slot_of(p.name);
      if (filled[slot]) slot = kNoSlot;
      filled[slot] = true;
      slots.push_back(slot);
    }
    if (!(filled[0] && filled[1] && filled[2])) fail(element.where, "element \"vertex\" needs properties x, y and z");
    has_normals = filled[3] && filled[4] && filled[5];
    has_uv = filled[6] && filled[7];
    for (size_t& slot : slots)
      if ((!has_normals && slot >= 3 && slot < 6) || (!has_uv && slot >= 6)) slot = kNoSlot;
  }
};

/// Returns the index of the list of vertex indices. Throws InputError if it is missing.
size_t index_property(const PlyElement& element) {
  for (size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& p = element.properties[i];
    if (p.name != "vertex_indices" && p.name != "vertex_index") continue;
    if (!p.count_type || !is_integer(p.type)) fail(p.where, "property \"{}\" must be a list of integers", p.name);
    return i;
  }
  fail(element.where, "element \"face\" needs property \"vertex_indices\"");
}

/// Throws InputError at the end of the header if the element is missing.
const PlyElement& element_called(const PlyHeader& header, std::string_view name, const Location& end) {
  for (const PlyElement& element : header.elements)
    if (element.name == name) return element;
  fail(end, "the header declares no element \"{}\"", name);
}

/// Location of the mesh among the file's elements; checked before the body is read.
struct MeshLayout {
  uint64_t vertices;  ///< number that the header declares
  VertexLayout vertex;
  size_t indices;  ///< property of a face
  /// Property of a face with u and v of each corner, as MeshLab writes; used if the vertices have none.
  std::optional<size_t> corners;

  MeshLayout(const PlyElement& vertex_element, const PlyElement& face_element)
      : vertices(vertex_element.count), vertex(vertex_element), indices(index_property(face_element)) {
    for (size_t i = 0; i < face_element.properties.size() && !vertex.has_uv; ++i) {
      const PlyProperty& p = face_element.properties[i];
      if (p.name == "texcoord" && p.count_type && !is_integer(p.type)) corners = i;
    }
    if (vertices > UINT32_MAX) fail(vertex_element.where, "{} vertices are more than indices can tell", vertices);
    if (face_element.count == 0) fail(face_element.where, "the mesh has no faces");
  }
};

/// Names the content of the body other than the mesh. pbrt-v4's "face_indices" are for Ptex and silently ignored, as
/// parameter "faceIndices" of a triangle mesh is.
std::string unused_content(const PlyHeader& header, const MeshLayout& layout) {
  constexpr size_t kMostNamed = 8;
  std::vector<std::string> all;
  for (const PlyElement& element : header.elements) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    if (element.count == 0) continue;
    std::vector<std::string> names;
    for (size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& p = element.properties[i];
      const bool is_used =
          is_vertex ? layout.vertex.slots[i] != kNoSlot : i == layout.indices || (is_face && i == layout.corners);
      if (!is_used && p.name != "face_indices") names.push_back(fmt::format("\"{}\"", excerpt(p.name, p.where)));
    }
    const size_t more = names.size() - std::min(names.size(), kMostNamed);
    names.resize(names.size() - more);
    const std::string rest = more > 0 ? fmt::format(" and {} more", more) : "";
    if (!is_vertex && !is_face)
      all.push_back(fmt::format("{} rows of \"{}\"", element.count, excerpt(element.name, element.where)));
    else if (!names.empty())
      all.push_back(
          fmt::format("{}{} of {} {}", fmt::join(names, ", "), rest, element.count, is_face ? "faces" : "vertices"));
    if (all.size() == kMostNamed) break;
  }
  return fmt::format("{}", fmt::join(all, "; "));
}

template <class Source>
class BodyReader {
 public:
  BodyReader(Source& source, const PlyHeader& header, const MeshLayout& layout, const Vec3d& origin, PlyMesh& result)
      : source_(source), header_(header), layout_(layout), origin_(origin), result_(result), mesh_(result.mesh) {}

  /// Elements are read in file order; unknown ones are skipped.
  void read() {
    for (const PlyElement& element : header_.elements) {
      start(element);
      if (element.name == "vertex")
        read_vertices();
      else if (element.name == "face")
        read_faces();
      else
        for_each_row([&](const PlyProperty& p, size_t) { skip(p); }, [] {});
    }
    if (layout_.corners) divide_vertices();
    if (!source_.at_end())
      source_.fail_here("there is more data after the last element: a count in the header is wrong");
  }

 private:
  /// Checks a count against the file's size before memory is allocated.
  void start(const PlyElement& element) {
    element_ = &element;
    row_ = 0;
    size_t least = 0;
    for (const PlyProperty& p : element.properties) least += Source::least_bytes(p.count_type.value_or(p.type));
    if (element.count > 0 && least == 0) fail(element.where, "element \"{}\" has no properties", element.name);
    if (element.count > 0 && element.count > (source_.bytes_left() + Source::kMissingEnd) / least)
      fail(element.where, "element \"{}\" has {} rows of at least {} bytes, but {} bytes are left in the file",
           element.name, element.count, least, source_.bytes_left());
  }

  template <class ReadProperty, class EndRow>
  void for_each_row(const ReadProperty& read_property, const EndRow& finish) {
    StopPoll poll;
    for (row_ = 0; row_ < element_->count; ++row_) {
      poll();
      if (!source_.start_row()) fail_row(source_.problem());
      for (size_t i = 0; i < element_->properties.size(); ++i) read_property(element_->properties[i], i);
      if (!source_.end_row()) fail_row(source_.problem());
      finish();
    }
  }

  /// Values that have no slot are read and discarded.
  void read_vertices() {
    const VertexLayout& layout = layout_.vertex;
    const size_t count = static_cast<size_t>(element_->count);
    mesh_.p.reserve(count);
    if (layout.has_normals) mesh_.n.reserve(count);
    if (layout.has_uv) mesh_.uv.reserve(count);
    std::array<float, kSlots + 1> v{};
    Vec3d p;
    for_each_row(
        [&](const PlyProperty& property, size_t i) {
          const size_t slot = layout.slots[i];
          if (slot == kNoSlot) return skip(property);
          const double value = number(property.type);
          v[slot] = static_cast<float>(value);
          if (!std::isfinite(v[slot])) fail_row(fmt::format("{} is {}", property.name, v[slot]));
          (slot == 0 ? p.x : slot == 1 ? p.y : slot == 2 ? p.z : unused_) = value;
        },
        [&] {
          if (row_ == 0) note_step(p);
          mesh_.p.push_back(to_float(p - origin_));
          if (layout.has_normals) mesh_.n.push_back({v[3], v[4], v[5]});
          if (layout.has_uv) mesh_.uv.push_back({v[6], v[7]});
        });
  }

  /// Text has as many digits as its writer chose, whatever the header says.
  void note_step(const Vec3d& first) {
    if (header_.format == PlyFormat::ascii || !is_far(first)) return;
    for (const PlyProperty& p : element_->properties)
      if (slot_of(p.name) < 3 && p.type == PlyType::float32) result_.step = float_spacing(largest_coordinate(first));
  }

  /// Memory is reserved for no more faces than the rest of the file can contain.
  void read_faces() {
    const size_t indices = layout_.indices;
    const size_t least = 3 * Source::least_bytes(element_->properties[indices].type);
    const size_t most = std::min(static_cast<size_t>(element_->count), source_.bytes_left() / least);
    mesh_.triangles.reserve(most);
    for_each_row(
        [&](const PlyProperty& p, size_t i) {
          i == indices ? read_face(p) : i == layout_.corners ? read_corners(p) : skip(p);
        },
        [&] {
          if (layout_.corners) keep_corners();
        });
  }

  /// u and v of each corner of the row's face.
  void read_corners(const PlyProperty& p) {
    const double count = number(*p.count_type);
    values_.clear();
    if (count != 6 && count != 8) return skip_values(p, count);
    for (int i = 0; i < int(count); ++i) values_.push_back(float(number(p.type)));
  }

  /// The face may follow its coordinates in the row. Other numbers of values than of corners count as 0.
  void keep_corners() {
    std::vector<Vec2>& uvs = corners_ == 3 ? triangle_uvs_ : quad_uvs_;
    for (size_t i = 0; i < corners_; ++i) {
      const bool is_there = values_.size() == 2 * corners_ && std::isfinite(values_[2 * i] + values_[2 * i + 1]);
      uvs.push_back(is_there ? Vec2{values_[2 * i], values_[2 * i + 1]} : Vec2{});
    }
    corners_ = 0;
  }

  /// A vertex whose corners have several coordinates becomes several vertices.
  void divide_vertices() {
    std::vector<bool> is_used(mesh_.p.size());
    std::map<std::tuple<uint32_t, float, float>, uint32_t> others;
    mesh_.uv.assign(mesh_.p.size(), Vec2{});
    const auto assign = [&](uint32_t& vertex, const Vec2& uv) {
      if (vertex >= is_used.size()) return;  // the element "vertex" follows, or has fewer rows
      if (!is_used[vertex]) {
        is_used[vertex] = true;
        mesh_.uv[vertex] = uv;
      }
      if (mesh_.uv[vertex] == uv) return;
      const auto [known, is_new] = others.try_emplace({vertex, uv.x, uv.y}, uint32_t(mesh_.p.size()));
      if (is_new) {
        if (mesh_.p.size() >= UINT32_MAX) source_.fail_here("the corners of its faces are more than indices can tell");
        mesh_.p.push_back(mesh_.p[vertex]);
        if (!mesh_.n.empty()) mesh_.n.push_back(mesh_.n[vertex]);
        mesh_.uv.push_back(uv);
      }
      vertex = known->second;
    };
    for (size_t i = 0; i < mesh_.triangles.size(); ++i)
      for (size_t k = 0; k < 3; ++k) assign(mesh_.triangles[i][k], triangle_uvs_[3 * i + k]);
    for (size_t i = 0; i < result_.quads.size(); ++i)
      for (size_t k = 0; k < 4; ++k) assign(result_.quads[i][k], quad_uvs_[4 * i + k]);
  }

  /// Quadrilaterals are stored as such; other polygons are counted and skipped.
  void read_face(const PlyProperty& p) {
    const double corners = number(*p.count_type);
    if (corners != 3 && corners != 4) {
      ++result_.ignored;
      return skip_values(p, corners);
    }
    corners_ = static_cast<size_t>(corners);
    std::array<uint32_t, 4> c{};
    for (size_t i = 0; i < static_cast<size_t>(corners); ++i) c[i] = index(p.type);
    if (corners == 3)
      mesh_.triangles.push_back({c[0], c[1], c[2]});
    else
      result_.quads.push_back(c);
  }

  /// Throws InputError for an index that is not an integer or out of range.
  uint32_t index(PlyType type) {
    const double value = number(type);
    if (!(value >= 0 && value < static_cast<double>(layout_.vertices)) || value != std::floor(value))
      fail_row(fmt::format("index {} is out of range: there are {} vertices", value, layout_.vertices));
    return static_cast<uint32_t>(value);
  }

  /// Throws InputError if the file ends or the value is malformed.
  double number(PlyType type) {
    double value = 0;
    if (!source_.next(type, value)) fail_row(source_.problem());
    return value;
  }

  void skip(const PlyProperty& p) { skip_values(p, p.count_type ? number(*p.count_type) : 1); }

  /// Throws InputError for a count that the rest of the file cannot contain.
  void skip_values(const PlyProperty& p, double count) {
    if (!(count >= 0 && count <= static_cast<double>(source_.bytes_left())) || count != std::floor(count))
      fail_row(
          fmt::format("\"{}\" is a list of {} values, which the file does not hold", excerpt(p.name, p.where), count));
    if (!source_.skip(p.type, static_cast<size_t>(count))) fail_row(source_.problem());
  }

  /// Throws InputError with element, row and position.
  [[noreturn]] void fail_row(const std::string& message) const {
    source_.fail_here(fmt::format("{} {}: {}", excerpt(element_->name, element_->where), row_, message));
  }

  Source& source_;
  const PlyHeader& header_;
  const MeshLayout& layout_;
  const Vec3d origin_;
  PlyMesh& result_;
  TriangleMesh& mesh_;
  const PlyElement* element_ = nullptr;
  uint64_t row_ = 0;
  double unused_ = 0;
  size_t corners_ = 0;         ///< of the row's face; 0: it is skipped
  std::vector<float> values_;  ///< coordinates of the row's corners
  std::vector<Vec2> triangle_uvs_, quad_uvs_;
};

}  // namespace

PlyMesh read_ply_text(std::string_view bytes, const std::string& name, const Vec3d& origin) {
  const auto file = std::make_shared<const std::string>(name);
  const PlyHeader header = read_ply_header(bytes, file);
  const Location end{file, header.lines, 1};
  const MeshLayout layout(element_called(header, "vertex", end), element_called(header, "face", end));
  PlyMesh result;
  result.unused = unused_content(header, layout);
  const auto read_from = [&](auto source) { BodyReader(source, header, layout, origin, result).read(); };
  if (header.format == PlyFormat::ascii)
    read_from(ply::AsciiSource(bytes, header, file));
  else
    read_from(ply::BinarySource(bytes, header, file));
  return result;
}

PlyMesh read_ply_bytes(const std::string& bytes, const std::string& name, const Vec3d& origin) {
  return read_ply_text(is_gzip(bytes) ? unpack_gzip(bytes, name, {}) : bytes, name, origin);
}

PlyMesh read_ply(const std::filesystem::path& path, const Vec3d& origin) {
  return read_ply_bytes(read_file_bytes(path, {}), path.string(), origin);
}

}  // namespace frond
