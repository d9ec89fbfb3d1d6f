#include "materials/measured/goniometer_rows.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/messages/excerpt.h"
#include "core/spectrum.h"
#include "system/text_table.h"

namespace frond {
namespace {

enum Column : size_t { kIncidence, kWavelength, kTheta, kPhi, kF, kError, kPatch, kKind, kMaterial, kColumns };
constexpr std::array<std::string_view, kColumns> kNames{
    "incidence_deg", "wavelength_nm", "theta_deg", "phi_deg", "f_per_sr", "f_se", "projected_solid_angle_sr",
    "kind",          "material"};
/// Values of a column that are accepted. Values of f that are large or negative are limited later, with a warning.
struct Allowed {
  Column column;
  Interval range;
};
constexpr Allowed kAllowed[] = {
    {kIncidence, {0, 180}}, {kWavelength, {1, 1e6}}, {kTheta, {0, 180}}, {kF, {-1e6, 1e6}}, {kPatch, {0, 7}}};
constexpr size_t kRequired = kError, kNumbers = kKind;

/// Index of each column in a row; kNone: the file lacks it.
class Header {
 public:
  explicit Header(const TextTable& table) : table_(table) {
    for (size_t column = 0; column < kColumns; ++column) {
      const auto found = std::ranges::find_if(
          table.names(), [column](const TableField& name) { return lower_case(name.text) == kNames[column]; });
      at_[column] = found == table.names().end() ? kNone : size_t(found - table.names().begin());
      if (at_[column] == kNone && column < kRequired)
        fail(table.names_where(), "there is no column \"{}\"; a goniometer table needs the columns {}", kNames[column],
             fmt::join(std::span(kNames).first(kRequired), ", "));
    }
  }

  /// Returns the row that the table has read. Throws InputError for values out of range.
  GoniometerRow row() {
    table_.check_fields();
    std::array<double, kNumbers> values{};
    for (size_t column = 0; column < kNumbers; ++column)
      if (at_[column] != kNone) values[column] = number(column);
    for (const Allowed& a : kAllowed)
      if (!(values[a.column] >= a.range.min && values[a.column] <= a.range.max))
        fail(table_.where(at_[a.column]), "{} is {}, outside its range {} to {}", kNames[a.column], values[a.column],
             a.range.min, a.range.max);
    if (values[kTheta] == 90) fail(table_.where(at_[kTheta]), "theta_deg is 90, on neither side; remove the row");
    GoniometerRow row{values[kIncidence], values[kWavelength], values[kTheta], wrapped_azimuth(values[kPhi]),
                      values[kF],         values[kError],      values[kPatch], table_.where()};
    check_kind(row);
    check_material();
    return row;
  }

 private:
  static constexpr size_t kNone = size_t(-1);

  std::string_view text(size_t column) const { return table_.fields()[at_[column]].text; }
  double number(size_t column) const {
    const auto value = table_.number(text(column));
    if (!value || !std::isfinite(*value))
      fail(table_.where(at_[column]), "\"{}\" is no number for the column {}", text(column), kNames[column]);
    return *value;
  }
  /// Into [0, 360).
  static double wrapped_azimuth(double phi_deg) {
    const double turned = std::fmod(phi_deg, 360);
    return turned < 0 ? std::fmod(turned + 360, 360) : turned;
  }
  void check_kind(const GoniometerRow& row) const {
    if (at_[kKind] == kNone) return;
    const std::string_view kind = text(kKind), expected = row.is_reflected() ? "BRDF" : "BTDF";
    if (kind != expected)
      fail(table_.where(at_[kKind]), "\"{}\", but light at {} degrees and a detector at {} degrees measure the {}",
           kind, row.incidence_deg, row.theta_deg, expected);
  }
  void check_material() {
    if (at_[kMaterial] == kNone) return;
    if (material_.empty()) material_ = text(kMaterial);
    if (text(kMaterial) != material_) {
      const Location where = table_.where(at_[kMaterial]);
      fail(where, "the file has measurements of {} and {}; keep the rows of one", excerpt(material_, where),
           excerpt(text(kMaterial), where));
    }
  }

  const TextTable& table_;
  std::array<size_t, kColumns> at_{};
  std::string material_;
};

}  // namespace

std::vector<GoniometerRow> parse_goniometer_rows(std::string_view text, const std::string& name) {
  TextTable table(text, name);
  std::vector<GoniometerRow> rows;
  if (table.columns() > 0) {
    Header header(table);
    while (table.next()) rows.push_back(header.row());
  }
  if (rows.empty())
    fail(table.names_where(), "it is neither a tensor file nor a goniometer table: there are no rows of numbers");
  return rows;
}

}  // namespace frond
