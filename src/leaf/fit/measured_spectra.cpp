#include "leaf/fit/measured_spectra.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "leaf/tissue/constants.h"
#include "spectra/envi_library.h"
#include "spectra/spectra_text.h"
#include "spectra/tabulated.h"
#include "system/text_table.h"

namespace frond::leaf {
namespace {

/// The first three are shares of the light.
enum Column : uint8_t { kR, kT, kA, kWavelength, kTheta, kSide, kLeaf, kOther };
constexpr size_t kShares = 3;
constexpr std::array<std::string_view, kShares> kShareNames{"R", "T", "A"};

/// "Reflectance (%)" is a reflectance.
Column column_of(std::string_view name) {
  const std::string word = name_without_unit(name);
  const auto is = [&word](std::initializer_list<std::string_view> names) {
    return std::ranges::find(names, word) != names.end();
  };
  if (names_wavelengths(name)) return kWavelength;
  if (is({"r", "reflectance", "refl", "reflect.", "tgt.", "r_mean", "reflectance_mean"})) return kR;
  if (is({"t", "transmittance", "trans", "tran", "t_mean", "transmittance_mean"})) return kT;
  if (is({"a", "absorptance", "a_mean", "absorptance_mean"})) return kA;
  if (is({"theta_deg", "theta", "angle", "angle_deg", "incidence_deg"})) return kTheta;
  if (is({"side"})) return kSide;
  if (is({"leaf", "material", "sample", "name"})) return kLeaf;
  return kOther;
}

class Reader {
 public:
  /// `all`: reads every leaf, and collects the errors of each.
  Reader(std::string_view text, const std::string& name, const SpectraMeasurement& how, bool all)
      : how_(how), all_(all), text_(spectra_text(text)), table_(text_.text, name) {
    if (table_.columns() == 0) return;
    layout_ = text_.layout;
    begin();
    first_row_ = table_.names_where();
    while (table_.next()) row();
  }

  std::vector<MeasuredLeaf> finish_all() {
    if (columns_.empty() || entries_.empty()) fail(table_.names_where(), "there are no spectra in this file");
    scale();
    std::vector<MeasuredLeaf> result;
    for (Entry& e : entries_) result.push_back({std::move(e.name), std::move(e.spectra), std::move(e.error)});
    return result;
  }

