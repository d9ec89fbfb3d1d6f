#include "common.h"
#include "radiometry/brf.h"
#include "radiometry/flux.h"

namespace frond::python {
namespace {

using namespace nb::literals;

/// What both radiometers are told.
struct Measurement {
  std::string wavelengths;
  std::vector<std::pair<std::string, std::string>> swaps;
  std::optional<std::array<double, 5>> target;
  std::optional<std::array<double, 2>> period;
  std::optional<uint64_t> seed;
  uint64_t paths;
  double rms;
};

SceneOverrides overrides_of(const Measurement& a) {
  SceneOverrides overrides;
  overrides.seed = a.seed;
  for (const auto& [from, to] : a.swaps) overrides.swaps.push_back({from, parse_plugin_text(to, {})});
  return overrides;
}

std::optional<Target> target_of(const Measurement& a) {
  if (!a.target) return {};
  const auto [x0, x1, y0, y1, z] = *a.target;
  if (!(x0 < x1 && y0 < y1)) fail({}, "target: ({}, {}, {}, {}, {}) is empty: (x0, x1, y0, y1, z)", x0, x1, y0, y1, z);
  return Target{x0, x1, y0, y1, z};
}

nb::dict brf(const std::shared_ptr<SessionHandle>& owner, const SceneDescription& description,
             const std::vector<std::pair<double, double>>& views, const Measurement& a, const nb::object& progress) {
  BrfRequest request{{}, target_of(a), a.period, a.wavelengths};
  for (const auto& [zenith, azimuth] : views) {
    if (!(std::abs(zenith) < 90)) fail({}, "zenith: {} is not above the horizon, which is at 90", zenith);
    request.views.push_back({zenith, azimuth});
  }
  BrfReading reading;
  run(
      [&](const RenderControl& control) {
        const BrfMeter meter(owner->session, description, overrides_of(a), request);
        RenderPart part = meter.scene().empty_part();
        constexpr uint64_t kFirst = 64, kMost = uint64_t{1} << 32;
        uint64_t samples = a.rms > 0 ? kFirst : (a.paths + BrfMeter::kRows - 1) / BrfMeter::kRows;
        samples = std::max<uint64_t>(samples, meter.scene().scene().wavelengths().bands().size());
        for (;; samples *= 2) {
          owner->session.render(meter.scene(), {0, samples}, part, control);
          if (control.stop.stop_requested()) return;
          reading = meter.read(part.film);
          if (!(a.rms > 0 && reading.relative_error() > a.rms && samples < kMost)) return;
        }
      },
      progress);
  std::vector<double> mean, error;
  for (const MeanError& v : reading.values) mean.push_back(v.mean), error.push_back(v.standard_error);
  const std::vector<size_t> shape{reading.views.size(), reading.wavelengths_nm.size()};
  nb::dict d;
  d["wavelengths_nm"] = reading.wavelengths_nm;
  d["brf"] = to_array(std::move(mean), shape), d["brf_se"] = to_array(std::move(error), shape);
  d["paths"] = reading.paths;
  return d;
}

nb::dict flux(const std::shared_ptr<SessionHandle>& owner, const SceneDescription& description, const Measurement& a,
              bool by_instance, const nb::object& progress) {
  FluxReading reading;
  run(
      [&](const RenderControl& control) {
        FluxMeter meter(owner->session, description, overrides_of(a),
                        {target_of(a), a.period, a.wavelengths, by_instance});
        constexpr uint64_t kFirst = 1 << 16, kMost = uint64_t{1} << 40;
        for (uint64_t paths = a.rms > 0 ? kFirst : a.paths;; paths *= 2) {
          meter.trace(paths - meter.paths(), owner->session.pool(), control);
          if (control.stop.stop_requested()) return;
          reading = meter.read();
          if (!(a.rms > 0 && reading.error() > a.rms && paths < kMost)) return;
        }
      },
      progress);
  nb::list rows;
  const auto add = [&](const char* quantity, const std::string& material, const std::vector<MeanError>& shares) {
    for (size_t band = 0; band < shares.size(); ++band) {
      nb::dict row;
      row["quantity"] = quantity, row["material"] = material;
      row["wavelength_nm"] = reading.wavelengths_nm[band];
      row["share"] = shares[band].mean, row["share_se"] = shares[band].standard_error;
      rows.append(row);
    }
  };
  add("reflected", "", reading.reflected), add("transmitted", "", reading.transmitted);
  for (const auto& m : reading.materials) add("absorbed", m.name, m.absorbed);
  add("sum", "", reading.sum);
  for (const auto& m : reading.materials) add("incident", m.name, m.incident);
  for (const auto& m : reading.materials) add("uncollided", m.name, m.uncollided);
  nb::dict d;
  d["rows"] = rows, d["paths"] = reading.paths;
  if (by_instance) {
    const size_t bands = reading.wavelengths_nm.size();
    std::vector<double> mean, error;
    for (const MeanError& s : reading.by_instance) mean.push_back(s.mean), error.push_back(s.standard_error);
    const std::vector<size_t> shape{mean.size() / bands, bands};
    d["wavelengths_nm"] = reading.wavelengths_nm;
    d["absorbed"] = to_array(std::move(mean), shape), d["absorbed_se"] = to_array(std::move(error), shape);
    const size_t copies = reading.areas.size();
    d["areas"] = to_array(std::move(reading.areas), {copies});
  }
  return d;
}

}  // namespace

void bind_radiometry(nb::module_& m) {
  nb::class_<Measurement>(m, "Measurement")
      .def(
          "__init__",
          [](Measurement* self, const std::string& wavelengths,
             const std::vector<std::pair<std::string, std::string>>& swaps,
             const std::optional<std::array<double, 5>>& target, const std::optional<std::array<double, 2>>& period,
             std::optional<uint64_t> seed, uint64_t paths,
             double rms) { new (self) Measurement{wavelengths, swaps, target, period, seed, paths, rms}; },
          "wavelengths"_a, "swaps"_a, "target"_a.none(), "period"_a.none(), "seed"_a.none(), "paths"_a, "rms"_a);
  m.def("brf", &brf, "session"_a, "description"_a, "views"_a, "measurement"_a, "progress"_a.none());
  m.def("flux", &flux, "session"_a, "description"_a, "measurement"_a, "by_instance"_a, "progress"_a.none());
}

}  // namespace frond::python
