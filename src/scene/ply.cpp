#include "scene/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "scene/file_bytes.h"
#include "scene/ply_header.h"
#include "scene/tokenizer.h"

namespace frond {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Values of a binary body, one after the other.
class BinarySource {
 public:
  BinarySource(std::string_view bytes, const PlyHeader& header, std::shared_ptr<const std::string> file)
      : bytes_(bytes),
        at_(header.bytes),
        value_at_(at_),
        swap_((header.format == PlyFormat::little_endian) != (std::endian::native == std::endian::little)),
        file_(std::move(file)) {}

  /// Least bytes that one value takes.
  static size_t least_bytes(PlyType type) { return size_of(type); }
  size_t bytes_left() const { return bytes_.size() - at_; }
  bool at_end() {
    value_at_ = at_;
    return std::all_of(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), bytes_.end(), is_blank);
  }

  bool start_row() { return true; }
  bool end_row() { return true; }
  /// False when there is no value; `problem` says why.
  bool next(PlyType type, double& value) {
    value_at_ = at_;
    if (size_of(type) > bytes_left()) return false;
    value = value_of(type);
    at_ += size_of(type);
    return true;
  }
  bool skip(PlyType type, size_t count) {
    value_at_ = at_;
    if (count > bytes_left() / size_of(type)) return false;
    at_ += count * size_of(type);
    return true;
  }
  std::string problem() const { return "the file ends too early"; }
  /// At the last value asked for.
  [[noreturn]] void fail_here(const std::string& message) const {
    fail({}, "{}: byte {}: {}", *file_, value_at_, message);
  }

 private:
  template <class T>
  double load() const {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<T>(raw));
  }
  double value_of(PlyType type) const {
    switch (type) {
      case PlyType::int8:
        return load<int8_t>();
      case PlyType::uint8:
        return load<uint8_t>();
      case PlyType::int16:
        return load<int16_t>();
      case PlyType::uint16:
        return load<uint16_t>();
      case PlyType::int32:
        return load<int32_t>();
      case PlyType::uint32:
        return load<uint32_t>();
      case PlyType::float32:
        return load<float>();
      case PlyType::float64:
        return load<double>();
    }
    return 0;
  }

  std::string_view bytes_;
  size_t at_, value_at_;
  bool swap_;
  std::shared_ptr<const std::string> file_;
};

/// Values of an ASCII body: a row of an element is a line.
class AsciiSource {
 public:
  AsciiSource(std::string_view bytes, const PlyHeader& header, std::shared_ptr<const std::string> file)
      : bytes_(bytes), at_(header.bytes), line_start_(at_), line_(header.lines + 1), file_(std::move(file)) {}

  static size_t least_bytes(PlyType) { return 2; }  // a digit and what parts it from the next
  size_t bytes_left() const { return bytes_.size() - at_ + 1; }
  bool at_end() {
    skip_empty_lines();
    return !find_word();
  }

  bool start_row() {
    skip_empty_lines();
    return find_word() || refuse("the file ends too early");
  }
  bool end_row() {
    if (find_word()) return refuse("the row has more values than the element has properties");
    return true;
  }
  bool next(PlyType, double& value) {
    if (!find_word()) return refuse(at_ == bytes_.size() ? "the file ends too early" : "the row ends too early");
    const auto number = parse_number(word_);
    if (!number)
      return refuse(
          fmt::format("a number is needed, {} was given", Token{.kind = Token::Kind::word, .text = word_}.shown()));
    value = *number;
    at_ += word_.size();
    return true;
  }
  bool skip(PlyType type, size_t count) {
    for (double value; count > 0; --count)
      if (!next(type, value)) return false;
    return true;
  }
  const std::string& problem() const { return problem_; }
  [[noreturn]] void fail_here(const std::string& message) const {
    fail({file_, word_line_, static_cast<int>(word_start_ - line_start_) + 1}, "{}", message);
  }

 private:
  bool refuse(std::string problem) {
    problem_ = std::move(problem);
    return false;
  }
  void skip_empty_lines() {
    for (; at_ < bytes_.size() && is_blank(bytes_[at_]); ++at_)
      if (bytes_[at_] == '\n') ++line_, line_start_ = at_ + 1;
  }
  /// The next word on this line, without taking it.
  bool find_word() {
    while (at_ < bytes_.size() && bytes_[at_] != '\n' && is_blank(bytes_[at_])) ++at_;
    size_t end = at_;
    while (end < bytes_.size() && !is_blank(bytes_[end])) ++end;
    word_ = bytes_.substr(at_, end - at_);
    word_start_ = at_;
    word_line_ = line_;
    return !word_.empty();
  }

