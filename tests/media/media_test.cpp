// Media, their phase functions and majorants, and bad input.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <numbers>

#include "core/parallel.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "media/nanovdb_grid.h"
#include "scene/format/parser.h"
#include "scene/scene.h"
#include "spectra/analytic.h"
#include "spectra/cie.h"
#include "spectra/color/color_space.h"
#include "system/file_bytes.h"
#include "tests/support/input_error.h"
#include "tests/support/slow.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kHead =
    "Option \"string wavelengths\" \"bands,wavelengths=450,551,650\"\nFilm \"rgb\" \"integer xresolution\" 4 "
    "\"integer yresolution\" 4\nIntegrator \"volpath\"\n";

/// A scene whose camera is in the medium "m".
struct InMedium {
  explicit InMedium(const std::string& medium, const std::string& head = std::string(kHead))
      : description(parse_scene_text(
            head + "MakeNamedMedium \"m\" " + medium + "\nMediumInterface \"m\"\nCamera \"perspective\"\nWorldBegin\n",
            FROND_SOURCE_DIR "/tests/pbrt_reference/s.pbrt", silent_log())),
        scene(description, make_registry(builtin_materials(), builtin_integrators()), pool, silent_log()) {}
  const Medium& medium() const { return *scene.camera_medium(); }
  SampledWavelengths lambda() const { return scene.wavelengths().sample(0.5f); }

  ThreadPool pool{1};
  SceneDescription description;
  Scene scene;
};

std::string refusal_of(const std::string& medium) {
  return error_of([&] { InMedium scene(medium); });
}

Vec3 direction(RandomStream& rng) {
  const float z = 1 - 2 * rng.uniform(), phi = 2 * kPi * rng.uniform(), r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// Density integrates to 1, and samples have it: histograms of 20 bins of the cosine, chi-squared with 19 degrees of
// freedom above 70 with probability 1e-7.
TEST(Phase, SamplesHaveTheDensity) {
  SampledSpectrum reflected;
  reflected[0] = 0.7f, reflected[1] = 0.1f;
  for (const auto& [phase, lane] : {std::pair{Phase::henyey_greenstein(0), 0},
                                    {Phase::henyey_greenstein(0.8f), 0},
                                    {Phase::henyey_greenstein(-0.5f), 0},
                                    {Phase::bi_lambertian(reflected), 0},
                                    {Phase::bi_lambertian(reflected), 1}}) {
    constexpr int kBins = 20, kSamples = 200000, kPerBin = 2000;
    std::array<double, kBins> expected{}, found{};
    for (int i = 0; i < kBins * kPerBin; ++i) {
      const double cosine = -1 + 2 * (i + 0.5) / (kBins * kPerBin);
      expected[size_t(i / kPerBin)] +=
          2 * std::numbers::pi * double(phase.value(float(cosine))[lane]) * 2 / (kBins * kPerBin);
    }
    double sum = 0, chi = 0;
    for (const double e : expected) sum += e;
    EXPECT_NEAR(sum, 1, 1e-3);
    RandomStream rng(1);
    const Vec3 w = direction(rng);
    for (int i = 0; i < kSamples; ++i) {
      const Vec3 wi = phase.sample(w, lane, {rng.uniform(), rng.uniform()}, rng);
      EXPECT_NEAR(length(wi), 1, 1e-4);
      found[size_t(std::clamp((dot(w, wi) + 1) / 2 * kBins, 0.f, kBins - 1.f))] += 1;
    }
    for (size_t i = 0; i < kBins; ++i) chi += std::pow(found[i] - kSamples * expected[i], 2) / (kSamples * expected[i]);
    EXPECT_LT(chi, 70);
  }
}

/// Points along random rays: the majorants cover all places where there is a density, and are no smaller.
void expect_bounded(const std::string& text, float reach = 3) {
  const InMedium in(text);
  const SampledWavelengths lambda = in.lambda();
  RandomStream rng(7);
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 toward{rng.uniform(), rng.uniform(), rng.uniform()}, d = direction(rng);
    Ray ray{toward - d * reach, d, 2 * reach};
    MajorantSteps steps = in.medium().majorants(ray, lambda);
    MajorantSteps::Step step{};
    float end = 0;
    const auto density_at = [&](float t) {
      const MediumPoint at = in.medium().properties(ray.o + ray.d * t, lambda);
      return at.sigma_a[0] + at.sigma_s[0];
    };
    while (steps.next(step)) {
      EXPECT_GE(step.begin, end == 0 ? 0 : end * 0.999999f);
      end = step.end;
      for (int k = 0; k < 4; ++k) {
        const float sigma = density_at(step.begin + (step.end - step.begin) * rng.uniform());
        EXPECT_LE(sigma, step.sigma[0] * 1.0001f + 1e-6f);
        met += sigma > 0;
      }
    }
  }
  EXPECT_GT(met, 1000);
}

