#include "leaf/walk/batch_walk.h"

#include <bit>
#include <cassert>
#include <numbers>
#include <vector>

#include "core/stop.h"
#include "leaf/walk/batch_slots.h"

namespace frond::leaf {
namespace {

using batch::Slots;
using batch::Tables;

float narrowness(const Lobe* lobe) { return lobe ? static_cast<float>(1 / (lobe->exponent() + 1)) : 0; }

/// An optical depth in powers of two. Clamped: infinities would give NaN, and nothing is transmitted at such depths
/// anyway.
float depth_in_octaves(double depth) { return static_cast<float>(std::min(depth, 1e30) * std::numbers::log2e); }

Tables tables_of(const Tissue& tissue) {
  Tables t{};
  for (size_t state = 0; state < batch::kStates; ++state) {
    const size_t interface = state / 2, up = state % 2;
    const size_t from = interface + up, to = interface + 1 - up;
    const double eta = tissue.n[from] / tissue.n[to];
    t.eta[state] = static_cast<float>(eta);
    t.one_less_eta2[state] = static_cast<float>((1 - eta) * (1 + eta));
    const float depth = depth_in_octaves(tissue.optical_depth[from]);
    const bool moves = tissue.air_space_moves;
    t.depth[state] = moves && from == 2 ? 0 : depth;
    t.depth_slope[state] = !moves ? 0 : from == 2 ? depth : from == 4 ? -depth : 0;
    t.narrowness_reflected[state] = narrowness(tissue.lobe(interface, up, false));
    t.narrowness_refracted[state] = narrowness(tissue.lobe(interface, up, true));
  }
  return t;
}

/// Keeps the slots filled with rays until all have ended.
class Batch {
 public:
  Batch(const Tissue& tissue, const Vec3d& wo, uint64_t key, uint64_t first, std::span<BatchRay> out)
      : tables_(tables_of(tissue)), traps_(find_traps(tissue)), out_(out), stream_(hash_key(key)), first_(first) {
    assert(wo.z != 0 && std::isfinite(wo.z));
    const double sine = std::hypot(wo.x, wo.y), length = std::hypot(sine, wo.z);
    cos_theta_ = static_cast<float>(std::abs(wo.z) / length);
    sin_theta_ = static_cast<float>(sine / length);
    cos_phi_ = sine > 0 ? static_cast<float>(-wo.x / sine) : 1;
    sin_phi_ = sine > 0 ? static_cast<float>(-wo.y / sine) : 0;
    up_ = wo.z < 0;
  }

  void run(batch::Step step) {
    live_ = std::min(out_.size(), Slots::kCount);
    for (size_t slot = 0; slot < live_; ++slot) start(slot);
    for (StopPoll poll; live_ > 0; poll()) {
      uint64_t ended = step(tables_, slots_, live_);
      if (live_ < Slots::kCount) ended &= (uint64_t{1} << live_) - 1;
      if (!traps_.empty()) ended |= absorb_trapped();
      // From the last to the first: the slot that moves into a gap is then never one that has ended.
      for (; ended != 0; ended ^= std::bit_floor(ended)) finish(static_cast<size_t>(std::bit_width(ended)) - 1);
    }
  }

 private:
  /// A medium in which total reflection can keep a ray without end.
  struct Trap {
    int32_t state_down, state_up;
    float sin_theta;  ///< above it, or within rounding of it, neither interface transmits light
  };
  static std::vector<Trap> find_traps(const Tissue& tissue) {
    constexpr double kRounding = 1e-6;  // of the sine's square
    std::vector<Trap> traps;
    for (size_t medium = 1; medium < Tissue::kBeneath; ++medium) {
      const bool smooth = !tissue.lobe(medium - 1, true, false) && !tissue.lobe(medium, false, false);
      const double critical = std::max(tissue.n[medium - 1], tissue.n[medium + 1]) / tissue.n[medium];
      const auto interface = static_cast<int32_t>(medium);
      if (smooth && tissue.optical_depth[medium] == 0 && critical < 1)
        traps.push_back({2 * interface, 2 * interface - 1, static_cast<float>(critical - kRounding / critical)});
    }
    return traps;
  }
  /// Ends the rays that are kept in such a medium, as absorbed.
  uint64_t absorb_trapped() {
    uint64_t bits = 0;
    for (size_t i = 0; i < live_; ++i)
      for (const Trap& trap : traps_) {
        const bool there = slots_.state[i] == (slots_.up[i] ? trap.state_up : trap.state_down);
        if (!there || slots_.draws_again[i] || slots_.sin_theta[i] <= trap.sin_theta) continue;
        slots_.weight[i] = 0;
        bits |= uint64_t{1} << i;
      }
    return bits;
  }

