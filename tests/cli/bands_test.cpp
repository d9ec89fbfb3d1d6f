#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "image/image_file.h"
#include "image/spectral_layout.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(SpectralChannels, AreNamedAfterTheLayout) {
  EXPECT_EQ(spectral_channel(551), "S0.551,000000nm");
  EXPECT_EQ(spectral_channel(1032.25), "S0.1032,250000nm");
  EXPECT_EQ(wavelength_of_channel("S0.1032,250000nm"), 1032.25);
  EXPECT_EQ(wavelength_of_channel("S0.551nm"), 551);
  for (const char* other : {"R", "S1.551,000000nm", "variance.551,000000nm", "S0.nm", "S0.5x1nm", "S0.551"})
    EXPECT_FALSE(wavelength_of_channel(other)) << other;
}

/// A plate that fills the view and reflects half at 900 nm and 0.1 below 700, in equal-energy light from everywhere.
class BandCommands : public CommandTest {
 protected:
  void SetUp() override {
    setenv("SOURCE_DATE_EPOCH", "0", 1);
    folder_.write("scene.pbrt", R"(
LookAt 0 0 1  0 0 0  0 1 0
Camera "orthographic"
Film "rgb" "integer xresolution" 6 "integer yresolution" 4
Sampler "lattice" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 2 "bool sampledirect" false
WorldBegin
LightSource "infinite" "spectrum L" [300 1 2500 1]
Material "diffuse" "spectrum reflectance" [300 0.1 700 0.1 900 0.5 2500 0.5]
Shape "disk" "float radius" 9
)");
    folder_.write("nir.spd", "840 0  850 1  950 1  960 0");
  }
  Outcome render(const std::string& wavelengths, const std::string& output, const Words& more = {}) const {
    return frond_command(
        {"render", path("scene.pbrt"), "--no-cache", "-q", "-o", path(output), "--wavelengths", wavelengths}, more);
  }
  /// Radiance of a white plate in this light.
  static double white() { return 1 / 106.856895; }  // over the integral of ybar
};

TEST_F(BandCommands, GiveOneChannelForEachBandAndReadBack) {
  const Outcome o = render("bands,wavelengths=450,551,640,800,900,2200", "a.exr");
  ASSERT_EQ(o.code, 0) << o.err;
  const ImageFile file = read_image(path("a.exr"), {});
  for (const auto& [nm, reflectance] : {std::pair{450., 0.1}, {551., 0.1}, {800., 0.3}, {900., 0.5}, {2200., 0.5}}) {
    const auto channel = file.image.channel(spectral_channel(nm));
    ASSERT_TRUE(channel) << nm;
    // Every scattered ray meets the sky: nothing is left to chance.
    for (int x = 0; x < 6; ++x) EXPECT_NEAR(double(file.image.at(x, 1, *channel)) / white(), reflectance, 1e-4) << nm;
    EXPECT_TRUE(file.image.channel("variance." + spectral_channel(nm).substr(3)));
  }
  EXPECT_TRUE(file.image.channel("leaf"));
  EXPECT_EQ(file.header.text.at("spectralLayoutVersion"), "1.0");
  EXPECT_EQ(file.header.text.at("emissiveUnits"), "W.m^-2.sr^-1");
  EXPECT_EQ(file.header.text.at("frond:wavelengths"), "bands,wavelengths=450,551,640,800,900,2200");
}

TEST_F(BandCommands, ShowColorsWhereTheBandsCoverTheVisible) {
  ASSERT_EQ(render("bands,wavelengths=450,550,650,700", "a.exr").code, 0);
  const ImageFile visible = read_image(path("a.exr"), {});
  EXPECT_EQ(visible.header.color_space, "linear sRGB");
  // A flat spectrum of 0.1 under equal-energy light, whose luminance is 0.1.
  double luminance = 0;
  for (const auto& [name, weight] : {std::pair{"R", 0.2126}, {"G", 0.7152}, {"B", 0.0722}})
    luminance += weight * double(visible.image.at(0, 0, visible.image.channel(name).value()));
  EXPECT_NEAR(luminance, 0.1, 1e-3);
  ASSERT_EQ(render("bands,wavelengths=800,850,900,950,1000", "b.exr").code, 0);
  EXPECT_FALSE(read_image(path("b.exr"), {}).image.channel("R"));
}