  std::string_view bytes_, word_;
  size_t at_, line_start_, word_start_ = 0;
  int line_, word_line_ = 0;
  std::shared_ptr<const std::string> file_;
  std::string problem_;
};

/// Where a vertex property goes: x y z, nx ny nz, u v; or nowhere.
constexpr size_t kSlots = 8, kNoSlot = kSlots;

size_t slot_of(std::string_view name) {
  constexpr std::string_view kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
  for (size_t i = 0; i < std::size(kNames); ++i)
    if (name == kNames[i]) return i;
  if (name == "u" || name == "s" || name == "texture_u" || name == "texture_s") return 6;
  if (name == "v" || name == "t" || name == "texture_v" || name == "texture_t") return 7;
  return kNoSlot;
}

/// Which slots the vertices of a file fill; checked to be whole groups.
struct VertexLayout {
  std::vector<size_t> slots;  ///< one for each property
  bool has_normals = false, has_uv = false;

  explicit VertexLayout(const PlyElement& element) {
    std::array<bool, kSlots + 1> filled{};
    for (const PlyProperty& p : element.properties) {
      const size_t slot = p.count_type ? kNoSlot : slot_of(p.name);
      if (slot != kNoSlot && filled[slot]) fail(p.where, "a second property \"{}\" for the same coordinate", p.name);
      filled[slot] = true;
      slots.push_back(slot);
    }
    if (!(filled[0] && filled[1] && filled[2])) fail(element.where, "element \"vertex\" needs properties x, y and z");
    has_normals = filled[3] || filled[4] || filled[5];
    has_uv = filled[6] || filled[7];
    if (has_normals && !(filled[3] && filled[4] && filled[5]))
      fail(element.where, "element \"vertex\" has a part of nx, ny and nz only");
    if (has_uv && !(filled[6] && filled[7])) fail(element.where, "element \"vertex\" has one of u and v only");
  }
};

size_t index_property(const PlyElement& element) {
  for (size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& p = element.properties[i];
    if (p.name != "vertex_indices" && p.name != "vertex_index") continue;
    if (!p.count_type || !is_integer(p.type)) fail(p.where, "property \"{}\" must be a list of integers", p.name);
    return i;
  }
  fail(element.where, "element \"face\" needs property \"vertex_indices\"");
}

const PlyElement& element_called(const PlyHeader& header, std::string_view name, const Location& end) {
  for (const PlyElement& element : header.elements)
    if (element.name == name) return element;
  fail(end, "the header declares no element \"{}\"", name);
}

