// Film "spectral": pbrt-v4's buckets beside the colours.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/film/image_format.h"
#include "render/parts/part_file.h"
#include "spectra/analytic.h"
#include "spectra/cie.h"
#include "spectra/tabulated.h"
#include "tests/render/render_scene.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using test::SceneRender;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class SpectralFilm : public ::testing::Test {
 protected:
  /// The scene of the other tests with this film.
  std::filesystem::path scene(const std::string& film) const {
    std::string text = test::a_scene();
    text.replace(text.find("Film \"rgb\""), 10, "Film \"spectral\" " + film);
    return folder_.write("scene.pbrt", text);
  }
  /// An even sky of this light, and nothing else.
  std::filesystem::path sky(const std::string& film, const std::string& light, const std::string& more = "") const {
    return folder_.write("sky.pbrt", fmt::format(R"(
Camera "perspective"
Film "spectral" "integer xresolution" 40 "integer yresolution" 27 {}
{}
WorldBegin
LightSource "infinite" {}
)",
                                                 film, more, light));
  }
  /// Mean of a channel.
  static double mean(const Image& image, const std::string& name) {
    double sum = 0;
    const std::vector<float> plane = image.plane(image.channel(name).value());
    for (const float v : plane) sum += double(v);
    return sum / double(plane.size());
  }
  static Image image(const RenderPart& part) { return film_image(part.film, finished_format(part)); }

  TestFolder folder_{"spectral_film"};
};

TEST_F(SpectralFilm, HasTheChannelsOfPbrt) {
  const Image sixteen = image(SceneRender{}.part(scene(""), {0, 4}));
  for (const char* name : {"R", "G", "B", "S0.374,688nm", "S0.404,062nm", "S0.815,312nm", "variance.374,688nm", "leaf"})
    EXPECT_THAT(sixteen.channels, Contains(name));
  EXPECT_EQ(std::ranges::count_if(sixteen.channels, [](const std::string& n) { return n.starts_with("S0."); }), 16);
  const Image wide = image(SceneRender{}.part(
      sky("\"integer nbuckets\" 7 \"float lambdamin\" 400 \"float lambdamax\" 2500", "\"spectrum L\" \"stdillum-E\""),
      {0, 4}));
  for (const char* name : {"S0.550,000nm", "S0.850,000nm", "S0.2350,000nm"}) EXPECT_THAT(wide.channels, Contains(name));
}

/// A light that is linear in the wavelength has the value at its centre as mean in a bucket. In each bucket are more
/// than 10,000 samples, whose standard deviation is below 8 %: 0.5 % is more than 6 standard errors of independent
/// samples (false alarms below 1e-7), with both ways of filtering.
TEST_F(SpectralFilm, HasTheMeanRadianceOfLinearLight) {
  const TabulatedSpectrum light(std::vector<SpectrumPoint>{{300, 1}, {1100, 3}});
  for (const char* filter : {"gaussian", "box"}) {
    const RenderPart part = SceneRender{.filter = filter}.part(
        sky("\"integer nbuckets\" 6 \"float lambdamin\" 400 \"float lambdamax\" 1000 \"float iso\" 250",
            "\"spectrum L\" [ 300 1 1100 3 ]"),
        {0, 16});
    const Image all = image(part);
    for (int i = 0; i < 6; ++i) {
      const int nm = 450 + 100 * i;
      const double expected = double(light.at(float(nm))) * photometric(ConstantSpectrum(1)) / photometric(light);
      EXPECT_NEAR(mean(all, fmt::format("S0.{},000nm", nm)), expected, 0.005 * expected) << filter << nm;
    }
    EXPECT_EQ(unsampled_text(part.film), "");
  }
}

/// The colours are those of film "rgb", within 6 standard errors of the mean over the image.
TEST_F(SpectralFilm, HasTheColorsOfFilmRgb) {
  const RenderPart spectral = SceneRender{.seed = 2}.part(scene(""), {0, 32});
  const RenderPart rgb = SceneRender{}.part(folder_.write("rgb.pbrt", test::a_scene()), {0, 32});
  const Image a = image(spectral), b = image(rgb);
  for (const char* c : {"R", "G", "B"}) {
    const double variance = mean(a, std::string("variance.") + c) + mean(b, std::string("variance.") + c);
    EXPECT_NEAR(mean(a, c), mean(b, c), 6 * std::sqrt(variance / (40 * 27))) << c;
  }
}

