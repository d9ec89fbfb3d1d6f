#include "spectra/response_file.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/messages/excerpt.h"
#include "spectra/envi_library.h"
#include "spectra/spd_file.h"
#include "spectra/spectra_text.h"

namespace frond {
namespace {

bool names_bands(const TableField& field) {
  const std::string name = name_without_unit(field.text);
  return name == "band" || name == "band_name" || name == "bandname" || name == "band name" || name == "channel";
}

/// Whether the column has the spread of another one, as "StDev [watts]" of Landsat's responses.
bool names_spread(std::string_view name) {
  const std::string lower = name_without_unit(name);
  return lower.starts_with("std") || lower.starts_with("stdev") || lower.ends_with("_se") || lower == "sd";
}

bool is_missing(std::string_view text) {
  const std::string lower = lower_case(text);
  return lower.empty() || lower == "nan" || lower == "na";
}

constexpr std::string_view kResponseLine = "a response is a number at each wavelength (nm)";

/// Sorts the points, makes noise about 0 zero, and removes zeros at both ends, which may be at any wavelengths.
void tidy(BandResponse& band) {
  constexpr double kNoise = 0.01;
  std::vector<SpectrumPoint>& points = band.points;
  if (points.empty()) return;
  std::ranges::stable_sort(points, {}, &SpectrumPoint::lambda_nm);
  const double largest = std::ranges::max_element(points, {}, &SpectrumPoint::value)->value;
  for (SpectrumPoint& p : points)
    if (p.value < 0 && p.value >= -kNoise * largest) p.value = 0;
  const auto is_lit = [](const SpectrumPoint& p) { return p.value != 0; };
  auto begin = std::ranges::find_if(points, is_lit);
  auto end = std::find_if(points.rbegin(), points.rend(), is_lit).base();
  if (begin == points.end()) return points.clear();
  if (begin != points.begin()) --begin;
  if (end != points.end()) ++end;
  points = std::vector(begin, end);
  check_points(points);
}

/// The bands of a table whose first line names its columns.
std::vector<BandResponse> bands_of(TextTable& table) {
  const auto& names = table.names();
  const size_t wavelength = wavelength_column(names).value_or(0);
  const double to_nm = is_in_micrometres(names[wavelength].text) ? 1000 : 1;
  const auto label = std::ranges::find_if(names, names_bands);
  const auto label_column = size_t(label - names.begin());
  std::vector<size_t> columns;
  std::vector<BandResponse> bands;
  std::map<std::string, size_t, std::less<>> labels;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i == wavelength || i == label_column || names[i].text.empty() || names_spread(names[i].text)) continue;
    columns.push_back(i);
    if (label == names.end()) bands.push_back({std::string(names[i].text), {}});
  }
  if (columns.empty() || (label != names.end() && columns.size() > 1))
    fail(table.names_where(),
         "a table of responses has a column of wavelengths (nm) and one for each band, or columns "
         "of bands, wavelengths and responses");
  while (table.next()) {
    table.check_fields();
    const double nm = to_nm * table.number(wavelength, kResponseLine);
    if (!std::isfinite(nm)) fail(table.where(wavelength), "{} is not a wavelength in nm", nm);
    size_t band = 0;
    if (label != names.end()) {
      const std::string name(table.fields()[label_column].text);
      band = labels.try_emplace(name, bands.size()).first->second;
      if (band == bands.size()) bands.push_back({name, {}});
    }
    for (const size_t column : columns) {
      BandResponse& to = bands[band++];
      if (!is_missing(table.fields()[column].text))
        to.points.push_back({nm, table.number(column, kResponseLine), table.where(column)});
    }
  }
  return bands;
}

}  // namespace

std::vector<BandResponse> parse_responses(std::string_view text, const std::string& name, std::string_view column) {
  const SpectraText recognised = spectra_text(text);
  TextTable table(recognised.text, name, TableComments::anywhere);
  std::vector<BandResponse> bands;
  if (table.has_names())
    bands = bands_of(table);
  else
    bands.push_back({{}, parse_spd_points(text, name, column)});
  if (!column.empty()) {
    const auto is_other = [&](const BandResponse& b) { return lower_case(b.name) != lower_case(column); };
    if (std::ranges::all_of(bands, is_other)) {
      std::vector<std::string_view> others;
      for (const BandResponse& b : bands) others.push_back(b.name);
      fail(table.names_where(), "there is no band \"{}\"{}", column, suggestion(column, others));
    }
    std::erase_if(bands, is_other);
  }
  for (BandResponse& band : bands) tidy(band);
  if (column.empty() && bands.size() == 1 && std::ranges::none_of(table.names(), names_bands)) bands[0].name.clear();
  return bands;
}

std::vector<BandResponse> read_responses(const std::filesystem::path& path, const Location& where) {
  const auto [file, column] = spectrum_column(path);
  if (is_foreign(path)) mark_foreign(file);
  std::vector<BandResponse> bands =
      parse_responses(read_spectra_text(file, where, "spectrum file"), file.string(), column);
  if (bands.size() == 1 && bands[0].name.empty()) bands[0].name = spectrum_name(path);
  return bands;
}

}  // namespace frond
