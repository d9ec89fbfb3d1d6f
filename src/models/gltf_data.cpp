#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <optional>
#include <stdexcept>
#ifdef FROND_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

#include "models/gltf_data.h"

namespace frond {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kMeshopt = "EXT_meshopt_compression";

/// Throws an error with the place in the JSON.
[[noreturn]] void fail(const std::string& place, const std::string& problem) {
  throw std::runtime_error(place + ": " + problem);
}

/// A value of componentType.
struct Component {
  uint64_t code;  ///< OpenGL's constant
  size_t size;    ///< bytes
  double most;    ///< that normalized integers are divided by; 0: not an integer
};
constexpr Component kComponents[] = {{5120, 1, 127},   {5121, 1, 255},        {5122, 2, 32767},
                                     {5123, 2, 65535}, {5125, 4, 4294967295}, {5126, 4, 0}};

/// Returns the record of a componentType.
const Component& component_of(uint64_t code, const std::string& place) {
  const auto* found = std::ranges::find(kComponents, code, &Component::code);
  if (found == std::end(kComponents)) fail(place, "its accessor has an unknown componentType");
  return *found;
}

/// Returns a number whose address may have any alignment.
template <class Stored>
double loaded(const char* from) {
  Stored value;
  std::memcpy(&value, from, sizeof value);
  return double(value);
}

/// Returns a component as it is stored.
double value_of(uint64_t code, const char* from) {
  switch (code) {
    case 5120:
      return loaded<int8_t>(from);
    case 5121:
      return loaded<uint8_t>(from);
    case 5122:
      return loaded<int16_t>(from);
    case 5123:
      return loaded<uint16_t>(from);
    case 5125:
      return loaded<uint32_t>(from);
    default:
      return loaded<float>(from);
  }
}

/// Returns a relative URI as the name of a file: %20 is a blank. Text that is no percent-encoding, or encodes a zero
/// byte, is returned unchanged.
std::string percent_decoded(std::string_view uri) {
  std::string name;
  for (size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    const char *digits = uri.data() + i + 1, *end = digits + 2;
    const bool is_encoded = uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, end, code, 16).ptr == end;
    if (is_encoded && code != 0) {
      name += char(code);
      i += 2;
    } else {
      name += uri[i];
    }
  }
  return name;
}

/// Returns the bytes that base64 digits encode; nothing if they are no such ones.
std::optional<std::string> base64_decoded(std::string_view text) {
  std::string bytes;
  uint32_t bits = 0;
  int count = 0;
  while (text.ends_with('=')) text.remove_suffix(1);
  for (const char c : text) {
    const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+' || c == '-' ? 62
                      : c == '/' || c == '_' ? 63
                                             : -1;
    if (digit < 0) return {};
    bits = bits << 6 | uint32_t(digit);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes += char(bits >> count & 0xff);
  }
  return bytes;
}

}  // namespace

std::optional<std::pair<std::string, std::string>> GltfData::embedded(std::string_view uri) {
  constexpr std::string_view kScheme = "data:", kBase64 = ";base64,";
  const size_t end = uri.find(kBase64);
  if (!uri.starts_with(kScheme) || end == uri.npos) return {};
  auto bytes = base64_decoded(uri.substr(end + kBase64.size()));
  if (!bytes) throw std::runtime_error("a URI has data that are not base64");
  return std::pair(std::string(uri.substr(kScheme.size(), end - kScheme.size())), std::move(*bytes));
}

std::string GltfData::file_name(std::string_view uri) const {
  std::string name = percent_decoded(uri);
  return !files_.has(name) && files_.has(std::string(uri)) ? std::string(uri) : name;
}

