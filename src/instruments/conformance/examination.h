#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "core/error.h"
#include "core/fluorescence.h"
#include "core/parallel.h"
#include "instruments/conformance/conformance.h"
#include "instruments/cubature.h"
#include "instruments/errors/power.h"
#include "instruments/errors/statistics.h"

template <>
struct fmt::formatter<frond::Vec3> : fmt::formatter<float> {
  template <class Context>
  auto format(const frond::Vec3& v, Context& context) const {
    return fmt::format_to(context.out(), "({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
  }
};

template <>
struct fmt::formatter<frond::SampledSpectrum> : fmt::formatter<float> {
  template <class Context>
  auto format(const frond::SampledSpectrum& s, Context& context) const {
    return fmt::format_to(context.out(), "[{:.6g} {:.6g} {:.6g} {:.6g}]", s[0], s[1], s[2], s[3]);
  }
};

namespace frond {

/// Samples, values and densities of a BSDF for one direction wo, from which the laws are tested. Internal to the laws.
struct Examination {
  /// f for a direction drawn in one bin, with the densities of the draw and of the BSDF.
  struct Probe {
    PartSampler::Draw drawn;
    SampledSpectrum f;
    float pdf;
    size_t bin;
    const Vec3& wi() const { return drawn.w; }
  };

  static constexpr int kPilotShare = 4;

  Examination(const Bsdf& asked, const SampledWavelengths& wavelengths, const Vec3& direction,
              const ExaminationEffort& effort, const std::string& asked_where);

  /// Returns a map of a pair of numbers for each bin; nullptr unless maps are requested. Empty `expected`: nothing to
  /// compare with.
  std::shared_ptr<const SphereMap> map(std::string found_name, std::span<const double> found,
                                       std::string expected_name = {}, std::span<const double> expected = {}) const;
  /// `count` as a share of all calls of `sample`.
  double share(int64_t count) const { return static_cast<double>(count) / static_cast<double>(drawn); }

  const Bsdf& bsdf;
  const SampledWavelengths& lambda;
  Vec3 wo;
  std::string where;
  bool maps;
  double excess, false_alarm_rate;  ///< see ExaminationEffort
  int64_t drawn;                    ///< calls of `sample`
  /// A quarter as many independent samples, which determine the bins and the bins that can be tested: choosing tests by
  /// the tested samples would bias their p-values.
  std::vector<BsdfSample> pilot;
  std::vector<BsdfSample> samples;  ///< calls that returned a direction
  bool exact;                       ///< see Law
  SphereBins bins;
  std::vector<double> pdf_mass;     ///< integral of `pdf` over each bin
  double pdf_error = 0;             ///< bound of the error of their sum where division has not settled it
  double overlooked = 0;            ///< bound of what their sum lacks: lobes between nodes, without a pilot sample
  std::vector<PartSampler> in_bin;  ///< draw directions in each bin
  std::vector<Probe> probes;

