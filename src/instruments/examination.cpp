#include "instruments/examination.h"

#include <algorithm>

namespace frond {
namespace {

std::vector<Vec3> directions(std::span<const BsdfSample> samples) {
  std::vector<Vec3> result;
  for (const BsdfSample& s : samples)
    if (!any(s.flags & Lobes::specular)) result.push_back(s.wi);
  return result;
}

constexpr double kQuadratureOfPart = 1e-8;  // of a pdf, in each of some 1,000 parts of the sphere

}  // namespace

Series::Series(const Bsdf& asked, const SampledWavelengths& wavelengths, const Vec3& direction, const Effort& effort,
               const std::string& asked_where)
    : bsdf(asked),
      lambda(wavelengths),
      wo(direction),
      where(asked_where),
      drawn(effort.samples),
      pilot(draw(effort.samples / kPilotShare, hash_key(effort.seed, 0))),
      samples(draw(effort.samples, hash_key(effort.seed, 1))),
      exact(!any(bsdf.flags() & Lobes::stochastic) && std::ranges::none_of(samples, &BsdfSample::pdf_is_approximate)),
      bins(directions(pilot), effort.samples / (exact ? 256 : 512)) {
  probe(hash_key(effort.seed, 2));
  pdf_mass.reserve(bins.size());
  for (size_t b = 0; b < bins.size(); ++b)
    pdf_mass.push_back(bins.integral(
        b, [this](const Vec3& wi) { return bsdf.pdf(wo, wi); }, kQuadratureOfPart));
}

std::vector<BsdfSample> Series::draw(int64_t count, uint64_t seed) const {
  std::vector<BsdfSample> result;
  result.reserve(static_cast<size_t>(count));
  for (int64_t i = 0; i < count; ++i)
    if (const auto s = draw_once(bsdf, wo, hash_key(seed, i))) result.push_back(*s);
  return result;
}

void Series::probe(uint64_t seed) {
  // An exact f needs no mean: a few directions a bin are enough to look at it.
  const int64_t each = exact ? 4 : std::max<int64_t>(4, drawn / static_cast<int64_t>(bins.size()));
  probes.reserve(bins.size() * static_cast<size_t>(each));
  RandomStream numbers(seed);
  for (size_t bin = 0; bin < bins.size(); ++bin)
    for (int64_t i = 0; i < each; ++i) {
      const double u = numbers.uniform_open(), v = numbers.uniform_open();
      const Vec3 wi = bins.box(bin).at(u, v);
      probes.push_back({wi, f_once(bsdf, wo, wi, hash_key(seed, bin, i)), bsdf.pdf(wo, wi), bin});
    }
}

}  // namespace frond
