#include <cmath>
#include <numbers>
#include <vector>

#include "instruments/conformance/examination.h"

namespace frond {
namespace {

bool idle_lanes_are_black(const SampledSpectrum& s, const SampledWavelengths& lambda) {
  for (int lane = 0; lane < kLanes; ++lane)
    if (!lambda.is_active(lane) && s[lane] != 0) return false;
  return true;
}

}  // namespace

namespace {

double sum(const SampledSpectrum& s) {
  double result = 0;
  for (int i = 0; i < kLanes; ++i) result += static_cast<double>(s[i]);
  return result;
}

/// Sums over the samples in each bin: of their own f and pdf, and of the values of `f` and `pdf`.
class AgreementMap {
 public:
  explicit AgreementMap(const Examination& s) : s_(s), f_(s.bins.size(), 0), own_f_(f_), pdf_(f_), own_pdf_(f_) {}

  void add(const BsdfSample& sample, const SampledSpectrum& f, float pdf) {
    const size_t bin = s_.bins.find(sample.wi);
    own_f_[bin] += sum(sample.f), f_[bin] += sum(f);
    own_pdf_[bin] += static_cast<double>(sample.pdf), pdf_[bin] += static_cast<double>(pdf);
  }
  std::shared_ptr<const SphereMap> map(bool of_pdf) const {
    return of_pdf ? s_.map("pdf of samples", own_pdf_, "pdf()", pdf_) : s_.map("f of samples", own_f_, "f()", f_);
  }

 private:
  const Examination& s_;
  std::vector<double> f_, own_f_, pdf_, own_pdf_;
};

}  // namespace

void check_agreement(const Examination& s, Findings& findings) {
  if (!s.exact) return;
  Verdict verdict(Law::agreement, s.where);
  AgreementMap map(s);
  bool pdf_agrees = true;
  for (const BsdfSample& sample : s.samples) {
    if (any(sample.flags & Lobes::specular)) continue;
    verdict.begin_case();
    const float pdf = s.bsdf.pdf(s.wo, sample.wi);
    const SampledSpectrum f = f_once(s.bsdf, s.wo, sample.wi, 0);
    pdf_agrees = pdf_agrees && is_close(sample.pdf, pdf);
    verdict.expect(is_close(sample.pdf, pdf), "wi {}: the sample's pdf is {}, pdf() {}", sample.wi, sample.pdf, pdf);
    verdict.expect(is_close(sample.f, f), "wi {}: the sample's f is {}, f() {}", sample.wi, sample.f, f);
    if (s.maps) map.add(sample, f, pdf);
  }
  findings.push_back(verdict.finding());
  findings.back().map = map.map(!pdf_agrees);
}

void check_flags(const Examination& s, Findings& findings) {
  Verdict verdict(Law::flags, s);
  const Lobes all = s.bsdf.flags();
  for (const BsdfSample& sample : s.samples) {
    verdict.begin_case_at(sample.wi);
    const bool back = any(sample.flags & Lobes::reflection), through = any(sample.flags & Lobes::transmission);
    verdict.expect((sample.flags & all) == sample.flags, "a sample has flags {:#x}, the BSDF {:#x}",
                   static_cast<int>(sample.flags), static_cast<int>(all));
    verdict.expect(back != through, "a sample is both or neither of reflected and transmitted");
    verdict.expect(sample.wi.z == 0 || back == same_side(s.wo, sample.wi), "wi {} is called {}", sample.wi,
                   back ? "reflected" : "transmitted");
    verdict.expect(any(sample.flags & (Lobes::diffuse | Lobes::glossy | Lobes::specular)),
                   "a sample is neither diffuse nor glossy nor specular");
  }
  for (const Examination::Probe& probe : s.probes) {
    verdict.begin_case_at(probe.wi());
    const Lobes side = same_side(s.wo, probe.wi()) ? Lobes::reflection : Lobes::transmission;
    verdict.expect(any(all & side) || probe.f.is_black(), "f is {} for wi {}, a side that the flags exclude", probe.f,
                   probe.wi());
  }
  findings.push_back(verdict.finding());
}

void check_lanes(const Examination& s, Findings& findings) {
  Verdict verdict(Law::lanes, s);
  for (const BsdfSample& sample : s.samples) {
    verdict.begin_case_at(sample.wi);
    verdict.expect(idle_lanes_are_black(sample.f, s.lambda), "sample, wi {}: a lane that is not active is not 0",
                   sample.wi);
  }
  for (const Examination::Probe& probe : s.probes) {
    verdict.begin_case_at(probe.wi());
    verdict.expect(idle_lanes_are_black(probe.f, s.lambda), "f, wi {}: a lane that is not active is not 0", probe.wi());
  }
  findings.push_back(verdict.finding());
}

void check_retired_lanes(const Bsdf& bsdf, const SampledWavelengths& lambda, const std::string& where, uint64_t seed,
                         Findings& findings) {
  constexpr int kDirections = 100;
  Verdict verdict(Law::lanes, where);
  RandomStream numbers(seed);
  const auto direction = [&numbers] {
    const double z = 2 * numbers.uniform_double() - 1;
    return sphere_direction(z, 2 * std::numbers::pi * numbers.uniform_double());
  };
  for (int i = 0; i < kDirections; ++i) {
    verdict.begin_case();
    const Vec3 wo = direction(), wi = direction();
    const SampledSpectrum f = f_once(bsdf, wo, wi, hash_key(seed, i));
    verdict.expect(idle_lanes_are_black(f, lambda), "wo {}, wi {}: f of a retired lane is not 0: {}", wo, wi, f);
    if (const auto s = sample_once(bsdf, wo, hash_key(seed, i)))
      verdict.expect(idle_lanes_are_black(s->f, lambda), "wo {}: a sample's f of a retired lane is not 0: {}", wo,
                     s->f);
  }
  findings.push_back(verdict.finding());
}

void check_coverage(const Examination& s, Findings& findings) {
  constexpr float kUnderflow = 1e-30f;  // a density may underflow where f nearly does
  Verdict verdict(Law::coverage, s);
  for (const Examination::Probe& probe : s.probes) {
    verdict.begin_case_at(probe.wi());
    verdict.expect(probe.pdf > 0 || !(probe.f.max() > kUnderflow), "wi {}: f is {}, pdf {}", probe.wi(), probe.f,
                   probe.pdf);
  }
  findings.push_back(verdict.finding());
}

void check_values(const Examination& s, Findings& findings) {
  Verdict verdict(Law::values, s);
  for (const BsdfSample& sample : s.samples) {
    verdict.begin_case_at(sample.wi);
    verdict.expect(is_valid_value(sample.f) && std::isfinite(sample.pdf) && sample.pdf > 0,
                   "sample, wi {}: f is {}, pdf {}", sample.wi, sample.f, sample.pdf);
  }
  for (const Examination::Probe& probe : s.probes) {
    verdict.begin_case_at(probe.wi());
    verdict.expect(is_valid_value(probe.f) && is_valid_value(probe.pdf), "wi {}: f is {}, pdf {}", probe.wi(), probe.f,
                   probe.pdf);
  }
  findings.push_back(verdict.finding());
}

}  // namespace frond