  MeasuredSpectra finish() {
    if (columns_.empty()) fail(table_.names_where(), "there are no spectra in this file");
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
  /// Finds the columns by their names.
  void begin() {
    if (!table_.has_names()) {
      if (table_.columns() < 2 || table_.columns() > 3)
        fail(table_.names_where(),
             "a file without names of columns has wavelength, R and, if there are three, T: here are {} columns",
             table_.columns());
      columns_ = {kWavelength, kR};
      if (table_.columns() == 3) columns_.push_back(kT);
      return;
    }
    for (const TableField& name : table_.names()) columns_.push_back(column_of(name.text));
    for (const Column once : {kR, kT, kA, kWavelength, kTheta, kSide, kLeaf})
      if (std::ranges::count(columns_, once) > 1)
        fail(table_.names_where(),
             "two columns have the same name: wavelength, R, T, A, theta_deg, side and leaf occur at most once");
    // pandas writes wavelengths that are an index without a name.
    if (!has(kWavelength) && table_.names()[0].text.empty()) columns_[0] = kWavelength;
    if (!has(kWavelength)) begin_rows();
    if (!has(kWavelength))
      fail(table_.names_where(), "there is no column of wavelengths: \"wavelength_nm\", \"nm\" or \"wavelength\"");
    if (!has(kR) && !has(kT) && !has(kA)) begin_columns();
    if (!has(kR) && !has(kT))
      fail(table_.names_where(), "there is neither a column of reflectances, \"R\", nor one of transmittances, \"T\"");
    // Absorptance follows from R and T; where one of them is missing, the other one follows from it.
    if (has(kR) && has(kT)) std::ranges::replace(columns_, kA, kOther);
    for (size_t i = 0; i < columns_.size(); ++i) {
      const std::string_view name = table_.names()[i].text;
      if (columns_[i] < kShares &&
          (name.find('%') != name.npos || lower_case(name).find("percent") != std::string::npos))
        units_[columns_[i]] = Unit::percent;
      if (columns_[i] == kOther && !name.empty()) unused_.emplace_back(name);
    }
  }

  void add_layout(const std::string& text) { layout_ += (layout_.empty() ? "" : "; ") + text; }

  /// Whether libraries name the spectra in a column of this name: "Sample_ID", "spectrum", "leaf id".
  static bool names_leaves(std::string_view name) {
    const std::string word = lower_case(name);
    const auto has = [&word](std::string_view part) { return word.find(part) != word.npos; };
    return has("sample") || has("leaf") || has("spectr") || word == "id";
  }

  /// A spectrum in each row, in columns that are named by wavelengths.
  void begin_rows() {
    WavelengthNames named = wavelength_names(table_.names());
    if (named.columns.empty()) return;
    std::optional<size_t> label;
    for (size_t i = 0; i < columns_.size(); ++i)
      if (!label && (columns_[i] == kLeaf || names_leaves(table_.names()[i].text))) label = i;
    for (size_t i = 0; i < columns_.size(); ++i) {
      const bool is_value = std::ranges::find(named.columns, i) != named.columns.end();
      if (!is_value && label != i && !table_.names()[i].text.empty()) unused_.emplace_back(table_.names()[i].text);
    }
    add_layout(fmt::format("a spectrum in each row, {} wavelengths, taken as R", named.columns.size()));
    table_.unpivot(std::move(named.columns), std::move(named.nm), label);
    columns_ = {kLeaf, kWavelength, kR};
  }

  /// A spectrum in each column, under the name of its leaf. Columns of what is no share of the light are refused.
  void begin_columns() {
    std::vector<size_t> values;
    std::vector<std::string> names;
    for (size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i] != kOther || table_.names()[i].text.empty()) continue;
      const std::string name = lower_case(table_.names()[i].text);
      for (const std::string_view other :
           {"radiance", "irradiance", "counts", "reference", "target", "absorbance", "emissivity", "transm"})
        if (name.find(other) != name.npos) return;
      values.push_back(i), names.emplace_back(table_.names()[i].text);
    }
    if (values.empty() || has(kTheta) || has(kSide) || has(kLeaf)) return;
    if (values.size() == 1) {
      // A name of a file, as ASD's, says as little as none; another name says that this is something else.
      if (text_.layout.empty() && names[0].find('.') == std::string::npos) return;
      columns_[values[0]] = kR;
      add_layout(fmt::format("\"{}\" is taken as R", names[0]));
      return;
    }
    add_layout(fmt::format("a spectrum in each of {} columns, taken as R", values.size()));
    const auto wavelength = static_cast<size_t>(std::ranges::find(columns_, kWavelength) - columns_.begin());
    table_.unpivot(std::move(values), std::move(names), wavelength);
    columns_ = {kWavelength, kLeaf, kR};
  }

  bool has(Column column) const { return std::ranges::find(columns_, column) != columns_.end(); }

  /// A share in a row, as the text states it.
  struct Given {
    std::optional<double> value = {};
    std::string text = {};
    Location where = {};
  };
  /// Measurements of one leaf.
  struct Entry {
    std::string name;
    MeasuredSpectra spectra = {};
    std::vector<std::array<Given, kShares>> given = {};  ///< shares of the measurements
    std::string error = {};
  };

  /// Returns the entry for a row, which all leaves share unless all are read; nullptr if the row is of another leaf.
  Entry* entry_of() {
    const auto column = static_cast<size_t>(std::ranges::find(columns_, kLeaf) - columns_.begin());
    std::string name;
    if (column < columns_.size() && column < table_.fields().size()) {
      name = table_.fields()[column].text;
      leaves_.insert(name);
      if (!all_ && !how_.leaf.empty() && name != how_.leaf) return nullptr;
    }
    const auto [place, is_new] = places_.try_emplace(all_ ? name : std::string(), entries_.size());
    if (is_new) {
      entries_.push_back({place->first});
      entries_.back().spectra.unused = unused_;
      entries_.back().spectra.layout = layout_;
    }
    return &entries_[place->second];
  }

  void row() {
    Entry* const entry = entry_of();
    if (!entry || !entry->error.empty()) return;
    if (!all_ || (entry->name.empty() && table_.fields().size() != columns_.size())) {
      add(*entry);
      return;
    }
    try {
      add(*entry);
    } catch (const InputError& e) {
      entry->error = e.what();
    }
  }

