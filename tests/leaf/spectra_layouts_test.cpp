#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <functional>

#include "leaf/fit/measured_spectra.h"
#include "spectra/spd_file.h"
#include "tests/support/input_error.h"

/// One spectrum in the layouts of instruments and libraries. The files are made here, in the published layouts.
namespace frond::leaf {
namespace {

using ::testing::HasSubstr;

struct Point {
  int nm;
  double r;
};
constexpr Point kPoints[] = {{400, 0.05}, {450, 0.06}, {551, 0.125}, {680, 0.0475}, {800, 0.45}, {1650, 0.3025}};

/// The points as lines; nm, R and R in percent for fmt.
std::string rows(std::string_view line, bool descending = false) {
  std::vector<Point> points(std::begin(kPoints), std::end(kPoints));
  if (descending) std::ranges::reverse(points);
  std::string text;
  for (const auto& [nm, r] : points) text += fmt::format(fmt::runtime(line), nm, r, 100 * r, nm / 1000.0) + "\n";
  return text;
}

/// A spectrum in a row.
std::string across(std::string_view format, bool names) {
  std::vector<std::string> fields;
  for (const auto& [nm, r] : kPoints)
    fields.push_back(names ? fmt::format(fmt::runtime(format), nm) : fmt::format("{}", r));
  return fmt::format("{}", fmt::join(fields, ","));
}

struct Layout {
  std::string name, text;
};

std::vector<Layout> layouts() {
  const std::string columns = rows("{0},{1}");
  return {
      {"CSV", "wavelength_nm,R\n" + columns},
      {"ASD ViewSpec", "Wavelength\tleaf00001.asd\r\n" + rows("{0}\t{1}\r")},
      {"ASD with its header",
       "Text conversion of header file leaf00001.asd\n-----\nThe instrument number was "
       "16456.\n\nWavelength\tleaf00001.asd.ref\n" +
           rows("{0}\t{1}")},
      {"Spectra Vista",
       "/*** Spectra Vista SIG Data ***/\nname= gr012211_0001.sig\ninstrument= HI: 1122011\nunits= Radiance, Radiance\n"
       "comm= a leaf\ndata= \n" +
           rows("{0}.0  1234.5  567.8  {2}")},
      {"Spectral Evolution",
       "Comment:\nVersion: 2.3 [1.2.3]\nInstrument: PSR+3500_SN123 [3]\nMeasurement: REFLECTANCE\nColumns [4]:\nData:\n"
       "Wvl\tRad. (Ref.)\tRad. (Target)\tReflect. %\n" +
           rows("{0}\t12.5\t6.1\t{2}")},
      {"Spectral Evolution, older", "Comment:\nColumns [2]:\nData:\nWvl\tTgt./Ref. %\n" + rows("  {0}.0\t {2}")},
      {"ECOSTRESS",
       "Name: Quercus robur\nType: vegetation\nWavelength Range: TIR\nX Units: Wavelength (micrometers)\nY Units: "
       "Reflectance "
       "(percentage)\nFirst X Value: 1.65\nNumber of X Values: 6\nAdditional Information: none\n\n" +
           rows("{3}\t{2}", true)},
      {"ASTER",
       "Name: leaf\r\nX Units: Wavelength (micrometers)\r\nY Units: Reflectance (percent)\r\nAdditional Information: "
       "none\r\n\r\n" +
           rows("  {3}    {2}\r", true)},
      {"ENVI plot", "ENVI ASCII Plot File [Mon Nov  2 10:11:12 2026]\nColumn 1: Wavelength\nColumn 2: a leaf~~1\n" +
                        rows("  {0}.000000  {1}")},
      {"EcoSIS, a spectrum in each row",
       "Sample_ID,Species,Latitude," + across("{}", true) + "\nL1,QURO,48.1," + across("", false) + "\n"},
      {"R's names", "\"sample\",\"LMA\"," + across("X{}", true) + "\nL1,60.5," + across("", false) + "\n"},
      {"names with units", across("R_{}nm", true) + ",year\n" + across("", false) + ",2021\n"},
      {"a column for each leaf", "wl,L1,L2\n" + rows("{0},{1},0.5")},
      {"after a head, with decimal commas", "Leaf clip\nOperator;A. B.\nwavelength;Reflectance (%)\n" +
                                                [] {
                                                  std::string text = rows("{0};{2}");
                                                  std::ranges::replace(text, '.', ',');
                                                  return text;
                                                }()},
  };
}

TEST(SpectraLayouts, HoldTheSameNumbers) {
  for (const auto& [name, text] : layouts()) {
    SCOPED_TRACE(name);
    const SpectraMeasurement how{.leaf = name == "a column for each leaf" ? "L1" : ""};
    MeasuredSpectra spectra = parse_measured_spectra(text, "leaf.txt", how);
    std::ranges::sort(spectra.measurements, {}, &LeafMeasurement::lambda_nm);
    ASSERT_EQ(spectra.measurements.size(), std::size(kPoints));
    for (size_t i = 0; i < std::size(kPoints); ++i) {
      EXPECT_NEAR(spectra.measurements[i].lambda_nm, kPoints[i].nm, 1e-9);
      EXPECT_NEAR(*spectra.measurements[i].r, kPoints[i].r, 1e-12);
    }
    EXPECT_EQ(spectra.layout.empty(), name == "CSV" || name == "after") << spectra.layout;
  }
}

// Spectrum parameters and responses read files of instruments as well; percent of R becomes a share.
TEST(SpectraLayouts, AreSpectraOfParameters) {
  for (const auto& [name, text] : layouts()) {
    if (name.find("row") != name.npos || name.find("names") != name.npos || name == "a column for each leaf") continue;
    SCOPED_TRACE(name);
    const std::vector<SpectrumPoint> points = parse_spd_points(text, "leaf.txt");
    ASSERT_EQ(points.size(), std::size(kPoints));
    for (size_t i = 0; i < std::size(kPoints); ++i) {
      EXPECT_NEAR(points[i].lambda_nm, kPoints[i].nm, 1e-9);
      EXPECT_NEAR(points[i].value, kPoints[i].r, 1e-12);
    }
  }
}

TEST(SpectraLayouts, KeepTheirLines) {
  const auto where = [](const std::string& text) {
    return error_of([&] { parse_measured_spectra(text, "leaf.txt", {}); });
  };
  EXPECT_THAT(where("/*** Spectra Vista SIG Data ***/\nname= x\ndata=\n400 1 2 5\n450 1 2 x\n"),
              HasSubstr("leaf.txt:5:9: "));
  EXPECT_THAT(where("sample," + across("{}", true) + "\nL1,0.1,0.1,0.1,0.1,0.1,7\n"), HasSubstr("leaf.txt:2:24: "));
  EXPECT_THAT(where("sample," + across("{}", true) + "\nL1,0.1,0.1\n"),
              HasSubstr("leaf.txt:2:1: 3 fields, but the file has 7"));
}

TEST(SpectraLayouts, SayWhatTheyTook) {
  const MeasuredSpectra spectra = parse_measured_spectra(layouts()[9].text, "leaf.csv", {});
  EXPECT_EQ(spectra.layout, "a spectrum in each row, 6 wavelengths, taken as R");
  EXPECT_EQ(spectra.unused, (std::vector<std::string>{"Species", "Latitude"}));
  EXPECT_EQ(parse_measured_spectra(layouts()[3].text, "leaf.sig", {}).layout, "Spectra Vista (.sig)");
}

TEST(SpectraLayouts, RefuseWhatIsNoShareOfTheLight) {
  const auto error = [](const std::string& text) {
    return error_of([&] { parse_measured_spectra(text, "leaf.txt", {}); });
  };
  EXPECT_THAT(error("nm,radiance\n400,0.1\n"), HasSubstr("neither a column of reflectances"));
  EXPECT_THAT(error("nm,target,reference\n400,0.1,0.2\n"), HasSubstr("neither a column of reflectances"));
  EXPECT_THAT(error("Name: a\nX Units: Wavelength (micrometers)\nY Units: Emissivity\n\n0.5 0.95\n"),
              HasSubstr("neither a column of reflectances"));
  EXPECT_NE(error("/*** Spectra Vista SIG Data ***/\nname= x\n"), "");
  EXPECT_THAT(error("wl,L1,L2\n400,0.1,0.2\n"), HasSubstr("the file has 2 leaves"));
}

}  // namespace
}  // namespace frond::leaf
