#include "render/film/splatting.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "core/math/random.h"
#include "instruments/errors/image_error.h"
#include "render/parts/part_file.h"
#include "scene/registry.h"
#include "tests/render/render_scene.h"
#include "tests/support/bind.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using test::a_scene;
using test::number;
using test::SceneRender;

std::unique_ptr<Filter> make(std::string_view name, std::vector<ParsedParam> params = {}) {
  const Registry registry = make_registry({}, {});
  return test::make_plugin(registry.filters.get(name, {}), std::move(params));
}

std::unique_ptr<Filter> make(std::string_view name, double radius) {
  return make(name, {number("float", "xradius", {radius}), number("float", "yradius", {radius})});
}

ParsedParam word(std::string reconstruction) {
  return {"string", "reconstruction", {}, {}, std::vector<std::string>{std::move(reconstruction)}};
}

/// A film of shared samples that a test makes up.
class MadeUp {
 public:
  MadeUp(const Filter& filter, int width, int height, size_t bands = 0, bool halves = false)
      : kernel_(filter), film_(format_of(kernel_, width, height, bands, halves)) {}

  /// `samples` of each pixel of a tile; sample(x, y, index) returns a sample's position in its pixel and its value.
  struct Seen {
    Vec2 u;
    SensorResponse response;
  };
  using Sample = std::function<Seen(int, int, uint64_t)>;
  void add(size_t tile_index, SampleRange samples, const Sample& sample) {
    const FilmFormat& format = film_.format();
    const Crop c = film_.tile_pixels(tile_index);
    FilmTile tile(format, c);
    for (uint64_t s = samples.begin; s < samples.end; ++s)
      for (int y = c.y0; y < c.y1; ++y)
        for (int x = c.x0; x < c.x1; ++x) {
          const auto [u, response] = sample(x, y, s);
          tile.add(format, x, y, {{{response, 1, false, u}}}, &kernel_);
        }
    tile.cover({c, samples});
    ASSERT_TRUE(film_.merge(tile_index, tile));
  }
  void add(size_t tile_index, uint64_t samples, const Sample& sample) { add(tile_index, {0, samples}, sample); }
  void add_everywhere(uint64_t samples, const Sample& sample) {
    for (size_t i = 0; i < film_.tiles(); ++i) add(i, samples, sample);
  }
  /// In a film with halves: the first part, then the rest.
  void add_parts(uint64_t first, uint64_t samples, const Sample& sample) {
    for (size_t i = 0; i < film_.tiles(); ++i) {
      add(i, first, sample);
      film_.begin_second_half(i);
      add(i, {first, samples}, sample);
    }
  }
  const Film& film() const { return film_; }
  const Splatting& splatting() const { return *film_.format().splatting; }

 private:
  static FilmFormat format_of(const SplatKernel& kernel, int width, int height, size_t bands, bool halves) {
    FilmFormat format{.settings = {.width = width,
                                   .height = height,
                                   .crop = {0, 0, width, height},
                                   .filename = "",
                                   .max_component = std::numeric_limits<double>::infinity()},
                      .bands = bands,
                      .halves = halves,
                      .splatting = kernel.splatting()};
    format.splatting->sampled = widened(format.settings.crop, format.splatting->reach_x(), format.splatting->reach_y());
    return format;
  }

  SplatKernel kernel_;
  Film film_;
};

/// Place number `i` of a grid of so many in a pixel.
Vec2 grid(uint64_t i, uint64_t side) {
  return {(float(i % side) + 0.5f) / float(side), (float(i / side) + 0.5f) / float(side)};
}

SensorResponse grey(double value) { return std::array{value, value, value}; }

/// Share of a filter's weight below `x`, pixels from its centre, along one axis.
double weight_below(const Filter& filter, double x) {
  constexpr int kSteps = 20000;
  const auto radius = double(filter.radius().x);
  double below = 0, all = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double at = (2 * (i + 0.5) / kSteps - 1) * radius, w = double(filter.evaluate_axes({float(at), 0}).x);
    all += w, below += at < x ? w : 0;
  }
  return below / all;
}

