#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "instruments/examination.h"

namespace frond {
namespace {

Finding statistical(Law law, const Series& s, double p_value, std::string message) {
  return {.law = law, .where = s.where, .message = std::move(message), .p_value = p_value, .statistical = true};
}

bool is_specular(const BsdfSample& sample) { return any(sample.flags & Lobes::specular); }

double weight(const BsdfSample& sample, int lane) {
  return static_cast<double>(sample.f[lane]) * std::abs(static_cast<double>(sample.wi.z)) /
         static_cast<double>(sample.pdf);
}

double total(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum;
}

}  // namespace

void check_sampling(const Series& s, Findings& findings) {
  if (!s.exact) return;
  std::vector<double> observed(s.bins.size(), 0), expected(s.bins.size(), 0);
  for (const BsdfSample& sample : s.samples)
    if (!is_specular(sample)) observed[s.bins.find(sample.wi)] += 1;
  const double count = total(observed), mass = total(s.pdf_mass);
  if (count < 50 || mass <= 0) return;  // a purely specular one; coverage and normalisation see what is wrong otherwise
  for (size_t b = 0; b < expected.size(); ++b) expected[b] = count * s.pdf_mass[b] / mass;
  findings.push_back(statistical(Law::sampling, s, chi_square_p(observed, expected),
                                 fmt::format("{} sampled directions in {} bins", count, s.bins.size())));
}

void check_normalisation(const Series& s, Findings& findings) {
  const double mass = total(s.pdf_mass);
  const auto deltas = std::ranges::count_if(s.samples, is_specular);
  if (!s.exact || !(mass <= 1 + kQuadrature)) {
    Verdict verdict(Law::normalisation, s.where);
    const double least = deltas > 0 ? 0 : 1 - kQuadrature;
    verdict.expect(mass >= least && mass <= 1 + kQuadrature, "pdf integrates to {:.6g}, not to 1", mass);
    findings.push_back(verdict.finding());
    return;
  }
  const int64_t directions = static_cast<int64_t>(s.samples.size()) - deltas;
  findings.push_back(
      statistical(Law::normalisation, s, binomial_p(directions, s.drawn, mass - kQuadrature, mass + kQuadrature),
                  fmt::format("pdf integrates to {:.6g}, sample gives a direction in {:.6g} of all calls", mass,
                              s.share(directions))));
}

namespace {

/// Rounding of a mean of weights in float.
constexpr double kWeightRounding = 1e-4;

/// Mean weight of `sample`, a call without a direction counting as 0.
Estimate mean_weight(const Series& s, int lane) {
  Moments moments;
  for (const BsdfSample& sample : s.samples) moments.add(weight(sample, lane));
  moments.add_zeros(s.drawn - moments.count());
  return moments.estimate();
}

/// Integral of f(w, s.wo) |cos theta| over w, lane by lane, for a BSDF that conserves the energy of light that arrives
/// along wi, summed over wo: a stratified mean over the bins.
std::array<Estimate, kLanes> albedo_from_light(const Series& s, uint64_t seed) {
  std::array<Estimate, kLanes> result{};
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
    for (size_t lane = 0; lane < kLanes; ++lane) result[lane] += moments[lane].estimate();
  }
  return result;
}

}  // namespace

void check_energy(const Series& s, const Claims& claims, uint64_t seed, Findings& findings) {
  const bool is_from_light = any(s.bsdf.flags() & Lobes::from_light);
  std::array<Estimate, kLanes> from_light{};
  if (is_from_light) from_light = albedo_from_light(s, seed);
  for (int lane = 0; lane < s.lambda.count; ++lane) {
    if (!s.lambda.is_active(lane)) continue;
    const Estimate out = is_from_light ? from_light[static_cast<size_t>(lane)] : mean_weight(s, lane);
    const double p =
        claims.lossless ? equality_p(out, {.mean = 1}, kWeightRounding) : at_most_p(out, 1, kWeightRounding);
    findings.push_back(
        statistical(Law::energy, s, p,
                    fmt::format("of 1 at {} nm, {:.6g} +- {:.2g} comes out", s.lambda.nm[static_cast<size_t>(lane)],
                                out.mean, out.standard_error())));
  }
}

namespace {

/// What `sample` and `f` say of one bin, or of several together.
struct BinComparison {
  Moments sampled;           // weights of samples in the bin; calls that went elsewhere are not counted yet
  double sampled_count = 0;  // effective count that the pilot promises
  Estimate integrated;       // of f |cos theta| over the bin
  double integrated_count = 0;

