#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "instruments/examination.h"

namespace frond {
namespace {

bool near(float a, float b) {
  return std::abs(a - b) <= static_cast<float>(kRounding) * std::max(std::abs(a), std::abs(b));
}

bool near(const SampledSpectrum& a, const SampledSpectrum& b) {
  return std::ranges::equal(a.v, b.v, [](float x, float y) { return near(x, y); });
}

bool is_proper(float x) { return std::isfinite(x) && x >= 0; }
bool is_proper(const SampledSpectrum& s) {
  return std::ranges::all_of(s.v, [](float x) { return is_proper(x); });
}

bool idle_lanes_are_black(const SampledSpectrum& s, const SampledWavelengths& lambda) {
  for (int lane = 0; lane < kLanes; ++lane)
    if (!lambda.is_active(lane) && s[lane] != 0) return false;
  return true;
}

}  // namespace

void check_agreement(const Series& s, Findings& findings) {
  if (!s.exact) return;
  Verdict verdict(Law::agreement, s.where);
  for (const BsdfSample& sample : s.samples) {
    if (any(sample.flags & Lobes::specular)) continue;
    const float pdf = s.bsdf.pdf(s.wo, sample.wi);
    const SampledSpectrum f = f_once(s.bsdf, s.wo, sample.wi, 0);
    verdict.expect(near(sample.pdf, pdf), "wi {}: the sample's pdf is {}, pdf() {}", sample.wi, sample.pdf, pdf);
    verdict.expect(near(sample.f, f), "wi {}: the sample's f is {}, f() {}", sample.wi, sample.f, f);
    if (verdict.failed()) break;
  }
  findings.push_back(verdict.finding());
}

void check_flags(const Series& s, Findings& findings) {
  Verdict verdict(Law::flags, s.where);
  const Lobes all = s.bsdf.flags();
  for (const BsdfSample& sample : s.samples) {
    const bool back = any(sample.flags & Lobes::reflection), through = any(sample.flags & Lobes::transmission);
    verdict.expect((sample.flags & all) == sample.flags, "a sample has flags {:#x}, the BSDF {:#x}",
                   static_cast<int>(sample.flags), static_cast<int>(all));
    verdict.expect(back != through, "a sample is both or neither of reflected and transmitted");
    verdict.expect(sample.wi.z == 0 || back == same_side(s.wo, sample.wi), "wi {} is called {}", sample.wi,
                   back ? "reflected" : "transmitted");
    verdict.expect(any(sample.flags & (Lobes::diffuse | Lobes::glossy | Lobes::specular)),
                   "a sample is neither diffuse nor glossy nor specular");
  }
  for (const Series::Probe& probe : s.probes) {
    const Lobes side = same_side(s.wo, probe.wi()) ? Lobes::reflection : Lobes::transmission;
    verdict.expect(any(all & side) || probe.f.is_black(), "f is {} for wi {}, a side that the flags exclude", probe.f,
                   probe.wi());
  }
  findings.push_back(verdict.finding());
}

void check_lanes(const Series& s, Findings& findings) {
  Verdict verdict(Law::lanes, s.where);
  for (const BsdfSample& sample : s.samples)
    verdict.expect(idle_lanes_are_black(sample.f, s.lambda), "sample, wi {}: a lane that is not active is not 0",
                   sample.wi);
  for (const Series::Probe& probe : s.probes)
    verdict.expect(idle_lanes_are_black(probe.f, s.lambda), "f, wi {}: a lane that is not active is not 0", probe.wi());
  findings.push_back(verdict.finding());
}

void check_coverage(const Series& s, Findings& findings) {
  constexpr float kUnderflow = 1e-30f;  // where f has all but vanished, a density may have vanished
  Verdict verdict(Law::coverage, s.where);
  for (const Series::Probe& probe : s.probes)
    verdict.expect(probe.pdf > 0 || !(probe.f.max() > kUnderflow), "wi {}: f is {}, pdf {}", probe.wi(), probe.f,
                   probe.pdf);
  findings.push_back(verdict.finding());
}

void check_values(const Series& s, Findings& findings) {
  Verdict verdict(Law::values, s.where);
  for (const BsdfSample& sample : s.samples)
    verdict.expect(is_proper(sample.f) && std::isfinite(sample.pdf) && sample.pdf > 0, "sample, wi {}: f is {}, pdf {}",
                   sample.wi, sample.f, sample.pdf);
  for (const Series::Probe& probe : s.probes)
    verdict.expect(is_proper(probe.f) && is_proper(probe.pdf), "wi {}: f is {}, pdf {}", probe.wi(), probe.f,
                   probe.pdf);
  findings.push_back(verdict.finding());
}

namespace {

std::vector<Vec3> random_directions(int count, uint64_t seed) {
  RandomStream numbers(seed);
  std::vector<Vec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 2 * numbers.uniform_double() - 1, phi = 6.28 * numbers.uniform_double();
    directions.push_back(sphere_direction(z, phi));
  }
  return directions;
}

std::vector<Vec3> awkward_directions(uint64_t seed) {
  std::vector<Vec3> directions{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {-1, 0, -0.f}};
  for (const double z : {1e-30, 1e-7, 1e-4, 0.01, 1 - 1e-7})
    for (const double side : {-1.0, 1.0}) directions.push_back(sphere_direction(side * z, 0.7));
  for (const Vec3& w : random_directions(10, seed)) directions.push_back(w);
  return directions;
}

void check_sample_values(const Bsdf& bsdf, const Vec3& wo, uint64_t seed, Verdict& verdict) {
  constexpr std::array<float, 4> kNumbers{0, 0x1p-24f, 0.5f, 1 - 0x1p-24f};
  for (const float uc : kNumbers)
    for (const float u : kNumbers)
      for (const float v : kNumbers) {
        RandomStream stream(hash_key(seed, uint64_t(uc * 0x1p24f), uint64_t(u * 0x1p24f), uint64_t(v * 0x1p24f)));
        const auto s = bsdf.sample(wo, uc, {u, v}, stream);
        if (!s) continue;
        verdict.expect(is_proper(s->f), "wo {}, numbers {} {} {}: a sample's f is {}", wo, uc, u, v, s->f);
        verdict.expect(std::isfinite(s->pdf) && s->pdf > 0, "wo {}, numbers {} {} {}: a sample's pdf is {}", wo, uc, u,
                       v, s->pdf);
        verdict.expect(std::abs(length(s->wi) - 1) < 1e-5f, "wo {}, numbers {} {} {}: wi {} is not a unit vector", wo,
                       uc, u, v, s->wi);
        verdict.expect((wo.z != 0 && s->wi.z != 0) || s->f.is_black(), "wo {}, wi {}: scattered at cos theta = 0", wo,
                       s->wi);
      }
}

}  // namespace