TEST_F(BandCommands, TakeASensorsResponsesAndWriteThem) {
  const Outcome o = render("bands,responses=" + path("nir.spd"), "a.exr", {"--spp", "64"});
  ASSERT_EQ(o.code, 0) << o.err;
  const ImageFile file = read_image(path("a.exr"), {});
  const auto channel = file.image.channel("S0.nir");
  ASSERT_TRUE(channel) << ::testing::PrintToString(file.image.channels);
  EXPECT_EQ(file.header.text.at("S0.nir"), "840nm:0;850nm:1;950nm:1;960nm:0;");
  // The mean of the reflectance, linear from 0.38 at 840 nm to 0.5 at 900, under the trapezium: by Simpson's rule
  // 0.4845.
  double sum = 0, area = 0;
  for (double nm = 840.05; nm < 960; nm += 0.1) {
    const double s = std::clamp(std::min(nm - 840, 960 - nm) / 10, 0.0, 1.0);
    sum += s * std::min(0.1 + (nm - 700) * 0.002, 0.5), area += s;
  }
  double mean = 0, error = 0;
  const auto variance = file.image.channel("variance.nir").value();
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 6; ++x)
      mean += double(file.image.at(x, y, *channel)), error += double(file.image.at(x, y, variance));
  // 5 standard errors: one false alarm in 1.7 million seeds, and this one is fixed.
  EXPECT_NEAR(mean / 24 / white(), sum / area, 5 * std::sqrt(error) / 24 / white());
}

TEST_F(BandCommands, WriteTheResponsesPointByPoint) {
  folder_.write("narrow.spd", "300 0  839.25 0  840.25 0.125  841.25 0  2500 0");
  const Outcome o = render("bands,responses=" + path("narrow.spd"), "a.exr");
  ASSERT_EQ(o.code, 0) << o.err;
  const ImageFile file = read_image(path("a.exr"), {});
  EXPECT_EQ(file.header.text.at("S0.narrow"), "839.25nm:0;840.25nm:0.125;841.25nm:0;");
}

/// Bands with equal mean wavelengths.
TEST_F(BandCommands, HaveNamesInImagesPartsAndConversions) {
  folder_.write("par.spd", "400 1  700 1");
  folder_.write("green.spd", "540 1  560 1");
  const std::string bands =
      "bands,responses=" + path("par.spd") + "," + path("green.spd") + "," + path("nir.spd") + ",names=PAR,G,nir";
  ASSERT_EQ(render(bands, "whole.exr").code, 0);
  ASSERT_EQ(frond_command(
                {"render", path("scene.pbrt"), "--no-cache", "-q", "--part", path("a.part"), "--wavelengths", bands})
                .code,
            0);
  ASSERT_EQ(frond_command({"merge", path("a.part"), "-o", path("merged.exr"), "-q"}).code, 0);
  const ImageFile file = read_image(path("whole.exr"), {}), merged = read_image(path("merged.exr"), {});
  EXPECT_THAT(bands_of(file.image), ::testing::ElementsAre("G", "PAR", "nir"));  // EXR sorts channels
  EXPECT_EQ(merged.image.channels, file.image.channels);
  EXPECT_EQ(merged.image.pixels, file.image.pixels);
  EXPECT_EQ(merged.header.text.at("S0.G"), "540nm:1;560nm:1;");
  const auto value = [&](const char* name) { return double(file.image.at(0, 0, file.image.channel(name).value())); };
  EXPECT_NEAR(value("S0.PAR") / white(), 0.1, 1e-4);
  EXPECT_NEAR(value("S0.G") / white(), 0.1, 1e-4);
  EXPECT_GT(value("S0.nir") / white(), 0.3);
  const auto convert = [&](const std::string& chosen) {
    return frond_command({"convert", path("whole.exr"), "--bands", chosen, "-o", path("shown.exr"), "-q"});
  };
  ASSERT_EQ(convert("nir,PAR,G").code, 0);
  const ImageFile shown = read_image(path("shown.exr"), {});
  EXPECT_GT(shown.image.at(0, 0, shown.image.channel("R").value()), 0.3f);
  EXPECT_NEAR(shown.image.at(0, 0, shown.image.channel("B").value()), 0.1f, 1e-4);
  EXPECT_THAT(convert("nir,PAR,red").err, HasSubstr("has no band \"red\"; its bands are G, PAR, nir"));
  EXPECT_THAT(convert("nir,PAR").err, HasSubstr("takes three bands, as in 850,650,550 or nir,red,green; 2 were given"));
  EXPECT_THAT(convert("nir,550,G").err, HasSubstr("no band within 10 nm of 550 nm; its bands are at G, PAR, nir"));
  EXPECT_THAT(frond_command({"convert", path("whole.exr"), "-o", path("b.png")}).err,
              HasSubstr("holds bands G, PAR, nir and no colours; frond convert --bands nir,PAR,G"));
}

/// The order in which wavelengths are named changes no value.
TEST_F(BandCommands, MayBeNamedInAnyOrder) {
  for (const auto& [ascending, other] :
       {std::pair{"450,640,900", "900,450,640"}, {"450,500,551,640,900,2200", "2200,640,450,900,551,500"}}) {
    ASSERT_EQ(render(std::string("bands,wavelengths=") + ascending, "a.exr").code, 0);
    ASSERT_EQ(render(std::string("bands,wavelengths=") + other, "b.exr").code, 0);
    const ImageFile a = read_image(path("a.exr"), {}), b = read_image(path("b.exr"), {});
    EXPECT_EQ(a.image.channels, b.image.channels);
    for (const double nm : {450., 640., 900.})
      EXPECT_NEAR(a.image.at(2, 2, a.image.channel(spectral_channel(nm)).value()),
                  b.image.at(2, 2, b.image.channel(spectral_channel(nm)).value()), 1e-4 * white());
  }
}