const std::vector<std::string_view> kWideFilters{"triangle", "gaussian", "mitchell", "sinc"};

TEST(Splatting, IsChosenWhereItMakesLessNoise) {
  for (const std::string_view name : kWideFilters) EXPECT_TRUE(splats(*make(name))) << name;
  EXPECT_FALSE(splats(*make("box")));
  EXPECT_FALSE(splats(*make("gaussian", 0.5)));
  EXPECT_TRUE(splats(*make("box", 1)));
  // A narrow peak in a wide radius: most samples would weigh nothing.
  EXPECT_FALSE(splats(*make("gaussian", {number("float", "sigma", {0.05})})));
  EXPECT_FALSE(splats(*make("gaussian", 20)));  // a sample would reach too many pixels
}

TEST(Splatting, IsChosenAsTheSceneSays) {
  EXPECT_FALSE(splats(*make("gaussian", {word("importance")})));
  EXPECT_TRUE(splats(*make("gaussian", {number("float", "sigma", {0.05}), word("splatting")})));
  EXPECT_FALSE(splats(*make("box", {word("splatting")})));  // it is the same
  const std::string said = error_of([] { make("gaussian", {number("float", "xradius", {9}), word("splatting")}); });
  EXPECT_THAT(said, ::testing::HasSubstr("radii of 8.5 pixels at most"));
}

TEST(Splatting, WeightsAreTheFiltersAndAverageToWhatIsSaid) {
  for (const std::string_view name : kWideFilters) {
    const auto filter = make(name);
    const SplatKernel kernel(*filter);
    const Splatting s = kernel.splatting();
    constexpr uint64_t kSide = 64;
    for (int dy = -s.reach_y(); dy <= s.reach_y(); ++dy)
      for (int dx = -s.reach_x(); dx <= s.reach_x(); ++dx) {
        double sum = 0, squares = 0, ratio = 0;
        for (uint64_t i = 0; i < kSide * kSide; ++i) {
          const Vec2 u = grid(i, kSide);
          const SplatKernel::Weights w = kernel.at(u);
          const double weight = double(w.at(size_t(dx + s.reach_x()), size_t(dy + s.reach_y())));
          const Vec2 f = filter->evaluate_axes({u.x - 0.5f - float(dx), u.y - 0.5f - float(dy)}),
                     peak = filter->evaluate_axes({0, 0});
          sum += weight, squares += weight * weight;
          const SplatKernel::Weights top = kernel.at({0.5f, 0.5f});
          ratio = double(top.at(size_t(s.reach_x()), size_t(s.reach_y())));
          EXPECT_NEAR(weight / ratio, double(f.x / peak.x * (f.y / peak.y)), 2e-3) << name;
        }
        EXPECT_NEAR(sum / (kSide * kSide), s.mean(dx, dy), 2e-4) << name;
        EXPECT_NEAR(squares / (kSide * kSide), s.square(dx, dy), 2e-4) << name;
      }
    EXPECT_EQ(s.has_negative_weights, name == "mitchell" || name == "sinc");
  }
}

/// An edge, and a ramp, seen by evenly spread samples: pixels equal the filtered values with either reconstruction.
TEST(Splatting, BlursAsTheFilterDoes) {
  constexpr uint64_t kSide = 16;
  for (const std::string_view name : kWideFilters) {
    const auto filter = make(name);
    MadeUp edge(*filter, 20, 3), ramp(*filter, 20, 3);
    constexpr double kEdge = 9.3;
    edge.add_everywhere(kSide * kSide, [](int x, int, uint64_t i) {
      const Vec2 u = grid(i, kSide);
      return MadeUp::Seen{u, grey(x + double(u.x) < kEdge ? 1 : 0)};
    });
    ramp.add_everywhere(kSide * kSide, [](int x, int, uint64_t i) {
      const Vec2 u = grid(i, kSide);
      return MadeUp::Seen{u, grey(x + double(u.x))};
    });
    for (int x = 0; x < 20; ++x) {
      const double expected = weight_below(*filter, kEdge - (x + 0.5));
      double importance = 0, weights = 0;
      constexpr uint64_t kFine = 256;
      for (uint64_t i = 0; i < kFine; ++i) {
        const auto [offset, weight] = filter->sample({(float(i) + 0.5f) / kFine, 0.5f});
        weights += double(weight), importance += x + 0.5 + double(offset.x) < kEdge ? double(weight) : 0;
      }
      // The grid of splats moves the edge by up to half a step, and so does the grid of importance samples.
      EXPECT_NEAR(edge.film().mean(x, 1)[0], expected, 0.04) << name << x;
      EXPECT_NEAR(importance / weights, expected, 0.04) << name << x;
      EXPECT_NEAR(ramp.film().mean(x, 1)[0], x + 0.5, 1e-3) << name << x;
    }
  }
}

