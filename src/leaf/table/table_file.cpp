#include "leaf/table/table_file.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>

#include "system/file_bytes.h"
#include "system/text_table.h"

namespace frond::leaf {
namespace {

enum TableColumn : size_t { kTheta, kWavelength, kRs, kRd, kT, kRsError, kRdError, kTError, kColumns };
constexpr std::string_view kTableColumns[kColumns] = {"theta_deg", "wavelength_nm", "Rs",    "Rd",
                                                      "T",         "Rs_se",         "Rd_se", "T_se"};
constexpr size_t kRequired = kT + 1;
/// Columns that instruments write in addition and that follow from the others.
constexpr std::string_view kPassedOver[] = {"R", "A", "R_se", "A_se"};
constexpr std::string_view kErrorComment = "# error ";

struct TableRow {
  std::array<double, kColumns> value{};
  Location where;

  Shares shares() const { return {value[kRs], value[kRd], value[kT]}; }
  Shares errors() const { return {value[kRsError], value[kRdError], value[kTError]}; }
};

/// Column of each field of a row; kColumns: ignored.
class Header {
 public:
  explicit Header(const TextTable& table) : table_(table) {
    const auto& names = table.names();
    if (names.empty()) fail(table.names_where(), "the first line has no names of columns; {}", expected());
    for (size_t i = 0; i < names.size(); ++i) {
      const Location where = table.names_where(i);
      columns_.push_back(column(names[i].text, where));
      if (columns_.back() == kColumns) continue;
      if (has_[columns_.back()]) fail(where, "there are two columns \"{}\"", names[i].text);
      has_[columns_.back()] = true;
    }
    for (size_t c = 0; c < kRequired; ++c)
      if (!has_[c]) fail(table.names_where(), "there is no column \"{}\"; {}", kTableColumns[c], expected());
    if (has_errors() != (has_[kRdError] && has_[kTError]) || has_[kRdError] != has_[kTError])
      fail(table.names_where(), "the columns Rs_se, Rd_se and T_se come together or not at all");
  }

  bool has_errors() const { return has_[kRsError]; }
  /// Returns the row that the table has read.
  TableRow row() const {
    table_.check_fields();
    TableRow row{.where = table_.where()};
    for (size_t i = 0; i < columns_.size(); ++i)
      if (columns_[i] != kColumns) row.value[columns_[i]] = checked(columns_[i], i);
    const double sum = row.value[kRs] + row.value[kRd] + row.value[kT];
    constexpr double kRounding = 1e-6;
    if (sum > 1 + kRounding) fail(row.where, "Rs + Rd + T is {:.7g}: a leaf scatters 1 at most", sum);
    return row;
  }

 private:
  static std::string expected() {
    return fmt::format("a leaf's table has the columns {}, and may have {}",
                       fmt::join(std::begin(kTableColumns), std::begin(kTableColumns) + kRequired, ","),
                       fmt::join(std::begin(kTableColumns) + kRequired, std::end(kTableColumns), ","));
  }

  static size_t column(std::string_view name, const Location& where) {
    const auto is = [&](std::string_view other) { return lower_case(name) == lower_case(other); };
    if (name.empty() || std::ranges::any_of(kPassedOver, is)) return kColumns;
    const auto* found = std::ranges::find_if(kTableColumns, is);
    if (found != std::end(kTableColumns)) return static_cast<size_t>(found - kTableColumns);
    const std::string_view meant = nearest(name, {std::begin(kTableColumns), std::end(kTableColumns)});
    fail(where, "there is no column \"{}\" in a leaf's table{}; {}", name,
         meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant), expected());
  }

  double checked(size_t column, size_t field) const {
    const std::string_view text = table_.fields()[field].text;
    const Location where = table_.where(field);
    const auto number = table_.number(text);
    if (!number) fail(where, "{} is a number, \"{}\" was given", kTableColumns[column], text);
    const double v = *number;
    if (column == kTheta && !(v >= 0 && v <= 180)) fail(where, "theta_deg is from 0 to 180, {} was given", v);
    if (column == kWavelength && !(v > 0 && std::isfinite(v))) fail(where, "wavelength_nm is above 0, {} was given", v);
    if (column >= kRs && !(v >= 0 && v <= 1))
      fail(where, "{} is a share of the light, from 0 to 1; {} was given", kTableColumns[column], v);
    return v;
  }

  const TextTable& table_;
  std::vector<size_t> columns_;
  std::array<bool, kColumns> has_{};
};

/// All rows of one wavelength, in the file's order.
using Spectrum = std::vector<TableRow>;

void add(std::vector<Spectrum>& spectra, std::map<double, size_t>& known, const TableRow& row) {
  const double nm = row.value[kWavelength], theta = row.value[kTheta];
  const auto [place, is_new] = known.emplace(nm, spectra.size());
  if (is_new) spectra.emplace_back();
  Spectrum& rows = spectra[place->second];
  if (!rows.empty() && !(theta > rows.back().value[kTheta]))
    fail(row.where, "theta_deg {} comes after {} at {} nm (line {}): angles ascend, each once for a wavelength", theta,
         rows.back().value[kTheta], nm, rows.back().where.line);
  rows.push_back(row);
}

[[noreturn]] void fail_missing(const TableRow& row, double theta, const TableRow& of_other) {
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
  for (const TableRow& row : spectra[0]) table.theta_deg.push_back(row.value[kTheta]);
  for (const Spectrum& rows : spectra) {
    check_same_angles(spectra[0], rows);
    table.wavelengths_nm.push_back(rows[0].value[kWavelength]);
    for (const TableRow& row : rows) {
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
  text += fmt::format("{}\n", fmt::join(std::begin(kTableColumns),
                                        has_errors ? std::end(kTableColumns) : kTableColumns + kRequired, ","));
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

namespace {

/// The error that the comments of a table state; 0 if they do not.
double stated_error(std::string_view text) {
  const size_t begin = text.starts_with(kErrorComment) ? 0 : text.find(fmt::format("\n{}", kErrorComment));
  if (begin == text.npos) return 0;
  const size_t number = begin + (begin > 0 ? 1 : 0) + kErrorComment.size();
  double error = 0;
  std::from_chars(text.data() + number, text.data() + text.size(), error);
  return error;
}

}  // namespace

Table parse_table(std::string_view text, const std::string& name) {
  TextTable rows(text, name);
  if (rows.columns() == 0)
    fail(rows.names_where(),
         "the table is empty: a line with the names of the columns and then a row for each angle and wavelength is "
         "expected");
  const Header header(rows);
  std::vector<Spectrum> spectra;
  std::map<double, size_t> known;
  while (rows.next()) add(spectra, known, header.row());
  if (spectra.empty()) fail(rows.names_where(), "the table is empty: a row for each angle and wavelength is expected");
  Table table = assemble(spectra, header.has_errors());
  table.error = stated_error(text);
  return table;
}

bool is_leaf_table(std::string_view text) {
  if (text.find('\0') != text.npos) return true;
  const TextTable table(text, {});
  return table.columns() == 0 || std::ranges::any_of(table.names(), [](const TableField& f) {
           const std::string name = lower_case(f.text);
           return name == lower_case(kTableColumns[kRs]) || name == lower_case(kTableColumns[kRd]);
         });
}

Table read_table(const std::filesystem::path& path, const Location& where) {
  return parse_table(read_file_bytes(path, where, "leaf table"), path.string());
}

}  // namespace frond::leaf
