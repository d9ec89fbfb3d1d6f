#include "spectra/envi_library.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "spectra/spd_file.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using testing::HasSubstr;

std::string header(const std::string& type, const std::string& more = "") {
  return "ENVI\ndescription = {made for this test,\n = two lines}\nsamples = 3\nlines = 2\nbands = 1\nheader offset = "
         "2\n"
         "file type = ENVI Spectral Library\ndata type = " +
         type + "\ninterleave = bsq\nwavelength = {\n 500, 550.5,\n 600}\nspectra names = {leaf 1, \"leaf 2\"}\n" +
         more;
}

/// The values as the bytes of a type, after two other bytes; `swaps`: in the other order.
template <class T>
std::string bytes(const std::vector<double>& values, bool swaps = false) {
  std::string data = "xx";
  for (const double v : values) {
    const T value = static_cast<T>(v);
    char of_value[sizeof value];
    std::memcpy(of_value, &value, sizeof value);
    if (swaps) std::reverse(std::begin(of_value), std::end(of_value));
    data.append(of_value, sizeof value);
  }
  return data;
}

TEST(EnviLibrary, IsATableWithASpectrumInEachColumn) {
  const std::string table =
      "ENVI Spectral Library\nwavelength(nm),\"leaf 1\",\"leaf 2\"\n500,0.25,0.5\n550.5,0.125,0.375\n600,0,1\n";
  const std::vector<double> values{0.25, 0.125, 0, 0.5, 0.375, 1}, scaled{2500, 1250, 0, 5000, 3750, 10000};
  const std::string factor = "reflectance scale factor = 10000\n";
  EXPECT_EQ(envi_library_table(header("4"), bytes<float>(values), {}), table);
  EXPECT_EQ(envi_library_table(header("5"), bytes<double>(values), {}), table);
  EXPECT_EQ(envi_library_table(header("4", "byte order = 1\n"), bytes<float>(values, true), {}), table);
  EXPECT_EQ(envi_library_table(header("2", factor), bytes<int16_t>(scaled), {}), table);
  EXPECT_EQ(envi_library_table(header("12", factor + "byte order = 1\n"), bytes<uint16_t>(scaled, true), {}), table);
  EXPECT_EQ(envi_library_table(header("3", factor), bytes<int32_t>(scaled), {}), table);
  EXPECT_THAT(envi_library_table(header("2", "data ignore value = -1\n"), bytes<int16_t>({1, -1, 2, 3, 4, 5}), {}),
              HasSubstr("550.5,,4\n"));
  EXPECT_THAT(envi_library_table(header("4", "wavelength units = Micrometers\n"), bytes<float>(values), {}),
              HasSubstr("wavelength(um),"));
}

TEST(EnviLibrary, WhatDoesNotMatchIsRefused) {
  const auto error = [](const std::string& head, const std::string& data) {
    return error_of([&] { envi_library_table(head, data, {}); });
  };
  const std::string data = bytes<float>({1, 2, 3, 4, 5, 6});
  const auto with = [](std::string head, const std::string& from, const std::string& to) {
    return head.replace(head.find(from), from.size(), to);
  };
  EXPECT_THAT(error("samples = 3\n", data), HasSubstr("begins with \"ENVI\""));
  EXPECT_THAT(error(header("4"), data.substr(1)),
              HasSubstr("2 spectra of 3 samples has 26 bytes of data, 25 are here"));
  EXPECT_THAT(error(header("6"), data), HasSubstr("data type 6"));
  EXPECT_THAT(error(with(header("4"), "Spectral Library", "Standard"), data),
              HasSubstr("of an image, \"ENVI Standard\""));
  EXPECT_THAT(error(with(header("4"), "samples = 3", "samples = 4"), data + data),
              HasSubstr("4 samples: 3 are listed"));
  EXPECT_THAT(error(with(header("4"), "samples = 3", "samples = 1e300"), data),
              HasSubstr("a line \"samples = NUMBER\""));
  EXPECT_THAT(error(with(header("4"), "550.5", "x"), data), HasSubstr("not a number"));
  EXPECT_THAT(error(header("4", "wavelength units = Wavenumber\n"), data), HasSubstr("not in \"wavenumber\""));
}

/// By its data and by its header; the spectrum of a leaf is FILE:NAME.
TEST(EnviLibrary, IsReadBesideItsHeader) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("frond_envi_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "a.sli", std::ios::binary) << bytes<float>({0.25, 0.125, 0, 0.5, 0.375, 1});
  EXPECT_THAT(error_of([&] { read_spectra_text(folder / "a.sli", {}, "spectra"); }), HasSubstr("a.hdr is missing"));
  std::ofstream(folder / "a.hdr") << header("4");
  for (const char* name : {"a.sli", "a.hdr"}) {
    const auto points = read_spd_points((folder / name).string() + ":leaf 2", {});
    ASSERT_EQ(points.size(), 3u) << name;
    EXPECT_EQ(points[1].lambda_nm, 550.5);
    EXPECT_EQ(points[1].value, 0.375);
  }
  EXPECT_THAT(error_of([&] { read_spd_points(folder / "a.sli", {}); }), HasSubstr("there are 2 columns of values"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace frond
