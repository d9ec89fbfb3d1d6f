#include "integrators/path_pilots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "core/stop.h"
#include "integrators/path_parts.h"
#include "spectra/color/color_space.h"

namespace frond {
namespace {

/// CPU times, in units of that of a scattered ray and its vertex (measured): of a camera ray; of a light sample at a
/// first vertex, without its shadow ray; of that shadow ray.
constexpr double kCameraRay = 0.6, kLightSample = 0.15, kShadowRay = 0.45;

/// The variance falls with these powers of the number of samples of a pixel: that at edges faster than the rest
/// (measured, with the sampler "lattice").
constexpr double kPower = 1.1, kPowerAtEdges = 1.5;

/// Factor that converts the squared difference of two bundles, as far as it is noise at edges, to the variance with 64
/// samples, the usual number, on the scale of the rest of the noise, whose variance falls with another power. The two
/// bundles are halves of one lattice, whose errors partly cancel in their sum. Hence the square of their difference is
/// 4 (1 - 2^-power) times the variance of a bundle.
const double kEdges = std::pow(64. / PathBundle::kSize, kPower - kPowerAtEdges) / (2 * (1 - std::exp2(-kPowerAtEdges)));

using Color = std::array<double, 3>;

/// Linear colour that a radiance adds to the image; where the film's channels are spectral bands, the sum of what it
/// adds to them, and zeros. The colour is RGB, as noise of XYZ would be that of brightness alone: the sampling of
/// wavelengths keeps the sum of X, Y and Z nearly free of noise.
Color color_of(const WavelengthStrategy& wavelengths, const SampledSpectrum& radiance,
               const SampledWavelengths& lambda) {
  const SensorResponse response = wavelengths.sensor(radiance, lambda);
  const std::string_view space = wavelengths.film_space();
  if (space.empty())
    return {std::accumulate(response.value.begin(), response.value.begin() + response.count, 0.), 0, 0};
  static const Matrix3 kSrgbFromXyz = find_color_space("linear sRGB")->rgb_from_xyz;
  return space == kXyzName ? kSrgbFromXyz * response.color() : response.color();
}

/// Effect of a second sample: sums over bundles.
struct SecondSample {
  double saved = 0;  ///< decrease of the variance of a bundle's sum
  double cost = 0;   ///< CPU time
};

/// Taking two samples instead of one.
struct Option {
  SecondSample second;
  int* count;  ///< the number of samples
};

/// Variance of a pixel by its cause.
struct Noise {
  double later;  ///< random numbers of light samples and scattered rays
  double edges;  ///< the rest, which is attributed to the positions of camera rays

  /// Variance in the same time, if a path takes `cost` times as long, relative to cost^(kPower - 1).
  double in_same_time(double cost) const { return later * cost + edges * std::pow(cost, 1 + kPowerAtEdges - kPower); }
};

/// Selects the options with which images have the least variance in the same time. The sets that are compared consist
/// of the options that save most for their cost; without noise at edges the best set is one of these. `noise` and
/// `cost`, the CPU time, are those without options, and become those with the selected ones.
void select_best(std::vector<Option> options, Noise& noise, double& cost) {
  std::erase_if(options, [](const Option& o) { return !(o.second.saved > 0 && o.second.cost > 0); });
  std::ranges::stable_sort(options, std::greater(), [](const Option& o) { return o.second.saved / o.second.cost; });
  const auto take = [](const SecondSample& second, Noise& left, double& time) {
    left.later = std::max(0., left.later - second.saved);
    time += second.cost;
  };
  Noise tried = noise;
  double tried_cost = cost, least = noise.in_same_time(1);
  size_t best = 0;
  for (size_t i = 0; i < options.size(); ++i) {
    take(options[i].second, tried, tried_cost);
    const double after = tried.in_same_time(tried_cost / cost);
    if (after < least) least = after, best = i + 1;
  }
  for (size_t i = 0; i < best; ++i) {
    take(options[i].second, noise, cost);
    *options[i].count = 2;
  }
}

/// The nearest power of two: scenes that differ in a material share their roulette, so that their images can be
/// compared path by path.
float rounded(double x) { return float(std::exp2(std::round(std::log2(x)))); }

/// What the rays that first vertices scatter find: sums over the rays.
struct Scattered {
  double squares = 0;  ///< of the colour that a ray adds to the image
  double shares = 0;   ///< squares of the share with which its radiance counts
  double rays = 0;     ///< number of rays, later ones included
  double count = 0;

