// Measured spectra of `frond fit`.

#include "leaf/fit/measured_spectra.h"

#include "leaf/tissue/constants.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

static void check(const leaf::MeasuredSpectra& spectra, size_t bytes) {
  fuzz::require(spectra.measurements.size() + spectra.left_out <= bytes, "a row takes a byte or more");
  for (const leaf::LeafMeasurement& m : spectra.measurements) {
    fuzz::require(m.lambda_nm >= leaf::kConstantsRange_nm.min && m.lambda_nm <= leaf::kConstantsRange_nm.max,
                  "wavelengths are in the range of the constants");
    fuzz::require(m.theta_deg >= 0 && m.theta_deg <= 180, "angles are in range");
    fuzz::require(m.r || m.t, "a measurement has a value");
    for (const auto& share : {m.r, m.t}) fuzz::require(!share || std::isfinite(*share), "a share is finite");
  }
}

FROND_FUZZ_TARGET(measured_spectra, bytes) {
  for (const char* name : {"", "a"})  // a file of one leaf, and a leaf among several
    fuzz::accepts([&] { check(leaf::parse_measured_spectra(bytes, "leaf.csv", {.leaf = name}), bytes.size()); });
  fuzz::accepts([&] {
    for (const leaf::MeasuredLeaf& leaf : leaf::parse_measured_leaves(bytes, "leaf.csv", {}))
      if (leaf.error.empty()) check(leaf.spectra, bytes.size());
  });
}