TEST(Media, MajorantsAreUpperBounds) {
  expect_bounded(R"("string type" "homogeneous")");
  expect_bounded(R"("string type" "cloud")");
  expect_bounded(R"("string type" "cloud" "point3 p0" [0 0.6 0] "point3 p1" [1 1.3 1] "float density" 0.05)");
  std::string values, colors;
  RandomStream rng(3);
  for (int i = 0; i < 5 * 7 * 40; ++i) values += fmt::format(" {}", rng.uniform() < 0.7 ? 0 : rng.uniform());
  for (int i = 0; i < 3 * 3 * 3; ++i) colors += fmt::format(" {} {} {}", rng.uniform(), rng.uniform(), rng.uniform());
  expect_bounded(R"("string type" "uniformgrid" "integer nx" 5 "integer ny" 7 "integer nz" 40 "float density" [)" +
                 values + "]");
  expect_bounded(R"("string type" "rgbgrid" "integer nx" 3 "integer ny" 3 "integer nz" 3 "rgb sigma_s" [)" + colors +
                 "]");
}

TEST(Media, AGridHasItsValuesAtTheCentresOfCells) {
  const InMedium in(R"("string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 3
    "float density" [1 2 3 4 5 6] "float sigma_s" 0)");
  const auto at = [&](const Vec3& p) { return in.medium().properties(p, in.lambda()).sigma_a[0]; };
  for (int z = 0; z < 3; ++z)
    for (int x = 0; x < 2; ++x)
      EXPECT_NEAR(at({0.25f + 0.5f * float(x), 0.5f, (float(z) + 0.5f) / 3}), float(1 + x + 2 * z), 1e-5f);
  EXPECT_NEAR(at({0.5f, 0.5f, 0.5f}), 3.5f, 1e-5f);
  EXPECT_NEAR(at({0.f, 0.5f, 0.5f}), 1.5f, 1e-5f) << "half of the outermost value at a face";
}

TEST(Media, TooManyExpectedNullCollisionsAreRefusedWithTheirPlace) {
  const auto refused = ::testing::AllOf(HasSubstr("s.pbrt:4:"), HasSubstr("more than 100000 null collisions"));
  const std::string spike = R"("integer nx" 2 "point3 p0" [-2 -2 -2] "point3 p1" [2 2 2] )";
  EXPECT_THAT(refusal_of(R"("string type" "cloud" "point3 p0" [-2 -2 -2] "point3 p1" [2 2 2] "float density" 0
    "float sigma_s" 1e9 "float sigma_a" 0)"),
              refused);
  EXPECT_THAT(refusal_of(R"("string type" "uniformgrid" "float density" [1e-6 1e30] "float sigma_a" 0 )" + spike),
              refused);
  EXPECT_THAT(refusal_of(R"("string type" "rgbgrid" "rgb sigma_a" [0 0 0 0 0 0]
    "rgb sigma_s" [0 0 0 1e20 1e20 1e20] )" +
                         spike),
              refused);
}

TEST(Media, DenseOrThinMediaAreNotRefused) {
  EXPECT_EQ(refusal_of(R"("string type" "uniformgrid" "float density" 1e30)"), "") << "all collisions are real";
  EXPECT_EQ(refusal_of(R"("string type" "uniformgrid" "integer nx" 2 "float density" [0 1e3])"), "");
  EXPECT_EQ(refusal_of(R"("string type" "cloud" "float sigma_s" 1e3)"), "");
  EXPECT_EQ(refusal_of(R"("string type" "homogeneous" "float sigma_s" 1e30)"), "");
  EXPECT_EQ(refusal_of(R"("string type" "cloud" "point3 p0" [-2 1 -2] "point3 p1" [2 2 2] "float density" 0
    "float sigma_s" 1e9)"),
            "")
      << "its majorant is that of an empty cloud";
}

