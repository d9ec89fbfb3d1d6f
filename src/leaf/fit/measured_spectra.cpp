#include "leaf/fit/measured_spectra.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "leaf/tissue/constants.h"
#include "spectra/tabulated.h"
#include "system/csv_fields.h"
#include "system/file_bytes.h"

namespace frond::leaf {
namespace {

enum class Column : uint8_t { wavelength, r, t, theta, side, leaf, other };

using Field = CsvField;

std::string lower(std::string_view s) {
  std::string result(s);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

char separator_of(std::string_view line) {
  for (const char c : {';', '\t', ','})
    if (line.find(c) != line.npos) return c;
  return ' ';
}

/// "Reflectance (%)" is "reflectance".
Column column_of(std::string_view name) {
  const std::string word = lower(trimmed(name.substr(0, std::min(name.find_first_of("([/"), name.size()))));
  const auto is = [&word](std::initializer_list<std::string_view> names) {
    return std::ranges::find(names, word) != names.end();
  };
  if (is({"wavelength", "wavelength_nm", "wavelengths", "nm", "lambda", "lambda_nm", "wvl", "wl"}))
    return Column::wavelength;
  if (is({"r", "reflectance", "refl", "r_mean", "reflectance_mean"})) return Column::r;
  if (is({"t", "transmittance", "trans", "tran", "t_mean", "transmittance_mean"})) return Column::t;
  if (is({"theta_deg", "theta", "angle", "angle_deg", "incidence_deg"})) return Column::theta;
  if (is({"side"})) return Column::side;
  if (is({"leaf", "material", "sample", "name"})) return Column::leaf;
  return Column::other;
}

class Reader {
 public:
  /// `all`: reads every leaf, and collects the errors of each.
  Reader(const std::string& name, const SpectraMeasurement& how, bool all)
      : how_(how), all_(all), where_{std::make_shared<const std::string>(name), 0, 1} {}

  void line(std::string_view text) {
    ++where_.line;
    const std::string_view content = trimmed(text);
    if (content.empty() || content.front() == '#') return;
    if (!separator_) separator_ = separator_of(text);
    const std::vector<Field> fields = split_fields(text, *separator_, where_);
    if (columns_.empty()) {
      if (begin(fields)) return;
    }
    row(fields);
  }

  std::vector<MeasuredLeaf> finish_all() {
    if (columns_.empty() || entries_.empty()) fail(where_, "there are no spectra in this file");
    scale();
    std::vector<MeasuredLeaf> result;
    for (Entry& e : entries_) result.push_back({std::move(e.name), std::move(e.spectra), std::move(e.error)});
    return result;
  }

  MeasuredSpectra finish() {
    if (columns_.empty()) fail(where_, "there are no spectra in this file");
    if (how_.leaf.empty() && leaves_.size() > 1) {
      constexpr size_t kNamed = 12;
      const std::vector<std::string> named(leaves_.begin(),
                                           std::next(leaves_.begin(), ptrdiff_t(std::min(leaves_.size(), kNamed))));
      fail(first_row_, "the file has {} leaves: {} selects one of {}{}{}", leaves_.size(), how_.leaf_option,
           fmt::join(named, ", "), leaves_.size() > kNamed ? ", ..." : "",
           how_.all_option.empty() ? "" : fmt::format("; {} takes all", how_.all_option));
    }
    if (!how_.leaf.empty() && !leaves_.contains(how_.leaf)) {
      if (leaves_.empty()) fail(first_row_, "the file has no names of leaves: {} has no effect", how_.leaf_option);
      const std::string_view meant = nearest(how_.leaf, std::vector<std::string_view>(leaves_.begin(), leaves_.end()));
      fail(first_row_, "there is no leaf \"{}\" in this file{}", how_.leaf,
           meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant));
    }
    if (entries_.empty()) return {};
    scale();
    return std::move(entries_[0].spectra);
  }

 private:
  /// Returns true if the line held column names.
  bool begin(const std::vector<Field>& fields) {
    first_row_ = where_;
    if (field_number(fields[0].text, *separator_)) {
      if (fields.size() < 2 || fields.size() > 3)
        fail(where_,
             "a file without names of columns has wavelength, R and, if there are three, T: here are {} columns",
             fields.size());
      columns_ = {Column::wavelength, Column::r};
      if (fields.size() == 3) columns_.push_back(Column::t);
      return false;
    }
    for (const Field& f : fields) {
      columns_.push_back(column_of(f.text));
      if (f.text.find('%') == f.text.npos && lower(f.text).find("percent") == std::string::npos) continue;
      if (columns_.back() == Column::r) units_[0] = Unit::percent;
      if (columns_.back() == Column::t) units_[1] = Unit::percent;
    }
    for (const Column once : {Column::wavelength, Column::r, Column::t, Column::theta, Column::side, Column::leaf})
      if (std::ranges::count(columns_, once) > 1)
        fail(where_, "two columns have the same name: wavelength, R, T, theta_deg, side and leaf occur at most once");
    if (std::ranges::count(columns_, Column::wavelength) == 0)
      fail(where_, "there is no column of wavelengths: \"wavelength_nm\", \"nm\" or \"wavelength\"");
    if (std::ranges::count(columns_, Column::r) + std::ranges::count(columns_, Column::t) == 0)
      fail(where_, "there is neither a column of reflectances, \"R\", nor one of transmittances, \"T\"");
    return true;
  }

  /// Measurements of one leaf.
  struct Entry {
    std::string name;
    MeasuredSpectra spectra = {};
    std::vector<std::array<Field, 2>> fields = {};  ///< R and T of the measurements
    std::string error = {};
  };

  /// Returns the entry for a row, which all leaves share unless all are read; nullptr if the row is of another leaf.
  Entry* entry_of(const std::vector<Field>& fields) {
    const auto column = static_cast<size_t>(std::ranges::find(columns_, Column::leaf) - columns_.begin());
    std::string name;
    if (column < columns_.size() && column < fields.size()) {
      name = fields[column].text;
      leaves_.insert(name);
      if (!all_ && !how_.leaf.empty() && name != how_.leaf) return nullptr;
    }
    const auto [place, is_new] = places_.try_emplace(all_ ? name : std::string(), entries_.size());
    if (is_new) entries_.push_back({place->first});
    return &entries_[place->second];
  }

  void row(const std::vector<Field>& fields) {
    Entry* const entry = entry_of(fields);
    if (!entry || !entry->error.empty()) return;
    if (!all_ || (entry->name.empty() && fields.size() != columns_.size())) {
      add(fields, *entry);
      return;
    }
    try {
      add(fields, *entry);
    } catch (const InputError& e) {
      entry->error = e.what();
    }
  }

  void add(const std::vector<Field>& fields, Entry& entry) {
    if (fields.size() != columns_.size())
      fail(where_, "{} fields, but the file has {} columns", fields.size(), columns_.size());
    LeafMeasurement measurement{0, how_.theta_deg, {}, {}};
    std::array of_row{fields[0], fields[0]};
    bool is_below = false;
    for (size_t i = 0; i < fields.size(); ++i) {
      const auto& [text, where] = fields[i];
      switch (columns_[i]) {
        case Column::wavelength:
          measurement.lambda_nm = wavelength(fields[i]);
          break;
        case Column::r:
          measurement.r = value(fields[i], "R");
          of_row[0] = fields[i];
          break;
        case Column::t:
          measurement.t = value(fields[i], "T");
          of_row[1] = fields[i];
          break;
        case Column::theta: {
          const auto theta = field_number(text, *separator_);
          if (!theta || !(*theta >= 0 && *theta <= 180))
            fail(where, "theta_deg is from 0 to 180 degrees, \"{}\" was given", text);
          measurement.theta_deg = *theta;
          break;
        }
        case Column::side:
          is_below = below(fields[i]);
          break;
        case Column::leaf:
        case Column::other:
          break;
      }
    }
    if (is_below && measurement.theta_deg <= 90) measurement.theta_deg = 180 - measurement.theta_deg;
    if (measurement.theta_deg == 90) fail(where_, "light along the leaf, at 90 degrees, meets neither side");
    if ((!measurement.r && !measurement.t) || !kConstantsRange_nm.contains(measurement.lambda_nm)) {
      ++entry.spectra.left_out;
      return;
    }
    entry.spectra.measurements.push_back(measurement);
    entry.fields.push_back(of_row);
  }

  double wavelength(const Field& field) const {
    const auto number = field_number(field.text, *separator_);
    if (!number || !(*number > 0 && std::isfinite(*number)))
      fail(field.where, "a wavelength in nm is a number above 0, \"{}\" was given", field.text);
    return *number < kLeast_nm ? *number * 1000 : *number;
  }

  /// None if a field is empty or marks a missing number.
  std::optional<double> value(const Field& field, std::string_view what) const {
    const std::string word = lower(field.text);
    if (word.empty() || word == "nan" || word == "na" || word == "null" || word == "-") return {};
    const auto number = field_number(field.text, *separator_);
    constexpr double kLeast = -5, kMost = 150;  // range accepted: noise about 0, and percentages
    if (!number || !(*number >= kLeast && *number <= kMost)) refuse_share(field.where, what, field.text);
    return number;
  }

  static bool below(const Field& field) {
    const std::string word = lower(field.text);
    if (word == "abaxial" || word == "lower" || word == "below" || word == "back") return true;
    if (word == "adaxial" || word == "upper" || word == "above" || word == "front") return false;
    fail(field.where, "a side is adaxial (upper) or abaxial (lower), \"{}\" was given", field.text);
  }

  [[noreturn]] static void refuse_share(const Location& where, std::string_view what, std::string_view given) {
    fail(where, "{} is a share of the light, from 0 to 1 or in percent; \"{}\" was given", what, given);
  }

  using Share = std::optional<double> LeafMeasurement::*;
  static constexpr std::array<Share, 2> kShares{&LeafMeasurement::r, &LeafMeasurement::t};
  static constexpr std::array<std::string_view, 2> kNames{"R", "T"};
  enum class Unit : uint8_t { unknown, fraction, percent };

  /// Returns the unit that a column's values show: a few that are too large for fractions are mistakes, or noise.
  Unit unit_of(Share share) const {
    constexpr double kLargestFraction = 1.5;
    size_t all = 0, large = 0;
    double most = 0;
    for (const Entry& e : entries_)
      for (const LeafMeasurement& m : e.spectra.measurements)
        if (m.*share) ++all, large += *(m.*share) > kLargestFraction ? 1 : 0, most = std::max(most, *(m.*share));
    if (2 * large > all) return Unit::percent;
    return all > 0 && most <= 1 ? Unit::fraction : Unit::unknown;
  }

  /// Decides for the columns whose names have no unit. If the values of one are in percent, those of the other are too,
  /// unless they look like fractions: then the names of the columns must tell.
  void find_units() {
    if (units_[0] != Unit::unknown || units_[1] != Unit::unknown) {
      for (size_t i = 0; i < 2; ++i)
        if (units_[i] == Unit::unknown) units_[i] = unit_of(kShares[i]);
      return;
    }
    for (size_t i = 0; i < 2; ++i) units_[i] = unit_of(kShares[i]);
    for (size_t i = 0; i < 2; ++i) {
      if (units_[i] != Unit::percent || units_[1 - i] == Unit::percent) continue;
      if (units_[1 - i] == Unit::fraction)
        fail(first_row_,
             "{} looks like percent and {} like fractions: name the columns with their units, as in \"{} (%)\"",
             kNames[i], kNames[1 - i], kNames[i]);
      units_[1 - i] = Unit::percent;
    }
  }

  /// Converts percent, and refuses what no spectrometer gives.
  void scale() {
    find_units();
    for (Entry& e : entries_) {
      if (!all_) {
        scale(e);
        continue;
      }
      try {
        scale(e);
      } catch (const InputError& error) {
        if (e.error.empty()) e.error = error.what();
      }
    }
  }

  void scale(Entry& entry) {
    constexpr double kNoise = 0.05;
    std::array<bool, 2> is_there{};
    for (size_t row = 0; row < entry.spectra.measurements.size(); ++row) {
      LeafMeasurement& measurement = entry.spectra.measurements[row];
      for (size_t i = 0; i < 2; ++i) {
        std::optional<double>& share = measurement.*kShares[i];
        if (!share) continue;
        is_there[i] = true;
        const bool is_in_percent = units_[i] == Unit::percent;
        if (is_in_percent) *share /= 100;
        if (*share < -kNoise || *share > 1 + kNoise)
          fail(entry.fields[row][i].where, "{} is a share of the light, from 0 to 1{}; \"{}\" was given", kNames[i],
               is_in_percent ? " or, as in this column, from 0 to 100 percent"
                             : " (most values of this column are not in percent)",
               entry.fields[row][i].text);
      }
      const double sum = measurement.r.value_or(0) + measurement.t.value_or(0);
      if (sum > 1 + kNoise) fail(entry.fields[row][0].where, "R + T is {:.4g}: a leaf scatters 1 at most", sum);
    }
    std::string& in_percent = entry.spectra.in_percent;
    for (size_t i = 0; i < 2; ++i)
      if (is_there[i] && units_[i] == Unit::percent)
        in_percent += fmt::format("{}{}", in_percent.empty() ? "" : " and ", kNames[i]);
  }

  const SpectraMeasurement& how_;
  bool all_;
  Location where_, first_row_;
  std::optional<char> separator_;
  std::vector<Column> columns_;
  std::set<std::string> leaves_;
  std::vector<Entry> entries_;
  std::map<std::string, size_t> places_;  ///< of entries, by name
  std::array<Unit, 2> units_{};           ///< of R and T
};

}  // namespace

namespace {

void read_lines(std::string_view text, Reader& reader) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    reader.line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace

MeasuredSpectra parse_measured_spectra(std::string_view text, const std::string& name, const SpectraMeasurement& how) {
  Reader reader(name, how, false);
  read_lines(text, reader);
  return reader.finish();
}

std::vector<MeasuredLeaf> parse_measured_leaves(std::string_view text, const std::string& name,
                                                const SpectraMeasurement& how) {
  Reader reader(name, how, true);
  read_lines(text, reader);
  return reader.finish_all();
}

std::vector<MeasuredLeaf> read_measured_leaves(const std::filesystem::path& path, const SpectraMeasurement& how) {
  return parse_measured_leaves(read_file_bytes(path, {}, "measured spectra"), path.string(), how);
}

MeasuredSpectra read_measured_spectra(const std::filesystem::path& path, const SpectraMeasurement& how) {
  return parse_measured_spectra(read_file_bytes(path, {}, "measured spectra"), path.string(), how);
}

}  // namespace frond::leaf