/// Where a tile has more samples than its neighbour, as with --max-rms, pixels between them stay where they are.
TEST(Splatting, TilesOfManySamplesDoNotDrawPixelsToThem) {
  for (const std::string_view name : kWideFilters) {
    MadeUp ramp(*make(name), 32, 16);
    for (size_t i = 0; i < ramp.film().tiles(); ++i) {
      const uint64_t side = ramp.film().tile_pixels(i).x0 < 16 ? 4 : 16;
      ramp.add(i, side * side, [side](int x, int, uint64_t s) {
        const Vec2 u = grid(s, side);
        return MadeUp::Seen{u, grey(x + double(u.x))};
      });
    }
    for (int x = 0; x < 32; ++x) EXPECT_NEAR(ramp.film().mean(x, 8)[0], x + 0.5, 0.02) << name << x;
  }
}

/// Actual and stated variance of pixels of films with independent samples: sums over a film's pixels.
struct Trials {
  double mean = 0, actual = 0, stated = 0;
  double ratio() const { return stated / actual; }
};

constexpr int kTrials = 300, kSide = 6;
// A sample variance of 300 normal values has a standard error of 8 %; of 36 pixels, three of which share their
// noise, 2.4 %. 5 of them are exceeded in less than 1 of 10^6 cases; the seeds are fixed.
const double kOff = 5 * std::sqrt(2.0 / kTrials * 3 / (kSide * kSide));

/// If `first` is above 0, the variance is that from the first part and the rest.
Trials trials(const Filter& filter, size_t bands, uint64_t first, uint64_t samples,
              const std::function<double(int, double)>& signal) {
  std::vector<double> sum(kSide * kSide), squares(sum.size());
  Trials result;
  for (int trial = 0; trial < kTrials; ++trial) {
    MadeUp made(filter, kSide, kSide, bands, first > 0);
    RandomStream random(hash_key(uint64_t(trial), samples, bands));
    const auto sample = [&](int x, int, uint64_t s) {
      const Vec2 u{random.uniform(), random.uniform()};
      const double noise = 2 * double(random.uniform()) - 1, value = signal(x, double(u.x)) + noise;
      if (bands == 0) return MadeUp::Seen{u, grey(value)};
      SensorResponse one;
      one.count = 1, one.channel[0] = uint16_t(s % bands), one.value[0] = value;
      return MadeUp::Seen{u, one};
    };
    if (first > 0)
      made.add_parts(first, samples, sample);
    else
      made.add_everywhere(samples, sample);
    const Film& film = made.film();
    for (int i = 0; i < kSide * kSide; ++i) {
      const int x = i % kSide, y = i / kSide;
      const Film::BandMean band = bands > 0 ? film.band_mean(x, y, 0) : Film::BandMean{};
      const double value = bands > 0 ? band.mean : film.mean(x, y)[0];
      sum[size_t(i)] += value, squares[size_t(i)] += value * value;
      result.stated +=
          (bands > 0 ? band.variance : (first > 0 ? film.half_variance(x, y) : film.variance(x, y))[0]) / kTrials;
    }
  }
  for (size_t i = 0; i < sum.size(); ++i) {
    const double mean = sum[i] / kTrials;
    result.mean += mean / double(sum.size());
    result.actual += (squares[i] / kTrials - mean * mean) * kTrials / (kTrials - 1);
  }
  return result;
}

