// Spectrum files (.spd), and responses of sensors.

#include "spectra/response_file.h"
#include "spectra/spd_file.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

static void check(const std::vector<SpectrumPoint>& points) {
  for (size_t i = 0; i < points.size(); ++i) {
    fuzz::require_finite(std::array{points[i].lambda_nm, points[i].value}, "a point");
    fuzz::require(points[i].value >= 0, "values are not negative");
    fuzz::require(points[i].lambda_nm > (i == 0 ? 0 : points[i - 1].lambda_nm), "wavelengths ascend");
  }
}

FROND_FUZZ_TARGET(spectrum, bytes) {
  fuzz::accepts([&] {
    for (const BandResponse& band : parse_responses(bytes, "srf.csv")) check(band.points);
  });
  const auto path = fuzz::folder().write("curve.spd", bytes);
  std::vector<SpectrumPoint> points;
  if (!fuzz::accepts([&] { points = read_spd_points(path, {}); })) return;
  fuzz::require(points.size() >= 2 && 4 * points.size() <= bytes.size() + 1, "a point takes four bytes or more");
  check(points);
  SpectrumPtr spectrum;
  if (!fuzz::accepts([&] { spectrum = read_spd(path, {}); })) return;
  for (const float nm : {1.f, 360.f, 400.25f, 555.f, 830.f, 2500.f, 1e6f})
    fuzz::require(std::isfinite(spectrum->at(nm)) && spectrum->at(nm) >= 0, "a spectrum is finite");
  fuzz::require(std::isfinite(spectrum->max_value()), "the largest value is finite");
}
