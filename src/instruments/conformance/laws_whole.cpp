#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "instruments/conformance/examination.h"

namespace frond {
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

// Directions where division by zero or cancellation is likely: poles, horizon, grazing.
std::vector<Vec3> edge_case_directions(uint64_t seed) {
  std::vector<Vec3> directions{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {-1, 0, -0.f}};
  for (const double z : {1e-30, 1e-7, 1e-4, 0.01, 1 - 1e-7})
    for (const double side : {-1.0, 1.0}) directions.push_back(sphere_direction(side * z, 0.7));
  for (const Vec3& w : random_directions(10, seed)) directions.push_back(w);
  return directions;
}

// Numbers at the ends of [0, 1), where inverse distributions may diverge.
void check_sample_values(const Bsdf& bsdf, const Vec3& wo, uint64_t seed, Verdict& verdict) {
  constexpr std::array<float, 4> kNumbers{0, 0x1p-24f, 0.5f, 1 - 0x1p-24f};
  for (const float uc : kNumbers)
    for (const float u : kNumbers)
      for (const float v : kNumbers) {
        RandomStream stream(hash_key(seed, uint64_t(uc * 0x1p24f), uint64_t(u * 0x1p24f), uint64_t(v * 0x1p24f)));
        verdict.begin_case();
        const auto s = bsdf.sample(wo, uc, {u, v}, stream);
        if (!s) continue;
        verdict.expect(is_valid_value(s->f), "wo {}, numbers {} {} {}: a sample's f is {}", wo, uc, u, v, s->f);
        verdict.expect(std::isfinite(s->pdf) && s->pdf > 0, "wo {}, numbers {} {} {}: a sample's pdf is {}", wo, uc, u,
                       v, s->pdf);
        verdict.expect(std::abs(length(s->wi) - 1) < 1e-5f, "wo {}, numbers {} {} {}: wi {} is not a unit vector", wo,
                       uc, u, v, s->wi);
        verdict.expect((wo.z != 0 && s->wi.z != 0) || s->f.is_black(), "wo {}, wi {}: scattered at cos theta = 0", wo,
                       s->wi);
      }
}

}  // namespace

void check_edge_cases(const Bsdf& bsdf, const std::string& where, uint64_t seed, Findings& findings) {
  Verdict verdict(Law::values, where);
  const auto directions = edge_case_directions(seed);
  for (const Vec3& wo : directions) {
    for (const Vec3& wi : directions) {
      verdict.begin_case();
      const SampledSpectrum f = f_once(bsdf, wo, wi, seed);
      const float pdf = bsdf.pdf(wo, wi);
      verdict.expect(is_valid_value(f), "wo {}, wi {}: f is {}", wo, wi, f);
      verdict.expect(is_valid_value(pdf), "wo {}, wi {}: pdf is {}", wo, wi, pdf);
      verdict.expect((wo.z != 0 && wi.z != 0) || f.is_black(), "wo {}, wi {}: scattered at cos theta = 0", wo, wi);
    }
    check_sample_values(bsdf, wo, seed, verdict);
  }
  findings.push_back(verdict.finding());
}

namespace {

/// The quantity that is equal if the directions are exchanged: n_i^2 f(wo, wi), over the square of the index on +z.
SampledSpectrum reciprocal_once(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, uint64_t key) {
  const SampledSpectrum f = f_once(bsdf, wo, wi, key);
  return wi.z < 0 && wo.z > 0 ? f * radiance_to_power(bsdf, wo, wi) : f;
}

/// f in both orders of directions between `a` and patches of the sphere.
std::shared_ptr<const SphereMap> reciprocity_map(const Bsdf& bsdf, const Vec3& a, uint64_t seed) {
  constexpr int kBands = 16, kSectors = 32;
  const auto mean_of = [](const SampledSpectrum& s) {
    return static_cast<double>(s[0]) + static_cast<double>(s[1]) + static_cast<double>(s[2]) +
           static_cast<double>(s[3]);
  };
  SphereMap map{a, "f(wo, wi)", "f(wi, wo)", {}};
  for (int band = 0; band < kBands; ++band)
    for (int sector = 0; sector < kSectors; ++sector) {
      const double z = 2. / kBands, phi = 2 * std::numbers::pi / kSectors;
      const SphereBox box{-1 + band * z, -1 + (band + 1) * z, sector * phi, (sector + 1) * phi};
      const Vec3 b = box.at(0.5, 0.5);
      map.patches.push_back(
          {box, mean_of(reciprocal_once(bsdf, a, b, seed)), mean_of(reciprocal_once(bsdf, b, a, seed))});
    }
  return std::make_shared<SphereMap>(std::move(map));
}

void check_exact_reciprocity(const Bsdf& bsdf, const std::string& where, const ExaminationEffort& effort,
                             Findings& findings) {
  Verdict verdict(Law::reciprocity, where);
  const auto directions = random_directions(20, effort.seed);
  std::optional<Vec3> broken_at;
  for (size_t i = 0; i < directions.size(); ++i) {
    const Vec3& a = directions[i];
    for (const Vec3& b : std::span(directions).subspan(i + 1)) {
      const SampledSpectrum there = reciprocal_once(bsdf, a, b, effort.seed),
                            back = reciprocal_once(bsdf, b, a, effort.seed);
      verdict.begin_case();
      verdict.expect(is_close(there, back), "f is {} from {} to {}, {} back", there, a, b, back);
    }
    if (verdict.failed() && !broken_at) broken_at = a;
  }
  Finding finding = verdict.finding();
  if (broken_at && effort.maps) finding.map = reciprocity_map(bsdf, *broken_at, effort.seed);
  findings.push_back(finding);
}

/// Compares means of f over streams in both orders, for a few pairs of directions.
void check_mean_reciprocity(const Bsdf& bsdf, const std::string& where, const ExaminationEffort& effort,
                            Findings& findings) {
  const auto directions = random_directions(16, effort.seed);
  for (size_t pair = 0; pair + 1 < directions.size(); pair += 2) {
    const Vec3 &a = directions[pair], &b = directions[pair + 1];
    std::array<Moments, kLanes> there, back;
    for (int64_t i = 0; i < effort.samples; ++i) {
      const SampledSpectrum f = reciprocal_once(bsdf, a, b, hash_key(effort.seed, pair, i, 0));
      const SampledSpectrum g = reciprocal_once(bsdf, b, a, hash_key(effort.seed, pair, i, 1));
      for (size_t lane = 0; lane < kLanes; ++lane) there[lane].add(f.v[lane]), back[lane].add(g.v[lane]);
    }
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const Estimate x = there[lane].estimate(), y = back[lane].estimate();
      if (std::max(there[lane].effective_count(), back[lane].effective_count()) < kEnoughForNormal) continue;
      const EqualityTest test(x, y);
      findings.push_back({.law = Law::reciprocity,
                          .where = where,
                          .message = fmt::format("mean f is {:.4g} +- {:.2g} from {} to {}, {:.4g} +- {:.2g} back",
                                                 x.mean, x.standard_error(), a, b, y.mean, y.standard_error()),
                          .p_value = test.p,
                          .statistical = true,
                          .measure = test.measure});
    }
  }
}

}  // namespace

void check_reciprocity(const Bsdf& bsdf, const std::string& where, const ExaminationEffort& effort,
                       Findings& findings) {
  if (any(bsdf.flags() & Lobes::stochastic))
    check_mean_reciprocity(bsdf, where, effort, findings);
  else
    check_exact_reciprocity(bsdf, where, effort, findings);
}

}  // namespace frond
