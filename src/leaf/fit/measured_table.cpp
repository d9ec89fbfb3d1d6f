#include "leaf/fit/measured_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "leaf/table/table_file.h"
#include "spectra/envi_library.h"

namespace frond::leaf {
namespace {

/// Counts what `measured_table` leaves out or changes.
struct Changes {
  size_t incomplete = 0, negative = 0, above_one = 0;

  std::string warning(const std::string& name) const {
    std::string text;
    const auto add = [&text](size_t count, std::string_view what) {
      if (count > 0) text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", what, count);
    };
    add(incomplete, "wavelengths without R and T at every angle, left out");
    add(negative, "values below 0, taken as 0");
    add(above_one, "pairs with R + T above 1, divided by their sum");
    return text.empty() ? text : fmt::format("{}: {}", name, text);
  }
};

Shares shares_of(const LeafMeasurement& m, double surface, Changes& changes) {
  changes.negative += size_t(*m.r < 0) + size_t(*m.t < 0);
  const double r = std::max(*m.r, 0.0), t = std::max(*m.t, 0.0), sum = std::max(r + t, 1.0);
  changes.above_one += size_t(r + t > 1);
  const double rs = std::min(surface, r / sum);
  return {rs, r / sum - rs, t / sum};
}

}  // namespace

MeasuredTable measured_table(const MeasuredSpectra& spectra, double surface, const std::string& name) {
  const Location where{std::make_shared<const std::string>(name), 0, 0};
  std::map<double, std::map<double, const LeafMeasurement*>> by_wavelength;  // then by angle
  std::set<double> angles;
  for (const LeafMeasurement& m : spectra.measurements) {
    if (!by_wavelength[m.lambda_nm].emplace(m.theta_deg, &m).second)
      fail(where, "{} nm at {} degrees occurs twice: a leaf material needs one value, such as the mean", m.lambda_nm,
           m.theta_deg);
    angles.insert(m.theta_deg);
  }
  MeasuredTable result;
  Changes changes;
  Table& table = result.table;
  table.theta_deg.assign(angles.begin(), angles.end());
  for (const auto& [nm, at_angles] : by_wavelength) {
    const bool is_complete = at_angles.size() == angles.size() &&
                             std::ranges::all_of(at_angles, [](const auto& a) { return a.second->r && a.second->t; });
    if (!is_complete) {
      ++changes.incomplete;
      continue;
    }
    table.wavelengths_nm.push_back(nm);
    for (const auto& [theta, m] : at_angles) table.shares.push_back(shares_of(*m, surface, changes));
  }
  if (table.wavelengths_nm.empty())
    fail(where,
         "no wavelength has both R and T{}: a leaf material needs both; frond fit derives the missing one from a model",
         angles.size() > 1 ? " at every angle" : "");
  if (table.theta_deg.front() > 90)
    fail(where, "all measurements are of the abaxial side: without a column \"side\" they hold for both sides");
  result.warning = changes.warning(name);
  return result;
}

MeasuredTable read_table_or_spectra(const std::filesystem::path& path, const Location& where,
                                    const SpectraMeasurement& how, double surface) {
  const std::string text = read_spectra_text(path, where, "leaf table");
  if (is_leaf_table(text)) return {parse_table(text, path.string())};
  return measured_table(parse_measured_spectra(text, path.string(), how), surface, path.string());
}

}  // namespace frond::leaf