void check_awkward_values(const Bsdf& bsdf, const std::string& where, uint64_t seed, Findings& findings) {
  Verdict verdict(Law::values, where);
  const auto directions = awkward_directions(seed);
  for (const Vec3& wo : directions) {
    for (const Vec3& wi : directions) {
      const SampledSpectrum f = f_once(bsdf, wo, wi, seed);
      const float pdf = bsdf.pdf(wo, wi);
      verdict.expect(is_proper(f), "wo {}, wi {}: f is {}", wo, wi, f);
      verdict.expect(is_proper(pdf), "wo {}, wi {}: pdf is {}", wo, wi, pdf);
      verdict.expect((wo.z != 0 && wi.z != 0) || f.is_black(), "wo {}, wi {}: scattered at cos theta = 0", wo, wi);
    }
    check_sample_values(bsdf, wo, seed, verdict);
  }
  findings.push_back(verdict.finding());
}

namespace {

void check_exact_reciprocity(const Bsdf& bsdf, const std::string& where, uint64_t seed, Findings& findings) {
  Verdict verdict(Law::reciprocity, where);
  const auto directions = random_directions(20, seed);
  for (const Vec3& a : directions)
    for (const Vec3& b : directions) {
      const SampledSpectrum there = f_once(bsdf, a, b, seed), back = f_once(bsdf, b, a, seed);
      verdict.expect(near(there, back), "f is {} from {} to {}, {} back", there, a, b, back);
    }
  findings.push_back(verdict.finding());
}

/// Means of f over the streams, both ways, for a few pairs of directions.
void check_mean_reciprocity(const Bsdf& bsdf, const std::string& where, const Effort& effort, Findings& findings) {
  const auto directions = random_directions(16, effort.seed);
  for (size_t pair = 0; pair + 1 < directions.size(); pair += 2) {
    const Vec3 &a = directions[pair], &b = directions[pair + 1];
    std::array<Moments, kLanes> there, back;
    for (int64_t i = 0; i < effort.samples; ++i) {
      const SampledSpectrum f = f_once(bsdf, a, b, hash_key(effort.seed, pair, i, 0));
      const SampledSpectrum g = f_once(bsdf, b, a, hash_key(effort.seed, pair, i, 1));
      for (size_t lane = 0; lane < kLanes; ++lane) there[lane].add(f.v[lane]), back[lane].add(g.v[lane]);
    }
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const Estimate x = there[lane].estimate(), y = back[lane].estimate();
      if (std::max(there[lane].effective_count(), back[lane].effective_count()) < kEnoughForNormal) continue;
      findings.push_back({.law = Law::reciprocity,
                          .where = where,
                          .message = fmt::format("mean f is {:.4g} +- {:.2g} from {} to {}, {:.4g} +- {:.2g} back",
                                                 x.mean, x.standard_error(), a, b, y.mean, y.standard_error()),
                          .p_value = equality_p(x, y, kRounding * std::max(x.mean, y.mean)),
                          .statistical = true});
    }
  }
}

}  // namespace

void check_reciprocity(const Bsdf& bsdf, const std::string& where, const Effort& effort, Findings& findings) {
  if (any(bsdf.flags() & Lobes::stochastic))
    check_mean_reciprocity(bsdf, where, effort, findings);
  else
    check_exact_reciprocity(bsdf, where, effort.seed, findings);
}

}  // namespace frond
