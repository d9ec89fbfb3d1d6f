#include "leaf/fluorescence/emission_matrices.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/fluorescence.h"
#include "system/file_bytes.h"
#include "system/text_table.h"

namespace frond::leaf {
namespace {

enum MatrixColumn : size_t { kExcitation, kEmission, kMb, kMf, kMatrixTheta, kMatrixColumnCount };
constexpr std::string_view kMatrixColumns[kMatrixColumnCount] = {"excitation_nm", "emission_nm", "Mb", "Mf",
                                                                 "theta_deg"};

/// Returns the fields of a row that hold the columns above. Others, as standard errors, are passed over. Only
/// "theta_deg" may be missing.
std::array<std::optional<size_t>, kMatrixColumnCount> columns_of(const TextTable& table) {
  std::array<std::optional<size_t>, kMatrixColumnCount> fields;
  for (size_t i = 0; i < table.names().size(); ++i)
    for (size_t c = 0; c < kMatrixColumnCount; ++c) {
      if (lower_case(table.names()[i].text) != lower_case(kMatrixColumns[c])) continue;
      if (fields[c]) fail(table.names_where(i), "there are two columns \"{}\"", kMatrixColumns[c]);
      fields[c] = i;
    }
  for (size_t c = 0; c < kMatrixTheta; ++c)
    if (!fields[c])
      fail(table.names_where(),
           "there is no column \"{}\": matrices of fluorescence have the columns {}, and may have \"theta_deg\", above "
           "90 for light on the abaxial side",
           kMatrixColumns[c], fmt::join(std::begin(kMatrixColumns), std::begin(kMatrixColumns) + kMatrixTheta, ","));
  return fields;
}

/// Returns a number of the current row. Throws InputError if it is none or outside the range.
double checked(const TextTable& table, size_t field, MatrixColumn column) {
  const std::string_view text = table.fields()[field].text;
  const auto number = table.number(text);
  if (!number) fail(table.where(field), "{} is a number, \"{}\" was given", kMatrixColumns[column], text);
  const double v = *number;
  if (column == kMb || column == kMf) {
    if (!(v >= 0 && std::isfinite(v)))
      fail(table.where(field), "{} is a number of photons per nm, at least 0; {} was given", kMatrixColumns[column], v);
    return v;
  }
  const Interval range = column == kExcitation ? frond::kExcitation_nm
                         : column == kEmission ? frond::kEmission_nm
                                               : Interval{0, 180};
  if (!range.contains(v))
    fail(table.where(field), "{} is from {} to {}, {} was given", kMatrixColumns[column], range.min, range.max, v);
  return v;
}

/// Index of the cell that contains x, and the fraction of its width. `nodes` has at least two, and x is within them.
std::pair<size_t, double> cell_of(const std::vector<double>& nodes, double x) {
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x);
  const auto i = static_cast<size_t>(above - nodes.begin()) - 1;
  return {i, (x - nodes[i]) / (nodes[i + 1] - nodes[i])};
}

bool covers(const std::vector<double>& nodes, double x) { return nodes.front() <= x && x <= nodes.back(); }

void keep_each_once(std::vector<double>& values) {
  std::ranges::sort(values);
  values.erase(std::ranges::unique(values).begin(), values.end());
}

}  // namespace

struct EmissionMatrices::Row {
  double excitation_nm, emission_nm;
  Sides value;
  Location where;

  bool is_at(double excitation, double emission) const {
    return excitation_nm == excitation && emission_nm == emission;
  }
};

