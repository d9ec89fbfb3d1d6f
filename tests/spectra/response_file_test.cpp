#include "spectra/response_file.h"

#include <gmock/gmock.h>

#include "tests/support/input_error.h"

namespace frond {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// "NAME: NM VALUE NM VALUE ..." for each band.
std::vector<std::string> words(const std::vector<BandResponse>& bands) {
  std::vector<std::string> all;
  for (const BandResponse& band : bands) {
    std::string& text = all.emplace_back(band.name + ":");
    for (const SpectrumPoint& p : band.points) text += fmt::format(" {} {}", p.lambda_nm, p.value);
  }
  return all;
}

std::vector<std::string> read(const std::string& text, std::string_view column = {}) {
  return words(parse_responses(text, "srf.csv", column));
}

std::string error(const std::string& text, std::string_view column = {}) {
  return error_of([&] { parse_responses(text, "srf.csv", column); });
}

/// The layouts of ESA (Sentinel-2), NASA (OceanColor) and USGS (Landsat), and others, with the same numbers.
TEST(ResponseFile, TablesOfAgenciesHaveABandInEachColumn) {
  const auto is_same = ElementsAre("B4: 600 0 650 0.5 700 1 750 0", "B8: 750 0 800 1");
  for (const std::string text :
       {"SR_WL,B4,B8\n0,0,0\n600,0,0\n650,0.5,0\n700,1,0\n750,0,0\n800,0,1\n",
        "SR_WL\tB4\tB8\n600\t0\t0\n650\t0.5\t0\n700\t1\t0\n750\t0\t0\n800\t0\t1\n",
        "/begin_header\n/missing=-999\n/delimiter=space\n! made for this test\n/fields=wavelength,B4,B8\n"
        "/units=nm,dimensionless,dimensionless\n/end_header\n   0.0  0.0  0.0\n 600.0  0.0  0.0\n 650.0 0.5 0\n"
        " 700 1 0\n 750 0 0\n 800 0 1\n",
        "/begin_header\n/delimiter=comma\n/fields=wavelength,B4,B8\n/units=um,none,none\n/end_header\n0.6,0,0\n"
        "0.65,.5,0\n.7,1,0\n.75,0,0\n.8,0,1\n",
        // Noise about 0, standard deviations, descending wavelengths.
        "Wavelength (nm),B4,STDDEV [watts],B8\n800,-0.001,0.1,1\n750,0,0.1,0\n700,1,0.1,-0.01\n650,0.5,0.1,0\n"
        "600,-0.002,0.1,0\n",
        // Bands of separate ranges, joined.
        "nm,B4,B8\n600,0,\n650,0.5,NaN\n700,1,NA\n750,0,0\n800,,1\n",
        "Band,Wavelength,RSR\nB4,600,0\nB4,650,0.5\nB8,750,0\nB4,700,1\nB4,750,0\nB8,800,1\n"})
    EXPECT_THAT(read(text), is_same) << text;
}

TEST(ResponseFile, OneBandIsSelected) {
  const std::string text = "SR_WL,B4,B8\n600,1,0\n700,1,0\n750,0,1\n";
  EXPECT_THAT(read(text, "b8"), ElementsAre("B8: 700 0 750 1"));
  EXPECT_THAT(read("band,wl,r\n1,600,1\n1,610,1\n2,700,1\n2,710,1\n", "2"), ElementsAre("2: 700 1 710 1"));
  EXPECT_THAT(error(text, "B5"), HasSubstr("srf.csv:1:1: there is no band \"B5\""));
}

TEST(ResponseFile, ABandOfNoResponseIsEmpty) {
  EXPECT_THAT(read("wl,B1,B2\n600,1,0\n700,1,0\n"), ElementsAre("B1: 600 1 700 1", "B2:"));
}

TEST(ResponseFile, WhatIsNoResponseIsRefused) {
  EXPECT_THAT(error("wl,B1,B2\n600,1,0\n700,x,0\n"), HasSubstr("srf.csv:3:5: a response is a number"));
  EXPECT_THAT(error("wl,B1,B2\n600,1,0\nnan,1,0\n"), HasSubstr("srf.csv:3:1: nan is not a wavelength"));
  EXPECT_THAT(error("wl,B1,B2\n600,1,0\n700,-0.5,0\n"), HasSubstr("a spectrum cannot be negative"));
  EXPECT_THAT(error("wl,B1,B2\n600,1,0\n700,-999,0\n"), HasSubstr("srf.csv:3:5"));
  EXPECT_THAT(error("wl,B1,B2\n600,1,0\n600,1,0\n"), HasSubstr("must ascend"));
  EXPECT_THAT(error("wl,B1,B2\n0.6,1,0\n0.7,1,0\n"), HasSubstr("are these micrometres?"));
  EXPECT_THAT(error("band,wl,r,q\n1,600,1,1\n"), HasSubstr("columns of bands, wavelengths and responses"));
  EXPECT_THAT(error("band,wl\n1,600\n"), HasSubstr("columns of bands, wavelengths and responses"));
  EXPECT_THAT(error(std::string("PK\3\4\0\0", 6)), HasSubstr("a workbook (.xlsx, .xls): save its sheet"));
}

}  // namespace
}  // namespace frond
