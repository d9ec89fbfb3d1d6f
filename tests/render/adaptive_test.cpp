#include "render/film/adaptive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "instruments/errors/statistics.h"
#include "render/parts/part_file.h"
#include "tests/render/render_scene.h"
#include "tests/support/input_error.h"
#include "tests/support/slow.h"

namespace frond {
namespace {

using test::SceneRender;

/// Requests a stop after a number of reports, as a signal would.
class StopAfter final : public Progress {
 public:
  explicit StopAfter(int reports) : left_(reports) {}
  void update(double, const RenderStatistics&) override {
    if (--left_ <= 0) stop_.request_stop();
  }
  std::stop_token token() const { return stop_.get_token(); }

 private:
  int left_;
  std::stop_source stop_;
};

class Adaptive : public ::testing::Test {
 protected:
  void SetUp() override { scene_ = folder_.write("scene.pbrt", test::a_scene()); }

  LoadedScene load(bool adaptive, uint64_t seed = 1, const std::string& filter = {}) {
    return SceneRender{.seed = seed, .filter = filter, .adaptive = adaptive}.load(session_, scene_);
  }
  RenderPart to_noise(const LoadedScene& scene, double max_rms, uint64_t most = 1u << 16) {
    RenderPart part = scene.empty_part();
    session_.render_to(scene, {.max_rms = max_rms, .most_samples = most}, part);
    return part;
  }
  /// A film whose second half begins in the middle.
  RenderPart in_halves(const LoadedScene& scene, uint64_t samples) {
    RenderPart part = scene.empty_part();
    session_.render(scene, SampleRange{0, samples / 2}, part);
    for (size_t i = 0; i < part.film.tiles(); ++i) part.film.begin_second_half(i);
    session_.render(scene, SampleRange{samples / 2, samples}, part);
    return part;
  }
  /// All of a part but what it took.
  static std::vector<unsigned char> bytes_of(const RenderPart& part) {
    PartHeader header = part.header;
    header.statistics = {};
    return encode_part(header, part.film);
  }

  TestFolder folder_{"adaptive"};
  std::filesystem::path scene_;
  Session session_{silent_log(), {.threads = 2}};
};

/// Mean square difference of two images, over pixels and colours.
double square_difference(const Film& a, const Film& b) {
  const Crop& c = a.settings().crop;
  double sum = 0;
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x)
      for (size_t i = 0; i < 3; ++i) sum += std::pow(a.mean(x, y)[i] - b.mean(x, y)[i], 2);
  return sum / (3 * c.width() * c.height());
}

/// Variance of the images of several seeds, mean over pixels and colours: the part of each image, whose mean is an
/// unbiased estimate.
std::vector<double> variances_of(const std::vector<RenderPart>& images) {
  const auto n = double(images.size());
  const Crop& c = images.front().film.settings().crop;
  std::vector<double> parts(images.size());
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x)
      for (size_t i = 0; i < 3; ++i) {
        double mean = 0;
        for (const RenderPart& image : images) mean += image.film.mean(x, y)[i] / n;
        for (size_t k = 0; k < images.size(); ++k)
          parts[k] += std::pow(images[k].film.mean(x, y)[i] - mean, 2) * n / (n - 1) / (3 * c.width() * c.height());
      }
  return parts;
}

/// The estimate is 1 to 1.5 times the variance (measured with 64 seeds). A t-value below -5 of 11 degrees of freedom
/// has a probability of 0.0002.
TEST_F(Adaptive, NoiseIsThatOfImagesOrMore) {
  constexpr uint64_t kSeeds = 12;
  const auto filters = slow_tests() ? std::vector{"gaussian", "mitchell", "box"} : std::vector{"gaussian"};
  const auto counts = slow_tests() ? std::vector<uint64_t>{32, 64, 256} : std::vector<uint64_t>{32, 64};
  for (const char* filter : filters)
    for (const uint64_t samples : counts) {
      std::vector<RenderPart> images;
      for (uint64_t seed = 1; seed <= kSeeds; ++seed) images.push_back(in_halves(load(true, seed, filter), samples));
      const std::vector<double> variances = variances_of(images);
      Moments variance, estimate, difference;
      for (size_t i = 0; i < kSeeds; ++i) {
        const double found = image_noise(images[i].film, 0).mean_square;
        variance.add(variances[i]), estimate.add(found), difference.add(found - variances[i]);
      }
      EXPECT_GE(difference.mean(), -5 * difference.estimate().standard_error()) << filter << samples;
      EXPECT_LE(estimate.mean(), 2 * variance.mean()) << filter << samples;
      for (const RenderPart& image : images)
        EXPECT_GE(image_noise(image.film, noise_z(8)).upper, variance.mean()) << filter << samples;
    }
}

