#pragma once

#include <algorithm>
#include <bit>
#include <functional>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "instruments/beam.h"

namespace frond {

/// Rays are traced in blocks, each with its own random stream.
inline constexpr int64_t kRaysPerBlock = 1 << 16;

/// Called from time to time, from the measuring thread, with the number of rays traced so far.
using RayProgress = std::function<void(int64_t rays)>;

/// Scatters the rays of one block, a batch at a time. Results depend on `lit` and the block's number alone.
class RayBlock {
 public:
  RayBlock(const LitMaterial& lit, int64_t number)
      : bsdf_(bsdf_of(lit.material, lit.beam, arena_)),
        material_(lit.material),
        beam_(lit.beam),
        toward_light_(toward_light(lit.beam)),
        as_rendered_(lit.as_rendered),
        rng_(hash_key(lit.seed, std::bit_cast<uint64_t>(lit.beam.theta_deg),
                      std::bit_cast<uint64_t>(lit.beam.lambda_nm), number)) {}
  RayBlock(const RayBlock&) = delete;
  RayBlock& operator=(const RayBlock&) = delete;

  /// Returns the next scattered rays, at most `wanted`; valid until the next call. Throws InputError if the material
  /// has a defect.
  std::span<const Scattered> next(int64_t wanted) {
    const std::span batch = std::span(rays_).first(static_cast<size_t>(std::min<int64_t>(wanted, kBatch)));
    if (beam_.band)
      for (Scattered& ray : batch) {
        of_ray_.reset();
        scatter(bsdf_at(material_, beam_.band->lit_response.sample(rng_.uniform()), of_ray_), {&ray, 1});
      }
    else
      scatter(bsdf_, batch);
    for (const Scattered& ray : batch) check(ray);
    return batch;
  }

 private:
  static constexpr int64_t kBatch = 512;

  void scatter(const Bsdf& bsdf, std::span<Scattered> rays) {
    if (as_rendered_)
      scatter_as_rendered(bsdf, toward_light_, rng_, rays);
    else
      bsdf.scatter(toward_light_, rng_, rays);
  }

  void check(const Scattered& ray) const {
    constexpr float kRounding = 1e-2f;
    if (ray.weight.is_physical() &&
        (ray.weight.is_black() || std::abs(dot(ray.direction, ray.direction) - 1) < kRounding))
      return;
    fail({},
         "the material has a defect: for light at {} degrees and {} it scatters a weight of {}, which is negative, "
         "infinite or not a number, or in a direction of no unit length",
         beam_.theta_deg, label_of(beam_), ray.weight[0]);
  }

  Arena arena_, of_ray_;  ///< the latter for the BSDF of one ray in a band
  const Bsdf& bsdf_;
  const Material& material_;
  Beam beam_;
  Vec3 toward_light_;
  bool as_rendered_;
  RandomStream rng_;
  std::array<Scattered, kBatch> rays_;
};

/// Traces rays `first` to `last` - 1 and adds them to `total`. `first` is a multiple of kRaysPerBlock. A Tally has
/// add(ray), add(tally) and clear(); tallies of blocks are added in their order, so that sums are bitwise equal for any
/// number of threads.
template <class Tally>
void tally_rays(const LitMaterial& lit, int64_t first, int64_t last, Tally& total, const ThreadPool& pool,
                const RayProgress& progress) {
  const int64_t wave = int64_t{kRaysPerBlock} * 8 * pool.size();
  Tally blank = total;
  blank.clear();
  std::vector<Tally> tallies(8 * static_cast<size_t>(pool.size()), blank);
  for (int64_t start = first; start < last; start += wave) {
    const int64_t end = std::min(last, start + wave), blocks = (end - start + kRaysPerBlock - 1) / kRaysPerBlock;
    pool.for_each(blocks, [&](int64_t i, int) {
      Tally& tally = tallies[static_cast<size_t>(i)];
      tally.clear();
      RayBlock block(lit, start / kRaysPerBlock + i);
      for (int64_t left = std::min(kRaysPerBlock, end - start - i * kRaysPerBlock); left > 0;) {
        check_stop();
        const auto batch = block.next(left);
        for (const Scattered& ray : batch) tally.add(ray);
        left -= static_cast<int64_t>(batch.size());
      }
    });
    for (int64_t i = 0; i < blocks; ++i) total.add(tallies[static_cast<size_t>(i)]);
    if (progress) progress(end);
  }
}

}  // namespace frond
