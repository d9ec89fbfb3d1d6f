#include "scene/geometry/npy.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

namespace frond {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kMagic = "\x93NUMPY";

/// Name and location of the data, for messages.
struct Source {
  std::string_view name;
  const Location& where;

  [[noreturn]] void reject(std::string_view why) const { fail(where, "{}: {}", name, why); }
};

/// Converts a Python literal of names, numbers, lists and tuples to JSON.
std::string to_json(std::string_view python) {
  std::string json;
  bool quoted = false;
  for (const char c : python) {
    if (c == '\'') quoted = !quoted;
    if (quoted && c != '\'') {
      json += c;
      continue;
    }
    if (c == ')' || c == ']' || c == '}')  // Python allows a comma before a closing bracket
      while (!json.empty() && (json.back() == ' ' || json.back() == ',')) json.pop_back();
    json += c == '\'' ? '"' : c == '(' ? '[' : c == ')' ? ']' : c;
    for (const auto& [word, value] : {std::pair{"True", "true"}, std::pair{"False", "false"}})
      if (json.ends_with(word)) json.replace(json.size() - std::strlen(word), std::string::npos, value);
  }
  return json;
}

/// Limit of a row, and of all numbers that describe one: their sums and products cannot overflow.
constexpr size_t kMostRowBytes = size_t{1} << 30;

/// Returns a * b, or a number above kMostRowBytes if either or the product is above it.
size_t limited_product(size_t a, size_t b) { return b != 0 && a > kMostRowBytes / b ? kMostRowBytes + 1 : a * b; }

/// Returns the size in a type such as "<f4"; 0 if there is none.
size_t size_of_type(const std::string& type) {
  const size_t digits = type.find_first_of("0123456789");
  if (digits == std::string::npos) return 0;
  size_t size = 0;
  const char* end = type.data() + type.size();
  const auto [stop, error] = std::from_chars(type.data() + digits, end, size);
  return error == std::errc() && stop == end ? size : 0;
}

/// numpy writes a shape of one dimension as a number or as a tuple. Dimensions are integers from 0.
std::vector<size_t> shape_of(const Json& json, const Source& source) {
  const auto dimension = [&source](const Json& number) {
    if (!number.is_number_unsigned()) source.reject("a shape holds integers from 0");
    return number.get<size_t>();
  };
  if (!json.is_array()) return {dimension(json)};
  std::vector<size_t> shape;
  for (const Json& number : json) shape.push_back(dimension(number));
  return shape;
}

/// Parses ["name", "type"] or ["name", "type", shape].
NpyField field_of(const Json& json, const Source& source) {
  NpyField field{.name = json.at(0), .type = json.at(1), .shape = {}};
  if (json.size() > 2) field.shape = shape_of(json.at(2), source);
  return field;
}

/// Returns the fields and rows of a header. Throws InputError for Fortran order and scalars.
NpyLayout layout_of(const Json& header, const Source& source) {
  NpyLayout layout;
  std::vector<size_t> shape = shape_of(header.at("shape"), source);
  if (header.at("fortran_order").get<bool>() && shape.size() > 1)
    source.reject("its columns stand one after another; numpy.ascontiguousarray puts its rows so");
  if (shape.empty()) source.reject("it holds a single value, not rows");
  layout.rows = shape[0];
  shape.erase(shape.begin());
  const Json& descr = header.at("descr");
  if (descr.is_string()) layout.fields.push_back({.name = "", .type = descr, .shape = shape});
  if (descr.is_array() && !shape.empty()) source.reject("it has rows of several records; one is needed in each");
  if (descr.is_array())
    for (const Json& json : descr) layout.fields.push_back(field_of(json, source));
  for (NpyField& field : layout.fields) {
    field.offset = layout.row_bytes;
    layout.row_bytes += field.bytes();
    if (layout.row_bytes > kMostRowBytes) source.reject(fmt::format("its rows have more than {} bytes", kMostRowBytes));
  }
  return layout;
}

template <class T>
T number_at(std::span<const std::byte> bytes, size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

size_t NpyField::count() const {
  size_t product = 1;
  for (const size_t n : shape) product = limited_product(product, n);
  return product;
}

size_t NpyField::bytes() const { return limited_product(count(), size_of_type(type)); }

/// Format versions 1.0 to 3.0 differ in the size of the header's length field.
NpyLayout read_npy_layout(std::span<const std::byte> file, std::string_view name, const Location& where,
                          uint64_t file_size) {
  const Source source{name, where};
  constexpr size_t kShort = 10, kLong = 12;
  if (file.size() < kLong || std::memcmp(file.data(), kMagic.data(), kMagic.size()) != 0)
    source.reject("it is no NumPy file: numpy.save writes them");
  const bool is_long = uint8_t(file[6]) > 1;
  const size_t start = is_long ? kLong : kShort;
  const size_t length = is_long ? number_at<uint32_t>(file, 8) : number_at<uint16_t>(file, 8);
  if (length > file.size() - start) source.reject("the file ends in its header");
  NpyLayout layout;
  try {
    const Json header = Json::parse(to_json({reinterpret_cast<const char*>(file.data()) + start, length}));
    layout = layout_of(header, source);
  } catch (const Json::exception&) {
    source.reject("its header is not one that numpy.save writes");
  }
  layout.begin = start + length;
  if (layout.row_bytes == 0 && layout.rows > 0) source.reject("its rows are empty");
  const size_t there =
      layout.row_bytes == 0 ? 0 : (std::max<uint64_t>(file_size, file.size()) - layout.begin) / layout.row_bytes;
  if (there < layout.rows)
    source.reject(fmt::format("the file is cut short: it says {} rows and has {}", layout.rows, there));
  return layout;
}

/// The header is padded so that the data are aligned, as numpy.save does.
std::string npy_header(std::span<const NpyField> fields, size_t rows) {
  std::string descr;
  for (const NpyField& field : fields) {
    std::string shape;
    for (const size_t n : field.shape) shape += fmt::format("{}, ", n);
    descr += fmt::format("('{}', '{}'{}), ", field.name, field.type, shape.empty() ? "" : ", (" + shape + ")");
  }
  constexpr size_t kStart = 10, kAlignment = 64;
  std::string dict = fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}", descr, rows);
  dict += std::string(kAlignment - (kStart + dict.size() + 1) % kAlignment, ' ') + '\n';
  std::string header(kMagic);
  header += '\x01';
  header += '\0';
  header += char(dict.size() & 0xff);
  header += char(dict.size() >> 8);
  return header + dict;
}

}  // namespace frond