  /// Scale of roulette for the least variance in the same time, of an image with this variance and CPU time (Bolin and
  /// Meyer 1997, "An Error Metric for Monte Carlo Ray Tracing", without its measure of what is visible). A path that
  /// survives with the probability q adds the variance X (1/q - 1) and takes the time q C, where X is the expected
  /// square of what it finds: the best q is sqrt(X / variance * cost / C), and X is proportional to the square of its
  /// share. The result is kEven times as large, because roulette is independent from sample to sample, whereas the
  /// variance is that of evenly spread samples, which falls faster (measured), and at least kLeast, because a pilot may
  /// miss what few rays find.
  float roulette_scale(double variance, double cost) const {
    constexpr double kEven = 2, kLeast = 2, kMost = 64;
    const double scale = kEven * std::sqrt(squares / shares * cost / variance / (rays / count));
    return std::isnan(scale) ? float(kMost) : rounded(std::clamp(scale, kLeast, kMost));
  }
};

/// Paths of a few pixels, two bundles of each, whose first vertices take two of both. All sums are over bundles.
class Pilot {
 public:
  Pilot(const World& world, const LightSelector& selector, const PathSettings& settings, const CameraSampling& sampling)
      : sampling_(sampling),
        samples_(sampling, nullptr),
        tracer_(make_recording_tracer(world, selector, settings, record_)) {}

  SecondSample light;
  std::map<uint32_t, SecondSample> scattered;  ///< by material
  Scattered later;                             ///< what scattered rays find
  double variance = 0;                         ///< of a bundle's sum
  double cost = 0;                             ///< CPU time
  double brightness = 0;                       ///< radiance of paths, mean over their wavelengths
  uint64_t path_count = 0;
  uint64_t rays_traced = 0;

  /// Traces two bundles of a pixel, which `index` selects at random. The sample numbers are those of no other index, as
  /// small images have fewer pixels than the pilot asks for. Where there are many bands, all bundles have the same
  /// ones, so that the difference between two is noise. Without the filter: where pixels share samples, noise is that
  /// of the samples inside a pixel.
  void add_pixel(uint64_t index) {
    constexpr uint32_t kAll = (1u << PathBundle::kSize) - 1;
    const PixelPosition pixel = sampling_.random_pixel(index);
    PathBundle& bundle = samples_.bundle();
    Color difference{};
    for (const uint64_t which : {0, 1}) {
      samples_.make(pixel, (2 * index + which) * PathBundle::kSize, kAll, 0);
      bundle.traced = 0;
      tracer_->trace(bundle);
      for (size_t i = 0; i < bundle.results.size(); ++i) {
        const SampledSpectrum& found = bundle.results[i].radiance;
        add(difference, bundle, i, found, which == 0);
        if (const float value = mean(found, bundle.lambda[i]); std::isfinite(value)) brightness += double(value);
      }
      path_count += bundle.results.size();
      add(light, bundle, record_.lights, LaneSet(bundle.lanes));
      light.cost += light_cost(record_.lights[1]);
      std::map<uint32_t, LaneSet> by_material;
      for (const size_t i : LaneSet(bundle.lanes))
        if (bundle.results[i].first.is_hit) by_material[bundle.results[i].first.material].add(i);
      for (const auto& [material, seen] : by_material) {
        add(scattered[material], bundle, record_.scattered, seen);
        for (const size_t i : seen) scattered[material].cost += record_.scattered[1].rays[i];
      }
      for (const SplitRecord::Part& part : record_.scattered) add(later, bundle, part);
      cost += double(bundle.traced) - (1 - kCameraRay) * double(bundle.results.size());
      for (const SplitRecord::Part& part : record_.lights) cost += light_cost(part) - rays_of(part);
      rays_traced += bundle.traced;
    }
    add_square(difference, variance);
  }

