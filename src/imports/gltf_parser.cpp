#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "imports/gltf_json.h"

namespace frond {
namespace {

using Json = nlohmann::json;
using Event = Json::parse_event_t;

constexpr size_t kDeepest = 200;

/// Returns the JSON of a binary file: its first chunk.
std::string_view json_chunk(std::string_view file) {
  constexpr size_t kHeader = 12, kChunkHeader = 8;
  if (file.size() < kHeader + kChunkHeader) throw std::runtime_error("it is cut short");
  uint32_t version = 0, length = 0;
  std::memcpy(&version, file.data() + 4, 4);
  std::memcpy(&length, file.data() + kHeader, 4);
  if (version != 2)
    throw std::runtime_error("its binary format is that of glTF " + std::to_string(version) + ", which is not read");
  if (file.substr(kHeader + 4, 4) != "JSON") throw std::runtime_error("its first chunk is not JSON");
  if (length > file.size() - kHeader - kChunkHeader) throw std::runtime_error("it is cut short");
  return file.substr(kHeader + kChunkHeader, length);
}

/// Replaces bytes that are not UTF-8, which some exporters write in names; nothing here depends on names.
std::string as_utf8(std::string_view bytes) {
  std::string out(bytes);
  for (size_t i = 0; i < out.size();) {
    const auto at = [&out](size_t k) { return k < out.size() ? static_cast<unsigned char>(out[k]) : 0u; };
    const unsigned c = at(i), next = at(i + 1);
    const auto follows = [&](size_t k) { return (at(i + k) & 0xc0) == 0x80; };
    size_t length = 0;
    if (c < 0x80)
      length = 1;
    else if (c >= 0xc2 && c < 0xe0 && follows(1))
      length = 2;
    else if (c >= 0xe0 && c < 0xf0 && follows(1) && follows(2) && !(c == 0xe0 && next < 0xa0) &&
             !(c == 0xed && next >= 0xa0))
      length = 3;
    else if (c >= 0xf0 && c < 0xf5 && follows(1) && follows(2) && follows(3) && !(c == 0xf0 && next < 0x90) &&
             !(c == 0xf4 && next >= 0x90))
      length = 4;
    if (length == 0) out[i] = '?';
    i += std::max<size_t>(length, 1);
  }
  return out;
}

}  // namespace

Json gltf_json(std::string_view file) {
  std::string text = as_utf8(file.starts_with("glTF") ? json_chunk(file) : file);
  text.resize(text.find_last_not_of(std::string_view("\0", 1)) + 1);  // padding that some exporters write
  std::vector<std::set<std::string>> keys;
  size_t depth = 0;
  const Json::parser_callback_t observe = [&](int, Event event, Json& value) {
    if (event == Event::object_start || event == Event::array_start) {
      if (++depth > kDeepest) throw std::runtime_error("its JSON is more than 200 levels deep");
      if (event == Event::object_start) keys.emplace_back();
    } else if (event == Event::object_end || event == Event::array_end) {
      --depth;
      if (event == Event::object_end) keys.pop_back();
    } else if (event == Event::key && !keys.back().insert(value.get<std::string>()).second) {
      throw std::runtime_error("an object of its JSON has \"" + value.get<std::string>() + "\" twice");
    }
    return true;
  };
  try {
    return Json::parse(text, observe);
  } catch (const Json::exception& error) {
    const std::string problem = error.what();
    const size_t end = problem.find("] ");  // of the name of the exception
    throw std::runtime_error("its JSON is damaged: " + (end == problem.npos ? problem : problem.substr(end + 2)));
  }
}

const Json* member(const Json& object, std::string_view key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

const Json* element(const Json& object, std::string_view key, std::optional<uint64_t> index) {
  const Json* array = member(object, key);
  return array && array->is_array() && index && *index < array->size() ? &(*array)[size_t(*index)] : nullptr;
}

std::optional<uint64_t> integer(const Json& object, std::string_view key) {
  constexpr uint64_t kMost = uint64_t(1) << 53;
  const Json* value = member(object, key);
  if (!value || !value->is_number_unsigned() || value->get<uint64_t>() >= kMost) return {};
  return value->get<uint64_t>();
}

double number(const Json& object, std::string_view key, double otherwise) {
  const Json* value = member(object, key);
  return value && value->is_number() ? value->get<double>() : otherwise;
}

std::string_view text(const Json& object, std::string_view key) {
  const Json* value = member(object, key);
  return value && value->is_string() ? std::string_view(value->get_ref<const std::string&>()) : std::string_view();
}

}  // namespace frond
