#include "leaf/table/mode_table_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/log.h"
#include "leaf/table/mode_table_cache.h"
#include "leaf/tissue/specimens.h"
#include "tests/support/input_error.h"

namespace frond::leaf {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;
namespace fs = std::filesystem;

ModeTableRequest request_of(std::string_view specimen, std::vector<double> wavelengths) {
  return {.params = find_specimen(specimen)->params, .wavelengths_nm = std::move(wavelengths), .tolerance = 1e-2};
}

void expect_same(const ModeTable& a, const ModeTable& b) {
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.error, b.error);
  ASSERT_EQ(a.modes.size(), b.modes.size());
  for (size_t c = 0; c < a.modes.size(); ++c)
    for (const bool below : {false, true})
      for (const bool crosses : {false, true})
        EXPECT_EQ(a.modes[c].series(below, crosses), b.modes[c].series(below, crosses)) << c;
}

TEST(ModeTableFile, ComesBackToTheBit) {
  for (const char* specimen : {"soybean", "maize"}) {
    const ModeTableRequest request = request_of(specimen, {608, 455});
    const ModeTable made = make_mode_table(request, ThreadPool(2));
    const ModeTableFile read = parse_mode_table_file(to_text(request, made, describe(request)), "test");
    EXPECT_EQ(read.wavelengths_nm(), request.wavelengths_nm);
    expect_same(read.spectrum, made);
  }
}

TEST(ModeTableFile, KeepsDepths) {
  ModeTableRequest request = request_of("soybean", {608, 455});
  request.depths = DepthAxis(0.1, 0.3, 0.5);
  const ModeTable made = make_mode_table(request, ThreadPool(2));
  const ModeTableFile read = parse_mode_table_file(to_text(request, made, ""), "test");
  ASSERT_EQ(read.columns.size(), 2 * request.depths.depths().size());
  EXPECT_EQ(read.columns[1].depth, request.depths.depths()[1]);
  expect_same(read.spectrum, made);
}

/// The same number in all nine places of a mode's file, for one cell.
std::string mode_of(double h) { return fmt::format("{0} {0} {0}\n{0} {0} {0}\n{0} {0} {0}\n", h); }

/// A leaf that scatters equally in all directions.
std::string plain_leaf() {
  std::string text = "# plain\ncells 1\nerror 0 # none\n\nwavelength_nm 551 index 1.4 depth 0\n";
  for (const char* side : {"adaxial", "abaxial"})
    for (const char* way : {"reflected", "transmitted"})
      text += fmt::format("{} {} modes 1\n{}", side, way, mode_of(0.02));
  return text;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const size_t place = text.find(what);
  EXPECT_NE(place, text.npos) << what;
  return text.replace(place, what.size(), by);
}

TEST(ModeTableFile, NamesWhatIsWrongAndWhere) {
  const std::string sound = plain_leaf();
  EXPECT_EQ(error_of([&] { parse_mode_table_file(sound, "leaf.modes"); }), "");
  struct {
    std::string what, by, message;
  } const kCases[] = {
      {"cells 1", "cells 0", "leaf.modes:2:7: cells: 1 to 32, 0 was given"},
      {"cells 1", "cells 1 2", "leaf.modes:2:9: 3 words in place of cells N"},
      {"cells", "Rs,Rd,T\ncells", "leaf.modes:2:1: 1 word in place of cells N"},
      {"error 0", "errors 0", "leaf.modes:3:1: \"error\" is expected here, not \"errors\""},
      {"551", "green", "leaf.modes:5:15: wavelength_nm is a number, \"green\" was given"},
      {"index 1.4", "index 0.9", "leaf.modes:5:25: index is from 1.001 to 10, 0.9 was given"},
      {"adaxial trans", "abaxial trans", "leaf.modes:10:1: \"adaxial\" is expected here, not \"abaxial\""},
      {"modes 1", "modes 65", "leaf.modes:6:25: modes: 1 to 64, 65 was given"},
      {"0.02", "-0.02", "leaf.modes:7:1: mode 0 is a mean over azimuth and not below 0, -0.02 was given"},
      {"0.02", "nan", "leaf.modes:7:1: nan is not a finite number"},
      {"0.02 0.02\n", "0.02\n", "leaf.modes:7:6: 2 words in place of the 3 numbers of mode 0"},
      {mode_of(0.02), mode_of(0.5), "leaf.modes:5:1: of light that enters the adaxial side at 0.0 degrees"},
  };
  for (const auto& [what, by, message] : kCases) {
    const std::string text = replaced(sound, what, by);
    EXPECT_THAT(error_of([&] { parse_mode_table_file(text, "leaf.modes"); }), HasSubstr(message));
  }
  EXPECT_THAT(error_of([&] { parse_mode_table_file(sound.substr(0, sound.size() - 15), "leaf.modes"); }),
              HasSubstr("the file ends before the 3 numbers of mode 0"));
  EXPECT_THAT(error_of([&] { parse_mode_table_file("", "leaf.modes"); }), HasSubstr("the file ends before cells N"));
  EXPECT_THAT(error_of([&] { parse_mode_table_file(sound + "0.02\n", "leaf.modes"); }),
              HasSubstr(":22:1: 1 word in place of"));
  EXPECT_THAT(error_of([&] { parse_mode_table_file(std::string("\0", 1), "leaf.modes"); }),
              HasSubstr("not a text file"));
}

