#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "report/share_tables.h"

namespace frond {

Panel shares_panel(std::string x_label) {
  const Axis y{"reflectance R (from below)", {0, 1}, false, 0.1};
  return {900, 540, "", {std::move(x_label)}, y, "transmittance T (from above)"};
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
  const auto curve_of = [&](const LabelledMeasurement& r) {
    if (alone) return r.material;
    return by_wavelength ? fmt::format("{}, {:.6g}°", r.material, r.measurement.beam.theta_deg)
                         : fmt::format("{}, {}", r.material, label_of(r.measurement.beam));
  };
  const auto labels = distinct(measurements, curve_of);
  check_shares_chart(labels.size() / std::min(angles, wavelengths), angles, wavelengths);
  Panel panel = shares_panel(by_wavelength ? "wavelength (nm)" : "angle of incidence (degrees)");
  // Few points are drawn as marks; many as lines and error bars only.
  const Mark mark = std::max(angles, wavelengths) <= 40 ? Mark::disk : Mark::none;
  for (size_t i = 0; i < labels.size(); ++i) {
    Series r{labels[i], kSeriesColors[i], 1.5, {}, mark, 2.5}, t{"", r.color, 1.5, Dash::dashed, mark, 2.5};
    for (const LabelledMeasurement& l : measurements) {
      if (curve_of(l) != labels[i]) continue;
      const Estimate &up = l.measurement.reflectance, &down = l.measurement.transmittance;
      r.points.push_back(with_error(x_of(l), up.mean, up.standard_error()));
      t.points.push_back(with_error(x_of(l), 1 - down.mean, down.standard_error()));
    }
    if (by_wavelength)  // bands are in any order
      for (Series* s : {&r, &t}) std::ranges::stable_sort(s->points, {}, &ChartPoint::x);
    panel.series.insert(panel.series.end(), {r, t});
  }
  panel.series.insert(panel.series.end(), {line("R", "#808080"), line("1 − T", "#808080", 1.5, Dash::dashed)});
  return {1, {panel}};
}

}  // namespace frond