double flat(int, double) { return 2; }
double steps(int x, double) { return x < 3 ? 0 : 4; }
/// Structure within pixels, which the means of pixels alone do not show.
double edge(int x, double u) { return x + u < 2.4 ? 0 : 4; }

TEST(Splatting, VarianceIsThatOfIndependentSamples) {
  for (const char* name : {"gaussian", "mitchell"})
    for (const size_t bands : {0u, 2u})
      for (const auto& signal : {flat, steps}) {
        // Bands have half of the samples each.
        const Trials t = trials(*make(name), bands, 0, bands > 0 ? 32 : 16, signal);
        EXPECT_NEAR(t.ratio(), 1, kOff + 0.03) << name << bands;  // of few samples a ratio has a bias
      }
}

/// The mean over 36 pixels and 300 images of estimates of one degree of freedom: the standard error, 2.4 %, is within
/// kOff.
TEST(Splatting, VarianceFromHalvesIsRightWhateverPixelsShow) {
  for (const char* name : {"gaussian", "mitchell"})
    for (const uint64_t first : {32u, 48u})
      for (const auto& signal : {flat, steps, edge}) {
        const Trials t = trials(*make(name), 0, first, 64, signal);
        EXPECT_NEAR(t.ratio(), 1, kOff + 0.03) << name << first;
      }
}

TEST(Splatting, OneSampleAPixelTellsNoVariance) {
  const Trials t = trials(*make("gaussian"), 0, 0, 1, flat);
  EXPECT_EQ(t.stated, 0);
  EXPECT_NEAR(t.mean, 2, 0.05);
}

TEST(Splatting, NoiseIsLessThanOfSamplesOfTheirOwn) {
  // Variance per sample relative to a box filter's, as the page on filters states it.
  const auto factor = [](std::string_view name) {
    const Splatting s = SplatKernel(*make(name)).splatting();
    double mean = 0, square = 0;
    for (int dy = -s.reach_y(); dy <= s.reach_y(); ++dy)
      for (int dx = -s.reach_x(); dx <= s.reach_x(); ++dx) mean += s.mean(dx, dy), square += s.square(dx, dy);
    return square / (mean * mean);
  };
  EXPECT_NEAR(factor("gaussian"), 0.337, 0.001);
  EXPECT_LT(factor("mitchell"), 1);
  EXPECT_LT(factor("sinc"), 1.05);
}

/// The image's noise as a field, of white noise in all samples.
std::vector<float> noise_field(const Filter& filter, int size, uint64_t seed) {
  MadeUp made(filter, size, size);
  RandomStream random(hash_key(seed, 77));
  made.add_everywhere(4, [&](int, int, uint64_t) {
    const Vec2 u{random.uniform(), random.uniform()};
    return MadeUp::Seen{u, grey(double(random.uniform()) + double(random.uniform()) - 1)};
  });
  std::vector<float> field;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) field.push_back(float(made.film().mean(x, y)[0]));
  return field;
}

/// Without bias, the estimated bias is noise: its standard error must not be too small.
TEST(Splatting, StandardErrorsKnowThatPixelsShareTheirNoise) {
  constexpr int kSize = 16, kFields = 300;
  const auto filter = make("gaussian");
  const double correlated = SplatKernel(*filter).splatting().correlated_pixels;
  EXPECT_GT(correlated, 2);
  EXPECT_LT(correlated, 8);
  double as_independent = 0, as_correlated = 0;
  for (uint64_t i = 0; i < kFields; ++i) {
    std::array<std::vector<float>, 4> v;
    for (uint64_t k = 0; k < 4; ++k) v[k] = noise_field(*filter, kSize, 4 * i + k);
    const auto z = [&](double pixels) {
      const MeanSquare bias = image_error(v[0], v[1], v[2], v[3], {}, pixels).bias_squared;
      return bias.value / bias.standard_error;
    };
    as_independent += std::pow(z(1), 2) / kFields, as_correlated += std::pow(z(correlated), 2) / kFields;
  }
  // Mean squares of 300 values: above 1.4 for right standard errors in less than 1 of 10^5 cases.
  EXPECT_GT(as_independent, 1.4);
  EXPECT_LT(as_correlated, 1.4);
}