TEST(Media, BadInputIsRefusedWithItsPlace) {
  EXPECT_THAT(refusal_of(R"("float sigma_a" 1)"), HasSubstr("needs parameter \"string type\""));
  EXPECT_THAT(refusal_of(R"("string type" "homogenous")"), HasSubstr("did you mean \"homogeneous\"?"));
  EXPECT_THAT(refusal_of(R"("string type" "homogeneous" "float sigma_a" -1)"), HasSubstr("below 0"));
  EXPECT_THAT(refusal_of(R"("string type" "homogeneous" "string preset" "Skin9")"),
              HasSubstr("did you mean \"Skin1\""));
  EXPECT_THAT(refusal_of(R"("string type" "homogeneous" "string preset" "Skin1" "float sigma_a" 1)"),
              HasSubstr("exclude"));
  EXPECT_THAT(refusal_of(R"("string type" "uniformgrid")"), HasSubstr("needs parameter \"float density\""));
  EXPECT_THAT(refusal_of(R"("string type" "uniformgrid" "float density" [1 2 3] "integer nx" 2)"),
              HasSubstr("has 3 values, nx ny nz = 2 x 1 x 1 = 2 are needed"));
  EXPECT_THAT(refusal_of(R"("string type" "uniformgrid" "float density" 1 "float temperature" [1 2])"),
              HasSubstr("\"temperature\" has 2 values"));
  EXPECT_THAT(refusal_of(R"("string type" "uniformgrid" "float density" 1 "point3 p1" [1 0 1])"),
              HasSubstr("no extent along y"));
  EXPECT_THAT(refusal_of(R"("string type" "uniformgrid" "float density" -1)"), HasSubstr("outside its range"));
  EXPECT_THAT(refusal_of(R"("string type" "rgbgrid")"), HasSubstr("needs \"rgb sigma_a\" or \"rgb sigma_s\""));
  EXPECT_THAT(refusal_of(R"("string type" "rgbgrid" "rgb sigma_s" [1 1])"), HasSubstr("groups of 3"));
  EXPECT_THAT(refusal_of(R"("string type" "rgbgrid" "rgb sigma_s" [1 1 1] "rgb Le" [1 1 1])"),
              HasSubstr("needs \"rgb sigma_a\""));
  EXPECT_THAT(refusal_of(R"("string type" "nanovdb" "string filename" "missing.nvdb")"), HasSubstr("missing.nvdb"));
  EXPECT_THAT(error_of([] {
                (void)parse_scene_text(
                    "MakeNamedMedium \"mist\" \"string type\" \"homogeneous\"\nMediumInterface \"mits\"\n"
                    "Camera \"perspective\"\nWorldBegin\n",
                    "s.pbrt", silent_log());
              }),
              HasSubstr("s.pbrt:2:17: there is no medium \"mits\"; did you mean \"mist\"?"));
  EXPECT_THAT(error_of([] {
                (void)parse_scene_text(
                    "MakeNamedMedium \"m\" \"string type\" \"cloud\"\nMakeNamedMedium \"m\" "
                    "\"string type\" \"cloud\"\nWorldBegin\n",
                    "s.pbrt", silent_log());
              }),
              HasSubstr("s.pbrt:2:17: medium \"m\" is defined again"));
}

TEST(Media, ColoursAreNotKnownInTheInfrared) {
  const auto refusal_at_1650_nm = [](const std::string& medium) {
    return error_of([&] {
      InMedium scene(medium, "Option \"string wavelengths\" \"bands,wavelengths=550,1650\"\nIntegrator \"volpath\"\n");
    });
  };
  const std::string known = "is known from 360 to 830 nm, the render needs 550 to 1650 nm";
  EXPECT_THAT(refusal_at_1650_nm("\"string type\" \"homogeneous\"\n\"string preset\" \"Skin1\""),
              HasSubstr("s.pbrt:4:17: \"preset\" " + known));
  EXPECT_THAT(refusal_at_1650_nm("\"string type\" \"rgbgrid\"\n\"rgb sigma_s\" [1 1 1]"),
              HasSubstr("s.pbrt:4:16: \"sigma_s\" " + known));
  EXPECT_THAT(refusal_at_1650_nm("\"string type\" \"rgbgrid\" \"rgb sigma_a\" [1 1 1] \n\"rgb Le\" [1 1 1]"),
              HasSubstr("\"sigma_a\" " + known));
  EXPECT_EQ(refusal_at_1650_nm("\"string type\" \"homogeneous\" \"float sigma_a\" 2"), "");
}