TEST_F(SpectralFilm, HasBucketsWithoutExposure) {
  const Image one = image(SceneRender{}.part(scene(""), {0, 4}));
  for (const auto& [iso, factor] : {std::pair{"250", 2.5}, {"0", 0.}}) {
    const Image other = image(SceneRender{}.part(scene(fmt::format("\"float iso\" {}", iso)), {0, 4}));
    EXPECT_NEAR(mean(other, "S0.550,938nm"), mean(one, "S0.550,938nm"), 1e-6 * mean(one, "S0.550,938nm"));
    EXPECT_NEAR(mean(other, "G"), factor * mean(one, "G"), 1e-6 * mean(one, "G"));
  }
}

TEST_F(SpectralFilm, PartsAddUpToTheWhole) {
  for (const char* filter : {"gaussian", "box"}) {
    const SceneRender how{.filter = filter};
    const auto file = scene("\"integer nbuckets\" 5");
    const RenderPart whole = how.part(file, {0, 20});
    std::vector<std::filesystem::path> files;
    for (const auto& range : {SampleRange{0, 7}, {7, 20}}) {
      const RenderPart part = how.part(file, range);
      files.emplace_back(folder_.name_of(fmt::format("{}.part", range.begin)));
      write_part(files.back(), part.header, part.film);
    }
    const RenderPart merged = merge_parts(files);
    EXPECT_EQ(merged.film, whole.film);
    EXPECT_EQ(image(merged).channels, image(whole).channels);
    EXPECT_EQ(image(merged).pixels, image(whole).pixels);
  }
}

/// Four samples cover 16 buckets if they are stratified. Of independent ones (3/4)^4 = 32 % have none, with a standard
/// error of 0.3 % (17,280 values): the first digit 3 fails with probability below 1e-9.
TEST_F(SpectralFilm, ReportsBucketsWithoutSamples) {
  const std::string light = "\"spectrum L\" \"stdillum-E\"";
  const SceneRender how{.filter = "box"};
  EXPECT_EQ(unsampled_text(how.part(sky("", light), {0, 4}).film), "");
  const auto independent = sky("", light, "Sampler \"independent\"");
  EXPECT_THAT(unsampled_text(how.part(independent, {0, 4}).film), ::testing::StartsWith("3"));
  Session session(silent_log());
  const LoadedScene loaded = how.load(session, independent);
  EXPECT_THAT(error_of([&] { loaded.check_samples(3); }), HasSubstr("16 bands need 4 samples"));
}

TEST_F(SpectralFilm, NeedsWavelengthsOfItsBuckets) {
  const auto file = sky("\"float lambdamin\" 350", "\"spectrum L\" \"stdillum-E\"");
  EXPECT_THAT(error_of([&] {
                (void)SceneRender{.wavelengths = "hero,lambdamin=360"}.part(file, {0, 4});
              }),
              HasSubstr("the film's channels reach from 350 to 830 nm, the wavelengths from 360 to 830 nm"));
  const RenderPart bands = SceneRender{.wavelengths = "bands,wavelengths=550,650"}.part(file, {0, 4});
  EXPECT_FALSE(bands.film.format().has_buckets());
  EXPECT_THAT(image(bands).channels, Contains("S0.550,000000nm"));
  const RenderPart smpte = SceneRender{.wavelengths = "smpte"}.part(file, {0, 4});
  EXPECT_EQ(smpte.film.bands(), 0u);
  EXPECT_THAT(error_of([&] {
                (void)SceneRender{}.part(sky("\"float lambdamax\" 350", "\"rgb L\" 1"), {0, 4});
              }),
              HasSubstr("lambdamax"));
}

/// Beyond the data of the scene's spectra it is an error, as in bands.
TEST_F(SpectralFilm, RefusesDataThatEndTooSoon) {
  EXPECT_THAT(error_of([&] {
                (void)SceneRender{}.part(sky("\"float lambdamax\" 1050", "\"rgb L\" [ 1 1 1 ]"), {0, 4});
              }),
              HasSubstr("is known from"));
}

}  // namespace
}  // namespace frond