/// The state after a time limit, or of a render with a fixed number of samples.
TEST_F(Adaptive, WithoutASecondHalfVarianceIsThatBetweenSamples) {
  for (const char* filter : {"gaussian", "box"}) {
    const LoadedScene scene = load(true, 1, filter);
    RenderPart part = scene.empty_part();
    session_.render(scene, SampleRange{0, 16}, part);
    part.film.begin_second_half(part.film.tile_at(0, 0));  // the last samples of this tile
    for (const auto& [x, y] : {std::pair{1, 1}, {20, 13}})
      EXPECT_EQ(part.film.half_variance(x, y), part.film.variance(x, y)) << filter;
    const Film halves = in_halves(scene, 16).film;
    EXPECT_NE(halves.half_variance(20, 13), halves.variance(20, 13)) << filter;
  }
}

TEST_F(Adaptive, NoiseComesDownToWhatIsAskedFor) {
  const LoadedScene scene = load(true);
  RenderPart reference = scene.empty_part();
  session_.render(scene, SampleRange{1 << 20, (1 << 20) + 2048}, reference);  // of other samples
  uint64_t before = 0;
  for (const double max_rms : {0.05, 0.02, 0.01}) {
    const RenderPart part = to_noise(scene, max_rms);
    EXPECT_LE(image_noise(part.film, noise_z(part.header.round + 1)).upper_rms(), max_rms);
    EXPECT_LE(std::sqrt(square_difference(part.film, reference.film)), max_rms);
    EXPECT_EQ(missing_samples_text(part), "");
    EXPECT_GE(part.header.statistics.paths, before);
    before = part.header.statistics.paths;
  }
  // The sky takes less than the thing.
  const SampleCount count = sample_count(to_noise(scene, 0.004).film);
  EXPECT_LT(count.least, count.most);
  EXPECT_TRUE(std::has_single_bit(count.least) && std::has_single_bit(count.most));
}

/// The noise of each colour is divided by its mean over the image, so that it has no unit.
TEST_F(Adaptive, RelativeNoiseIsThatOfTheMeans) {
  const LoadedScene scene = load(true);
  constexpr double kRelative = 0.05;
  RenderPart part = scene.empty_part();
  session_.render_to(scene, {.max_rms = kRelative, .is_relative = true}, part);
  const NoiseUnit unit = noise_unit(part.film, true);
  EXPECT_LE(image_noise(part.film, noise_z(part.header.round + 1), unit).upper_rms(), kRelative);
  RenderPart reference = scene.empty_part();
  session_.render(scene, SampleRange{1 << 20, (1 << 20) + 2048}, reference);  // of other samples
  const Crop& c = part.film.settings().crop;
  double mean = 0, square = 0;
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x) mean += reference.film.mean(x, y)[1] / (c.width() * c.height());
  EXPECT_NEAR(unit[1], mean, 0.02 * mean);
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x)
      for (size_t i = 0; i < 3; ++i)
        square += std::pow((part.film.mean(x, y)[i] - reference.film.mean(x, y)[i]) / unit[i], 2);
  EXPECT_LE(std::sqrt(square / (3 * c.width() * c.height())), kRelative);
  EXPECT_LT(part.header.statistics.paths, to_noise(scene, kRelative * mean / 4).header.statistics.paths);
  const Film black(part.film.format());
  EXPECT_THAT(error_of([&] { noise_unit(black, true); }),
              ::testing::HasSubstr("relative noise needs light of every colour"));
}

TEST_F(Adaptive, MostSamplesAreNotExceeded) {
  const LoadedScene scene = load(true);
  for (const uint64_t most : {32u, 33u, 96u, 100u}) {
    const RenderPart part = to_noise(scene, 1e-6, most);
    EXPECT_EQ(sample_count(part.film).least, most);
    EXPECT_EQ(sample_count(part.film).most, most);
    EXPECT_GT(image_noise(part.film, noise_z(1)).upper_rms(), 1e-6);
  }
  EXPECT_THAT(error_of([&] { to_noise(scene, 1e-6, 31); }), ::testing::HasSubstr("at least 32 samples"));
  // More are powers of 2 again.
  RenderPart part = to_noise(scene, 1e-6, 100);
  session_.render_to(scene, {.max_rms = 1e-6, .most_samples = 256}, part);
  EXPECT_EQ(sample_count(part.film).least, 256u);
  EXPECT_EQ(part.film.tile(0).samples_in_first_half(), 128);
}