  void add(Entry& entry) {
    table_.check_fields();
    LeafMeasurement measurement{0, how_.theta_deg, {}, {}};
    std::array<Given, kShares> given;
    bool is_below = false;
    for (size_t i = 0; i < columns_.size(); ++i) {
      const std::string_view text = table_.fields()[i].text;
      switch (columns_[i]) {
        case kWavelength:
          measurement.lambda_nm = wavelength(i);
          break;
        case kR:
        case kT:
        case kA:
          given[columns_[i]] = share(i, kShareNames[columns_[i]]);
          break;
        case kTheta: {
          const auto theta = table_.number(text);
          if (!theta || !(*theta >= 0 && *theta <= 180))
            fail(table_.where(i), "theta_deg is from 0 to 180 degrees, \"{}\" was given", text);
          measurement.theta_deg = *theta;
          break;
        }
        case kSide:
          is_below = below(i);
          break;
        case kLeaf:
        case kOther:
          break;
      }
    }
    if (is_below && measurement.theta_deg <= 90) measurement.theta_deg = 180 - measurement.theta_deg;
    if (measurement.theta_deg == 90) fail(table_.where(), "light along the leaf, at 90 degrees, meets neither side");
    if ((!given[kR].value && !given[kT].value) || !kConstantsRange_nm.contains(measurement.lambda_nm)) {
      ++entry.spectra.left_out;
      return;
    }
    entry.spectra.measurements.push_back(measurement);
    entry.given.push_back(std::move(given));
  }

  double wavelength(size_t field) const {
    const std::string_view text = table_.fields()[field].text;
    const auto number = table_.number(text);
    if (!number || !(*number > 0 && std::isfinite(*number)))
      fail(table_.where(field), "a wavelength in nm is a number above 0, \"{}\" was given", text);
    if (*number == 1 && table_.has_names() && table_.names()[field].text.empty())
      fail(table_.where(field), "there is no column of wavelengths: this one has no name and counts rows");
    return *number < kLeast_nm ? *number * 1000 : *number;
  }

  /// No value if a field is empty or marks a missing number.
  Given share(size_t field, std::string_view what) const {
    const std::string_view text = table_.fields()[field].text;
    const std::string word = lower_case(text);
    if (word.empty() || word == "nan" || word == "na" || word == "null" || word == "-") return {};
    const auto number = table_.number(text);
    constexpr double kLeast = -5, kMost = 150;  // range accepted: noise about 0, and percentages
    if (!number || !(*number >= kLeast && *number <= kMost)) reject_share(table_.where(field), what, text);
    return {number, std::string(text), table_.where(field)};
  }

  bool below(size_t field) const {
    const std::string word = lower_case(table_.fields()[field].text);
    if (word == "abaxial" || word == "lower" || word == "below" || word == "back") return true;
    if (word == "adaxial" || word == "upper" || word == "above" || word == "front") return false;
    fail(table_.where(field), "a side is adaxial (upper) or abaxial (lower), \"{}\" was given",
         table_.fields()[field].text);
  }

  [[noreturn]] static void reject_share(const Location& where, std::string_view what, std::string_view given) {
    fail(where, "{} is a share of the light, from 0 to 1 or in percent; \"{}\" was given", what, given);
  }

  enum class Unit : uint8_t { unknown, fraction, percent };

  /// Returns the unit that a column's values show: a few that are too large for fractions are mistakes, or noise.
  Unit unit_of(size_t share) const {
    constexpr double kLargestFraction = 1.5;
    size_t all = 0, large = 0;
    double most = 0;
    for (const Entry& e : entries_)
      for (const auto& given : e.given)
        if (const auto& v = given[share].value)
          ++all, large += *v > kLargestFraction ? 1 : 0, most = std::max(most, *v);
    if (2 * large > all) return Unit::percent;
    return all > 0 && most <= 1 ? Unit::fraction : Unit::unknown;
  }

