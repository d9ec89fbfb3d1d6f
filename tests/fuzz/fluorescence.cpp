// Matrices of fluorescence, and emission shapes (a spectrum of photons).

#include "leaf/fluorescence/emission.h"
#include "leaf/fluorescence/emission_matrices.h"
#include "spectra/spd_file.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(fluorescence, bytes) {
  fuzz::accepts([&] {
    const leaf::EmissionMatrices m(bytes, "m.csv", {.is_energy = true, .scale = 0.2});
    for (const double excitation : {400.0, 433.3, 550.0, 750.0}) {
      fuzz::require(m.emitted(excitation) >= 0 && m.emitted(excitation) <= 1 + 1e-9, "at most one photon is emitted");
      for (const double emission : {640.0, 685.5, 850.0})
        for (const bool abaxial : {false, true}) {
          const auto [lit, opposite] = m.at(emission, excitation, abaxial);
          fuzz::require_finite(std::array{lit, opposite}, "a number of photons");
          fuzz::require(lit >= 0 && opposite >= 0, "numbers of photons are not negative");
        }
    }
  });
  fuzz::accepts([&] {
    const leaf::EmissionShape shape("emission", parse_spd_points(bytes, "emission.csv"), {});
    double sum = 0;
    for (double nm = 640; nm <= 850; ++nm) sum += shape.at(nm);
    fuzz::require(std::abs(sum - 1) < 1e-9, "the emission is normalised");
  });
}
