#include <gtest/gtest.h>

#include <cmath>

#include "core/log.h"
#include "tests/leaf/statistics.h"
#include "tests/support/bind.h"
#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::ChannelMean;
using test::render_text;
using test::z_limit;
using test::z_of_chi_square;

/// A flat leaf that fills the film, seen at 40 degrees by an orthographic camera, adaxial side up.
std::string flat_leaf(const std::string& light, const std::string& leaf, const std::string& placement = "",
                      const std::string& integrator = "\"integer maxdepth\" 1") {
  return fmt::format(R"(
LookAt {} 0 {}  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-.1 .1 -.1 .1]
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent"
PixelFilter "box"
Integrator "path" {}
WorldBegin
{}
Material {}
{}
Shape "trianglemesh" "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] "integer indices" [0 1 2  0 2 3]
)",
                     std::sin(40 * M_PI / 180), std::cos(40 * M_PI / 180), integrator, light, leaf, placement);
}

const std::string kAbm = R"("abm" "string specimen" "soybean")";
const std::string kWeighted = R"("abm" "string specimen" "soybean" "string mode" "weighted")";
const std::string kSimplified = R"("leaf_simplified" "string specimen" "soybean" "string tablemethod" "solve")";
const std::string kAbove =
    R"(LightSource "distant" "point3 from" [-.3 .2 1] "point3 to" [0 0 0] "spectrum L" "stdillum-D65")";
const std::string kBelow =
    R"(LightSource "distant" "point3 from" [-.3 .2 -1] "point3 to" [0 0 0] "spectrum L" "stdillum-D65")";

/// Two-sided z-test of two independent means; 5 standard errors: a false alarm in 1.7 million.
void expect_same(const ChannelMean& a, const ChannelMean& b, const std::string& what) {
  EXPECT_LT(std::abs(a.mean - b.mean), 5 * std::hypot(a.error, b.error) + 1e-5 * std::abs(a.mean))
      << what << ": " << a.mean << " and " << b.mean;
}

void expect_same(const Film& a, const Film& b, const std::string& what) {
  for (size_t c = 0; c < 3; ++c)
    expect_same(channel_mean(a, c), channel_mean(b, c), fmt::format("{}, channel {}", what, c));
}

/// The material's own f cos, channel by channel, averaged over calls with separate streams.
std::array<ChannelMean, 3> own_f_cos(const std::string& plugin, std::vector<ParsedParam> params, const Vec3& wo,
                                     const Vec3& wi, int calls) {
  const Registry registry = make_registry(builtin_materials(), builtin_integrators());
  const auto strategy = test::make_plugin(registry.wavelengths.get("smpte", {}), {});
  const auto material = test::make_plugin(registry.materials.get(plugin, {}), std::move(params));
  ThreadPool pool(2);
  const Log& quiet = silent_log();
  material->prepare({*strategy, pool, quiet, {}});
  const SampledWavelengths lambda = strategy->sample(0.5f);
  Arena arena;
  const Bsdf* bsdf = material->evaluate({{}, {0, 0, 1}, Frame::around({0, 0, 1}), {}}, lambda, arena);
  std::array<double, 3> sum{}, squares{};
  for (int i = 0; i < calls; ++i) {
    RandomStream rng(hash_key(77, uint64_t(i)));
    const SampledSpectrum f = bsdf->f(wo, wi, rng);
    for (size_t c = 0; c < 3; ++c) {
      const double x = double(f[int(c)]) * double(std::abs(wi.z));
      sum[c] += x, squares[c] += x * x;
    }
  }
  std::array<ChannelMean, 3> means;
  const double n = calls;
  for (size_t c = 0; c < 3; ++c)
    means[c] = {sum[c] / n, calls > 1 ? std::sqrt(std::max(0.0, squares[c] - sum[c] * sum[c] / n) / (n * (n - 1))) : 0};
  return means;
}