/// Of a .glb the first buffer without a URI is the second chunk. Each file is read once.
std::string_view GltfData::buffer(uint64_t index, const std::string& place) {
  const Json* buffer = element(file_.document, "buffers", index);
  if (!buffer) fail(place, "its bufferView names a buffer that does not exist");
  const bool has_uri = member(*buffer, "uri") != nullptr;
  if (!has_uri && (index != 0 || !file_.is_binary)) fail(place, "its buffer has no uri");
  std::string_view bytes = file_.bytes;
  if (has_uri) {
    const auto [entry, is_new] = buffers_.try_emplace(index);
    if (is_new) {
      const std::string_view uri = text(*buffer, "uri");
      if (auto data = embedded(uri))
        entry->second = std::move(data->second);
      else
        entry->second = files_.content(file_name(uri));
    }
    bytes = entry->second;
  }
  const uint64_t length = integer(*buffer, "byteLength").value_or(0);
  if (length > bytes.size()) fail(place, "its buffer is shorter than its byteLength");
  return bytes.substr(0, length);
}

/// Of a buffer view, or of its compressed data.
std::string_view GltfData::range(const Json& view, const std::string& place) {
  const auto index = integer(view, "buffer");
  if (!index) fail(place, "its bufferView has no buffer");
  const std::string_view bytes = buffer(*index, place);
  const uint64_t offset = integer(view, "byteOffset").value_or(0), length = integer(view, "byteLength").value_or(0);
  if (offset > bytes.size() || length > bytes.size() - offset) fail(place, "its bufferView is longer than its buffer");
  return bytes.substr(offset, length);
}

