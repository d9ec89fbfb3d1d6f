#include "leaf/table/table_file.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "system/csv_fields.h"
#include "system/file_bytes.h"

namespace frond::leaf {
namespace {

enum Column : size_t { kTheta, kWavelength, kRs, kRd, kT, kRsError, kRdError, kTError, kColumns };
constexpr std::string_view kNames[kColumns] = {"theta_deg", "wavelength_nm", "Rs", "Rd", "T", "Rs_se", "Rd_se", "T_se"};
constexpr size_t kRequired = kT + 1;
/// Columns that instruments write in addition and that follow from the others.
constexpr std::string_view kPassedOver[] = {"R", "A", "R_se", "A_se"};
constexpr std::string_view kErrorComment = "# error ";

using Field = CsvField;

struct Row {
  std::array<double, kColumns> value{};
  Location where;

  Shares shares() const { return {value[kRs], value[kRd], value[kT]}; }
  Shares errors() const { return {value[kRsError], value[kRdError], value[kTError]}; }
};

/// Column of each field of a row; kColumns: ignored.
class Header {
 public:
  explicit Header(const std::vector<Field>& fields) {
    for (const auto& [name, where] : fields) {
      columns_.push_back(column(name, where));
      if (columns_.back() == kColumns) continue;
      if (has_[columns_.back()]) fail(where, "there are two columns \"{}\"", name);
      has_[columns_.back()] = true;
    }
    for (size_t c = 0; c < kRequired; ++c)
      if (!has_[c]) fail(fields[0].where, "there is no column \"{}\"; {}", kNames[c], expected());
    if (has_errors() != (has_[kRdError] && has_[kTError]) || has_[kRdError] != has_[kTError])
      fail(fields[0].where, "the columns Rs_se, Rd_se and T_se come together or not at all");
  }

  bool has_errors() const { return has_[kRsError]; }
  Row row(const std::vector<Field>& fields) const {
    if (fields.size() != columns_.size())
      fail(fields[0].where, "{} fields, but the file has {} columns", fields.size(), columns_.size());
    Row row{.where = fields[0].where};
    for (size_t i = 0; i < fields.size(); ++i)
      if (columns_[i] != kColumns) row.value[columns_[i]] = checked(columns_[i], fields[i]);
    const double sum = row.value[kRs] + row.value[kRd] + row.value[kT];
    constexpr double kRounding = 1e-6;
    if (sum > 1 + kRounding) fail(row.where, "Rs + Rd + T is {:.7g}: a leaf scatters 1 at most", sum);
    return row;
  }

 private:
  static std::string expected() {
    return fmt::format("a leaf's table has the columns {}, and may have {}",
                       fmt::join(std::begin(kNames), std::begin(kNames) + kRequired, ","),
                       fmt::join(std::begin(kNames) + kRequired, std::end(kNames), ","));
  }

  static size_t column(std::string_view name, const Location& where) {
    if (std::ranges::find(kPassedOver, name) != std::end(kPassedOver)) return kColumns;
    const auto* found = std::ranges::find(kNames, name);
    if (found != std::end(kNames)) return static_cast<size_t>(found - kNames);
    const std::string_view meant = nearest(name, {std::begin(kNames), std::end(kNames)});
    fail(where, "there is no column \"{}\" in a leaf's table{}; {}", name,
         meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant), expected());
  }

  static double checked(size_t column, const Field& field) {
    const auto number = field_number(field.text, ',');
    if (!number) fail(field.where, "{} is a number, \"{}\" was given", kNames[column], field.text);
    const double v = *number;
    if (column == kTheta && !(v >= 0 && v <= 180)) fail(field.where, "theta_deg is from 0 to 180, {} was given", v);
    if (column == kWavelength && !(v > 0 && std::isfinite(v)))
      fail(field.where, "wavelength_nm is above 0, {} was given", v);
    if (column >= kRs && !(v >= 0 && v <= 1))
      fail(field.where, "{} is a share of the light, from 0 to 1; {} was given", kNames[column], v);
    return v;
  }