/// Two samples see a band, and in one pixel they weigh next to nothing together: one is in a negative lobe.
TEST(Splatting, WeightsThatCancelOutDoNotMakeAPixelBright) {
  const auto filter = make("mitchell");
  constexpr int kPixel = 5;
  const auto weight_at = [&](float x) { return filter->evaluate_axes({x - (kPixel + 0.5f), 0}).x; };
  float near = 4;  // where the weight in the pixel is that of the other, but for the sign
  constexpr float kFar = 3.9f;
  while (near < 5 && weight_at(near) + weight_at(kFar) <= 0) near += 1e-3f;
  ASSERT_LT(near, 5);
  ASSERT_LT(weight_at(kFar), 0);
  MadeUp made(*filter, 12, 1, 2);
  made.add_everywhere(1, [&](int x, int y, uint64_t) {
    SensorResponse one;
    const bool sees = y == 0 && (x == 3 || x == 4);
    one.count = 1, one.channel[0] = sees ? 0 : 1, one.value[0] = x == 4 ? 10 : 0;
    return MadeUp::Seen{{sees ? (x == 4 ? near : kFar) - float(x) : 0.5f, 0.5f}, one};
  });
  EXPECT_GT(made.film().band_mean(kPixel, 0, 0).mean, 0);
  EXPECT_LT(made.film().band_mean(kPixel, 0, 0).mean, 20);
}

class SplattingRenders : public ::testing::Test {
 protected:
  void SetUp() override { scene_ = folder_.write("scene.pbrt", a_scene()); }

  TestFolder folder_{"splatting"};
  std::filesystem::path scene_;
};

TEST_F(SplattingRenders, ACropHasThePixelsOfTheWhole) {
  for (const char* filter : {"gaussian", "mitchell", "sinc", "triangle,xradius=1.2", "box"}) {
    const SceneRender how{.channels = {"depth", "samples"}, .filter = filter};
    const RenderPart whole = how.part(scene_, {0, 7});
    for (const Crop& crop : {Crop{0, 0, 3, 2}, {7, 9, 30, 20}, {16, 16, 32, 27}, {39, 26, 40, 27}}) {
      SceneRender part_of_it = how;
      part_of_it.pixels = crop, part_of_it.is_part = false;
      const RenderPart part = part_of_it.part(scene_, {0, 7});
      for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
          EXPECT_EQ(part.film.mean(x, y), whole.film.mean(x, y)) << filter << ' ' << x << ' ' << y;
          EXPECT_EQ(part.film.variance(x, y), whole.film.variance(x, y)) << filter;
          EXPECT_EQ(part.film.samples(x, y), 7u);
          EXPECT_EQ(part.film.features(x, y).means, whole.film.features(x, y).means);
        }
    }
  }
}

/// The scene itself has a crop.
TEST_F(SplattingRenders, PiecesOfAScenesCropAddUpToIt) {
  std::string text = a_scene();
  text.replace(text.find("Film \"rgb\""), 10, "Film \"rgb\" \"integer pixelbounds\" [3 33 5 25]");
  folder_.write("scene.pbrt", text);
  const RenderPart whole = SceneRender{}.part(scene_, {0, 5});
  std::vector<std::filesystem::path> files;
  for (const Crop& pixels : {Crop{3, 5, 18, 25}, {18, 5, 33, 14}, {18, 14, 33, 25}}) {
    const RenderPart part = SceneRender{.pixels = pixels}.part(scene_, {0, 5});
    files.push_back(folder_.name_of(fmt::format("{}.part", files.size())));
    write_part(files.back(), part.header, part.film);
  }
  const RenderPart merged = merge_parts(files);
  EXPECT_EQ(merged.film, whole.film);
  EXPECT_EQ(missing_samples_text(merged), "");
  EXPECT_FALSE(lacks_neighboring_samples(merged.film));
  EXPECT_TRUE(lacks_neighboring_samples(merge_parts({files[1], files[2]}).film));
}

