#include "models/gltf_json.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "system/utf8.h"

namespace frond {
namespace {

using Json = nlohmann::json;
using Event = Json::parse_event_t;

constexpr size_t kDeepest = 200;

/// Takes a chunk of a binary file: its content, of a type.
std::string_view take_chunk(std::string_view& rest, std::string_view type) {
  constexpr size_t kHeader = 8;
  if (rest.size() < kHeader) throw std::runtime_error("it is cut short");
  uint32_t length = 0;
  std::memcpy(&length, rest.data(), 4);
  if (rest.substr(4, 4) != type) throw std::runtime_error("it has no chunk \"" + std::string(type.substr(0, 3)) + "\"");
  if (length > rest.size() - kHeader) throw std::runtime_error("it is cut short");
  const std::string_view content = rest.substr(kHeader, length);
  rest.remove_prefix(kHeader + length);
  return content;
}

/// Returns the chunks of a binary file: JSON, and bytes or nothing.
std::pair<std::string_view, std::string_view> chunks(std::string_view file) {
  constexpr size_t kHeader = 12;
  if (file.size() < kHeader) throw std::runtime_error("it is cut short");
  uint32_t version = 0;
  std::memcpy(&version, file.data() + 4, 4);
  if (version != 2)
    throw std::runtime_error("its binary format is that of glTF " + std::to_string(version) + ", which is not read");
  file.remove_prefix(kHeader);
  const std::string_view json = take_chunk(file, "JSON");
  return {json, file.empty() ? file : take_chunk(file, std::string_view("BIN\0", 4))};
}

/// Replaces bytes that are not UTF-8, which some exporters write in names; nothing here depends on names.
std::string as_utf8(std::string_view bytes) {
  std::string out(bytes);
  for (size_t i = 0; i < out.size();) {
    const size_t length = utf8_length(std::string_view(out).substr(i));
    if (length == 0) out[i] = '?';
    i += std::max<size_t>(length, 1);
  }
  return out;
}

}  // namespace

GltfFile parse_gltf(std::string_view file) {
  const bool is_binary = file.starts_with("glTF");
  const auto [json, bytes] = is_binary ? chunks(file) : std::pair(file, std::string_view());
  std::string text = as_utf8(json);
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
    return {Json::parse(text, observe), is_binary, bytes};
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

std::vector<double> numbers(const Json& object, std::string_view key, std::vector<double> otherwise) {
  const Json* array = member(object, key);
  if (!array || !array->is_array() || array->size() != otherwise.size()) return otherwise;
  for (size_t i = 0; i < otherwise.size(); ++i)
    if ((*array)[i].is_number()) otherwise[i] = (*array)[i].get<double>();
  return otherwise;
}

const Json* extension(const Json& object, std::string_view name) {
  const Json* all = member(object, "extensions");
  return all ? member(*all, name) : nullptr;
}

std::string_view text(const Json& object, std::string_view key) {
  const Json* value = member(object, key);
  return value && value->is_string() ? std::string_view(value->get_ref<const std::string&>()) : std::string_view();
}

}  // namespace frond
