#pragma once

#include <cstddef>
#include <cstdint>

namespace frond::leaf::batch {

/// Data that the driver (batch_walk.cpp) and its kernels share. Plain data only: a kernel is compiled for instructions
/// that this machine may lack, so it must not emit functions that other files could be linked with.

/// State of a ray: interface * 2 + (the ray goes up). The ray has come to that interface, and its next event happens
/// there.
inline constexpr size_t kStates = 12;
inline constexpr int32_t kEntersDown = 0, kEntersUp = 11;  // no ray comes back to these

/// A tissue as tables by state, each padded to the longest register.
struct alignas(64) Tables {
  static constexpr size_t kLength = 16;

  float eta[kLength];            ///< index of the medium that the ray comes from over the one beyond
  float one_less_eta2[kLength];  ///< 1 - eta^2, rounded last
  /// Optical depth, in powers of two, along the normal up to the interface: `depth` + `depth_slope` * position of the
  /// air space.
  float depth[kLength], depth_slope[kLength];
  /// 1 / (exponent + 1) of the lobe, 0 if there is none.
  float narrowness_reflected[kLength], narrowness_refracted[kLength];
};

/// Rays that are traced at once. Any number gives the same results. Masks are -1 for true, 0 for false.
struct alignas(64) Slots {
  static constexpr size_t kCount = 64;

  // Direction: |z|, sin theta, and the azimuth's cosine and sine. Refraction and reflection keep the azimuth.
  float cos_theta[kCount], sin_theta[kCount], cos_phi[kCount], sin_phi[kCount];
  int32_t up[kCount];     ///< mask: z > 0
  int32_t state[kCount];  ///< current state, or the last one before the walk ended
  /// Mask: the direction is a lobe's axis. The last draw from the lobe fell beyond the interface; the next event draws
  /// again, with the same `narrowness`.
  int32_t draws_again[kCount];
  float narrowness[kCount];
  float air_space[kCount];  ///< position of the air space in [0, 1], where it moves
  float weight[kCount];     ///< 0: absorbed
  // Random numbers: sfc32, one generator for each ray.
  uint32_t a[kCount], b[kCount], c[kCount], counter[kCount];
};

/// Executes one event for each of the first `count` slots, or some more. Bit i of the result: slot i's ray has left or
/// was absorbed; bits from `count` on are undefined.
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