/// Both reconstructions have the same blur: their images have the same mean, and differ by little more than noise.
TEST_F(SplattingRenders, BothWaysMakeOneImage) {
  for (const char* filter : {"gaussian", "mitchell"}) {
    const auto image = [&](const std::string& more, uint64_t seed) {
      return SceneRender{.seed = seed, .filter = filter + more}.part(scene_, {0, 512});
    };
    std::array<std::array<std::vector<float>, 4>, 3> colors;
    const std::array<RenderPart, 4> parts{image(",reconstruction=splatting", 1), image(",reconstruction=splatting", 2),
                                          image(",reconstruction=importance", 3),
                                          image(",reconstruction=importance", 4)};
    EXPECT_TRUE(parts[0].film.format().splatting.has_value());
    EXPECT_FALSE(parts[2].film.format().splatting.has_value());
    for (size_t i = 0; i < 4; ++i)
      for (int y = 0; y < 27; ++y)
        for (int x = 0; x < 40; ++x)
          for (size_t c = 0; c < 3; ++c) colors[c][i].push_back(float(parts[i].film.mean(x, y)[c]));
    for (const auto& v : colors) {
      const ImageError e = image_error(v[0], v[1], v[2], v[3], {}, parts[0].film.format().splatting->correlated_pixels);
      // 4.5 standard errors: one of 10^5 cases for each of six.
      EXPECT_LE(e.bias_squared.value, 4.5 * e.bias_squared.standard_error + 1e-6) << filter;
      EXPECT_NEAR(e.mean_difference, 0, 2e-3) << filter;
    }
  }
}

TEST_F(SplattingRenders, FilterOfTheCommandGoesBeforeTheScenes) {
  Session session(silent_log(), {.threads = 1});
  const auto filter_of = [&](const std::string& filter) {
    const Identity identity = SceneRender{.filter = filter}.load(session, scene_).identity();
    for (const auto& field : identity.fields())
      if (field.name == "filter") return field.value;
    return std::string();
  };
  EXPECT_EQ(filter_of(""), "gaussian, splatting");
  EXPECT_EQ(filter_of("box"), "box, importance sampling");
  EXPECT_EQ(filter_of("gaussian,reconstruction=importance"), "gaussian,reconstruction=importance, importance sampling");
  EXPECT_THAT(error_of([&] { filter_of("gaussian,reconstruction=other"); }),
              ::testing::HasSubstr("auto, splatting, importance"));
}

TEST_F(SplattingRenders, WhatIsNotTheSameImageIsNotAddedUp) {
  const RenderPart shared = SceneRender{}.part(scene_, {0, 2}),
                   own = SceneRender{.filter = "gaussian,reconstruction=importance"}.part(scene_, {2, 4});
  const std::vector<std::filesystem::path> files{folder_.name_of("a.part"), folder_.name_of("b.part")};
  write_part(files[0], shared.header, shared.film);
  write_part(files[1], own.header, own.film);
  EXPECT_THAT(error_of([&] { merge_parts(files); }), ::testing::HasSubstr("filter: gaussian, splatting"));
}

TEST_F(SplattingRenders, ErrorsNameTheirPlace) {
  std::string text = a_scene();
  text.replace(text.find("PixelFilter \"gaussian\""), 22,
               "PixelFilter \"gaussian\" \"float xradius\" 12 \"string reconstruction\" \"splatting\"");
  folder_.write("scene.pbrt", text);
  EXPECT_THAT(error_of([&] { SceneRender{}.part(scene_, {0, 1}); }), ::testing::HasSubstr("scene.pbrt:6:67: "));
}

}  // namespace
}  // namespace frond