 private:
  std::vector<BsdfSample> draw(int64_t count, uint64_t seed) const;
  void integrate_pdf();
  void bound_missed_lobes();
  void probe(uint64_t seed);
};

/// Largest relative difference that float rounding explains, for exponents up to 1000: 1000 times a few roundings.
inline constexpr double kRounding = 1e-3;

/// Relative error allowed to the quadrature of a pdf: float rounding of the pdf and the rule's own error.
inline constexpr double kQuadrature = 5e-4;

/// Comparison of two estimates by equality_p with a slack of kRounding.
struct EqualityTest {
  EqualityTest(const Estimate& a, const Estimate& b);
  double p;
  Measure measure;  ///< relative difference
};

/// Effective count below which a mean is far from normally distributed.
inline constexpr double kEnoughForNormal = 100;

/// One call of `sample` with numbers and a stream from `key`.
inline std::optional<BsdfSample> sample_once(const Bsdf& bsdf, const Vec3& wo, uint64_t key) {
  check_stop();
  RandomStream numbers(hash_key(key, 0)), stream(hash_key(key, 1));
  const float uc = numbers.uniform(), u = numbers.uniform(), v = numbers.uniform();
  return bsdf.sample(wo, uc, {u, v}, stream);
}

/// One call of `f` with a stream from `key`.
inline SampledSpectrum f_once(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, uint64_t key) {
  check_stop();
  RandomStream stream(key);
  return bsdf.f(wo, wi, stream);
}

/// Whether two values are equal apart from rounding.
inline bool is_close(float a, float b) {
  return std::abs(a - b) <= static_cast<float>(kRounding) * std::max(std::abs(a), std::abs(b));
}

inline bool is_close(const SampledSpectrum& a, const SampledSpectrum& b) {
  for (int i = 0; i < kLanes; ++i)
    if (!is_close(a[i], b[i])) return false;
  return true;
}

/// Finite and not negative.
inline bool is_valid_value(float x) { return std::isfinite(x) && x >= 0; }
inline bool is_valid_value(const SampledSpectrum& s) {
  for (int i = 0; i < kLanes; ++i)
    if (!is_valid_value(s[i])) return false;
  return true;
}

/// A finding of a statistical test.
inline Finding statistical(Law law, const Examination& s, double p_value, std::string message, Measure measure,
                           std::shared_ptr<const SphereMap> map = nullptr) {
  Finding finding{.law = law, .where = s.where, .message = std::move(message), .p_value = p_value, .statistical = true};
  finding.measure = std::move(measure);
  finding.map = std::move(map);
  return finding;
}

inline bool is_specular(const BsdfSample& sample) { return any(sample.flags & Lobes::specular); }

/// f |cos theta| / pdf in one lane.
inline double weight(const BsdfSample& sample, int lane) {
  return static_cast<double>(sample.f[lane]) * std::abs(static_cast<double>(sample.wi.z)) /
         static_cast<double>(sample.pdf);
}

// Laws for one direction wo.
void check_sampling(const Examination& s, Findings& findings);
void check_normalisation(const Examination& s, Findings& findings);
void check_energy(const Examination& s, const Claims& claims, uint64_t seed, Findings& findings);
void check_unbiasedness(const Examination& s, Findings& findings);
void check_streams(const Examination& s, uint64_t seed, Findings& findings);
void check_agreement(const Examination& s, Findings& findings);
void check_flags(const Examination& s, Findings& findings);
void check_lanes(const Examination& s, Findings& findings);
void check_coverage(const Examination& s, Findings& findings);
void check_values(const Examination& s, Findings& findings);

// Laws of a BSDF as a whole.
/// `lambda`: the wavelengths of the BSDF, of which a lane in use is retired.
void check_retired_lanes(const Bsdf& bsdf, const SampledWavelengths& lambda, const std::string& where, uint64_t seed,
                         Findings& findings);
void check_edge_cases(const Bsdf& bsdf, const std::string& where, uint64_t seed, Findings& findings);
void check_reciprocity(const Bsdf& bsdf, const std::string& where, const ExaminationEffort& effort, Findings& findings);

/// Laws of the fluorescence of a material.
void check_fluorescence(const Fluorescence& fluorescence, const std::string& where, const ExaminationEffort& effort,
                        Findings& findings);

/// Runs `test`. A logic error, a runtime error or an object that a BSDF or a material throws becomes a finding of
/// Law::values. InputError, Stopped and other exceptions, such as those of a caller's Python code, pass through.
template <class Test>
void run_guarded(const std::string& where, Findings& findings, const Test& test) {
  const auto report = [&](const std::string& message) {
    findings.push_back({.law = Law::values, .where = where, .message = message, .p_value = 0});
  };
  try {
    test();
  } catch (const Stopped&) {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    report(fmt::format("an exception is thrown: {}", error.what()));
  } catch (const std::logic_error& error) {
    report(fmt::format("an exception is thrown: {}", error.what()));
  } catch (const std::exception&) {
    throw;
  } catch (...) {
    report("an object that is no std::exception is thrown");
  }
}

/// Verdict on a law that permits no exception: passes until the first violation, whose text it stores.
class Verdict {
 public:
  Verdict(Law law, const std::string& where) : finding_{.law = law, .where = where, .message = {}} {}
  /// For the directions of an examination: counts violations in each bin for a map.
  Verdict(Law law, const Examination& s) : Verdict(law, s.where) {
    if (!s.maps) return;
    series_ = &s;
    asked_.assign(s.bins.size(), 0);
    faults_.assign(s.bins.size(), 0);
  }

  bool failed() const { return finding_.p_value == 0; }
  /// Begins a case: a direction or a pair of them.
  void begin_case() { ++cases_, case_failed_ = false; }
  /// Begins a case and sets the direction that the following expectations refer to.
  void begin_case_at(const Vec3& wi) {
    begin_case();
    if (!series_) return;
    bin_ = series_->bins.find(wi);
    asked_[bin_] += 1;
  }
  /// Records a violation unless `holds`.
  template <class... Args>
  void expect(bool holds, fmt::format_string<Args...> format, const Args&... args) {
    if (holds) return;
    if (series_) faults_[bin_] += 1;
    if (!case_failed_) ++failures_, case_failed_ = true;
    if (failed()) return;
    finding_.p_value = 0;
    finding_.message = fmt::vformat(format, fmt::make_format_args(args...));
  }
  /// The verdict as a finding: p = 1 or 0.
  Finding finding() const {
    Finding result = finding_;
    if (cases_ > 0)
      result.measure = {.quantity = "share of directions that break it",
                        .value = failures_ / cases_,
                        .detectable_at = [n = cases_](double) { return detectable_share(n, kPower); }};
    if (series_ && failed()) result.map = map_of_faults();
    return result;
  }

 private:
  std::shared_ptr<const SphereMap> map_of_faults() const;

  Finding finding_;
  const Examination* series_ = nullptr;
  size_t bin_ = 0;
  double cases_ = 0, failures_ = 0;
  bool case_failed_ = false;
  std::vector<double> asked_, faults_;
};

}  // namespace frond