  void start(size_t i) {
    index_[i] = started_;
    seed(i, first_ + started_++);
    slots_.cos_theta[i] = cos_theta_, slots_.sin_theta[i] = sin_theta_;
    slots_.cos_phi[i] = cos_phi_, slots_.sin_phi[i] = sin_phi_;
    slots_.up[i] = up_ ? -1 : 0;
    slots_.state[i] = up_ ? batch::kEntersUp : batch::kEntersDown;
    slots_.draws_again[i] = 0, slots_.narrowness[i] = 0;
    slots_.weight[i] = 1;
  }

  /// Draws 2 * ray and 2 * ray + 1 of SplitMix64.
  void seed(size_t i, uint64_t ray) {
    constexpr uint64_t kStep = 0x9e3779b97f4a7c15ull;
    const uint64_t ab = mix64(stream_ + 2 * ray * kStep), rest = mix64(stream_ + (2 * ray + 1) * kStep);
    slots_.a[i] = static_cast<uint32_t>(ab), slots_.b[i] = static_cast<uint32_t>(ab >> 32);
    slots_.c[i] = static_cast<uint32_t>(rest), slots_.counter[i] = 1;
    slots_.air_space[i] = static_cast<float>(rest >> 40) * 0x1p-24f;
  }

  void finish(size_t i) {
    out_[index_[i]] = ray(i);
    if (started_ < out_.size()) return start(i);
    --live_;
    move(live_, i);
  }

  Fate fate(size_t i) const {
    if (slots_.weight[i] == 0) return Fate::absorbed;
    // Rays leave from their start states by reflection alone.
    if (slots_.state[i] == batch::kEntersDown || slots_.state[i] == batch::kEntersUp) return Fate::surface;
    return (slots_.up[i] != 0) == up_ ? Fate::transmitted : Fate::reflected;
  }

  BatchRay ray(size_t i) const {
    if (slots_.weight[i] == 0) return {{}, 0, Fate::absorbed};
    const float x = slots_.sin_theta[i] * slots_.cos_phi[i], y = slots_.sin_theta[i] * slots_.sin_phi[i];
    const float z = slots_.up[i] ? slots_.cos_theta[i] : -slots_.cos_theta[i];
    return {normalize(Vec3{x, y, z}), slots_.weight[i], fate(i)};
  }

  void move(size_t from, size_t to) {
    const auto each = [&](auto&... column) { ((column[to] = column[from]), ...); };
    each(slots_.cos_theta, slots_.sin_theta, slots_.cos_phi, slots_.sin_phi, slots_.up, slots_.state,
         slots_.draws_again, slots_.narrowness, slots_.air_space, slots_.weight, slots_.a, slots_.b, slots_.c,
         slots_.counter, index_);
  }

  Slots slots_{};
  Tables tables_;
  std::vector<Trap> traps_;
  std::span<BatchRay> out_;
  std::array<size_t, Slots::kCount> index_{};  ///< of each slot's ray in out_
  uint64_t stream_, first_;
  size_t started_ = 0, live_ = 0;
  float cos_theta_, sin_theta_, cos_phi_, sin_phi_;
  bool up_;
};

std::vector<const batch::Kernel*> supported_kernels() {
  std::vector<const batch::Kernel*> kernels;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) kernels.push_back(&batch::kAvx512);
  if (__builtin_cpu_supports("avx2")) kernels.push_back(&batch::kAvx2);
#endif
  kernels.push_back(&batch::kBaseline);
  return kernels;
}

}  // namespace

std::span<const batch::Kernel* const> batch_kernels() {
  static const std::vector<const batch::Kernel*> kernels = supported_kernels();
  return kernels;
}

std::string_view name_of(const batch::Kernel& kernel) { return kernel.name; }

void walk_batch(const batch::Kernel& kernel, const Tissue& tissue, const Vec3d& wo, Absorption absorption, uint64_t key,
                std::span<BatchRay> out, uint64_t first) {
  Batch(tissue, wo, key, first, out).run(kernel.step[absorption == Absorption::weighted][tissue.sieve_and_detour]);
}

void walk_batch(const Tissue& tissue, const Vec3d& wo, Absorption absorption, uint64_t key, std::span<BatchRay> out,
                uint64_t first) {
  walk_batch(*batch_kernels().front(), tissue, wo, absorption, key, out, first);
}

}  // namespace frond::leaf
