#pragma once

#include <cstddef>
#include <cstdint>

namespace frond::leaf::batch {

/// What the driver (batch_walk.cpp) and its kernels share. Plain data and nothing else: a kernel is compiled for
/// instructions that this machine may lack, so it must not emit functions that other files could be linked with.

/// interface * 2 + (the ray goes up): the ray has come to that interface, and its next event happens there.
inline constexpr size_t kStates = 12;
inline constexpr int32_t kEntersDown = 0, kEntersUp = 11;  // no ray comes back to these

/// A tissue as a table by state, each padded to a register's length.
struct alignas(64) Tables {
  static constexpr size_t kLength = 16;

  float eta[kLength];            ///< index of the medium that the ray comes from over the one beyond
  float one_less_eta2[kLength];  ///< 1 - eta^2, rounded last
  /// Optical depth of the way to the interface along its normal, in powers of two: `depth` + `depth_slope` * the place
  /// of the air space.
  float depth[kLength], depth_slope[kLength];
  /// 1 / (exponent + 1) of the lobe, 0 where there is none.
  float narrowness_reflected[kLength], narrowness_refracted[kLength];
};

/// Rays under way at once. Any number gives the same results. Masks are -1 for true, 0 for false.
struct alignas(64) Slots {
  static constexpr size_t kCount = 64;

  // The direction: |z|, sin theta, and the azimuth's cosine and sine. Refraction and reflection keep the azimuth.
  float cos_theta[kCount], sin_theta[kCount], cos_phi[kCount], sin_phi[kCount];
  int32_t up[kCount];     ///< mask: z > 0
  int32_t state[kCount];  ///< where the ray is at, or was at when it ended
  /// Mask: the direction is a lobe's axis. The last draw from the lobe fell beyond the interface; the next event draws
  /// again, with the same `narrowness`.
  int32_t draws_again[kCount];
  float narrowness[kCount];
  float air_space[kCount];  ///< its place, where it moves
  float weight[kCount];     ///< 0: absorbed
  // Random numbers: sfc32, one generator for each ray.
  uint32_t a[kCount], b[kCount], c[kCount], counter[kCount];
};

/// One event for each of the first `count` slots, or some more. Bit i of the result: slot i's ray has left or was
/// absorbed; bits from `count` on mean nothing.
using Step = uint64_t (*)(const Tables& tables, Slots& slots, size_t count);

/// The same arithmetic compiled for different instructions.
struct Kernel {
  const char* name;
  Step step[2][2];  ///< [weighted][sieve and detour]
};

extern const Kernel kBaseline;
#if defined(__x86_64__)
extern const Kernel kAvx2, kAvx512;
#endif

}  // namespace frond::leaf::batch