/// The colour, relative to its largest channel, that the absorption of a grid has under D65.
Triple color_in_grid(const Medium& medium, const Vec3& unit, const ColorSpace& space) {
  Triple xyz{};
  double white = 0;
  for (int nm = 360; nm <= 830; ++nm) {
    SampledWavelengths lambda;
    lambda.nm[0] = float(nm), lambda.pdf[0] = 1, lambda.active[0] = true, lambda.count = 1;
    const double light = double(unit_d65()->at(float(nm))), sigma = double(medium.properties(unit, lambda).sigma_a[0]);
    const Triple bar = cie_xyz(nm);
    for (size_t i = 0; i < 3; ++i) xyz[i] += light * sigma * bar[i];
    white += light * bar[1];
  }
  for (double& v : xyz) v /= white;
  return inverse(space.xyz_from_rgb) * (bradford(to_xyz(*unit_d65()), kD65White.xyz()) * xyz);
}

// Most of these colours are no reflectance at half of their brightness.
TEST(Media, AGridHasTheColoursOfAWideSpace) {
  const ColorSpace& space = *find_color_space("rec2020");
  const std::array<Triple, 4> colors{{{1, 0, 0.02}, {0, 1, 0}, {0.02, 0.02, 1}, {0, 3, 1.5}}};
  std::string values;
  for (const Triple& c : colors) values += fmt::format(" {} {} {}", c[0], c[1], c[2]);
  const InMedium in("\"string type\" \"rgbgrid\" \"integer nx\" 4 \"float scale\" 1 \"rgb sigma_a\" [" + values + "]",
                    std::string(kHead) + "ColorSpace \"rec2020\"\n");
  for (size_t i = 0; i < colors.size(); ++i) {
    const Triple found = color_in_grid(in.medium(), {(float(i) + 0.5f) / 4, 0.5f, 0.5f}, space);
    const double largest = *std::ranges::max_element(colors[i]);
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], colors[i][k], 0.03 * largest) << i;
  }
}

// Beyond 10,000 distinct colours, most come from a table. The last layer along z has them.
TEST(Media, AGridHasManyColours) {
  constexpr int kSide = 22;
  const auto level = [](int i) { return double(i) / (kSide - 1); };
  std::string values;
  for (int z = 0; z < kSide; ++z)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) values += fmt::format(" {} {} {}", level(x), level(y), level(z));
  const InMedium in(R"("string type" "rgbgrid" "integer nx" 22 "integer ny" 22 "integer nz" 22 "rgb sigma_a" [)" +
                    values + "]");
  const auto middle = [](int i) { return (float(i) + 0.5f) / kSide; };
  for (const auto& [x, y] : {std::pair{0, 0}, {21, 0}, {0, 21}, {10, 15}, {21, 20}}) {
    const Triple found =
        color_in_grid(in.medium(), {middle(x), middle(y), middle(kSide - 1)}, *find_color_space("srgb"));
    const Triple expected{level(x), level(y), 1};
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 0.03) << x << ' ' << y;
  }
}

TEST(Media, AColourThatNoSpectrumHasIsRefused) {
  EXPECT_THAT(error_of([] {
                InMedium in("\"string type\" \"rgbgrid\"\n\"rgb sigma_a\" [0 0 1]",
                            std::string(kHead) + "ColorSpace \"aces2065-1\"\n");
              }),
              HasSubstr("s.pbrt:6:16: rgb (0, 0, 1) of color space \"aces2065-1\" is purer than any light can be"));
}

TEST(Media, AnEmptyOrEqualInterfaceIsNone) {
  const SceneDescription scene = parse_scene_text(
      "WorldBegin\nMakeNamedMedium \"m\" \"string type\" \"homogeneous\"\nMediumInterface \"\" \"\"\nShape \"sphere\"\n"
      "MediumInterface \"m\"\nShape \"sphere\"\nMediumInterface \"m\" \"\"\nShape \"sphere\"\nMediumInterface \"\"\n"
      "Shape \"sphere\"\n",
      "s.pbrt", silent_log());
  ASSERT_EQ(scene.shapes.size(), 4u);
  EXPECT_EQ(scene.shapes[0].medium_interface, 0u);
  EXPECT_EQ(scene.shapes[1].medium_interface, 0u);
  EXPECT_EQ(scene.shapes[2].medium_interface, 1u);
  EXPECT_EQ(scene.shapes[3].medium_interface, 0u);
}

const std::string kTorus = FROND_SOURCE_DIR "/tests/pbrt_reference/torus.nvdb";
std::string torus() { return read_file_bytes(kTorus, {}); }
std::unique_ptr<NanoVdbGrid> read_grid(std::string_view bytes, std::string_view name = "density") {
  return NanoVdbGrid::read(bytes, "torus.nvdb", name, {});
}
bool can_read() { return refusal_of(R"("string type" "nanovdb" "string filename" "torus.nvdb")").empty(); }