  /// Decides for the columns whose names have no unit. If the values of one column are in percent, the values of the
  /// others are too, unless they look like fractions: then the names of the columns must state the unit.
  void find_units() {
    const bool is_named = std::ranges::count(units_, Unit::unknown) < std::ptrdiff_t(kShares);
    for (size_t i = 0; i < kShares; ++i)
      if (units_[i] == Unit::unknown) units_[i] = unit_of(i);
    if (is_named) return;
    const auto percent = std::ranges::find(units_, Unit::percent);
    if (percent == units_.end()) return;
    const auto i = size_t(percent - units_.begin());
    for (size_t j = 0; j < kShares; ++j) {
      if (units_[j] == Unit::fraction)
        fail(first_row_,
             "{} looks like percent and {} like fractions: name the columns with their units, as in \"{} (%)\"",
             kShareNames[i], kShareNames[j], kShareNames[i]);
      units_[j] = Unit::percent;
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

  /// Share of 1; nullopt if the row has none.
  std::optional<double> share_of(const Given& given, size_t share) const {
    if (!given.value) return {};
    const bool is_in_percent = units_[share] == Unit::percent;
    const double value = is_in_percent ? *given.value / 100 : *given.value;
    if (value < -kNoise || value > 1 + kNoise)
      fail(given.where, "{} is a share of the light, from 0 to 1{}; \"{}\" was given", kShareNames[share],
           is_in_percent ? " or, as in this column, from 0 to 100 percent"
                         : " (most values of this column are not in percent)",
           given.text);
    return value;
  }

  void scale(Entry& entry) const {
    std::array<bool, kShares> is_there{};
    for (size_t row = 0; row < entry.spectra.measurements.size(); ++row) {
      LeafMeasurement& measurement = entry.spectra.measurements[row];
      std::array<std::optional<double>, kShares> share;
      double sum = 0;
      std::string summed;
      for (size_t i = 0; i < kShares; ++i) {
        share[i] = share_of(entry.given[row][i], i);
        if (!share[i]) continue;
        is_there[i] = true;
        sum += *share[i];
        summed += fmt::format("{}{}", summed.empty() ? "" : " + ", kShareNames[i]);
      }
      const auto first = std::ranges::find_if(share, [](const auto& s) { return s.has_value(); });
      if (sum > 1 + kNoise)
        fail(entry.given[row][size_t(first - share.begin())].where, "{} is {:.4g}: {}", summed, sum,
             share[kA] ? "the shares of the light are 1 together" : "a leaf scatters 1 at most");
      if (share[kA]) (share[kR] ? share[kT] : share[kR]) = 1 - sum;
      measurement.r = share[kR], measurement.t = share[kT];
    }
    if (is_there[kA]) entry.spectra.derived = has(kR) ? 'T' : 'R';
    std::vector<std::string_view> in_percent;
    for (size_t i = 0; i < kShares; ++i)
      if (is_there[i] && units_[i] == Unit::percent) in_percent.push_back(kShareNames[i]);
    entry.spectra.in_percent = fmt::format("{}", fmt::join(in_percent, " and "));
  }

  static constexpr double kNoise = 0.05;

  const SpectraMeasurement& how_;
  bool all_;
  SpectraText text_;
  TextTable table_;
  Location first_row_;
  std::vector<Column> columns_;
  std::vector<std::string> unused_;  ///< names of columns
  std::string layout_;               ///< MeasuredSpectra::layout
  std::set<std::string> leaves_;
  std::vector<Entry> entries_;
  std::map<std::string, size_t> places_;  ///< of entries, by name
  std::array<Unit, kShares> units_{};
};

}  // namespace

MeasuredSpectra parse_measured_spectra(std::string_view text, const std::string& name, const SpectraMeasurement& how) {
  return Reader(text, name, how, false).finish();
}

std::vector<MeasuredLeaf> parse_measured_leaves(std::string_view text, const std::string& name,
                                                const SpectraMeasurement& how) {
  return Reader(text, name, how, true).finish_all();
}

std::vector<MeasuredLeaf> read_measured_leaves(const std::filesystem::path& path, const SpectraMeasurement& how) {
  return parse_measured_leaves(read_spectra_text(path, {}, "measured spectra"), path.string(), how);
}

MeasuredSpectra read_measured_spectra(const std::filesystem::path& path, const SpectraMeasurement& how) {
  return parse_measured_spectra(read_spectra_text(path, {}, "measured spectra"), path.string(), how);
}

}  // namespace frond::leaf
