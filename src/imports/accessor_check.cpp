#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "imports/gltf_accessors.h"
#include "imports/gltf_json.h"

namespace frond {
namespace {

using Json = nlohmann::json;

/// Values of componentType: OpenGL's constants.
constexpr uint64_t kFloat = 5126, kByte = 5121, kShort = 5123, kInt = 5125;

/// Returns the size of a component, bytes; 0 if the type is unknown.
uint64_t size_of(uint64_t component) {
  if (component == 5120 || component == kByte) return 1;
  if (component == 5122 || component == kShort) return 2;
  return component == kInt || component == kFloat ? 4 : 0;
}

/// Returns the values of a type, for messages.
std::string name_of(uint64_t component) {
  constexpr const char* kNames[] = {"bytes", "unsigned bytes", "shorts", "unsigned shorts",
                                    "",      "unsigned ints",  "floats"};
  return component >= 5120 && component <= kFloat && component != 5124 ? kNames[component - 5120] : "an unknown type";
}

/// Checks one accessor.
class AccessorCheck {
 public:
  AccessorCheck(const Json& document, std::string place, bool is_binary)
      : document_(document), place_(std::move(place)), is_binary_(is_binary) {}

  uint64_t check(uint64_t index, AccessorUse use) const {
    const Json* accessor = element(document_, "accessors", index);
    if (!accessor) fail("it names an accessor that does not exist");
    const auto count = integer(*accessor, "count");
    if (!count || *count == 0 || *count > kMostElements) fail("its accessor has no count, or one above 2^32");
    const uint64_t component = integer(*accessor, "componentType").value_or(0);
    check_type(*accessor, component, use);
    const uint64_t size = size_of(component) * (use == AccessorUse::indices               ? 1
                                                : use == AccessorUse::texture_coordinates ? 2
                                                                                          : 3);
    const Json* sparse = member(*accessor, "sparse");
    if (const auto view = integer(*accessor, "bufferView")) {
      const uint64_t stride = check_view(*view, integer(*accessor, "byteOffset").value_or(0), *count, size);
      if (sparse && stride != size) fail("its accessor is sparse, of interleaved values, which is not read");
    } else if (!sparse) {
      fail("its accessor has no bufferView: its values are compressed by an extension that is not read, or all 0");
    }
    if (sparse) check_sparse(*sparse, *count, size);
    return *count;
  }

 private:
  static constexpr uint64_t kMostElements = uint64_t(1) << 32;

  [[noreturn]] void fail(const std::string& problem) const { throw std::runtime_error(place_ + ": " + problem); }

  /// Whether the library reads the values correctly: it copies bytes without conversion.
  void check_type(const Json& accessor, uint64_t component, AccessorUse use) const {
    const std::string_view shape = text(accessor, "type");
    const bool is_index = use == AccessorUse::indices;
    const std::string_view wanted = is_index ? "SCALAR" : use == AccessorUse::texture_coordinates ? "VEC2" : "VEC3";
    const bool is_read =
        is_index ? component == kByte || component == kShort || component == kInt : component == kFloat;
    if (shape == wanted && is_read) return;
    const Json* normalized = member(accessor, "normalized");
    const bool is_normalized = normalized && normalized->is_boolean() && normalized->get<bool>();
    fail("it is " + std::string(shape) + " of " + (is_normalized ? "normalized " : "") + name_of(component) +
         ", read is " + std::string(wanted) + " of " + (is_index ? "unsigned integers" : "floats") +
         ": export the model without quantization");
  }

  /// Whether the accessor's bytes are inside the view and the view inside the buffer: the library does not check it.
  uint64_t check_view(uint64_t index, uint64_t offset, uint64_t count, uint64_t size) const {
    const Json* view = element(document_, "bufferViews", index);
    if (!view) fail("its accessor names a bufferView that does not exist");
    const auto buffer_index = integer(*view, "buffer");
    const Json* buffer = element(document_, "buffers", buffer_index);
    if (!buffer) fail("its bufferView names a buffer that does not exist");
    const bool is_chunk = is_binary_ && *buffer_index == 0;
    if (!member(*buffer, "uri") && !is_chunk) fail("its buffer has no uri: its values are those of an extension");
    if (const Json* extensions = member(*buffer, "extensions"))
      for (const auto& [name, extension] : extensions->items())
        if (const Json* fallback = member(extension, "fallback"); fallback && *fallback == true)
          fail("its values are compressed by " + name + ", which is not read");
    const uint64_t stride = integer(*view, "byteStride").value_or(0) > 0 ? *integer(*view, "byteStride") : size;
    constexpr uint64_t kLargestStride = 1 << 16;
    const uint64_t length = integer(*view, "byteLength").value_or(0);
    if (stride > kLargestStride || offset + stride * (count - 1) + size > length)
      fail("its accessor is longer than its bufferView");
    if (integer(*view, "byteOffset").value_or(0) + length > integer(*buffer, "byteLength").value_or(0))
      fail("its bufferView is longer than its buffer");
    return stride;
  }

  /// The values that are changed, and their indices.
  void check_sparse(const Json& sparse, uint64_t count, uint64_t size) const {
    const auto changed = integer(sparse, "count");
    const Json *indices = member(sparse, "indices"), *values = member(sparse, "values");
    if (!changed || *changed == 0 || *changed > count || !indices || !values) fail("its sparse accessor is incomplete");
    const uint64_t component = integer(*indices, "componentType").value_or(0);
    if (component != kByte && component != kShort && component != kInt)
      fail("the indices of its sparse accessor are " + name_of(component));
    const auto check = [&](const Json& part, uint64_t each) {
      const auto view = integer(part, "bufferView");
      if (!view) fail("its sparse accessor is incomplete");
      if (check_view(*view, integer(part, "byteOffset").value_or(0), *changed, each) != each)
        fail("its sparse accessor is interleaved, which is not read");
    };
    check(*indices, size_of(component));
    check(*values, size);
  }

  const Json& document_;
  std::string place_;
  bool is_binary_;
};

}  // namespace

uint64_t check_accessor(const Json& document, uint64_t index, AccessorUse use, const std::string& place,
                        bool is_binary) {
  return AccessorCheck(document, place, is_binary).check(index, use);
}

}  // namespace frond