TEST(NanoVdb, MajorantsAreUpperBounds) {
  if (!can_read()) GTEST_SKIP() << "built without NanoVDB";
  expect_bounded(R"("string type" "nanovdb" "string filename" "torus.nvdb")");
}

TEST(NanoVdb, ReadsAFogVolume) {
  if (!can_read()) GTEST_SKIP() << "built without NanoVDB";
  const auto grid = read_grid(torus());
  ASSERT_TRUE(grid);
  EXPECT_FALSE(read_grid(torus(), "temperature"));
  EXPECT_NEAR(grid->bounds().min.x, -1.05f, 1e-4f);
  EXPECT_NEAR(grid->bounds().max.x, 1.2f, 1e-4f);
  EXPECT_NEAR(grid->at({0.75f, 0, 0}), 0.83f, 0.2f) << "in the tube";
  EXPECT_EQ(grid->at({0, 0, 0}), 0) << "in the hole";
  EXPECT_EQ(grid->at({100, 1e30f, -1e30f}), 0);
}

/// The torus with the magic numbers and the version that newer libraries write, without compression. `is_raw`: a grid
/// alone, without the file's header.
std::string newer_torus(bool is_raw, uint32_t version) {
  constexpr size_t kHeader = 16, kMeta = 176, kName = 8, kPackedSize = 8;
  std::string head = torus().substr(0, kHeader + kMeta + kName);
  const std::string packed = torus().substr(head.size() + kPackedSize);
  const auto number = [](std::string& bytes, size_t at) -> uint64_t& {
    return *reinterpret_cast<uint64_t*>(bytes.data() + at);
  };
  std::string grid(number(head, kHeader), '\0');
  uLongf size = grid.size();
  uncompress(reinterpret_cast<Bytef*>(grid.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
             packed.size());
  grid.replace(0, 8, "NanoVDB1");
  std::memcpy(grid.data() + 16, &version, sizeof version);
  head.replace(0, 8, "NanoVDB2");
  std::memcpy(head.data() + 8, &version, sizeof version);
  head[14] = 0;                             // no compression
  number(head, kHeader + 8) = grid.size();  // in the file
  return is_raw ? grid : head + grid;
}

TEST(NanoVdb, ReadsTheMagicNumbersOfNewerVersions) {
  if (!can_read()) GTEST_SKIP() << "built without NanoVDB";
  constexpr uint32_t kVersion = 32 << 21 | 9 << 10, kNextMajor = 33 << 21 | 1 << 10 | 2;
  const auto old = read_grid(torus());
  for (const bool is_raw : {false, true}) {
    const std::string bytes = newer_torus(is_raw, kVersion);
    const auto grid = read_grid(bytes);
    ASSERT_TRUE(grid) << is_raw;
    EXPECT_FALSE(read_grid(bytes, "temperature"));
    for (const Vec3& p : {Vec3{0.75f, 0, 0}, Vec3{0, 0.7f, 0.1f}, Vec3{0, 0, 0}}) EXPECT_EQ(grid->at(p), old->at(p));
    EXPECT_THAT(error_of([&] { (void)read_grid(newer_torus(is_raw, kNextMajor)); }),
                HasSubstr("it is of version 33.1.2, versions 32.x are read"));
    for (size_t size = 1; size < bytes.size(); size += size < 1300 ? 1 : 9973)
      EXPECT_THROW((void)read_grid(std::string_view(bytes).substr(0, size)), InputError) << size;
  }
}

TEST(NanoVdb, TruncatedAndDamagedFilesAreRefused) {
  if (!can_read()) GTEST_SKIP() << "built without NanoVDB";
  const std::string bytes = torus();
  const size_t step = slow_tests() ? 97 : 997;
  for (size_t size = 1; size < bytes.size(); size += size < 300 ? 1 : step)
    EXPECT_THROW((void)read_grid(std::string_view(bytes).substr(0, size)), InputError) << size;
  EXPECT_THAT(error_of([] { (void)read_grid("no NanoVDB file, but text"); }), HasSubstr("does not begin as one"));
  // Any byte changed: refused, or read within bounds.
  RandomStream rng(5);
  for (int i = 0; i < (slow_tests() ? 2000 : 200); ++i) {
    std::string damaged = bytes;
    for (int k = 0; k < 3; ++k) damaged[size_t(rng.uniform() * float(bytes.size()))] ^= char(1 + rng.uniform() * 254);
    try {
      if (const auto grid = read_grid(damaged)) (void)grid->at({0.75f, 0, 0});
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace frond
