#include "render/film/adaptive.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "instruments/errors/statistics.h"

namespace frond {
namespace {

/// Variance of colours in the given units, averaged over them.
double mean_over_colors(const Triple& variance, const NoiseUnit& unit) {
  double sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += variance[c] / (unit[c] * unit[c]);
  return sum / 3;
}

double pixels_of(const Crop& c) { return double(c.width()) * double(c.height()); }

/// Number of samples after `doublings` doublings, at most `most`. The first one only rounds up to the next power of 2.
double doubled(double samples, double doublings, uint64_t most) {
  if (doublings == 0) return samples;
  return std::max(samples,
                  std::min(double(std::bit_ceil(uint64_t(samples) + 1)) * std::exp2(doublings - 1), double(most)));
}

/// The variance of a pixel falls with this power of the number of samples (measured, with the sampler "lattice").
constexpr double kPower = 1.2;

/// Statistics of a tile for the allocation of samples.
struct TileNoise {
  double pixels = 0, samples = 0;
  double cost = 0;                ///< rays per path, plus one for the cost of the path itself
  double inside = 0;              ///< number of its pixels in the image
  double noise = 0, between = 0;  ///< sums over these: Film::half_variance and Film::variance
};

TileNoise noise_of(const Film& film, size_t i, const NoiseUnit& unit) {
  const FilmTile& tile = film.tile(i);
  const double pixels = pixels_of(tile.pixels()), samples = double(samples_of(tile).most);
  TileNoise t{pixels, samples, double(tile.rays()) / (pixels * samples) + 1};
  const Crop inside = intersection(tile.pixels(), film.settings().crop);
  for (int y = inside.y0; y < inside.y1; ++y)
    for (int x = inside.x0; x < inside.x1; ++x, ++t.inside) {
      t.noise += mean_over_colors(film.half_variance(x, y), unit);
      t.between += mean_over_colors(film.variance(x, y), unit);
    }
  return t;
}

/// Variance of a pixel's value in each tile, mean over its pixels. The variance between samples has many degrees of
/// freedom but ignores how evenly they are distributed. The ratio of both variances, from the 3 x 3 tiles around a
/// tile, corrects that.
std::vector<double> variances_of(const std::vector<TileNoise>& tiles, size_t columns) {
  std::vector<double> result;
  const auto rows = tiles.size() / columns;
  for (size_t row = 0; row < rows; ++row)
    for (size_t column = 0; column < columns; ++column) {
      TileNoise sum{};
      for (size_t r = row - std::min<size_t>(row, 1); r < std::min(row + 2, rows); ++r)
        for (size_t c = column - std::min<size_t>(column, 1); c < std::min(column + 2, columns); ++c) {
          const TileNoise& t = tiles[r * columns + c];
          sum.noise += t.noise, sum.between += t.between, sum.inside += t.inside;
        }
      const TileNoise& tile = tiles[row * columns + column];
      const TileNoise& own = tile.inside > 0 ? tile : sum;  // a tile next to the image has no pixels in it
      result.push_back(sum.between > 0 ? own.between / own.inside * sum.noise / sum.between : 0);
    }
  return result;
}

}  // namespace

SampleCount samples_of(const FilmTile& tile) {
  const Crop& c = tile.pixels();
  SampleCount n{tile.pixel(c.x0, c.y0).samples, 0};
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x)
      n = {std::min(n.least, tile.pixel(x, y).samples), std::max(n.most, tile.pixel(x, y).samples)};
  return n;
}

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
      const double noise = mean_over_colors(film.half_variance(x, y), unit);
      sum += noise, squares += noise * noise;
    }
  const double pixels = pixels_of(c), alike = film.format().splatting ? film.format().splatting->correlated_pixels : 1;
  return {sum / pixels, (sum + z * std::sqrt(squares * alike)) / pixels};
}

double noise_z(int number) { return normal_upper_quantile((1 - kNoiseConfidence) / (double(number) * (number + 1))); }

SamplePlan first_plan(const Film& film) {
  return {std::vector<uint64_t>(film.tiles(), kLeastAdaptive / 2),
          uint64_t(pixels_of(film.sampled())) * kLeastAdaptive};
}

std::optional<SamplePlan> second_half_plan(const Film& film, uint64_t most) {
  SamplePlan plan;
  bool has_more = false;
  for (size_t i = 0; i < film.tiles(); ++i) {
    const FilmTile& tile = film.tile(i);
    const auto [least_samples, samples] = samples_of(tile);
    const bool is_doubled = !tile.has_second_half() && least_samples == samples;
    const uint64_t end = is_doubled ? uint64_t(doubled(double(samples), 1, most)) : samples;
    plan.tile_ends.push_back(end);
    plan.predicted_paths += end * uint64_t(pixels_of(tile.pixels()));
    has_more |= end > least_samples;
  }
  return has_more ? std::optional(std::move(plan)) : std::nullopt;
}

SamplePlan next_plan(const Film& film, double max_rms, uint64_t most, const NoiseUnit& unit, const NoiseEstimate& now) {
  std::vector<TileNoise> tiles;
  for (size_t i = 0; i < film.tiles(); ++i) tiles.push_back(noise_of(film, i, unit));
  const std::vector<double> variance = variances_of(tiles, film.columns());
  // The target applies to the upper bound: the goal for the estimate is lower by their present ratio.
  const double sharpness = now.mean_square > 0 ? now.mean_square / now.upper : 1;
  const double goal = max_rms * max_rms * sharpness * pixels_of(film.settings().crop);
  // `scale` is 1 over the least reduction of the image's noise per ray for which samples are doubled.
  const auto samples_at = [&](size_t i, double scale) {
    const TileNoise& t = tiles[i];
    const double worth = scale * variance[i] / (t.samples * t.cost);
    const double doublings = worth > 1 ? std::round(std::log2(worth) / (1 + kPower)) : 0;
    return doubled(t.samples, doublings, most);
  };
  const auto noise_at = [&](double scale) {
    double noise = 0;
    for (size_t i = 0; i < tiles.size(); ++i)
      noise += tiles[i].inside * variance[i] * std::pow(tiles[i].samples / samples_at(i, scale), kPower);
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
      plan.tile_ends.push_back(uint64_t(std::min(wanted, doubled(tiles[i].samples, 1, most))));
    }
    return plan;
  };
  const auto has_more = [&](const SamplePlan& plan) {
    for (size_t i = 0; i < tiles.size(); ++i)
      if (double(plan.tile_ends[i]) > tiles[i].samples) return true;
    return false;
  };
  SamplePlan plan = plan_for(goal);
  if (std::ranges::all_of(tiles, [most](const TileNoise& t) { return t.samples >= double(most); })) return plan;
  // The noise test has just failed: a plan without more samples is too optimistic, and the goal is lowered.
  constexpr double kStricter = 0.8, kStrictest = 1e-6;
  for (double part = kStricter; !has_more(plan) && part > kStrictest; part *= kStricter) plan = plan_for(goal * part);
  return plan;
}

}  // namespace frond
