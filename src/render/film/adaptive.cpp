#include "render/film/adaptive.h"

#include <algorithm>
#include <cmath>

#include "instruments/errors/statistics.h"

namespace frond {
namespace {

constexpr uint64_t kBlock = FilmTile::kBlock;

/// Variance of colours in the given units, averaged over them.
double averaged(const Triple& variance, const NoiseUnit& unit) {
  double sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += variance[c] / (unit[c] * unit[c]);
  return sum / 3;
}

double pixels_of(const Crop& c) { return double(c.width()) * double(c.height()); }

/// Statistics of a tile for the allocation of samples.
struct TileNoise {
  double pixels, samples;
  double variance;  ///< variance of one sample, mean over the tile's pixels
  double cost;      ///< rays per path, plus one for the cost of the path itself
};

TileNoise noise_of(const Film& film, size_t i, const NoiseUnit& unit) {
  const FilmTile& tile = film.tile(i);
  const Crop& c = tile.pixels();
  double noise = 0;
  if (film.format().splatting) {
    const Crop reached = intersection(tile.reached(), film.settings().crop);
    for (int y = reached.y0; y < reached.y1; ++y)
      for (int x = reached.x0; x < reached.x1; ++x) noise += averaged(film.block_variance_by(i, x, y), unit);
  } else {
    for (int y = c.y0; y < c.y1; ++y)
      for (int x = c.x0; x < c.x1; ++x) noise += averaged(film.block_variance(x, y), unit);
  }
  const double pixels = pixels_of(c), samples = double(tile.pixel(c.x0, c.y0).samples);
  return {pixels, samples, noise / pixels * samples, double(tile.rays()) / (pixels * samples) + 1};
}

/// Average of each tile's variance and of the mean variance of the 3 x 3 tiles around it.
std::vector<double> smoothed(const std::vector<TileNoise>& tiles, size_t columns) {
  std::vector<double> result;
  const auto rows = tiles.size() / columns;
  for (size_t row = 0; row < rows; ++row)
    for (size_t column = 0; column < columns; ++column) {
      double sum = 0, count = 0;
      for (size_t r = row - std::min<size_t>(row, 1); r < std::min(row + 2, rows); ++r)
        for (size_t c = column - std::min<size_t>(column, 1); c < std::min(column + 2, columns); ++c)
          sum += tiles[r * columns + c].variance, ++count;
      result.push_back((tiles[row * columns + column].variance + sum / count) / 2);
    }
  return result;
}

}  // namespace

double NoiseEstimate::rms() const { return std::sqrt(mean_square); }
double NoiseEstimate::upper_rms() const { return std::sqrt(upper); }

NoiseUnit noise_unit(const Film& film, bool is_relative) {
  if (!is_relative) return kFilmUnit;
  const Crop& crop = film.settings().crop;
  NoiseUnit mean{};
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x) {
      const Triple pixel = film.mean(x, y);
      for (size_t c = 0; c < 3; ++c) mean[c] += pixel[c] / pixels_of(crop);
    }
  if (!std::ranges::all_of(mean, [](double m) { return m > 0; }))
    fail({}, "relative noise needs light of every colour: the mean of R, G or B over the image is not above 0");
  return mean;
}

NoiseEstimate image_noise(const Film& film, double z, const NoiseUnit& unit) {
  const Crop& c = film.settings().crop;
  double sum = 0, squares = 0;
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x) {
      const double noise = averaged(film.block_variance(x, y), unit);
      sum += noise, squares += noise * noise;
    }
  const double pixels = pixels_of(c), alike = film.format().splatting ? film.format().splatting->correlated_pixels : 1;
  return {sum / pixels, (sum + z * std::sqrt(squares * alike)) / pixels};
}

double noise_z() { return normal_upper_quantile(sidak_level(1 - kNoiseConfidence, kNoiseLooks)); }

SamplePlan first_plan(const Film& film) {
  return {std::vector<uint64_t>(film.tiles(), kLeastAdaptive), uint64_t(pixels_of(film.sampled())) * kLeastAdaptive};
}

SamplePlan next_plan(const Film& film, double max_rms, uint64_t most_samples, const NoiseUnit& unit) {
  const uint64_t most = most_samples / kBlock * kBlock;
  std::vector<TileNoise> tiles;
  for (size_t i = 0; i < film.tiles(); ++i) tiles.push_back(noise_of(film, i, unit));
  const std::vector<double> variance = smoothed(tiles, film.columns());
  // The target applies to the upper bound: the goal for the estimate is lower by their present ratio.
  const NoiseEstimate now = image_noise(film, noise_z(), unit);
  const double sharpness = now.mean_square > 0 ? now.mean_square / now.upper : 1;
  const double goal = max_rms * max_rms * sharpness * pixels_of(film.settings().crop);
  const auto samples_at = [&](size_t i, double scale) {
    return std::clamp(scale * std::sqrt(variance[i] / tiles[i].cost), tiles[i].samples,
                      std::max(double(most), tiles[i].samples));
  };
  const auto noise_at = [&](double scale) {
    double noise = 0;
    for (size_t i = 0; i < tiles.size(); ++i) noise += tiles[i].pixels * variance[i] / samples_at(i, scale);
    return noise;
  };
  const auto plan_for = [&](double noise) {
    double low = 0, high = 1;
    constexpr double kMostScale = 1e30;
    while (noise_at(high) > noise && high < kMostScale) low = high, high *= 2;
    for (int i = 0; i < 50; ++i) {
      const double middle = (low + high) / 2;
      (noise_at(middle) > noise ? low : high) = middle;
    }
    SamplePlan plan;
    for (size_t i = 0; i < tiles.size(); ++i) {
      const double wanted = samples_at(i, high);
      plan.predicted_paths += uint64_t(wanted * tiles[i].pixels);
      const double end = std::min(wanted, 2 * tiles[i].samples);
      plan.tile_ends.push_back(uint64_t(std::ceil(end / double(kBlock))) * kBlock);
    }
    return plan;
  };
  const auto has_more = [&](const SamplePlan& plan) {
    for (size_t i = 0; i < tiles.size(); ++i)
      if (double(plan.tile_ends[i]) > tiles[i].samples) return true;
    return false;
  };
  SamplePlan plan = plan_for(goal);
  // The noise test has just failed: a plan without more samples is too optimistic, and the goal is lowered.
  constexpr double kStricter = 0.8, kStrictest = 1e-6;
  for (double part = kStricter; !has_more(plan) && part > kStrictest; part *= kStricter) plan = plan_for(goal * part);
  return plan;
}

}  // namespace frond
