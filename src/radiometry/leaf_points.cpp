#include "radiometry/leaf_points.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "core/stop.h"
#include "radiometry/ratio_sums.h"
#include "scene/leaf_models.h"

namespace frond {
namespace {

/// Returns how many repetitions of a position, by a period, lie in [low, high).
double repetitions(double at, double low, double high, const std::optional<double>& period) {
  if (period) return std::floor((high - at) / *period) - std::floor((low - at) / *period);
  const double rounding = 1e-6 * (high - low);
  return at >= low - rounding && at <= high + rounding ? 1 : 0;
}

/// Sums of weights of points.
struct WeightSums {
  double sum = 0, square = 0;
  void add(double weight) { sum += weight, square += weight * weight; }
  /// Returns the mean of n weights times a factor.
  MeanError mean(double n, double factor) const {
    const double mean = sum / n, variance = std::max(0.0, square / n - mean * mean);
    constexpr double kRounding = 1e-12;  // equal weights have no error
    return {mean * factor, variance > kRounding * mean * mean ? std::sqrt(variance / n) * factor : 0};
  }
};

}  // namespace

std::vector<uint8_t> counted_materials(const SceneDescription& description, const std::vector<std::string>& names,
                                       const Registry& registry) {
  std::vector<uint8_t> flags = leaf_flags(description, registry);
  std::vector<std::string_view> known;
  for (const MaterialDescription& m : description.materials) known.push_back(m.shown_name());
  if (!names.empty()) {
    std::ranges::fill(flags, 0);
    for (const std::string& name : names) {
      if (std::ranges::find(known, name) == known.end())
        fail({}, "the scene has no material \"{}\"{}", name, suggestion(name, known));
      for (size_t i = 0; i < known.size(); ++i) flags[i] |= known[i] == name;
    }
  }
  if (std::ranges::count(flags, 0) == std::ssize(flags)) {
    std::ranges::sort(known);
    known.erase(std::ranges::unique(known).begin(), known.end());
    fail({}, "no material of the scene is a leaf model: name the leaves by \"material\"; there are \"{}\"",
         fmt::join(known, "\", \""));
  }
  return flags;
}

double count_in_column(const Scene& scene, const Target& target, const Vec3& p) {
  const Vec3d at = to_double(p) + scene.origin();
  const auto period = scene.period();
  const auto along = [](const std::optional<Vec2>& v, float Vec2::*axis) {
    return v ? std::optional(double((*v).*axis)) : std::nullopt;
  };
  return repetitions(at.x, target.x0, target.x1, along(period, &Vec2::x)) *
         repetitions(at.y, target.y0, target.y1, along(period, &Vec2::y));
}

bool is_sunlit(const Scene& scene, const Hit& hit, const Vec3& w, uint64_t key) {
  return !scene.occluded({offset_origin(hit, w), w}, key);
}

LeafArea leaf_area(const Scene& scene, const std::optional<Target>& target, std::span<const uint8_t> is_leaf,
                   const std::optional<Vec3>& sun, size_t points, ThreadPool& pool) {
  enum Use : uint64_t { kPoints = 0x61726561, kShadows };
  constexpr size_t kBlock = 4096;
  const SurfacePoints surfaces(scene.geometry(), is_leaf);
  if (!(surfaces.total() > 0)) return {{0, 0}, {0, 0}, {0, 0}};
  const auto drawn = surfaces.draw(hash_key(scene.seed(), uint64_t{kPoints}), 0, points);
  std::vector<uint8_t> sunlit(points);
  pool.for_each(int64_t((points + kBlock - 1) / kBlock), [&](int64_t block, int) {
    StopPoll poll;
    for (size_t i = size_t(block) * kBlock; i < std::min(points, (size_t(block) + 1) * kBlock); ++i) {
      poll();
      sunlit[i] = sun && is_sunlit(scene, drawn[i], *sun, hash_key(scene.seed(), uint64_t{kShadows}, uint64_t(i)));
    }
  });
  WeightSums all, lit, shaded;
  for (size_t i = 0; i < points; ++i) {
    const double weight = drawn[i].weight * (target ? count_in_column(scene, *target, drawn[i].p) : 1);
    all.add(weight), lit.add(sunlit[i] ? weight : 0), shaded.add(sunlit[i] ? 0 : weight);
  }
  const auto n = double(points);
  if (!sun) return {all.mean(n, surfaces.total()), kUnknown, kUnknown};
  return {all.mean(n, surfaces.total()), lit.mean(n, surfaces.total()), shaded.mean(n, surfaces.total())};
}

/// The share is a ratio of weights; its error is that of a binomial share with half a point more on either side.
std::vector<MeanError> sunlit_shares(const Scene& scene, const Organs& organs, const Vec3& sun, size_t points,
                                     ThreadPool& pool) {
  enum Use : uint64_t { kPoints = 0x6f726761, kShadows };
  constexpr size_t kBatch = 1 << 16, kBlock = 1024;
  struct Counted {
    double all = 0, sunlit = 0, points = 0;
  };
  std::vector<Counted> counted(organs.size());
  std::vector<std::pair<RandomSurfacePoint, uint64_t>> batch;
  std::vector<uint8_t> sunlit(kBatch);
  uint64_t first = 0;
  const auto add_batch = [&] {
    pool.for_each(int64_t((batch.size() + kBlock - 1) / kBlock), [&](int64_t block, int) {
      StopPoll poll;
      for (size_t i = size_t(block) * kBlock; i < std::min(batch.size(), (size_t(block) + 1) * kBlock); ++i) {
        poll();
        sunlit[i] = is_sunlit(scene, batch[i].first, sun, hash_key(scene.seed(), uint64_t{kShadows}, first + i));
      }
    });
    for (size_t i = 0; i < batch.size(); ++i) {
      Counted& one = counted[batch[i].second - 1];
      const double weight = batch[i].first.weight;
      one.all += weight, one.sunlit += sunlit[i] ? weight : 0, one.points += weight > 0 ? 1 : 0;
    }
    first += batch.size();
    batch.clear();
  };
  organs.draw(points, hash_key(scene.seed(), uint64_t{kPoints}), [&](const RandomSurfacePoint& point, uint64_t of) {
    batch.emplace_back(point, of);
    if (batch.size() == kBatch) add_batch();
  });
  add_batch();
  std::vector<MeanError> shares;
  for (const Counted& one : counted) {
    const double share = one.sunlit / one.all, near = (share * one.points + 0.5) / (one.points + 1);
    shares.push_back(one.all > 0 ? MeanError{share, std::sqrt(near * (1 - near) / one.points)} : kUnknown);
  }
  return shares;
}

}  // namespace frond