/// The test of the number n has the error probability 0.05 / (n (n + 1)).
TEST_F(Adaptive, AllNoiseTestsTogetherHaveTheirConfidence) {
  EXPECT_NEAR(noise_z(1), 1.95996, 1e-4);  // 0.025
  EXPECT_NEAR(noise_z(4), 2.80703, 1e-4);  // 0.0025
}

/// New halves without samples would contain no information.
TEST_F(Adaptive, AfterTheDeadlineHalvesRemain) {
  const LoadedScene scene = load(true);
  RenderPart part = in_halves(scene, 64);
  session_.render_to(scene, {.max_rms = 1e-6}, part, {.deadline = std::chrono::steady_clock::now()});
  EXPECT_EQ(part.film, in_halves(scene, 64).film);
}

/// Stops a render after a number of reports, repeatedly, until it is complete. `on(part, control)` renders.
RenderPart in_pieces(const LoadedScene& scene, int reports, const auto& on) {
  RenderPart part = scene.empty_part();
  for (int i = 0; i < 10000; ++i) {
    StopAfter stop(reports);
    on(part, RenderControl{.stop = stop.token(), .progress = &stop});
    const auto bytes = encode_part(part.header, part.film);  // what the next process finds
    part = decode_part({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "x.part");
    if (!stop.token().stop_requested()) return part;
  }
  ADD_FAILURE() << "the render does not get on";
  return part;
}

TEST_F(Adaptive, StoppedAndResumedItIsTheSameRender) {
  for (const char* filter : {"gaussian", "box"}) {
    const LoadedScene scene = load(true, 1, filter);
    const double rms = 0.004;
    const RenderPart whole = to_noise(scene, rms);
    ASSERT_GT(whole.header.round, 0);
    for (const int reports : {1, 3, 7, 20}) {
      const RenderPart part = in_pieces(scene, reports, [&](RenderPart& p, const RenderControl& control) {
        session_.render_to(scene, {.max_rms = rms, .most_samples = 1u << 16}, p, control);
      });
      EXPECT_EQ(part.film, whole.film) << filter;
      EXPECT_EQ(bytes_of(part), bytes_of(whole)) << filter << reports;
      EXPECT_EQ(part.header.statistics.paths, whole.header.statistics.paths);
    }
  }
}

TEST_F(Adaptive, PlainRendersStoppedAndResumedAreTheSameToo) {
  const LoadedScene scene = load(false);
  RenderPart whole = scene.empty_part();
  session_.render(scene, SampleRange{0, 70}, whole);
  for (const int reports : {1, 3, 7}) {
    const RenderPart part = in_pieces(scene, reports, [&](RenderPart& p, const RenderControl& control) {
      session_.render(scene, SampleRange{0, 70}, p, control);
    });
    EXPECT_EQ(bytes_of(part), bytes_of(whole)) << reports;
    EXPECT_EQ(part.header.statistics.paths, whole.header.statistics.paths);
  }
}

/// The merged part continues as a whole, independent of the plans of its parts. The second cut divides a tile, whose
/// pixels get equal numbers again.
TEST_F(Adaptive, MergedPiecesGoOn) {
  for (const int x : {16, 10}) {
    std::vector<std::filesystem::path> files;
    for (const Crop& pixels : {Crop{0, 0, x, 27}, Crop{x, 0, 40, 27}}) {
      const LoadedScene piece = SceneRender{.pixels = pixels, .adaptive = true}.load(session_, scene_);
      RenderPart part = piece.empty_part();
      if (pixels.x0 == 0)
        part = to_noise(piece, 0.05);
      else
        session_.render(piece, SampleRange{0, 20}, part);  // without halves
      files.emplace_back(folder_.name_of(fmt::format("{}.part", pixels.x0)));
      write_part(files.back(), part.header, part.film);
    }
    RenderPart merged = merge_parts(files);
    EXPECT_EQ(missing_samples_text(merged), x == 16 ? "" : "samples 20:32 of pixels 10,16,0,16");
    EXPECT_EQ(merged.film.half_variance(4, 12) == merged.film.variance(4, 12), x == 10);
    session_.render_to(load(true), {.max_rms = 0.02}, merged);
    EXPECT_EQ(missing_samples_text(merged), "");
    EXPECT_LE(image_noise(merged.film, noise_z(merged.header.round + 1)).upper_rms(), 0.02);
    for (size_t i = 0; i < merged.film.tiles(); ++i) {
      EXPECT_EQ(samples_of(merged.film.tile(i)).least, samples_of(merged.film.tile(i)).most);
      EXPECT_TRUE(merged.film.tile(i).has_second_half());
    }
  }
}

}  // namespace
}  // namespace frond