  void add(const BinComparison& other) {
    sampled.add(other.sampled);
    sampled_count += other.sampled_count;
    integrated += other.integrated;
    integrated_count += other.integrated_count;
  }
};

std::vector<BinComparison> compare_bins(const Series& s, int lane) {
  std::vector<BinComparison> bins(s.bins.size());
  std::vector<Moments> pilots(s.bins.size()), integrals(s.bins.size());
  for (const BsdfSample& sample : s.pilot)
    if (!is_specular(sample)) pilots[s.bins.find(sample.wi)].add(weight(sample, lane));
  for (const BsdfSample& sample : s.samples)
    if (!is_specular(sample)) bins[s.bins.find(sample.wi)].sampled.add(weight(sample, lane));
  for (const Series::Probe& probe : s.probes)
    integrals[probe.bin].add(static_cast<double>(probe.f[lane] * std::abs(probe.wi().z)) / probe.drawn.density);
  for (size_t b = 0; b < bins.size(); ++b) {
    bins[b].sampled_count = Series::kPilotShare * pilots[b].effective_count();
    bins[b].integrated = integrals[b].estimate();
    bins[b].integrated_count = integrals[b].effective_count();
  }
  return bins;
}

Finding compare(const Series& s, int lane, BinComparison bin, const std::string& name) {
  bin.sampled.add_zeros(s.drawn - bin.sampled.count());
  const Estimate sampled = bin.sampled.estimate();
  const double slack = kRounding * std::max(sampled.mean, bin.integrated.mean);
  return statistical(
      Law::unbiasedness, s, equality_p(sampled, bin.integrated, slack),
      fmt::format("lane {}, {}: sample carries {:.4g} +- {:.2g}, f {:.4g} +- {:.2g}", lane, name, sampled.mean,
                  sampled.standard_error(), bin.integrated.mean, bin.integrated.standard_error()));
}

std::string box_text(const SphereBox& box) {
  return fmt::format("cos theta {:.3f} to {:.3f}, phi {:.3f} to {:.3f}", box.z0, box.z1, box.phi0, box.phi1);
}

}  // namespace

void check_unbiasedness(const Series& s, Findings& findings) {
  if (s.exact) return;
  for (int lane = 0; lane < s.lambda.count; ++lane) {
    if (!s.lambda.is_active(lane)) continue;
    // Bins with too little in them to be compared alone; and each side as a whole, where little errors add up.
    BinComparison thin, front, back;
    const auto bins = compare_bins(s, lane);
    for (size_t b = 0; b < bins.size(); ++b) {
      const SphereBox& box = s.bins.box(b);
      (box.z0 >= 0 ? front : back).add(bins[b]);
      if (bins[b].sampled_count < kEnoughForNormal)
        thin.add(bins[b]);
      else
        findings.push_back(compare(s, lane, bins[b], box_text(box)));
    }
    const std::pair<const BinComparison&, const char*> sums[] = {
        {thin, "all thin bins"}, {front, "all of the front"}, {back, "all of the back"}};
    for (const auto& [bin, name] : sums)
      if (std::max(bin.sampled_count, bin.integrated_count) >= kEnoughForNormal)
        findings.push_back(compare(s, lane, bin, name));
  }
}

/// At a pair of directions f keeps its mean over the streams; a hair's breadth aside that mean is the same. Noise made
/// from directions is one number at the pair and another one beside it: it never averages out where directions repeat.
void check_streams(const Series& s, uint64_t seed, Findings& findings) {
  if (s.exact) return;
  constexpr int kPairs = 4;
  constexpr float kHair = 1e-5f;
  RandomStream numbers(hash_key(seed, 3));
  for (uint64_t pair = 0; pair < kPairs; ++pair) {
    const Vec3 wi = s.probes[numbers.bits() % s.probes.size()].wi();
    std::array<Moments, kLanes> here, beside;
    for (int64_t i = 0; i < s.drawn / 20; ++i) {
      const Vec3 aside{numbers.uniform() - 0.5f, numbers.uniform() - 0.5f, 0};
      const SampledSpectrum f = f_once(s.bsdf, s.wo, wi, hash_key(seed, pair, i, 0));
      const SampledSpectrum g = f_once(s.bsdf, s.wo, normalize(wi + aside * kHair), hash_key(seed, pair, i, 1));
      for (size_t lane = 0; lane < kLanes; ++lane) here[lane].add(f.v[lane]), beside[lane].add(g.v[lane]);
    }
    for (size_t lane = 0; lane < kLanes; ++lane) {
      if (beside[lane].effective_count() < kEnoughForNormal) continue;
      const Estimate a = here[lane].estimate(), b = beside[lane].estimate();
      findings.push_back(statistical(Law::streams, s, equality_p(a, b, kRounding * std::max(a.mean, b.mean)),
                                     fmt::format("wi {}: mean f is {:.4g} +- {:.2g}, beside it {:.4g} +- {:.2g}", wi,
                                                 a.mean, a.standard_error(), b.mean, b.standard_error())));
    }
  }
}

}  // namespace frond
