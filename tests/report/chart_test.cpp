#include "report/chart.h"

#include <gmock/gmock.h>

#include <regex>

#include "report/polar_map.h"
#include "system/file_bytes.h"
#include "tests/support/input_error.h"
#include "tests/support/xml.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<std::string> texts(const std::vector<Tick>& ticks) {
  std::vector<std::string> list;
  for (const Tick& t : ticks) list.push_back(t.text);
  return list;
}

/// A panel from 0 to 1 each way.
Chart chart_of(const Series& s) { return {1, {{400, 300, "", {"x (m)", {0, 1}}, {"y (s)", {0, 1}}, false, {s}}}}; }

std::string svg_of(const Chart& chart) {
  const std::string svg = chart_svg(chart);
  EXPECT_EQ(test::xml_error(svg), "") << svg;
  return svg;
}

size_t count(const std::string& svg, const std::string& pattern) {
  const std::regex regex(pattern);
  return size_t(std::distance(std::sregex_iterator(svg.begin(), svg.end(), regex), {}));
}

TEST(ChartTicks, AreMultiplesOfOneTwoAndFive) {
  EXPECT_THAT(texts(ticks_of({"", {0, 1}}, 5)), ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1"));
  EXPECT_THAT(texts(ticks_of({"", {-0.3, 0.3}}, 6)), ElementsAre("-0.3", "-0.2", "-0.1", "0", "0.1", "0.2", "0.3"));
  EXPECT_THAT(texts(ticks_of({"", {400, 2500}}, 4)), ElementsAre("1000", "2000"));
  EXPECT_THAT(texts(ticks_of({"", {-75, 75}, false, 30}, 2)), ElementsAre("-60", "-30", "0", "30", "60"));
  EXPECT_THAT(texts(ticks_of({"", {0, 2.5e-7}}, 3)), ElementsAre("0", "10⁻⁷", "2×10⁻⁷"));
}

TEST(ChartTicks, OfLogarithmicAxes) {
  EXPECT_THAT(texts(ticks_of({"", {0.03, 3}, true}, 8)), ElementsAre("0.05", "0.1", "0.2", "0.5", "1", "2"));
  EXPECT_THAT(texts(ticks_of({"", {1e-6, 1}, true}, 8)),
              ElementsAre("10⁻⁶", "10⁻⁵", "0.0001", "0.001", "0.01", "0.1", "1"));
  EXPECT_THAT(texts(ticks_of({"", {1e-8, 1e8}, true}, 5)), ElementsAre("10⁻⁸", "0.0001", "1", "10000", "10⁸"));
  EXPECT_THAT(texts(ticks_of({"", {3, 4}, true}, 5)), ElementsAre("3", "3.2", "3.4", "3.6", "3.8", "4"));
}

TEST(ChartSvg, EscapesTexts) {
  Chart chart = chart_of(line("<b> & \"c\"\x01", "#000000"));
  chart.title = "R > T — f (sr⁻¹)\n";
  const std::string svg = svg_of(chart);
  EXPECT_THAT(svg, AllOf(HasSubstr(">&lt;b&gt; &amp; \"c\" </text>"), HasSubstr("R &gt; T — f (sr⁻¹) <")));
  EXPECT_THAT(svg, AllOf(HasSubstr("DejaVu Sans, sans-serif"), HasSubstr(">x (m)<"), HasSubstr(">y (s)<")));
}

TEST(ChartSvg, CutsLongTextsBetweenCharacters) {
  std::string label;
  for (int i = 0; i < 200; ++i) label += "°";
  const std::string svg = svg_of(chart_of(line(label, "#000000")));
  EXPECT_THAT(svg, AllOf(HasSubstr("°°…</text>"), Not(HasSubstr(label))));
}

TEST(ChartSvg, LeavesOutWhatHasNoPlace) {
  Series s{"", "#123456", 2, Dash::solid, Mark::disk, 3, {{0, 0}, {0.2, 0.2}, {NAN, 0.3}, {0.4, INFINITY}, {1, 1}}};
  const std::string svg = svg_of(chart_of(s));
  EXPECT_EQ(count(svg, "<path transform"), 3u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
  // The curve is interrupted.
  EXPECT_EQ(count(svg, "<path d='M[0-9.,]+L[0-9.,]+M[0-9.,]+' fill='none' stroke='#123456'"), 1u);
}

TEST(ChartSvg, ZeroHasNoPlaceOnALogarithmicAxis) {
  Series s = marks("", "#123456", Mark::square, 3, {{0.1, 0, {-1, 10}}, {0.2, 10}, {0.3, 100}});
  Chart chart = chart_of(s);
  chart.panels[0].y = {"y", {}, true};
  const std::string svg = svg_of(chart);
  EXPECT_EQ(count(svg, "<path transform"), 2u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, AllOf(HasSubstr(">10<"), HasSubstr(">100<")));  // the range is that of the two
}

TEST(ChartSvg, ClipsWhatIsOutside) {
  const std::string svg = svg_of(chart_of({"", "#123456", 1, {}, Mark::disk, 3, {{0.5, 0.5}, {2, 0.5}, {1e300, 0.5}}}));
  EXPECT_EQ(count(svg, "<path transform"), 1u);
  EXPECT_THAT(svg, HasSubstr("clip-path='url(#p0)'"));
  EXPECT_EQ(count(svg, "[0-9]{7}"), 0u);  // no coordinate is far away
}

TEST(ChartSvg, DrawsNothingOfEmptySeries) {
  for (const bool logarithmic : {false, true}) {
    Chart chart{1, {{400, 300, "", {"x", {}, logarithmic}, {"y", {}, logarithmic}, false, {Series{}}}}};
    EXPECT_THAT(svg_of(chart), Not(HasSubstr("nan")));
  }
  EXPECT_EQ(svg_of(Chart{}).find("NaN"), std::string::npos);
}

/// The legend lies below the axes, and makes the chart higher.
TEST(ChartSvg, HasALegendOfWhatHasALabel) {
  const auto height = [](const std::string& svg) { return std::stod(svg.substr(svg.find("height='") + 8)); };
  const std::string none = svg_of(chart_of(line("", "#000000"))), one = svg_of(chart_of(line("one", "#000000")));
  EXPECT_EQ(height(none), 300);
  EXPECT_GT(height(one), 300);
  std::smatch place;
  ASSERT_TRUE(std::regex_search(one, place, std::regex("y='([0-9.]+)'[^>]*>one<")));
  EXPECT_GT(std::stod(place[1]), 300);
}

/// Right of the axes, which leave room for them, in the order of the ends and without an overlap; none is in the
/// legend.
TEST(ChartSvg, LabelsTheEndsOfCurves) {
  Chart chart = chart_of(line("", "#111111"));
  auto& series = chart.panels[0].series;
  series.clear();
  for (const auto& [label, y] : {std::pair{"low", 0.02}, {"middle", 0.05}, {"high\nsecond", 0.9}, {"same", 0.05}}) {
    series.push_back(line("", "#123456", 1, Dash::solid, {{0, 0.5}, {0.6, y}, {0.8, NAN}}));
    series.back().end = label;
  }
  const std::string svg = svg_of(chart);
  const auto place = [&svg](const std::string& label) {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(svg, found, std::regex("x='([0-9.]+)' y='([0-9.]+)'[^>]*>" + label + "<"))) << label;
    return std::pair{std::stod(found[1]), std::stod(found[2])};
  };
  EXPECT_EQ(count(svg, "height='300'"), 1u);  // without a legend
  EXPECT_GT(place("high").first, 300);
  EXPECT_EQ(place("high").second + 14, place("second").second);
  EXPECT_LT(place("second").second, place("middle").second);
  EXPECT_LE(place("middle").second + 16, place("same").second);
  EXPECT_LE(place("same").second + 16, place("low").second);
  EXPECT_LT(place("low").second, 300 - 30);
  EXPECT_EQ(count(svg, "<path d='M[0-9.]+,[0-9.]+L[0-9.]+,[0-9.]+' fill='none' stroke='#123456' stroke-width='0.6'"),
            4u);
}

TEST(ChartSvg, IsTheSameEachTime) {
  const auto make = [] {
    return chart_svg(chart_of(line("a", "#000000", 1, Dash::dotted, {{0.1, 1. / 3}, {0.7, 0.9}})));
  };
  EXPECT_EQ(make(), make());
}

TEST(ColorScale, GoesFromEndToEnd) {
  const ColorScale scale{{"f", {1, 100}, true}};
  EXPECT_EQ(scale.color(1), "#440154");
  EXPECT_EQ(scale.color(10), "#21908d");
  EXPECT_EQ(scale.color(1000), "#fde725");
  EXPECT_EQ(scale.color(0), "#440154");
  EXPECT_EQ(scale.color(NAN), "#c0c0c0");
  EXPECT_THAT(svg_of({1, {scale.panel(300)}}), AllOf(HasSubstr(">10<"), HasSubstr(">f<")));
}

TEST(ChartFiles, AreRefusedBeforeAnythingIsMeasured) {
  const TestFolder folder("chart");
  EXPECT_THAT(error_of([&] { check_chart(folder.name_of("a.gif")); }), HasSubstr(".svg or a .png"));
  EXPECT_THAT(error_of([&] { check_chart(folder.name_of("no/a.svg")); }), HasSubstr("there is no folder"));
  EXPECT_THAT(error_of([&] { check_chart(folder.name_of("a.svg")); }), IsEmpty());
  EXPECT_EQ(error_of([&] { check_chart(folder.name_of("a.png")); }), png_refusal());
}

TEST(ChartFiles, ArePngWhereThereIsLibrsvg) {
  if (const std::string why = png_refusal(); !why.empty()) {
    EXPECT_THAT(why, AllOf(HasSubstr("librsvg2"), HasSubstr(".svg do not")));
    GTEST_SKIP() << why;
  }
  const TestFolder folder("chart");
  write_chart(folder.name_of("a.png"), chart_of(line("a", "#000000", 2, Dash::solid, {{0, 0}, {1, 1}})));
  const std::string png = read_file_bytes(folder.name_of("a.png"), {});
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png.substr(16, 4), std::string("\0\0\x01\x90", 4));  // 400 pixels wide
  write_chart(folder.name_of("b.png"), chart_of(line("a", "#000000", 2, Dash::solid, {{0, 0}, {1, 1}})));
  EXPECT_EQ(read_file_bytes(folder.name_of("b.png"), {}), png);
}

}  // namespace
}  // namespace frond