/// By EXT_meshopt_compression. The library asserts the parameters that are checked here.
std::string GltfData::decompressed(const Json& compressed, const std::string& place) {
#ifdef FROND_HAS_MESHOPTIMIZER
  const std::string_view bytes = range(compressed, place), mode = text(compressed, "mode");
  const std::string_view filter = text(compressed, "filter");
  const uint64_t count = integer(compressed, "count").value_or(0),
                 stride = integer(compressed, "byteStride").value_or(0);
  constexpr uint64_t kLargestStride = 256, kLargestFactor = 1024;  // data are compressed by less
  const bool is_vertices = mode == "ATTRIBUTES", is_triangles = mode == "TRIANGLES";
  const bool is_octahedral = filter == "OCTAHEDRAL", is_quaternion = filter == "QUATERNION";
  const bool is_known = is_vertices
                            ? stride % 4 == 0 && stride > 0 && stride <= kLargestStride
                            : (stride == 2 || stride == 4) && (is_triangles ? count % 3 == 0 : mode == "INDICES");
  const bool is_filter_known =
      filter.empty() || filter == "NONE" ||
      (is_vertices && (filter == "EXPONENTIAL" || (is_octahedral && stride <= 8) || (is_quaternion && stride == 8)));
  if (!is_known || !is_filter_known || count > kLargestFactor * (bytes.size() + 1) / stride)
    fail(place, "the parameters of " + std::string(kMeshopt) + " are not those of a version that is read");
  std::string result(count * stride, '\0');
  const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
  const int error = is_vertices    ? meshopt_decodeVertexBuffer(result.data(), count, stride, from, bytes.size())
                    : is_triangles ? meshopt_decodeIndexBuffer(result.data(), count, stride, from, bytes.size())
                                   : meshopt_decodeIndexSequence(result.data(), count, stride, from, bytes.size());
  if (error != 0) fail(place, "its data by " + std::string(kMeshopt) + " are damaged");
  if (is_octahedral) meshopt_decodeFilterOct(result.data(), count, stride);
  if (is_quaternion) meshopt_decodeFilterQuat(result.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(result.data(), count, stride);
  return result;
#else
  (void)compressed;
  fail(place, "its values are compressed by " + std::string(kMeshopt) + ", which this build of frond does not read");
#endif
}

/// A view with compressed data names its bytes in the extension; its own buffer may be a fallback without content.
std::string_view GltfData::view(uint64_t index, const std::string& place) {
  const Json* view = element(file_.document, "bufferViews", index);
  if (!view) fail(place, "its accessor names a bufferView that does not exist");
  const Json* compressed = extension(*view, kMeshopt);
  if (!compressed) return range(*view, place);
  const auto [entry, is_new] = views_.try_emplace(index);
  if (is_new) entry->second = decompressed(*compressed, place);
  return entry->second;
}

struct GltfData::Elements {
  std::string_view bytes;  ///< from the first element
  uint64_t stride;         ///< bytes from an element to the next
};

/// Checks that all elements are inside their view.
GltfData::Elements GltfData::elements(const Json& part, uint64_t component, uint64_t count, size_t width,
                                      const std::string& place) {
  const auto index = integer(part, "bufferView");
  if (!index) fail(place, "its sparse accessor is incomplete");
  std::string_view bytes = view(*index, place);
  const uint64_t size = component_of(component, place).size * width, offset = integer(part, "byteOffset").value_or(0);
  const uint64_t given = integer(*element(file_.document, "bufferViews", *index), "byteStride").value_or(0);
  const uint64_t stride = given > 0 ? given : size;
  constexpr uint64_t kLargestStride = 1 << 16;
  if (stride > kLargestStride || offset > bytes.size() || stride * (count - 1) + size > bytes.size() - offset)
    fail(place, "its accessor is longer than its bufferView");
  return {bytes.substr(offset), stride};
}

/// Normalized integers: c / 127 and so on, of signed ones at least -1 (3.11 of the specification).
template <class T>
std::vector<T> GltfData::numbers(uint64_t index, size_t width, const std::string& place) {
  constexpr std::array<std::string_view, 17> kTypes{"", "SCALAR", "VEC2", "VEC3", "VEC4", "", "", "",    "",
                                                    "", "",       "",     "",     "",     "", "", "MAT4"};
  constexpr uint64_t kMostElements = uint64_t(1) << 32;
  const Json* accessor = element(file_.document, "accessors", index);
  if (!accessor) fail(place, "it names an accessor that does not exist");
  const uint64_t count = integer(*accessor, "count").value_or(0);
  if (count == 0 || count > kMostElements) fail(place, "its accessor has no count, or one above 2^32");
  const Component& component = component_of(integer(*accessor, "componentType").value_or(0), place);
  if (text(*accessor, "type") != kTypes[width])
    fail(place, "it is " + std::string(text(*accessor, "type")) + ", which is to be " + std::string(kTypes[width]));
  if (std::is_integral_v<T> && (component.most == 0 || component.code == 5120 || component.code == 5122))
    fail(place, "it is of floats or signed integers, which are to be unsigned integers");
  const Json* normalized = member(*accessor, "normalized");
  const bool is_fraction = component.most > 0 && normalized && normalized->is_boolean() && normalized->get<bool>();
  const auto load = [&](const char* from) {
    const double value = value_of(component.code, from);
    return T(is_fraction ? std::max(value / component.most, -1.0) : value);
  };
  constexpr uint64_t kMostZeros = 1 << 24;
  if (!member(*accessor, "bufferView") && count > kMostZeros)
    fail(place, "its accessor has no bufferView, and many values");
  std::vector<T> values(count * width);
  if (member(*accessor, "bufferView")) {
    const Elements all = elements(*accessor, component.code, count, width, place);
    for (uint64_t i = 0; i < count; ++i)
      for (size_t k = 0; k < width; ++k)
        values[i * width + k] = load(all.bytes.data() + i * all.stride + k * component.size);
  }
  const Json* sparse = member(*accessor, "sparse");
  if (!sparse) return values;
  const uint64_t changed = integer(*sparse, "count").value_or(0);
  const Json *indices = member(*sparse, "indices"), *replaced = member(*sparse, "values");
  if (changed == 0 || changed > count || !indices || !replaced) fail(place, "its sparse accessor is incomplete");
  const Component& index_component = component_of(integer(*indices, "componentType").value_or(0), place);
  const Elements at = elements(*indices, index_component.code, changed, 1, place);
  const Elements from = elements(*replaced, component.code, changed, width, place);
  for (uint64_t i = 0; i < changed; ++i) {
    const double element = value_of(index_component.code, at.bytes.data() + i * at.stride);
    if (!(element >= 0 && element < double(count)))
      fail(place, "its sparse accessor changes an element that it does not have");
    for (size_t k = 0; k < width; ++k)
      values[size_t(element) * width + k] = load(from.bytes.data() + i * from.stride + k * component.size);
  }
  return values;
}

template std::vector<float> GltfData::numbers(uint64_t, size_t, const std::string&);
template std::vector<uint32_t> GltfData::numbers(uint64_t, size_t, const std::string&);

}  // namespace frond