/// Sorts the rows into a grid. Throws InputError unless each pair of wavelengths is there once.
EmissionMatrices::Matrix EmissionMatrices::matrix_of(std::vector<Row> rows) {
  std::ranges::stable_sort(rows, {}, [](const Row& r) { return std::pair(r.excitation_nm, r.emission_nm); });
  const auto is_pair = [](const Row& a, const Row& b) { return b.is_at(a.excitation_nm, a.emission_nm); };
  if (const auto twice = std::ranges::adjacent_find(rows, is_pair); twice != rows.end())
    fail(std::next(twice)->where,
         "{} to {} nm is there twice, first in line {}: a file has one leaf, and one angle for each lit side",
         twice->excitation_nm, twice->emission_nm, twice->where.line);
  Matrix m;
  for (const Row& r : rows) m.excitation_nm.push_back(r.excitation_nm), m.emission_nm.push_back(r.emission_nm);
  keep_each_once(m.excitation_nm), keep_each_once(m.emission_nm);
  if (m.excitation_nm.size() < 2 || m.emission_nm.size() < 2)
    fail(rows.front().where, "matrices have at least two wavelengths of excitation and two of emission");
  const size_t emissions = m.emission_nm.size();
  for (size_t i = 0; i < m.excitation_nm.size() * emissions; ++i) {
    const double excitation = m.excitation_nm[i / emissions], emission = m.emission_nm[i % emissions];
    if (i >= rows.size() || !rows[i].is_at(excitation, emission)) {
      const Row& near = rows[std::min(i, rows.size() - 1)];
      const auto other = std::ranges::find(rows, emission, &Row::emission_nm);
      fail(
          near.where,
          "there is no row for {} to {} nm: every wavelength of excitation needs the same wavelengths of emission, and "
          "{} nm is in line {}",
          excitation, emission, emission, other->where.line);
    }
    m.values.push_back(rows[i].value);
  }
  for (size_t e = 0; e < m.excitation_nm.size(); ++e) {
    double sum = 0;
    for (size_t f = 1; f < emissions; ++f) {
      const Sides *here = &m.values[e * emissions + f], *before = here - 1;
      sum +=
          (m.emission_nm[f] - m.emission_nm[f - 1]) / 2 * (here->lit + here->opposite + before->lit + before->opposite);
    }
    if (sum > 1)
      fail(rows[e * emissions].where,
           "{:.3g} photons leave the leaf for each photon of {} nm, at most 1 can: photons per nm and incident photon "
           "are expected; \"fluorescencescale\" multiplies them",
           sum, m.excitation_nm[e]);
    m.emitted.push_back(sum);
  }
  return m;
}

EmissionMatrices::EmissionMatrices(std::string_view text, const std::string& name, const MatrixUnit& unit)
    : name_(std::filesystem::path(name).filename().string()) {
  TextTable table(text, name);
  const auto fields = columns_of(table);
  std::array<std::vector<Row>, 2> rows;
  std::array<double, 2> angle{};
  while (table.next()) {
    table.check_fields();
    const auto number = [&](MatrixColumn c) { return checked(table, *fields[c], c); };
    const double theta = fields[kMatrixTheta] ? number(kMatrixTheta) : 0;
    std::vector<Row>& side = rows[theta > 90];
    double& angle_of_side = angle[theta > 90];
    if (!side.empty() && theta != angle_of_side)
      fail(table.where(*fields[kMatrixTheta]),
           "theta_deg {} after {}: the emission does not depend on the angle of incidence; keep the rows of one angle "
           "up to 90 and of one above 90",
           theta, angle_of_side);
    angle_of_side = theta;
    const double excitation = number(kExcitation), emission = number(kEmission);
    const double photons = unit.scale * (unit.is_energy ? emission / excitation : 1);
    side.push_back({excitation, emission, {photons * number(kMb), photons * number(kMf)}, table.where()});
  }
  if (rows[0].empty())
    fail(table.names_where(), "there is no row for light on the adaxial side: theta_deg up to 90, or no such column");
  for (size_t i = 0; i < 2; ++i)
    if (!rows[i].empty()) sides_[i] = matrix_of(std::move(rows[i]));
}

EmissionMatrices::Sides EmissionMatrices::at(double emission_nm, double excitation_nm, bool abaxial) const {
  const Matrix& m = sides_[abaxial && !sides_[1].values.empty() ? 1 : 0];
  if (!covers(m.excitation_nm, excitation_nm) || !covers(m.emission_nm, emission_nm)) return {};
  const auto [e, te] = cell_of(m.excitation_nm, excitation_nm);
  const auto [f, tf] = cell_of(m.emission_nm, emission_nm);
  const Sides *low = &m.values[e * m.emission_nm.size() + f], *high = low + m.emission_nm.size();
  const auto between = [&](double Sides::*side) {
    return std::lerp(std::lerp(low[0].*side, low[1].*side, tf), std::lerp(high[0].*side, high[1].*side, tf), te);
  };
  return {between(&Sides::lit), between(&Sides::opposite)};
}

double EmissionMatrices::emitted(double excitation_nm) const {
  double sum = 0;
  for (const Matrix* m : {&sides_[0], &sides_[sides_[1].values.empty() ? 0 : 1]}) {
    if (!covers(m->excitation_nm, excitation_nm)) continue;
    const auto [e, t] = cell_of(m->excitation_nm, excitation_nm);
    sum += std::lerp(m->emitted[e], m->emitted[e + 1], t) / 2;
  }
  return sum;
}

EmissionMatrices read_emission_matrices(const std::filesystem::path& path, const MatrixUnit& unit,
                                        const Location& where) {
  return {read_file_bytes(path, where, "file of matrices"), path.string(), unit};
}

}  // namespace frond::leaf
