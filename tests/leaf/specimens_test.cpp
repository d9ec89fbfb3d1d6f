#include "leaf/tissue/specimens.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

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
  const auto expect_row = [&](std::string_view name, std::string_view unit, auto TissueParams::*number) {
    const std::string row = fmt::format("| `{}` | {}| {} | {} |\n", name, unit, soybean.*number, maize.*number);
    EXPECT_NE(page.find(row), std::string::npos) << row;
  };
  for (const auto& [name, number] : {std::pair{"chlorophylla", &TissueParams::chlorophyll_a},
                                     {"chlorophyllb", &TissueParams::chlorophyll_b},
                                     {"carotenoids", &TissueParams::carotenoids},
                                     {"protein", &TissueParams::protein},
                                     {"cellulose", &TissueParams::cellulose},
                                     {"lignin", &TissueParams::lignin}})
    expect_row(name, "kg/m³ ", number);
  expect_row("mesophyllfraction", "", &TissueParams::mesophyll_fraction);
  expect_row("thickness", "m ", &TissueParams::thickness_m);
  expect_row("cuticleaspect", "", &TissueParams::cuticle_aspect);
  expect_row("epidermisaspect", "", &TissueParams::epidermis_aspect);
  expect_row("spongyaspect", "", &TissueParams::spongy_aspect);
  EXPECT_NE(page.find(fmt::format("| `palisadeaspect` | | {} | – |\n", soybean.palisade_aspect)), std::string::npos);
}

}  // namespace
}  // namespace frond::leaf
