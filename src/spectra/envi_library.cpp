#include "spectra/envi_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <map>
#include <optional>
#include <vector>

#include "core/messages/excerpt.h"
#include "core/units/number.h"
#include "system/file_bytes.h"
#include "system/lower_case.h"
#include "system/trimmed.h"

namespace frond {
namespace {

/// A header: lines "key = value"; values in braces are lists, over any number of lines.
class Header {
 public:
  Header(std::string_view text, const Location& where) : where_(where) {
    if (!text.starts_with("ENVI")) fail(where, "the header of a spectral library begins with \"ENVI\"");
    while (!text.empty()) {
      const size_t equals = text.find('=');
      if (equals == text.npos) break;
      const std::string_view before = text.substr(0, equals);
      const size_t line = before.rfind('\n');
      const size_t begin = std::min(text.find_first_not_of(" \t", equals + 1), text.size());
      const bool is_list = begin < text.size() && text[begin] == '{';
      const size_t end = std::min(text.find(is_list ? '}' : '\n', begin), text.size());
      fields_[lower_case(trimmed(before.substr(line == before.npos ? 0 : line + 1)))] =
          trimmed(text.substr(begin + (is_list ? 1 : 0), end - begin - (is_list ? 1 : 0)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }

  std::string_view text(std::string_view key) const {
    const auto found = fields_.find(key);
    return found == fields_.end() ? std::string_view() : found->second;
  }
  std::optional<double> number(std::string_view key) const {
    const auto value = parse_number(text(key));
    return value && std::isfinite(*value) ? value : std::nullopt;
  }
  /// A whole number within limits that keep all products exact.
  size_t count(std::string_view key, std::optional<double> otherwise = {}) const {
    constexpr double kMost = 1e8;
    const auto value = text(key).empty() ? otherwise : number(key);
    if (!value || !(*value >= 0 && *value <= kMost) || *value != std::floor(*value))
      fail(where_, "the header of a spectral library has a line \"{} = NUMBER\"", key);
    return static_cast<size_t>(*value);
  }
  std::vector<std::string_view> list(std::string_view key) const {
    std::vector<std::string_view> items;
    for (std::string_view rest = text(key); !rest.empty();) {
      const size_t comma = std::min(rest.find(','), rest.size());
      items.push_back(trimmed(rest.substr(0, comma)));
      rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return items;
  }

 private:
  const Location& where_;
  std::map<std::string, std::string_view, std::less<>> fields_;
};

/// Type of the values: "data type" of the header.
struct DataType {
  size_t number, bytes;
  double (*value)(const std::byte*);
};

template <class T>
double value_of(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return double(value);
}

template <class T>
constexpr DataType type_of(size_t number) {
  return {number, sizeof(T), value_of<T>};
}

constexpr std::array kTypes{type_of<uint8_t>(1), type_of<int16_t>(2),   type_of<int32_t>(3),  type_of<float>(4),
                            type_of<double>(5),  type_of<uint16_t>(12), type_of<uint32_t>(13)};

/// Wavelengths of the header, as the first column: its name and its fields.
std::vector<std::string> wavelength_fields(const Header& header, size_t bands, const Location& where) {
  const auto listed = header.list("wavelength");
  if (listed.size() != bands)
    fail(where, "the header of a spectral library lists the wavelength of each of its {} samples: {} are listed", bands,
         listed.size());
  const std::string unit = lower_case(header.text("wavelength units"));
  const bool is_um = unit.starts_with("micro") || unit == "um";
  if (!is_um && !unit.empty() && !unit.starts_with("nano") && unit != "nm" && unit != "unknown")
    fail(where, "the wavelengths of a spectral library are in nanometres or micrometres, not in \"{}\"", unit);
  std::vector<std::string> fields{is_um ? "wavelength(um)" : "wavelength(nm)"};
  for (const std::string_view nm : listed) {
    if (!parse_number(nm)) fail(where, "a wavelength of a spectral library is not a number");
    fields.emplace_back(nm);
  }
  return fields;
}

std::optional<std::filesystem::path> existing(std::initializer_list<std::filesystem::path> paths) {
  std::error_code error;
  for (const auto& path : paths)
    if (std::filesystem::is_regular_file(path, error)) return path;
  return {};
}

std::filesystem::path with_ending(std::filesystem::path path, const char* ending) { return path += ending; }

}  // namespace

std::string envi_library_table(std::string_view header_text, std::string_view data, const Location& where) {
  const Header header(header_text, where);
  if (lower_case(header.text("file type")) != "envi spectral library")
    fail(where, "the header is that of an image, \"{}\": a spectral library is expected", header.text("file type"));
  const size_t bands = header.count("samples"), spectra = header.count("lines"),
               offset = header.count("header offset", 0);
  const size_t number = header.count("data type");
  const auto* const type = std::ranges::find(kTypes, number, &DataType::number);
  if (type == kTypes.end()) fail(where, "the data type {} of a spectral library is not supported", number);
  const size_t bytes = offset + bands * spectra * type->bytes;
  if (bands == 0 || spectra == 0 || data.size() < bytes)
    fail(where, "a spectral library of {} spectra of {} samples has {} bytes of data, {} are here", spectra, bands,
         bytes, data.size());
  const bool is_float = type->number == 4;
  const bool is_swapped = header.count("byte order", 0) != 0;
  const auto factor = header.number("reflectance scale factor"), ignored = header.number("data ignore value");
  const auto names = header.list("spectra names");
  const std::vector<std::string> wavelengths = wavelength_fields(header, bands, where);

  std::string table = fmt::format("{}\n{}", kEnviLibrary, wavelengths[0]);
  for (size_t i = 0; i < spectra; ++i) {
    std::string name =
        i < names.size() && !names[i].empty() ? std::string(names[i]) : fmt::format("spectrum {}", i + 1);
    std::erase_if(name, [](char c) { return c == '"' || c == '\n' || c == '\r'; });
    table += fmt::format(",\"{}\"", name);
  }
  for (size_t band = 0; band < bands; ++band) {
    table += '\n' + wavelengths[band + 1];
    for (size_t i = 0; i < spectra; ++i) {
      std::array<std::byte, 8> value{};
      std::memcpy(value.data(), data.data() + offset + (i * bands + band) * type->bytes, type->bytes);
      if (is_swapped) std::reverse(value.begin(), value.begin() + ptrdiff_t(type->bytes));
      const double v = type->value(value.data()), share = factor && *factor != 0 ? v / *factor : v;
      // The shortest digits of 32-bit floats, so that 0.1 is read as 0.1.
      table += v == ignored ? ","
               : is_float   ? fmt::format(",{}", static_cast<float>(share))
                            : fmt::format(",{}", share);
    }
  }
  return table + '\n';
}

std::string read_spectra_text(const std::filesystem::path& path, const Location& where, std::string_view what) {
  const std::string ending = lower_case(path.extension().string());
  const bool is_data = ending == ".sli" || ending == ".slb";
  std::string text = read_file_bytes(path, where, what);
  if (!is_data && ending != ".hdr") return text;
  const std::filesystem::path stem = std::filesystem::path(path).replace_extension();
  const auto other = is_data
                         ? existing({with_ending(stem, ".hdr"), with_ending(path, ".hdr"), with_ending(stem, ".HDR")})
                         : existing({with_ending(stem, ".sli"), with_ending(stem, ".slb"), stem});
  const Location file{std::make_shared<const std::string>(path.string()), 0, 0};
  if (!other)
    fail(file, "a spectral library of ENVI is two files: {}{} is missing", stem.filename().string(),
         is_data ? ".hdr" : ".sli");
  if (is_foreign(path)) mark_foreign(*other);
  std::string second = read_file_bytes(*other, where, what);
  if (!is_data) text.swap(second);
  return envi_library_table(second, text, file);
}

}  // namespace frond