template <class Source>
class BodyReader {
 public:
  BodyReader(Source& source, const PlyHeader& header, TriangleMesh& mesh, uint64_t vertices)
      : source_(source), header_(header), mesh_(mesh), vertices_(vertices) {}

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
    if (!source_.at_end())
      source_.fail_here("there is more data after the last element: a count in the header is wrong");
  }

 private:
  /// Believes a count only as far as the file's size goes, before anything is allocated.
  void start(const PlyElement& element) {
    element_ = &element;
    row_ = 0;
    size_t least = 0;
    for (const PlyProperty& p : element.properties) least += Source::least_bytes(p.count_type.value_or(p.type));
    if (element.count > 0 && least == 0) fail(element.where, "element \"{}\" has no properties", element.name);
    if (element.count > 0 && element.count > source_.bytes_left() / least)
      fail(element.where, "element \"{}\" has {} rows of at least {} bytes, but {} bytes are left in the file",
           element.name, element.count, least, source_.bytes_left());
  }

  template <class ReadProperty, class EndRow>
  void for_each_row(const ReadProperty& read_property, const EndRow& finish) {
    for (row_ = 0; row_ < element_->count; ++row_) {
      if (!source_.start_row()) fail_row(source_.problem());
      for (size_t i = 0; i < element_->properties.size(); ++i) read_property(element_->properties[i], i);
      if (!source_.end_row()) fail_row(source_.problem());
      finish();
    }
  }

  void read_vertices() {
    const VertexLayout layout(*element_);
    const size_t count = static_cast<size_t>(element_->count);
    mesh_.p.reserve(count);
    if (layout.has_normals) mesh_.n.reserve(count);
    if (layout.has_uv) mesh_.uv.reserve(count);
    std::array<float, kSlots + 1> v{};
    for_each_row(
        [&](const PlyProperty& p, size_t i) {
          const size_t slot = layout.slots[i];
          if (slot == kNoSlot) return skip(p);
          v[slot] = static_cast<float>(number(p.type));
          if (!std::isfinite(v[slot])) fail_row(fmt::format("{} is {}", p.name, v[slot]));
        },
        [&] {
          mesh_.p.push_back({v[0], v[1], v[2]});
          if (layout.has_normals) mesh_.n.push_back({v[3], v[4], v[5]});
          if (layout.has_uv) mesh_.uv.push_back({v[6], v[7]});
        });
  }

  void read_faces() {
    const size_t indices = index_property(*element_);
    const size_t least = 3 * Source::least_bytes(element_->properties[indices].type);
    mesh_.triangles.reserve(std::min(static_cast<size_t>(element_->count), source_.bytes_left() / least));
    for_each_row([&](const PlyProperty& p, size_t i) { i == indices ? read_face(p) : skip(p); }, [] {});
  }

  void read_face(const PlyProperty& p) {
    const double corners = number(*p.count_type);
    if (corners != 3 && corners != 4)
      fail_row(fmt::format("{} corners; triangles and quadrilaterals are supported", corners));
    std::array<uint32_t, 4> c{};
    for (size_t i = 0; i < static_cast<size_t>(corners); ++i) c[i] = index(p.type);
    mesh_.triangles.push_back({c[0], c[1], c[2]});
    if (corners == 4) mesh_.triangles.push_back({c[0], c[2], c[3]});
  }

  uint32_t index(PlyType type) {
    const double value = number(type);
    if (!(value >= 0 && value < static_cast<double>(vertices_)) || value != std::floor(value))
      fail_row(fmt::format("index {} is out of range: there are {} vertices", value, vertices_));
    return static_cast<uint32_t>(value);
  }

  double number(PlyType type) {
    double value = 0;
    if (!source_.next(type, value)) fail_row(source_.problem());
    return value;
  }

  void skip(const PlyProperty& p) {
    size_t count = 1;
    if (p.count_type) {
      const double length = number(*p.count_type);
      if (!(length >= 0 && length <= static_cast<double>(source_.bytes_left())) || length != std::floor(length))
        fail_row(fmt::format("\"{}\" is a list of {} values, which the file does not hold", p.name, length));
      count = static_cast<size_t>(length);
    }
    if (!source_.skip(p.type, count)) fail_row(source_.problem());
  }

  [[noreturn]] void fail_row(const std::string& message) const {
    source_.fail_here(fmt::format("{} {}: {}", element_->name, row_, message));
  }

  Source& source_;
  const PlyHeader& header_;
  TriangleMesh& mesh_;
  uint64_t vertices_;
  const PlyElement* element_ = nullptr;
  uint64_t row_ = 0;
};

}  // namespace

TriangleMesh read_ply_text(std::string_view bytes, const std::string& name) {
  const auto file = std::make_shared<const std::string>(name);
  const PlyHeader header = read_ply_header(bytes, file);
  const Location end{file, header.lines, 1};
  const PlyElement& vertices = element_called(header, "vertex", end);
  const PlyElement& faces = element_called(header, "face", end);
  if (vertices.count > UINT32_MAX) fail(vertices.where, "{} vertices are more than indices can tell", vertices.count);
  if (faces.count == 0) fail(faces.where, "the mesh has no faces");
  TriangleMesh mesh;
  const auto read_from = [&](auto source) { BodyReader(source, header, mesh, vertices.count).read(); };
  if (header.format == PlyFormat::ascii)
    read_from(AsciiSource(bytes, header, file));
  else
    read_from(BinarySource(bytes, header, file));
  return mesh;
}

TriangleMesh read_ply(const std::filesystem::path& path) {
  return read_ply_text(read_file_bytes(path, {}), path.string());
}

}  // namespace frond
