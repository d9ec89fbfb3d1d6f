#include "leaf/tissue/specimens.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "leaf/fit/measured_spectra.h"
#include "leaf/solve/solver.h"
#include "tests/support/slow.h"

namespace frond::leaf {
namespace {

std::string conventions() {
  std::stringstream text;
  text << std::ifstream(FROND_SOURCE_DIR "/docs/conventions.md").rdbuf();
  return text.str();
}

TEST(Specimens, TheConventionsSayWhatTheyAre) {
  const std::string page = conventions();
  const TissueParams &soybean = find_specimen("soybean")->params, &maize = find_specimen("maize")->params;
  const auto expect_row = [&](std::string_view name, std::string_view unit) {
    const std::string row =
        fmt::format("| `{}` | {}| {} | {} |\n", name, unit, soybean.number(name), maize.number(name));
    EXPECT_NE(page.find(row), std::string::npos) << row;
  };
  for (const char* name : {"chlorophylla", "chlorophyllb", "carotenoids", "protein", "cellulose", "lignin"})
    expect_row(name, "kg/m³ ");
  expect_row("otherabsorption", "1/m ");
  for (const char* name : {"mesophyllfraction", "cuticleaspect", "epidermisaspect", "spongyaspect"})
    expect_row(name, "");
  expect_row("thickness", "m ");
  EXPECT_NE(page.find(fmt::format("| `palisadeaspect` | | {} | – |\n", soybean.palisade_aspect)), std::string::npos);
}

/// Root mean square error of R and T together at 8 degrees, over all measurements.
double rmse(const Specimen& specimen, const std::vector<LeafMeasurement>& measurements) {
  const TissueModel model(specimen.params);
  double sum = 0;
  for (const LeafMeasurement& measurement : measurements) {
    const Shares s = solve(model.at(measurement.lambda_nm), std::array{measurement.theta_deg})[0];
    sum += std::pow(s.surface + s.subsurface - *measurement.r, 2) + std::pow(s.transmitted - *measurement.t, 2);
  }
  return std::sqrt(sum / static_cast<double>(2 * measurements.size()));
}

TEST(Specimens, ThatAreFittedAreAsNearAsTheySay) {
  const std::string folder = FROND_SOURCE_DIR "/tests/reference/";
  int fitted = 0;
  for (const Specimen& specimen : kSpecimens) {
    const std::string name(specimen.name);
    const size_t said = specimen.source.find("RMSE ");
    if (said == std::string_view::npos || specimen.source.find("PROSPECT") != std::string_view::npos) continue;
    const std::string species = name.substr(0, name.find('-'));
    if (!slow_tests() && species != "soybean") continue;  // the least wavelengths
    ++fitted;
    const bool is_of_davis = species == "grape" || species == "toyon";
    const auto measurements = read_measured_spectra(folder + (species == "soybean" ? "lopex93_soybean.csv"
                                                              : is_of_davis        ? "davis_leaves.csv"
                                                                                   : "lopex93_leaves.csv"),
                                                    {.leaf = species == "soybean" ? "" : species + "_0000"})
                                  .measurements;
    EXPECT_NEAR(rmse(specimen, measurements), std::stod(std::string(specimen.source.substr(said + 5))), 2e-4) << name;
  }
  EXPECT_EQ(fitted, slow_tests() ? 7 : 1);
}

}  // namespace
}  // namespace frond::leaf
