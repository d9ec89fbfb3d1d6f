#include "materials/measured/goniometer_rows.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/excerpt.h"
#include "core/spectrum.h"
#include "system/csv_fields.h"

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

using Field = CsvField;

double number(const Field& field, std::string_view column) {
  const auto value = field_number(field.text, ',');
  if (!value || !std::isfinite(*value)) fail(field.where, "\"{}\" is no number for the column {}", field.text, column);
  return *value;
}

/// Index of each column in a row; npos: the file lacks it.
class Header {
 public:
  explicit Header(const std::vector<Field>& fields) : count_(fields.size()) {
    for (size_t column = 0; column < kColumns; ++column) {
      const auto found = std::ranges::find(fields, kNames[column], &Field::text);
      at_[column] = found == fields.end() ? kNone : size_t(found - fields.begin());
      if (at_[column] == kNone && column < kRequired)
        fail(fields.front().where, "there is no column \"{}\"; a goniometer table needs the columns {}", kNames[column],
             fmt::join(std::span(kNames).first(kRequired), ", "));
    }
  }

  /// Throws InputError for values out of range.
  GoniometerRow row(const std::vector<Field>& fields) {
    if (fields.size() != count_)
      fail(fields.front().where, "{} fields, but the file has {} columns", fields.size(), count_);
    std::array<double, kNumbers> values{};
    for (size_t column = 0; column < kNumbers; ++column)
      if (at_[column] != kNone) values[column] = number(fields[at_[column]], kNames[column]);
    for (const Allowed& a : kAllowed)
      if (!(values[a.column] >= a.range.min && values[a.column] <= a.range.max))
        fail(fields[at_[a.column]].where, "{} is {}, outside its range {} to {}", kNames[a.column], values[a.column],
             a.range.min, a.range.max);
    if (values[kTheta] == 90) fail(fields[at_[kTheta]].where, "theta_deg is 90, on neither side; remove the row");
    GoniometerRow row{values[kIncidence], values[kWavelength], values[kTheta], turned(values[kPhi]),
                      values[kF],         values[kError],      values[kPatch], fields[0].where};
    check_kind(row, fields);
    check_material(fields);
    return row;
  }

 private:
  static constexpr size_t kNone = size_t(-1);

  /// Into [0, 360).
  static double turned(double phi_deg) {
    const double turned = std::fmod(phi_deg, 360);
    return turned < 0 ? std::fmod(turned + 360, 360) : turned;
  }
  void check_kind(const GoniometerRow& row, const std::vector<Field>& fields) const {
    if (at_[kKind] == kNone) return;
    const auto& [kind, where] = fields[at_[kKind]];
    const std::string_view expected = row.is_reflected() ? "BRDF" : "BTDF";
    if (kind != expected)
      fail(where, "\"{}\", but light at {} degrees and a detector at {} degrees measure the {}", kind,
           row.incidence_deg, row.theta_deg, expected);
  }
  void check_material(const std::vector<Field>& fields) {
    if (at_[kMaterial] == kNone) return;
    const auto& [material, where] = fields[at_[kMaterial]];
    if (material_.empty()) material_ = material;
    if (material != material_)
      fail(where, "the file has measurements of {} and {}; keep the rows of one", excerpt(material_, where),
           excerpt(material, where));
  }

  size_t count_;
  std::array<size_t, kColumns> at_{};
  std::string material_;
};

}  // namespace

std::vector<GoniometerRow> parse_goniometer_rows(std::string_view text, const std::string& name) {
  Location where{std::make_shared<const std::string>(name), 0, 1};
  std::optional<Header> header;
  std::vector<GoniometerRow> rows;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin), content = trimmed(line);
    ++where.line;
    begin = end + 1;
    if (content.empty() || content.front() == '#') continue;
    const std::vector<Field> fields = split_fields(line, ',', where);
    if (!header)
      header.emplace(fields);
    else
      rows.push_back(header->row(fields));
  }
  if (rows.empty()) fail(where, "it is neither a tensor file nor a goniometer table: there are no rows of numbers");
  return rows;
}

}  // namespace frond
