#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "instruments/conformance/examination.h"

namespace frond {
namespace {

double total(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum;
}

}  // namespace

namespace {

/// Number of samples in each bin, without delta lobes.
std::vector<double> counts(const Examination& s) {
  std::vector<double> result(s.bins.size(), 0);
  for (const BsdfSample& sample : s.samples)
    if (!is_specular(sample)) result[s.bins.find(sample.wi)] += 1;
  return result;
}

std::string box_text(const SphereBox& box) {
  return fmt::format("cos theta {:.3f} to {:.3f}, phi {:.3f} to {:.3f}", box.z0, box.z1, box.phi0, box.phi1);
}

/// Describes the bin with the largest deviation in standard errors.
std::string describe_largest_deviation(const Examination& s, const std::vector<double>& observed,
                                       const std::vector<double>& expected) {
  const auto off = [&](size_t b) { return std::abs(observed[b] - expected[b]) / std::sqrt(expected[b] + 1); };
  size_t worst = 0;
  for (size_t b = 1; b < s.bins.size(); ++b)
    if (off(b) > off(worst)) worst = b;
  return fmt::format("{}: {} for {:.1f} expected", box_text(s.bins.box(worst)), observed[worst], expected[worst]);
}

std::vector<double> scaled(std::vector<double> values, double scale) {
  for (double& v : values) v *= scale;
  return values;
}

}  // namespace

void check_sampling(const Examination& s, Findings& findings) {
  if (!s.exact) return;
  const std::vector<double> observed = counts(s);
  const double count = total(observed), mass = total(s.pdf_mass);
  if (count < 50 || mass <= 0) return;    // purely specular, or a fault that coverage and normalisation find
  if (s.pdf_error > kQuadrature) return;  // the number expected in each bin is not known well enough
  const std::vector<double> expected = scaled(s.pdf_mass, count / mass);
  const ChiSquare test = chi_square(observed, expected);
  Measure measure{.quantity = "RMS relative deviation of bins"};
  if (test.freedom > 0) {
    measure.value = std::sqrt(std::max(0.0, test.statistic - test.freedom) / count);
    measure.detectable_at = [freedom = test.freedom, count](double level) {
      return detectable_deviation(freedom, count, level, kPower);
    };
  }
  findings.push_back(statistical(Law::sampling, s, test.p,
                                 fmt::format("{} sampled directions in {} bins, largest deviation in {}", count,
                                             s.bins.size(), describe_largest_deviation(s, observed, expected)),
                                 measure,
                                 s.map("directions sampled", observed, "directions expected from pdf", expected)));
}

void check_normalisation(const Examination& s, Findings& findings) {
  const double mass = total(s.pdf_mass), error = kQuadrature + s.pdf_error;
  const auto deltas = std::ranges::count_if(s.samples, is_specular);
  Measure measure{.quantity = "difference of pdf's integral"};
  if (mass <= 0) measure.quantity = "";  // all lobes are delta lobes
  const auto map = s.exact ? s.map("directions sampled", counts(s), "directions expected from pdf",
                                   scaled(s.pdf_mass, static_cast<double>(s.drawn)))
                           : nullptr;
  if (!s.exact || !(mass <= 1 + error)) {
    Verdict verdict(Law::normalisation, s.where);
    const double least = deltas > 0 ? 0 : 1 - error - s.overlooked;
    verdict.expect(mass >= least && mass <= 1 + error, "pdf integrates to {:.6g}, not to 1", mass);
    findings.push_back(verdict.finding());
    findings.back().map = map;
    measure.value = std::abs(mass - 1);
    measure.detectable_at = [most = error + (deltas > 0 ? 0 : s.overlooked)](double) { return most; };
    findings.back().measure = measure;
    return;
  }
  const int64_t directions = static_cast<int64_t>(s.samples.size()) - deltas;
  const double share = s.share(directions);
  measure.value = std::abs(share - mass);
  // sample returns fewer directions than pdf says; or pdf is too small for the share of directions.
  measure.detectable_at = [n = s.drawn, low = mass - error, above = error + s.overlooked, error, share](double level) {
    return std::max(error + detectable_shortfall(n, low, level, kPower),
                    above + detectable_surplus(n, share, level, kPower));
  };
  findings.push_back(
      statistical(Law::normalisation, s, binomial_p(directions, s.drawn, mass - error, mass + error + s.overlooked),
                  fmt::format("pdf integrates to {:.6g}, sample gives a direction in {:.6g} of all calls", mass, share),
                  measure, map));
}

namespace {

/// Comparison of `sample` and `f` in one bin, or in several together.
struct BinComparison {
  Moments sampled;           // weights of samples in the bin; other calls are added as zeros later
  double sampled_count = 0;  // effective count expected from the pilot
  Estimate integrated;       // of f |cos theta| over the bin
  double integrated_count = 0;