 private:
  /// Adds or subtracts the colour of a path.
  void add(Color& sum, const PathBundle& bundle, size_t path, const SampledSpectrum& radiance, bool is_positive) const {
    const Color color = color_of(sampling_.wavelengths, radiance, bundle.lambda[path]);
    for (size_t c = 0; c < 3; ++c) sum[c] += is_positive ? color[c] : -color[c];
  }

  static void add_square(const Color& color, double& sum) {
    const double square = color[0] * color[0] + color[1] * color[1] + color[2] * color[2];
    if (std::isfinite(square)) sum += square;
  }

  static double rays_of(const SplitRecord::Part& part) {
    return std::accumulate(part.rays.begin(), part.rays.end(), 0.);
  }
  static double light_cost(const SplitRecord::Part& part) {
    return kLightSample * double(part.paths.size()) + kShadowRay * rays_of(part);
  }

  /// Adds the effect of the second samples, by the radiance of first and second samples, which count half each. The
  /// variance of their mean is less than that of one of them by a quarter of the mean squared difference of the two,
  /// also where they are correlated.
  void add(SecondSample& effect, const PathBundle& bundle, const SplitRecord::Parts& parts,
           const LaneSet& paths) const {
    Color difference{};  // half of that between the samples
    for (const size_t i : LaneSet(paths.bits() & parts[1].paths.bits())) {
      add(difference, bundle, i, parts[0].radiance[i], true);
      add(difference, bundle, i, parts[1].radiance[i], false);
    }
    add_square(difference, effect.saved);
  }

  /// Adds what these scattered rays find.
  void add(Scattered& sums, const PathBundle& bundle, const SplitRecord::Part& part) const {
    for (const size_t i : part.paths) {
      if (!(part.share[i] > 0)) continue;  // the path ended
      Color color{};
      add(color, bundle, i, part.radiance[i], true);
      add_square(color, sums.squares);
      sums.shares += double(part.share[i]) * double(part.share[i]);
      sums.rays += part.rays[i];
      ++sums.count;
    }
  }

  const CameraSampling& sampling_;
  CameraSamples samples_;
  SplitRecord record_;
  std::unique_ptr<Tracer> tracer_;
};

}  // namespace

void adapt_to_scene(const World& world, const LightSelector& selector, const AdaptedSettings& adapted,
                    const CameraSampling& sampling, PathSettings& settings) {
  constexpr uint64_t kMostRays = 1 << 17;
  constexpr uint64_t kMostPixels = 1024;
  PathSettings two = settings;
  two.light_samples = two.scattered_rays = 2;
  two.roulette = {};
  Pilot pilot(world, selector, two, sampling);
  for (uint64_t pixel = 0; pixel < kMostPixels && pilot.rays_traced < kMostRays; ++pixel) {
    check_stop();
    pilot.add_pixel(pixel);
  }

  // The pilot takes two samples of both kinds: converts its noise and cost to those of the numbers in the settings,
  // where the numbers to be selected are one.
  Noise noise{.later = 0, .edges = pilot.variance};
  double cost = pilot.cost;
  std::vector<Option> options;
  const auto consider = [&](const SecondSample& second, bool is_open, int& count) {
    // The variance that remains with two samples is as large as the decrease by the second one.
    noise.edges -= second.saved;
    noise.later += count == 1 ? 2 * second.saved : second.saved;
    if (count == 1) cost -= second.cost;
    if (is_open) options.push_back({second, &count});
  };
  consider(pilot.light, adapted.light_samples, settings.light_samples);
  if (adapted.scattered_rays && !pilot.scattered.empty())
    settings.rays_by_material.resize(pilot.scattered.rbegin()->first + 1, settings.scattered_rays);
  for (const auto& [material, second] : pilot.scattered)
    consider(second, adapted.scattered_rays,
             adapted.scattered_rays ? settings.rays_by_material[material] : settings.scattered_rays);
  noise.edges = kEdges * std::max(0., noise.edges);
  select_best(options, noise, cost);
  if (!adapted.roulette || pilot.later.count == 0) return;
  const auto of_path = [&](double sum) { return sum / double(pilot.path_count); };
  settings.roulette = {.scale = pilot.later.roulette_scale(of_path(noise.later + noise.edges), of_path(cost)),
                       .mean = rounded(of_path(pilot.brightness))};
}

}  // namespace frond
