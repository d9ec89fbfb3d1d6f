#include "spectra/spd_file.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "core/messages/excerpt.h"
#include "spectra/envi_library.h"
#include "spectra/named.h"
#include "spectra/spectra_text.h"
#include "system/text_table.h"

namespace frond {
namespace {

constexpr std::string_view kSpectrumLine = "a spectrum file has a wavelength (nm) and a value in each line";

/// Reads alternating wavelengths and values, in lines of any length.
std::vector<SpectrumPoint> read_pairs(TextTable& table) {
  std::vector<SpectrumPoint> points;
  bool has_value = true, is_odd = true;
  size_t rows = 0;
  for (; table.next(); ++rows) {
    if (!table.is_blank_separated() && table.fields().size() != 2)
      fail(table.where(),
           "a line has a wavelength (nm) and a value, {} numbers are here; a first line that names the "
           "columns tells more of them apart",
           table.fields().size());
    is_odd = is_odd && table.fields().size() % 2 == 1 && table.fields().size() == table.columns();
    for (size_t i = 0; i < table.fields().size(); ++i, has_value = !has_value) {
      const double value = table.number(i, kSpectrumLine);
      if (has_value) points.push_back({value, 0, table.where(i)});
      points.back().value = value;
    }
  }
  // Lines of three numbers or more are a table, not pairs.
  if (is_odd && rows > 1 && table.columns() > 1)
    fail(points[0].where,
         "each line has {} numbers, a wavelength (nm) and a value are expected; a first line that "
         "names the columns tells them apart",
         table.columns());
  if (!has_value)
    fail(points.back().where, "wavelength {} nm has no value: the file ends after it", points.back().lambda_nm);
  return points;
}

/// Names of columns for a message, limited in number and length.
std::string listed(const TextTable& table, const std::vector<size_t>& columns) {
  constexpr size_t kMost = 16, kLength = 40;
  std::string text;
  for (size_t i = 0; i < std::min(columns.size(), kMost); ++i)
    text += fmt::format("{}\"{}\"", i > 0 ? ", " : "", table.names()[columns[i]].text.substr(0, kLength));
  return text + (columns.size() > kMost ? ", ..." : "");
}

/// Brings the points in ascending order; of several at one wavelength the first remains.
void sort(std::vector<SpectrumPoint>& points) {
  std::ranges::stable_sort(points, {}, &SpectrumPoint::lambda_nm);
  const auto rest = std::ranges::unique(points, {}, &SpectrumPoint::lambda_nm);
  points.erase(rest.begin(), rest.end());
}

/// A table whose first line names its columns.
class NamedColumns {
 public:
  /// `of_instrument`: the file of an instrument or a library, whose R or T is meant, in percent where its name says so.
  NamedColumns(TextTable& table, bool of_instrument) : table_(table), of_instrument_(of_instrument) {
    const auto& names = table.names();
    wavelength_ = wavelength_column(names).value_or(0);
    for (size_t i = 0; i < names.size(); ++i)
      if (i != wavelength_ && !names[i].text.empty()) values_.push_back(i);
    if (values_.empty())
      fail(table.names_where(),
           "a spectrum file has a column of wavelengths (nm) and one of values: this line is no "
           "pair of numbers, and does not name two columns");
  }

  std::vector<SpectrumPoint> read(std::string_view wanted) {
    std::vector<std::vector<double>> values(values_.size());
    std::vector<SpectrumPoint> points;
    while (table_.next()) {
      table_.check_fields();
      points.push_back({table_.number(wavelength_, kSpectrumLine), 0, table_.where(wavelength_)});
      for (size_t c = 0; c < values_.size(); ++c)
        if (values_.size() == 1 || is_wanted(c, wanted) || (wanted.empty() && is_share(c)))
          values[c].push_back(table_.number(values_[c], kSpectrumLine));
    }
    for (SpectrumPoint& p : points) p.lambda_nm *= is_in_micrometres(table_.names()[wavelength_].text) ? 1000 : 1;
    if (points.empty()) fail(table_.names_where(), "the file holds no spectrum: no line of numbers follows this one");
    // pandas writes wavelengths that are an index without a name.
    if (table_.names()[wavelength_].text.empty() && points[0].lambda_nm == 1)
      fail(points[0].where, "there is no column of wavelengths: this one has no name and counts rows");
    // Names are quoted now that the file is known to be a table of numbers.
    const size_t chosen = choose(wanted);
    const double scale =
        of_instrument_ && table_.names()[values_[chosen]].text.find('%') != std::string_view::npos ? 0.01 : 1;
    for (size_t i = 0; i < points.size(); ++i) points[i].value = scale * values[chosen][i];
    // Detectors of an instrument overlap, and libraries descend.
    if (of_instrument_) sort(points);
    return points;
  }