TEST(ModeTableFile, IsRefusedWhereItCannotBeReadOrSaysThingsTwice) {
  const TestFolder folder("body_file");
  EXPECT_THAT(error_of([&] { read_mode_table_file(folder.name_of(""), {}); }), HasSubstr("it is a folder"));
  EXPECT_THAT(error_of([&] { read_mode_table_file(folder.name_of("none"), {}); }), HasSubstr("No such file"));
  EXPECT_EQ(error_of([] { read_mode_table_file("/dev/zero", {}); }),
            "cannot read mode table \"/dev/zero\": it is no regular file");
  const std::string sound = plain_leaf();
  const fs::path twice = folder.write("twice", sound + sound.substr(sound.find("wavelength_nm")));
  EXPECT_THAT(error_of([&] { read_mode_table_file(twice, {}); }),
              HasSubstr("twice:22:1: 551 nm is given twice, first in line 5"));
}

TEST(ModeTableFile, IsTheCacheToo) {
  const TestFolder folder("body_cache");
  const ModeTableRequest request = request_of("soybean", {551});
  const auto get = [&] { return cached_mode_table(request, "test", ThreadPool(1), silent_log(), folder.name_of("")); };
  const ModeTable made = get();
  const std::vector<fs::path> files(fs::directory_iterator(folder.name_of("")), fs::directory_iterator());
  ASSERT_THAT(files, SizeIs(1));
  expect_same(read_mode_table_file(files[0], {}).spectrum, made);
  expect_same(get(), made);
  const auto text = [&] {
    std::ifstream in(files[0]);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  const std::string whole = text();
  for (const std::string& damaged : {std::string(), whole.substr(0, whole.size() / 2), whole + "0\n"}) {
    std::ofstream(files[0]) << damaged;
    expect_same(get(), made);
    EXPECT_EQ(text(), whole);
  }
}

TEST(ModeTableFile, LiesBetweenItsWavelengths) {
  const ModeTableRequest request = request_of("soybean", {608, 455});
  const ModeTableFile file{{{608, 0, {}}, {455, 0, {}}}, make_mode_table(request, ThreadPool(2))};
  const ModeTable between = at_wavelengths(file, {400, 493.25, 608});
  expect_same(at_wavelengths(file, {608, 455}), file.spectrum);
  const auto value = [](const ModeTable& s, size_t c) { return s.modes[c].series(false, false)[0][7]; };
  EXPECT_EQ(value(between, 0), value(file.spectrum, 1));
  EXPECT_NEAR(value(between, 1), 0.75 * value(file.spectrum, 1) + 0.25 * value(file.spectrum, 0), 1e-15);
  EXPECT_NEAR(between.index[1], 0.75 * file.spectrum.index[1] + 0.25 * file.spectrum.index[0], 1e-15);
}

}  // namespace
}  // namespace frond::leaf