TEST(FlatLeaf, ConvergesToTheMaterialsOwnF) {
  const Vec3 wo{std::sin(40 * kPi / 180), 0, std::cos(40 * kPi / 180)};
  const ParsedParam specimen{"string", "specimen", {}, {}, std::vector<std::string>{"soybean"}};
  const ParsedParam solve{"string", "tablemethod", {}, {}, std::vector<std::string>{"solve"}};
  for (const auto& [light, z] : {std::pair{kAbove, 1.f}, std::pair{kBelow, -1.f}}) {
    const Vec3 wi = normalize(Vec3{-.3f, .2f, z});
    const Film simplified = render_text(flat_leaf(light, kSimplified), {.samples = 4});
    const auto exact = own_f_cos("leaf_simplified", {specimen, solve}, wo, wi, 1);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(channel_mean(simplified, c).mean, exact[c].mean, 1e-4 * exact[c].mean);
    const Film walk = render_text(flat_leaf(light, kAbm), {.samples = 2000});
    const auto own = own_f_cos("abm", {specimen}, wo, wi, 100000);
    for (size_t c = 0; c < 3; ++c) {
      expect_same(channel_mean(walk, c), own[c], "abm, channel " + std::to_string(c));
      EXPECT_LT(own[c].error, 0.05 * own[c].mean) << "the test has lost its power";
    }
  }
}

/// Noise that hung on directions would be the same in every pixel here, and no number of samples would remove it.
TEST(FlatLeaf, NoiseOfTheWalkIsIndependentFromPixelToPixel) {
  const Film film = render_text(flat_leaf(kAbove, kAbm), {.samples = 500});
  const ChannelMean all = channel_mean(film, 1);
  double chi2 = 0;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) chi2 += std::pow(film.mean(x, y)[1] - all.mean, 2) / film.variance(x, y)[1];
  EXPECT_LT(std::abs(z_of_chi_square(chi2, 63)), z_limit(1)) << chi2;
}

TEST(FlatLeaf, ReverseOrientationAndAMirrorSwapTheSides) {
  for (const std::string& leaf : {kSimplified, kWeighted}) {
    const Film adaxial = render_text(flat_leaf(kAbove, leaf), {.samples = 1000});
    const Film reversed = render_text(flat_leaf(kAbove, leaf, "ReverseOrientation"), {.samples = 1000, .seed = 2});
    const Film mirrored = render_text(flat_leaf(kAbove, leaf, "Scale 1 1 -1"), {.samples = 1000, .seed = 3});
    const Film both =
        render_text(flat_leaf(kAbove, leaf, "ReverseOrientation Scale 1 1 -1"), {.samples = 1000, .seed = 4});
    const Film turned = render_text(flat_leaf(kAbove, leaf, "Rotate 180 1 0 0"), {.samples = 1000, .seed = 5});
    expect_same(reversed, mirrored, leaf + " reversed, mirrored");
    expect_same(reversed, turned, leaf + " reversed, turned over");
    expect_same(adaxial, both, leaf + " twice swapped");
    // The abaxial side reflects several times more in the blue.
    EXPECT_GT(channel_mean(reversed, 2).mean, 2 * channel_mean(adaxial, 2).mean) << leaf;
  }
}

/// Two layers of leaf under light from everywhere: analog, weighted, and without light sampling, pixel by pixel.
TEST(Walk, AnalogWeightedAndScatteringAloneAgreeWithinTheirNoise) {
  const std::string sky = R"(LightSource "infinite" "spectrum L" "stdillum-D65")";
  const std::string second = R"(Shape "disk" "float height" -.05 "float radius" 3)";
  const auto scene = [&](const std::string& leaf, const char* direct) {
    return flat_leaf(sky, leaf, second, fmt::format("\"integer maxdepth\" 6 \"bool sampledirect\" {}", direct));
  };
  const std::array films{render_text(scene(kAbm, "true"), {.samples = 1600, .seed = 1}),
                         render_text(scene(kWeighted, "true"), {.samples = 1600, .seed = 2}),
                         render_text(scene(kAbm, "false"), {.samples = 1600, .seed = 3}),
                         render_text(scene(kWeighted, "false"), {.samples = 1600, .seed = 4})};
  for (size_t i = 1; i < films.size(); ++i) expect_same(films[0], films[i], "variant " + std::to_string(i));
  EXPECT_LT(channel_mean(films[0], 1).error, 0.02 * channel_mean(films[0], 1).mean) << "the test has lost its power";
}

}  // namespace
}  // namespace frond
