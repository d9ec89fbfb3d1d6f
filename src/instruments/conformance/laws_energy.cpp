#include <array>
#include <cmath>
#include <numbers>

#include "instruments/conformance/examination.h"

namespace frond {
namespace {

/// Rounding of a mean of weights in float.
constexpr double kWeightRounding = 1e-4;

/// Exitant energy at one wavelength: in all, and through each bin.
struct Outgoing {
  Estimate all;
  std::vector<double> by_bin;
};

/// Mean weight of `sample`, as power; a call without a direction counts as 0.
Outgoing mean_weight(const Examination& s, int lane) {
  Moments moments;
  std::vector<double> by_bin(s.bins.size(), 0);
  for (const BsdfSample& sample : s.samples) {
    const double w = weight(sample, lane) * static_cast<double>(power_of_radiance(s.bsdf, s.wo, sample.wi)[lane]);
    moments.add(w);
    if (s.maps && !is_specular(sample)) by_bin[s.bins.find(sample.wi)] += w / static_cast<double>(s.drawn);
  }
  moments.add_zeros(s.drawn - moments.count());
  return {moments.estimate(), std::move(by_bin)};
}

/// Integral of f(w, s.wo) |cos theta| over w, lane by lane, by a stratified mean over the bins: the albedo of a BSDF
/// that conserves, summed over wo, the energy of light along wi.
std::array<Outgoing, kLanes> albedo_from_light(const Examination& s, uint64_t seed) {
  std::array<Outgoing, kLanes> result{};
  const int64_t each = std::max<int64_t>(4, s.drawn / static_cast<int64_t>(s.bins.size()));
  RandomStream numbers(seed);
  for (size_t b = 0; b < s.bins.size(); ++b) {
    std::array<Moments, kLanes> moments{};
    for (int64_t i = 0; i < each; ++i) {
      const auto [w, density] = s.in_bin[b].draw(numbers);
      const SampledSpectrum f = f_once(s.bsdf, w, s.wo, hash_key(seed, b, i));
      for (int lane = 0; lane < kLanes; ++lane)
        moments[static_cast<size_t>(lane)].add(static_cast<double>(f[lane] * std::abs(w.z)) / density);
    }
    for (size_t lane = 0; lane < kLanes; ++lane) {
      result[lane].all += moments[lane].estimate();
      result[lane].by_bin.push_back(moments[lane].mean());
    }
  }
  return result;
}

/// Energy through each bin, relative to a white Lambertian surface, |cos theta| / pi.
std::shared_ptr<const SphereMap> energy_map(const Examination& s, std::vector<double> by_bin) {
  for (size_t b = 0; b < by_bin.size(); ++b) {
    const SphereBox& box = s.bins.box(b);
    const double projected = std::abs(box.z1 * box.z1 - box.z0 * box.z0) / 2 * (box.phi1 - box.phi0);
    by_bin[b] *= std::numbers::pi / projected;
  }
  return s.map("energy that leaves, over that of a white diffuse sheet", by_bin);
}

}  // namespace

void check_energy(const Examination& s, const Claims& claims, uint64_t seed, Findings& findings) {
  const bool is_from_light = any(s.bsdf.flags() & Lobes::from_light);
  std::array<Outgoing, kLanes> from_light{};
  if (is_from_light) from_light = albedo_from_light(s, seed);
  for (int lane = 0; lane < s.lambda.count; ++lane) {
    if (!s.lambda.is_active(lane)) continue;
    const auto [out, by_bin] = is_from_light ? from_light[static_cast<size_t>(lane)] : mean_weight(s, lane);
    const double p =
        claims.lossless ? equality_p(out, {.mean = 1}, kWeightRounding) : at_most_p(out, 1, kWeightRounding);
    findings.push_back(statistical(Law::energy, s, p,
                                   fmt::format("of 1 at {} nm, {:.6g} +- {:.2g} comes out",
                                               s.lambda.nm[static_cast<size_t>(lane)], out.mean, out.standard_error()),
                                   energy_map(s, by_bin)));
  }
}

}  // namespace frond
