#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "report/share_tables.h"

namespace frond {

std::array<Panel, 2> shares_panels(const std::string& x_label) {
  return {Panel{900, 290, "", {""}, {"reflectance R"}}, Panel{900, 300, "", {x_label}, {"transmittance T"}}};
}

void set_range_of(std::array<Panel, 2>& panels) {
  Range range{0, 0};
  for (const Panel& panel : panels)
    for (const Series& s : panel.series)
      for (const ChartPoint& p : s.points) range.include(p.y);
  for (Panel& panel : panels) panel.y.range = {0, range.high > 0 ? std::min(1.0, 1.05 * range.high) : 1};
}

void check_shares_chart(size_t materials, size_t angles, size_t wavelengths) {
  const size_t along = std::max(angles, wavelengths), curves = materials * std::min(angles, wavelengths);
  if (along < 2)
    fail({}, "--plot draws R and T against wavelength or angle: at least two values of one of them are needed");
  if (curves > kSeriesColors.size())
    fail({},
         "--plot: {} curves ({} materials, {} angles, {} wavelengths) are more than the {} colours that can be told "
         "apart",
         curves, materials, angles, wavelengths, kSeriesColors.size());
}

Chart shares_chart(const std::vector<LabelledMeasurement>& measurements) {
  const size_t angles = distinct(measurements, [](const auto&r) { return r.measurement.beam.theta_deg; }).size(),
               wavelengths = distinct(measurements, [](const auto&r) { return label_of(r.measurement.beam); }).size();
  const bool by_wavelength = wavelengths >= angles, alone = std::min(angles, wavelengths) == 1;
  const auto x_of = [&](const LabelledMeasurement& r) {
    return by_wavelength ? r.measurement.beam.lambda_nm : r.measurement.beam.theta_deg;
  };
  const size_t materials = distinct(measurements, &LabelledMeasurement::material).size();
  const auto curve_of = [&](const LabelledMeasurement& r) {
    if (alone) return r.material;
    const Beam& beam = r.measurement.beam;
    const std::string light = by_wavelength ? fmt::format("{:.6g}°", beam.theta_deg) : label_of(beam);
    return materials == 1 ? light : fmt::format("{}, {}", r.material, light);
  };
  const auto labels = distinct(measurements, curve_of);
  check_shares_chart(materials, angles, wavelengths);
  auto panels = shares_panels(by_wavelength ? "wavelength (nm)" : "angle of incidence (degrees)");
  // Few points are drawn as marks; many as lines and error bars only.
  const Mark mark = std::max(angles, wavelengths) <= 40 ? Mark::disk : Mark::none;
  for (size_t i = 0; i < labels.size(); ++i) {
    Series r{"", kSeriesColors[(i + 1) % kSeriesColors.size()], 1.5, {}, mark, 2.5};
    r.end = labels[i];
    Series t = r;
    for (const LabelledMeasurement& l : measurements) {
      if (curve_of(l) != labels[i]) continue;
      const Estimate &up = l.measurement.reflectance, &down = l.measurement.transmittance;
      r.points.push_back(with_error(x_of(l), up.mean, up.standard_error()));
      t.points.push_back(with_error(x_of(l), down.mean, down.standard_error()));
    }
    if (by_wavelength)  // bands are in any order
      for (Series* s : {&r, &t}) std::ranges::stable_sort(s->points, {}, &ChartPoint::x);
    panels[0].series.push_back(r), panels[1].series.push_back(t);
  }
  set_range_of(panels);
  return {1, {panels[0], panels[1]}, materials == 1 && !alone ? measurements[0].material : ""};
}

}  // namespace frond