  void add(const BinComparison& other) {
    sampled.add(other.sampled);
    sampled_count += other.sampled_count;
    integrated += other.integrated;
    integrated_count += other.integrated_count;
  }
};

std::vector<BinComparison> compare_bins(const Examination& s, int lane) {
  std::vector<BinComparison> bins(s.bins.size());
  std::vector<Moments> pilots(s.bins.size()), integrals(s.bins.size());
  for (const BsdfSample& sample : s.pilot)
    if (!is_specular(sample)) pilots[s.bins.find(sample.wi)].add(weight(sample, lane));
  for (const BsdfSample& sample : s.samples)
    if (!is_specular(sample)) bins[s.bins.find(sample.wi)].sampled.add(weight(sample, lane));
  for (const Examination::Probe& probe : s.probes)
    integrals[probe.bin].add(static_cast<double>(probe.f[lane] * std::abs(probe.wi().z)) / probe.drawn.density);
  for (size_t b = 0; b < bins.size(); ++b) {
    bins[b].sampled_count = Examination::kPilotShare * pilots[b].effective_count();
    bins[b].integrated = integrals[b].estimate();
    bins[b].integrated_count = integrals[b].effective_count();
  }
  return bins;
}

/// Map of one lane: the shares of light that `sample` and f send into each bin.
std::shared_ptr<const SphereMap> weight_map(const Examination& s, std::span<const BinComparison> bins) {
  std::vector<double> sampled, integrated;
  for (const BinComparison& bin : bins) {
    sampled.push_back(bin.sampled.mean() * s.share(bin.sampled.count()));
    integrated.push_back(bin.integrated.mean);
  }
  return s.map("light sampled", sampled, "light expected from f", integrated);
}

Finding compare(const Examination& s, int lane, BinComparison bin, const std::string& name,
                const std::shared_ptr<const SphereMap>& map) {
  bin.sampled.add_zeros(s.drawn - bin.sampled.count());
  const Estimate sampled = bin.sampled.estimate();
  const EqualityTest test(sampled, bin.integrated);
  const float nm = s.lambda.nm[static_cast<size_t>(lane)];
  Finding finding =
      statistical(Law::unbiasedness, s, test.p,
                  fmt::format("{} nm, {}: sample carries {:.4g} +- {:.2g}, f {:.4g} +- {:.2g}", nm, name, sampled.mean,
                              sampled.standard_error(), bin.integrated.mean, bin.integrated.standard_error()),
                  test.measure, map);
  finding.wavelength_nm = static_cast<double>(nm);
  return finding;
}

}  // namespace

void check_unbiasedness(const Examination& s, Findings& findings) {
  if (s.exact) return;
  for (int lane = 0; lane < s.lambda.count; ++lane) {
    if (!s.lambda.is_active(lane)) continue;
    // Bins with too few samples for a separate test are tested together; so is each side as a whole, where small errors
    // add up.
    BinComparison thin, front, back;
    const auto bins = compare_bins(s, lane);
    const auto map = weight_map(s, bins);
    for (size_t b = 0; b < bins.size(); ++b) {
      const SphereBox& box = s.bins.box(b);
      (box.z0 >= 0 ? front : back).add(bins[b]);
      if (bins[b].sampled_count < kEnoughForNormal)
        thin.add(bins[b]);
      else
        findings.push_back(compare(s, lane, bins[b], box_text(box), map));
    }
    const std::pair<const BinComparison&, const char*> sums[] = {
        {thin, "all thin bins"}, {front, "all of the front"}, {back, "all of the back"}};
    for (const auto& [bin, name] : sums)
      if (std::max(bin.sampled_count, bin.integrated_count) >= kEnoughForNormal)
        findings.push_back(compare(s, lane, bin, name, map));
  }
}

/// The mean of f over streams is the same at a pair of directions and at a distance of 1e-5 from it. Noise derived from
/// directions is one number at the pair and another one beside it: it would not average out where directions repeat.
void check_streams(const Examination& s, uint64_t seed, Findings& findings) {
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
      const EqualityTest test(a, b);
      findings.push_back(statistical(Law::streams, s, test.p,
                                     fmt::format("wi {}: mean f is {:.4g} +- {:.2g}, beside it {:.4g} +- {:.2g}", wi,
                                                 a.mean, a.standard_error(), b.mean, b.standard_error()),
                                     test.measure));
    }
  }
}

}  // namespace frond