  std::vector<size_t> columns_;
  std::array<bool, kColumns> has_{};
};

/// All rows of one wavelength, in the file's order.
using Spectrum = std::vector<Row>;

void add(std::vector<Spectrum>& spectra, std::map<double, size_t>& known, const Row& row) {
  const double nm = row.value[kWavelength], theta = row.value[kTheta];
  const auto [place, is_new] = known.emplace(nm, spectra.size());
  if (is_new) spectra.emplace_back();
  Spectrum& rows = spectra[place->second];
  if (!rows.empty() && !(theta > rows.back().value[kTheta]))
    fail(row.where, "theta_deg {} comes after {} at {} nm (line {}): angles ascend, each once for a wavelength", theta,
         rows.back().value[kTheta], nm, rows.back().where.line);
  rows.push_back(row);
}

[[noreturn]] void fail_missing(const Row& row, double theta, const Row& of_other) {
  fail(row.where, "{} nm has no row for theta_deg {}, which {} nm has (line {}): all wavelengths need the same angles",
       row.value[kWavelength], theta, of_other.value[kWavelength], of_other.where.line);
}

void check_same_angles(const Spectrum& first, const Spectrum& other) {
  for (size_t i = 0; i < std::max(first.size(), other.size()); ++i) {
    if (i >= other.size()) fail_missing(other.back(), first[i].value[kTheta], first[i]);
    if (i >= first.size()) fail_missing(first.back(), other[i].value[kTheta], other[i]);
    const double a = first[i].value[kTheta], b = other[i].value[kTheta];
    if (a < b) fail_missing(other[i], a, first[i]);
    if (b < a) fail_missing(first[i], b, other[i]);
  }
}

Table assemble(const std::vector<Spectrum>& spectra, bool has_errors) {
  Table table;
  for (const Row& row : spectra[0]) table.theta_deg.push_back(row.value[kTheta]);
  for (const Spectrum& rows : spectra) {
    check_same_angles(spectra[0], rows);
    table.wavelengths_nm.push_back(rows[0].value[kWavelength]);
    for (const Row& row : rows) {
      table.shares.push_back(row.shares());
      if (has_errors) table.standard_errors.push_back(row.errors());
    }
  }
  if (table.theta_deg.front() > 90)
    fail(spectra[0][0].where,
         "all angles are above 90, on the abaxial side: those of the adaxial side are missing; give angles up to 90 "
         "alone for a leaf that is the same on both");
  return table;
}

}  // namespace

std::string to_csv(const Table& table, std::string_view header) {
  std::string text = fmt::format("{}{}{}\n", header, kErrorComment, table.error);
  const bool has_errors = !table.standard_errors.empty();
  text += fmt::format("{}\n", fmt::join(std::begin(kNames), has_errors ? std::end(kNames) : kNames + kRequired, ","));
  const auto out = std::back_inserter(text);
  const size_t angles = table.theta_deg.size();
  for (size_t i = 0; i < table.shares.size(); ++i) {
    const Shares& s = table.shares[i];
    fmt::format_to(out, "{},{},{},{},{}", table.theta_deg[i % angles], table.wavelengths_nm[i / angles], s.surface,
                   s.subsurface, s.transmitted);
    if (has_errors) {
      const Shares& e = table.standard_errors[i];
      fmt::format_to(out, ",{},{},{}", e.surface, e.subsurface, e.transmitted);
    }
    text += '\n';
  }
  return text;
}

Table parse_table(std::string_view text, const std::string& name) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  Location here{std::make_shared<const std::string>(name), 1, 1};
  if (text.find('\0') != text.npos) fail(here, "not a text file: a leaf table is a CSV file");
  std::optional<Header> header;
  std::vector<Spectrum> spectra;
  std::map<double, size_t> known;
  double error = 0;
  for (; !text.empty(); ++here.line) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with(kErrorComment))
      error = field_number(trimmed(line.substr(kErrorComment.size())), ',').value_or(0);
    if (trimmed(line).empty() || trimmed(line)[0] == '#') continue;
    if (header)
      add(spectra, known, header->row(split_fields(line, ',', here)));
    else
      header.emplace(split_fields(line, ',', here));
  }
  if (spectra.empty())
    fail(here, "the table is empty: {}a row for each angle and wavelength is expected",
         header ? "" : "a line with the names of the columns and then ");
  Table table = assemble(spectra, header->has_errors());
  table.error = error;
  return table;
}

bool is_leaf_table(std::string_view text) {
  if (text.find('\0') != text.npos) return true;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (trimmed(line).empty() || trimmed(line)[0] == '#') continue;
    return std::ranges::any_of(split_fields(line, ',', {}),
                               [](const Field& f) { return f.text == kNames[kRs] || f.text == kNames[kRd]; });
  }
  return true;
}

Table read_table(const std::filesystem::path& path, const Location& where) {
  return parse_table(read_file_bytes(path, where, "leaf table"), path.string());
}

}  // namespace frond::leaf
