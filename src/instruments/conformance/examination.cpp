#include "instruments/conformance/examination.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>

namespace frond {
namespace {

std::vector<Vec3> directions(std::span<const BsdfSample> samples) {
  std::vector<Vec3> result;
  for (const BsdfSample& s : samples)
    if (!any(s.flags & Lobes::specular)) result.push_back(s.wi);
  return result;
}

}  // namespace

EqualityTest::EqualityTest(const Estimate& a, const Estimate& b) {
  const double larger = std::max(a.mean, b.mean);
  p = equality_p(a, b, kRounding * larger);
  const Estimate difference{a.mean - b.mean, a.variance + b.variance, a.third_cumulant - b.third_cumulant};
  measure = {.quantity = "relative difference",
             .value = larger == 0 ? 0 : std::abs(difference.mean) / larger,
             .standard_error = difference.standard_error() / larger};
  if (larger > 0)
    measure.detectable_at = [difference, larger](double level) {
      const Estimate opposite{-difference.mean, difference.variance, -difference.third_cumulant};
      return kRounding + std::max(detectable_difference(difference, level / 2, kPower),
                                  detectable_difference(opposite, level / 2, kPower)) /
                             larger;
    };
}

Examination::Examination(const Bsdf& asked, const SampledWavelengths& wavelengths, const Vec3& direction,
                         const ExaminationEffort& effort, const std::string& asked_where)
    : bsdf(asked),
      lambda(wavelengths),
      wo(direction),
      where(asked_where),
      maps(effort.maps),
      excess(effort.excess),
      false_alarm_rate(effort.false_alarm_rate),
      drawn(effort.samples),
      pilot(draw(effort.samples / kPilotShare, hash_key(effort.seed, 0))),
      samples(draw(effort.samples, hash_key(effort.seed, 1))),
      exact(!any(bsdf.flags() & Lobes::stochastic) && std::ranges::none_of(samples, &BsdfSample::pdf_is_approximate)),
      bins(directions(pilot), std::min(effort.samples / (exact ? 256 : 512), exact ? 128 : 64)) {
  integrate_pdf();
  probe(hash_key(effort.seed, 2));
}

std::shared_ptr<const SphereMap> Examination::map(std::string found_name, std::span<const double> found,
                                                  std::string expected_name, std::span<const double> expected) const {
  if (!maps) return nullptr;
  SphereMap result{wo, std::move(found_name), std::move(expected_name), {}};
  for (size_t b = 0; b < bins.size(); ++b)
    result.patches.push_back({bins.box(b), found[b], expected.empty() ? 0 : expected[b]});
  return std::make_shared<SphereMap>(std::move(result));
}

std::shared_ptr<const SphereMap> Verdict::map_of_faults() const {
  std::vector<double> share(asked_.size(), 0);
  for (size_t b = 0; b < share.size(); ++b)
    if (asked_[b] > 0) share[b] = std::min(1.0, faults_[b] / asked_[b]);
  return series_->map("share of directions that break the law", share);
}

void Examination::integrate_pdf() {
  constexpr double kTolerance = 1e-8;  // for each of up to about 1,000 parts of the sphere
  // Where a pdf is negative or not a number, which another law reports, no quadrature would settle.
  const auto density = [this](const Vec3& wi) {
    const double pdf = bsdf.pdf(wo, wi);
    return pdf > 0 && std::isfinite(pdf) ? pdf : 0;
  };
  for (size_t b = 0; b < bins.size(); ++b) {
    auto parts = integrate(bins.box(b), density, kTolerance, bins.points(b));
    pdf_mass.push_back(total(parts));
    pdf_error += total_error(parts);
    in_bin.emplace_back(std::move(parts));
  }
  bound_missed_lobes();
}

/// The quadrature is based on the pilot alone, so the share of the other samples in lobes that it has missed is the
/// mass of those lobes.
void Examination::bound_missed_lobes() {
  constexpr double kAlarm = 1e-6;  // probability that the true mass is larger
  const auto part_of = [this](const BsdfSample& sample) -> const SpherePart* {
    const SpherePoint point(sample.wi);
    const auto parts = in_bin[bins.find(sample.wi)].parts();
    const auto found = std::ranges::find_if(
        parts, [&point](const SpherePart& part) { return part.box.contains(point.cos_theta, point.phi); });
    return found == parts.end() ? nullptr : &*found;
  };
  int64_t count = 0;
  for (const BsdfSample& sample : samples) {
    if (is_specular(sample)) continue;
    const SpherePart* part = part_of(sample);
    if (part && part->misses_lobe(bsdf.pdf(wo, sample.wi))) ++count;
  }
  overlooked = boost::math::gamma_q_inv(static_cast<double>(count + 1), kAlarm) / static_cast<double>(drawn);
}

std::vector<BsdfSample> Examination::draw(int64_t count, uint64_t seed) const {
  std::vector<BsdfSample> result;
  result.reserve(static_cast<size_t>(count));
  for (int64_t i = 0; i < count; ++i)
    if (const auto s = sample_once(bsdf, wo, hash_key(seed, i))) result.push_back(*s);
  return result;
}

void Examination::probe(uint64_t seed) {
  // An exact f has no noise to average: a few directions per bin suffice.
  const int64_t each = exact ? 4 : std::max<int64_t>(4, drawn / static_cast<int64_t>(bins.size()));
  probes.reserve(bins.size() * static_cast<size_t>(each));
  RandomStream numbers(seed);
  for (size_t bin = 0; bin < bins.size(); ++bin)
    for (int64_t i = 0; i < each; ++i) {
      const auto drawn_wi = in_bin[bin].draw(numbers);
      probes.push_back({drawn_wi, f_once(bsdf, wo, drawn_wi.w, hash_key(seed, bin, i)), bsdf.pdf(wo, drawn_wi.w), bin});
    }
}

}  // namespace frond
