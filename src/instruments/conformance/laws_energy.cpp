#include <array>
#include <cmath>
#include <limits>
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

double power_weight(const Examination& s, const BsdfSample& sample, int lane) {
  return weight(sample, lane) * static_cast<double>(radiance_to_power(s.bsdf, s.wo, sample.wi)[lane]);
}

/// Mean weight of `sample`, as power; a call without a direction counts as 0. `further` calls are drawn in addition to
/// the examination's.
std::array<Outgoing, kLanes> mean_weights(const Examination& s, int64_t further, uint64_t seed) {
  std::array<Moments, kLanes> moments{};
  std::array<Outgoing, kLanes> result{};
  for (Outgoing& out : result) out.by_bin.assign(s.bins.size(), 0);
  const auto add = [&](const BsdfSample& sample) {
    for (int lane = 0; lane < s.lambda.count; ++lane)
      moments[static_cast<size_t>(lane)].add(power_weight(s, sample, lane));
  };
  for (const BsdfSample& sample : s.samples) {
    add(sample);
    if (!s.maps || is_specular(sample)) continue;
    for (int lane = 0; lane < s.lambda.count; ++lane)
      result[static_cast<size_t>(lane)].by_bin[s.bins.find(sample.wi)] +=
          power_weight(s, sample, lane) / static_cast<double>(s.drawn);
  }
  for (int64_t i = 0; i < further; ++i)
    if (const auto sample = sample_once(s.bsdf, s.wo, hash_key(seed, i))) add(*sample);
  for (size_t lane = 0; lane < kLanes; ++lane) {
    moments[lane].add_zeros(s.drawn + further - moments[lane].count());
    result[lane].all = moments[lane].estimate();
  }
  return result;
}

/// Integral of f(w, s.wo) |cos theta| over w, lane by lane, by a stratified mean over the bins: the albedo of a BSDF
/// that conserves, summed over wo, the energy of light along wi.
std::array<Outgoing, kLanes> albedo_from_light(const Examination& s, int64_t calls, uint64_t seed) {
  std::array<Outgoing, kLanes> result{};
  const int64_t each = std::max<int64_t>(4, calls / static_cast<int64_t>(s.bins.size()));
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

/// Estimates from a pilot of 1 / kPilotShare as many calls.
std::array<Estimate, kLanes> pilot_of(const Examination& s, uint64_t seed) {
  std::array<Estimate, kLanes> result{};
  const int64_t calls = s.drawn / Examination::kPilotShare;
  if (any(s.bsdf.flags() & Lobes::from_light)) {
    const auto albedo = albedo_from_light(s, calls, seed);
    for (size_t lane = 0; lane < kLanes; ++lane) result[lane] = albedo[lane].all;
    return result;
  }
  for (int lane = 0; lane < s.lambda.count; ++lane) {
    Moments moments;
    for (const BsdfSample& sample : s.pilot) moments.add(power_weight(s, sample, lane));
    moments.add_zeros(calls - moments.count());
    result[static_cast<size_t>(lane)] = moments.estimate();
  }
  return result;
}

/// Number of calls in addition to s.drawn after which an excess of `effort.excess` would be found. Decided by the
/// pilot: a decision by the tested samples would bias their p-values. Albedos far below 1 need none.
int64_t further_calls(const Examination& s, const Claims& claims, uint64_t seed) {
  constexpr double kMostTests = 1e5;  // of a report; decides the level, which is known at its end
  constexpr double kFarBelow = 5;     // in standard errors
  if (s.excess <= kWeightRounding) return 0;
  const double z = normal_upper_quantile(s.false_alarm_rate / kMostTests) - normal_upper_quantile(kPower);
  const double allowed = (s.excess - kWeightRounding) / (1 + s.excess);  // relative, as in energy_measure
  double rounds = 0;
  for (const Estimate& e : pilot_of(s, hash_key(seed, 1))) {
    if (!claims.lossless && !(e.mean + kFarBelow * e.standard_error() >= 1)) continue;
    const double relative = z * e.standard_error() / e.mean;
    if (std::isfinite(relative)) rounds = std::max(rounds, relative * relative / (allowed * allowed));
  }
  const double calls = std::min<double>(kMostRounds, rounds / Examination::kPilotShare) * static_cast<double>(s.drawn);
  return std::max<int64_t>(0, static_cast<int64_t>(calls) - s.drawn);
}

/// The detectable error e is the error of a BSDF with the albedo 1 + e whose weights have this BSDF's coefficient of
/// variation.
Measure energy_measure(const Estimate& out, bool lossless) {
  Measure measure{.quantity = "directional albedo", .value = out.mean, .standard_error = out.standard_error()};
  if (out.mean > 0)
    measure.detectable_at = [out, lossless](double level) {
      const double relative = detectable_difference(out, lossless ? level / 2 : level, kPower) / out.mean;
      return relative < 1 ? (kWeightRounding + relative) / (1 - relative) : std::numeric_limits<double>::infinity();
    };
  return measure;
}

}  // namespace

void check_energy(const Examination& s, const Claims& claims, uint64_t seed, Findings& findings) {
  const int64_t further = further_calls(s, claims, seed);
  const auto outgoing = any(s.bsdf.flags() & Lobes::from_light) ? albedo_from_light(s, s.drawn + further, seed)
                                                                : mean_weights(s, further, hash_key(seed, 2));
  for (int lane = 0; lane < s.lambda.count; ++lane) {
    if (!s.lambda.is_active(lane)) continue;
    const auto& [out, by_bin] = outgoing[static_cast<size_t>(lane)];
    const float nm = s.lambda.nm[static_cast<size_t>(lane)];
    const double p =
        claims.lossless ? equality_p(out, {.mean = 1}, kWeightRounding) : at_most_p(out, 1, kWeightRounding);
    findings.push_back(statistical(
        Law::energy, s, p, fmt::format("of 1 at {} nm, {:.6g} +- {:.2g} comes out", nm, out.mean, out.standard_error()),
        energy_measure(out, claims.lossless), energy_map(s, by_bin)));
    findings.back().wavelength_nm = static_cast<double>(nm);
  }
}

}  // namespace frond