TEST_F(BandCommands, AreNoImageUntilThreeAreChosen) {
  const Outcome png = render("bands,wavelengths=650,551,900", "a.png");
  EXPECT_EQ(png.code, 1);
  EXPECT_THAT(png.err, HasSubstr("frond convert --bands"));
  ASSERT_EQ(render("bands,wavelengths=650,551,900", "a.exr").code, 0);
  const auto convert = [&](const std::string& bands, const std::string& to) {
    return frond_command({"convert", path("a.exr"), "--bands", bands, "-o", path(to)});
  };
  ASSERT_EQ(convert("899,650,551", "b.exr").code, 0);
  const ImageFile shown = read_image(path("b.exr"), {});
  EXPECT_NEAR(shown.image.at(0, 0, shown.image.channel("R").value()), 0.5f, 1e-4);
  EXPECT_NEAR(shown.image.at(0, 0, shown.image.channel("G").value()), 0.1f, 1e-4);
  EXPECT_EQ(convert("899,650,551", "b.png").code, 0);
  EXPECT_THAT(convert("800,650,551", "c.png").err, HasSubstr("no band within 10 nm of 800 nm"));
  EXPECT_THAT(convert("800,650", "c.png").code, 1);
  EXPECT_EQ(frond_command({"convert", path("b.exr"), "--bands", "899,650,551", "-o", path("d.png")}).code, 1);
}

TEST_F(BandCommands, SayHowTheyAreShownAndCompared) {
  ASSERT_EQ(render("bands,wavelengths=800,850,900,950,1000", "a.exr").code, 0);
  for (const auto& command : {std::vector<std::string>{"convert", path("a.exr"), "-o", path("b.png")},
                              {"difference", path("a.exr"), path("a.exr"), path("a.exr"), path("a.exr")}}) {
    const Outcome o = frond_command(command);
    EXPECT_EQ(o.code, 1);
    EXPECT_THAT(o.err, HasSubstr("a.exr holds bands from 800 to 1000 nm and no colours"));
    EXPECT_THAT(o.err, HasSubstr("frond convert --bands 1000,900,800"));
    EXPECT_THAT(o.err, HasSubstr("frond compare --wavelengths bands,..."));
  }
  EXPECT_EQ(frond_command({"convert", path("a.exr"), "--bands", "1000,900,800", "-o", path("b.png")}).code, 0);
}

TEST_F(BandCommands, NeedSamplesEnoughToSeeEachBand) {
  const Outcome o = render("bands,lambdamin=400,lambdamax=500,step=1", "a.exr", {"--spp", "25"});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, HasSubstr("101 bands need 26 samples"));
  EXPECT_EQ(render("bands,lambdamin=400,lambdamax=500,step=1", "a.exr", {"--spp", "26"}).code, 0);
}

TEST_F(BandCommands, NameDataThatEndTooSoon) {
  folder_.write("d65.pbrt", R"(WorldBegin LightSource "infinite" "spectrum L" "stdillum-D65")");
  const Outcome o =
      frond_command({"render", path("d65.pbrt"), "-o", path("a.exr"), "--wavelengths", "bands,wavelengths=551,900"});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, HasSubstr("is known from 360 to 830 nm, the render needs 551 to 900 nm"));
}

TEST_F(BandCommands, GiveLeavesTheSameValuesWhetherWavelengthsAreFixedOrInTurn) {
  folder_.write("leaf.pbrt", R"(
LookAt 0 0 1  0 0 0  0 1 0
Camera "orthographic"
Film "rgb" "integer xresolution" 2 "integer yresolution" 2
WorldBegin
LightSource "infinite" "spectrum L" [300 1 2500 1]
Material "leaf_lambert"
Shape "disk" "float radius" 9
)");
  const auto leaf = [&](const std::string& bands, const std::string& to) {
    const Outcome o = frond_command({"render", path("leaf.pbrt"), "--no-cache", "-q", "--spp", "1024", "-o", path(to),
                                     "--wavelengths", "bands,wavelengths=" + bands});
    EXPECT_EQ(o.code, 0) << o.err;
    const ImageFile file = read_image(path(to), {});
    const auto at = [&](const std::string& name) {
      return double(file.image.at(0, 0, file.image.channel(name).value()));
    };
    return std::pair{at(spectral_channel(711.3)), at("variance.711,300000nm")};
  };
  const auto [fixed, fixed_variance] = leaf("551,711.3", "a.exr");
  const auto [in_turn, in_turn_variance] = leaf("500,551,600,711.3,800,1300", "b.exr");
  // 5 standard errors: one false alarm in 1.7 million seeds, and this one is fixed.
  EXPECT_NEAR(fixed, in_turn, 5 * std::sqrt(fixed_variance + in_turn_variance));
}

}  // namespace
}  // namespace frond