 private:
  bool is_share(size_t c) const {
    const std::string name = name_without_unit(table_.names()[values_[c]].text);
    return of_instrument_ && (name == "r" || name == "t" || name.starts_with("reflect") || name.starts_with("tgt."));
  }
  bool is_wanted(size_t c, std::string_view wanted) const {
    return lower_case(table_.names()[values_[c]].text) == lower_case(wanted);
  }
  size_t choose(std::string_view wanted) const {
    const auto is = [&](std::string_view text) {
      std::vector<size_t> found;
      for (size_t c = 0; c < values_.size(); ++c)
        if (is_wanted(c, text)) found.push_back(c);
      return found;
    };
    if (wanted.empty() && values_.size() == 1) return 0;
    if (wanted.empty())
      for (size_t c = 0; c < values_.size(); ++c)
        if (is_share(c)) return c;
    const auto found = wanted.empty() ? std::vector<size_t>{} : is(wanted);
    if (found.size() == 1) return found[0];
    if (found.size() > 1) fail(table_.names_where(), "there are {} columns \"{}\"", found.size(), wanted);
    if (!wanted.empty())
      fail(table_.names_where(), "there is no column \"{}\"; there are {}", wanted, listed(table_, values_));
    fail(table_.names_where(), "there are {} columns of values, {}: FILE:COLUMN takes one of them, as in \"{}:{}\"",
         values_.size(), listed(table_, values_), std::filesystem::path(*table_.names_where().file).filename().string(),
         table_.names()[values_[0]].text);
  }

  TextTable& table_;
  bool of_instrument_;
  size_t wavelength_ = 0;
  std::vector<size_t> values_;  ///< columns
};

}  // namespace

std::vector<SpectrumPoint> parse_spd_points(std::string_view text, const std::string& name, std::string_view column) {
  const SpectraText recognised = spectra_text(text);
  TextTable table(recognised.text, name, TableComments::anywhere);
  if (table.columns() == 0)
    fail(table.names_where(), "the file holds no spectrum: wavelength (nm) and value in turn are expected");
  if (!column.empty() && !table.has_names())
    fail(table.names_where(), "there is no line that names the columns, so that \"{}\" could be one of them", column);
  std::vector<SpectrumPoint> points =
      table.has_names() ? NamedColumns(table, !recognised.layout.empty()).read(column) : read_pairs(table);
  check_points(points);
  return points;
}

SpectrumColumn spectrum_column(const std::filesystem::path& path) {
  const std::string text = path.string();
  const size_t colon = text.rfind(':');
  std::error_code error;
  if (colon == text.npos || colon == 0 || std::filesystem::exists(path, error) ||
      !std::filesystem::is_regular_file(text.substr(0, colon), error))
    return {path, {}};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

std::string spectrum_name(const std::filesystem::path& path) {
  const auto [file, column] = spectrum_column(path);
  return column.empty() ? file.stem().string() : column;
}

bool is_spectrum_file(std::string_view word, const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 4> kEndings{".spd", ".csv", ".tsv", ".txt"};
  const auto names = spectrum_names();
  if (std::ranges::find(names, word) != names.end()) return false;
  std::error_code error;
  return std::ranges::any_of(kEndings, [&](std::string_view ending) { return word.ends_with(ending); }) ||
         std::filesystem::is_regular_file(spectrum_column(path).file, error);
}

std::vector<SpectrumPoint> read_spd_points(const std::filesystem::path& path, const Location& where) {
  const auto [file, column] = spectrum_column(path);
  if (is_foreign(path)) mark_foreign(file);
  return parse_spd_points(read_spectra_text(file, where, "spectrum file"), file.string(), column);
}

SpectrumPtr read_spd(const std::filesystem::path& path, const Location& where) {
  return make_tabulated(read_spd_points(path, where));
}

SpectrumPtr named_or_read_spectrum(std::string_view word, const std::filesystem::path& path, const Location& where) {
  return is_spectrum_file(word, path) ? read_spd(path, where) : named_spectrum(word, where);
}

}  // namespace frond
