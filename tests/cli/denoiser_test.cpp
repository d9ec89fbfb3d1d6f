#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "image/image_file.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A coated plate that fills the view: its BSDF is a random walk, whose weights have much noise.
class ForDenoiser : public CommandTest {
 protected:
  void SetUp() override {
    folder_.write("scene.pbrt", R"(
LookAt 0 0 1  0 0 0  0 1 0
Camera "orthographic"
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
Sampler "lattice" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 2
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
Material "coateddiffuse" "rgb reflectance" [ .5 .5 .5 ] "float roughness" 0.3
Shape "disk" "float radius" 9
)");
  }
  ImageFile render(const std::string& output, const Words& more) const {
    const Outcome o = frond_command({"render", path("scene.pbrt"), "--no-cache", "-q", "-o", path(output)}, more);
    EXPECT_EQ(o.code, 0) << o.err;
    return read_image(path(output), {});
  }
  /// Mean, and standard deviation between pixels, of a channel.
  static std::pair<double, double> moments(const ImageFile& file, const char* name) {
    double sum = 0, squares = 0;
    const std::vector<float> plane = file.image.plane(file.image.channel(name).value());
    for (const float v : plane) sum += double(v), squares += double(v) * double(v);
    const double mean = sum / double(plane.size());
    return {mean, std::sqrt(std::max(squares / double(plane.size()) - mean * mean, 0.0))};
  }
  /// Covariance of neighbours in a row over the variance.
  static double correlation(const ImageFile& file) {
    const size_t g = file.image.channel("G").value();
    const auto [mean, deviation] = moments(file, "G");
    double sum = 0;
    int count = 0;
    for (int y = 0; y < file.image.height; ++y)
      for (int x = 1; x < file.image.width; ++x, ++count)
        sum += (double(file.image.at(x, y, g)) - mean) * (double(file.image.at(x - 1, y, g)) - mean);
    return sum / count / (deviation * deviation);
  }
};

/// 552 pairs of neighbours: the correlation of independent pixels has a standard deviation of 0.043; five of them are
/// exceeded once in a million runs with other seeds. That of the Gaussian (standard deviation 0.479 pixels) is
/// exp(-1 / (4 * 0.479^2)) = 0.34, which falls below the limit once in a thousand.
TEST_F(ForDenoiser, PixelsAreIndependent) {
  const ImageFile splatted = render("a.exr", {}), separate = render("b.exr", {"--for-denoiser"});
  EXPECT_GT(correlation(splatted), 0.21);
  EXPECT_LT(std::abs(correlation(separate)), 0.21);
  EXPECT_EQ(splatted.header.text.count("frond:correlated_pixels"), 1u);
  EXPECT_EQ(separate.header.text.count("frond:correlated_pixels"), 0u);
  EXPECT_THAT(separate.header.text.at("frond:command"), HasSubstr("--for-denoiser"));
}

/// The furnace's light is 1 everywhere, so that the colour of the plate is its albedo, with the noise of one sample of
/// the BSDF: that of the albedo is a quarter. The channels change no colour.
TEST_F(ForDenoiser, HasChannelsWithLittleNoise) {
  const ImageFile colors = render("a.exr", {"--filter", "gaussian,reconstruction=importance"});
  const ImageFile file = render("b.exr", {"--for-denoiser", "--channels", "depth,albedo"});
  for (const char* name : {"Z", "albedo.R", "albedo.B", "normal.X", "normal.Z"})
    EXPECT_TRUE(file.image.channel(name)) << name;
  const ImageFile scattered =
      render("c.exr", {"--for-denoiser", "--integrator", "path,sampledirect=false", "--spp", "64"});
  for (const char* c : {"R", "G", "B"}) {
    const auto [albedo, noise] = moments(file, (std::string("albedo.") + c).c_str());
    const auto [color, color_noise] = moments(scattered, c);
    EXPECT_NEAR(albedo, color, 5 * std::hypot(noise, color_noise) / 24) << c;
    EXPECT_LT(noise, color_noise) << c << ": 256 samples of the BSDF against 64";
    EXPECT_EQ(file.image.plane(*file.image.channel(c)), colors.image.plane(*colors.image.channel(c)));
  }
}

TEST_F(ForDenoiser, OfBandsHasTheNormalsAlone) {
  const ImageFile file = render("a.exr", {"--for-denoiser", "--wavelengths", "550,650", "--spp", "1"});
  EXPECT_TRUE(file.image.channel("normal.X"));
  EXPECT_FALSE(file.image.channel("albedo.R"));
}

TEST_F(ForDenoiser, ContradictsSplatting) {
  const Outcome o = frond_command({"render", path("scene.pbrt"), "--for-denoiser", "--filter",
                                   "gaussian,reconstruction=splatting", "-o", path("a.exr")});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, HasSubstr("--for-denoiser means \"reconstruction=importance\""));
}

class WithoutColorSpace : public CommandTest {
 protected:
  /// Writes a grey image whose header has no colour space, as after a denoiser.
  void SetUp() override {
    Image image(4, 3, {"R", "G", "B"});
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i % 3 + 1) / 8;
    write_image(path("bare.exr"), image, {});
    write_image(path("stated.exr"), image, {"linear SMPTE-C", {}});
  }
  Outcome convert(const std::string& from, const std::string& to, const Words& more = {}) const {
    return frond_command({"convert", path(from), "-o", path(to)}, more);
  }
  std::string space_of(const std::string& name) const { return read_image(path(name), {}).header.color_space; }
};

TEST_F(WithoutColorSpace, AnImageIsTakenForSrgbWithAWarning) {
  const Outcome assumed = convert("bare.exr", "a.exr");
  EXPECT_EQ(assumed.code, 0) << assumed.err;
  EXPECT_THAT(assumed.err,
              HasSubstr("bare.exr does not state its colour space: linear sRGB is assumed; --color-space"));
  EXPECT_EQ(space_of("a.exr"), "linear sRGB");
  const Outcome given = convert("bare.exr", "b.exr", {"--color-space", "smpte-c"});
  EXPECT_THAT(given.err, IsEmpty());
  EXPECT_EQ(space_of("b.exr"), "linear SMPTE-C");
  EXPECT_THAT(convert("bare.exr", "c.exr", {"--color-space", "sgrb"}).err, HasSubstr("did you mean \"srgb\"?"));
  EXPECT_EQ(convert("bare.exr", "a.png").code, 0);
}

TEST_F(WithoutColorSpace, AFilesOwnStatementHolds) {
  EXPECT_EQ(convert("stated.exr", "a.exr", {"--color-space", "srgb"}).code, 0);
  EXPECT_EQ(space_of("a.exr"), "linear SMPTE-C");
}

}  // namespace
}  // namespace frond
