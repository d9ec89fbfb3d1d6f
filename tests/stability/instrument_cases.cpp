#include <algorithm>

#include "instruments/goniophotometer.h"
#include "instruments/spectrophotometer.h"
#include "leaf/tissue/specimens.h"
#include "tests/stability/cases.h"
#include "tests/stability/specimen.h"

namespace frond::stability {
namespace {

using test::flag;
using test::words;

constexpr double kInstrumentNm = 551;

/// Rays, angle and wavelength of a measurement.
struct Request {
  int64_t rays = 1000;
  double theta_deg = 30, lambda_nm = kInstrumentNm;
};

void read_shares(const Request& r) {
  Specimen specimen("abm", {}, r.lambda_nm);
  measure_shares({specimen.material(), {r.theta_deg, r.lambda_nm}}, {r.rays}, specimen.pool());
}

void read_f(const Request& r) {
  Specimen specimen("abm", {}, r.lambda_nm);
  measure_f({specimen.material(), {r.theta_deg, r.lambda_nm}}, DetectorSphere(20, 40), r.rays, specimen.pool());
}

void add_refusal(Theme& theme, std::string name, const std::string& part, const Request& request) {
  theme.add(std::move(name), expect_refusal(part))
      .add(Method::spectrophotometer, refusal(part, [&] { read_shares(request); }))
      .add(Method::goniophotometer, refusal(part, [&] { read_f(request); }));
}

void add_patches(Theme& theme, int thetas, int phis, const std::string& part) {
  theme.add(fmt::format("{} x {} patches", thetas, phis), expect_refusal(part))
      .add(Method::goniophotometer, refusal(part, [&] { DetectorSphere(thetas, phis); }));
}

/// The detectors catch every ray: their f integrates to R and T.
Cell whole_sphere(double theta_deg, int thetas, int phis, const leaf::Shares& truth) {
  constexpr int64_t kRays = 50000;
  Specimen specimen("abm", {}, kInstrumentNm);
  const auto measurement = measure_f({specimen.material(), {theta_deg, kInstrumentNm}}, DetectorSphere(thetas, phis),
                                     kRays, specimen.pool());
  Estimate reflected, transmitted;
  for (size_t i = 0; i < measurement.sphere.size(); ++i) {
    const Patch patch = measurement.sphere.patch(i);
    const Estimate f = measurement.f(i);
    const double omega = patch.projected_solid_angle;
    (measurement.is_reflected(patch) ? reflected : transmitted) += Estimate{f.mean * omega, f.variance * omega * omega};
  }
  Comparison comparison;
  comparison.add("R", reflected, truth.surface + truth.subsurface, kRays);
  comparison.add("T", transmitted, truth.transmitted, kRays);
  return comparison.cell();
}

Cell all_shares(const Beam& beam, const leaf::Shares& truth, int64_t rays) {
  Specimen specimen("abm", {}, beam.lambda_nm);
  const auto measurement = measure_shares({specimen.material(), beam}, {rays}, specimen.pool());
  Comparison comparison;
  comparison.add("R", measurement.reflectance, truth.surface + truth.subsurface, rays);
  comparison.add("T", measurement.transmittance, truth.transmitted, rays);
  comparison.add("A", measurement.absorptance, 1 - truth.surface - truth.subsurface - truth.transmitted, rays);
  return comparison.cell();
}

leaf::Shares truth_of(const Beam& beam) {
  const leaf::TissueModel model(leaf::find_specimen("soybean")->params);
  return solved_finely(model.at(beam.lambda_nm), {beam.theta_deg}).truth[0];
}

void add_measurement(Theme& theme, std::string name, const Beam& beam, int thetas, int phis) {
  const leaf::Shares truth = truth_of(beam);
  theme.add(std::move(name), "R and T exact, also as the sum over all patches")
      .add(Method::spectrophotometer, all_shares(beam, truth, 50000))
      .add(Method::goniophotometer, whole_sphere(beam.theta_deg, thetas, phis, truth));
}

void add_delta_lobe(Theme& theme) {
  const Parameters published{flag("surfacedirect", false), words("tablemethod", {"solve"})};
  const std::string part = "the material has a delta lobe";
  Specimen specimen("leaf_simplified", published, kInstrumentNm);
  const auto measurement = measure_shares({specimen.material(), {30, kInstrumentNm}}, {50000}, specimen.pool());
  const leaf::Shares truth = truth_of({30, kInstrumentNm});
  Comparison comparison(1e-4);
  comparison.add("Rs", measurement.surface, truth.surface, 50000);
  comparison.add("Rd", measurement.subsurface, truth.subsurface, 50000);
  comparison.add("T", measurement.transmittance, truth.transmitted, 50000);
  theme.add("a delta lobe: leaf_simplified with \"surfacedirect\" false", "shares exact; f " + expect_refusal(part))
      .add(Method::spectrophotometer, comparison.cell())
      .add(Method::goniophotometer, refusal(part, [&] {
             check_no_delta_lobe({specimen.material(), {30, kInstrumentNm}});
           }));
}

}  // namespace

Theme instruments() {
  Theme theme{"Instruments", "`abm`, soybean, at 30 degrees and 551 nm unless the case states other values."};
  add_refusal(theme, "0 rays", "2 rays at least", {.rays = 0});
  add_refusal(theme, "-5 rays", "2 rays at least", {.rays = -5});
  add_refusal(theme, "1 ray", "2 rays at least", {.rays = 1});
  add_refusal(theme, "at -0.1 degrees", "from 0 to 180 degrees, -0.1 was given", {.theta_deg = -0.1});
  add_refusal(theme, "at 180.1 degrees", "from 0 to 180 degrees, 180.1 was given", {.theta_deg = 180.1});
  add_refusal(theme, "at NaN degrees", "from 0 to 180 degrees, nan was given", {.theta_deg = std::nan("")});
  for (const double nm : {300.0, 359.0, 2501.0, 2600.0, std::nan("")})
    add_refusal(theme, fmt::format("at {} nm", nm), "from 360 to 2500 nm", {.lambda_nm = nm});
  add_patches(theme, 1, 1, "1 patches in theta would leave one across the horizon");
  add_patches(theme, 0, 40, "a goniophotometer needs patches, 0 x 40 were asked for");
  add_patches(theme, 20, 0, "a goniophotometer needs patches, 20 x 0 were asked for");
  add_patches(theme, 19, 40, "an even number is needed");
  add_patches(theme, -2, 40, "a goniophotometer needs patches");
  add_patches(theme, 100000, 100000, "are more than 16000000");
  add_measurement(theme, "2 x 1 patches", {30, kInstrumentNm}, 2, 1);
  add_measurement(theme, "400 x 800 patches, most of them empty", {30, kInstrumentNm}, 400, 800);
  add_measurement(theme, "at 0 degrees", {0, kInstrumentNm}, 20, 40);
  add_measurement(theme, "at 90 degrees, as the limit from the front", {90, kInstrumentNm}, 20, 40);
  add_measurement(theme, "at 180 degrees", {180, kInstrumentNm}, 20, 40);
  add_delta_lobe(theme);
  return theme;
}

}  // namespace frond::stability
