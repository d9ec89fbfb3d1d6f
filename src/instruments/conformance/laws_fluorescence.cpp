#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

#include "instruments/conformance/examination.h"

namespace frond {
namespace {

/// Excitation (nm) of a direction: one after the other.
constexpr std::array kExcitations{440.0, 550.0, 650.0, 680.0, 700.0};
constexpr std::array kEmissions{645.0, 685.0, 740.0, 800.0};

std::string compared(std::string_view what, const Estimate& a, const Estimate& b) {
  return fmt::format("{}: {:.4g} +- {:.2g}, expected {:.4g} +- {:.2g}", what, a.mean, a.standard_error(), b.mean,
                     b.standard_error());
}

Finding statistical_finding(const std::string& where, double p, std::string message) {
  return {.law = Law::fluorescence, .where = where, .message = std::move(message), .p_value = p, .statistical = true};
}

/// The integral of f over each side is the number of photons that leave it.
void check_sides(const Fluorescence& fluorescence, const Vec3& wi, double excitation_nm, double emission_nm,
                 const std::string& where, int64_t samples, RandomStream& rng, Findings& findings) {
  Moments lit, opposite;
  std::array<Moments, 2> by_direction;
  for (int64_t i = 0; i < samples; ++i) {
    check_stop();
    const FluorescencePhotons photons = fluorescence.photons(wi, emission_nm, excitation_nm, rng);
    lit.add(photons.lit_side), opposite.add(photons.opposite_side);
    for (const size_t side : {0, 1}) {
      const double z = std::sqrt(rng.uniform_double()), phi = 2 * std::numbers::pi * rng.uniform_double();
      const Vec3 wo = sphere_direction(std::copysign(z, side == 0 ? double(wi.z) : -double(wi.z)), phi);
      by_direction[side].add(std::numbers::pi * fluorescence.f(wo, wi, emission_nm, excitation_nm, rng));
    }
  }
  for (const auto& [name, counted, integral] : {std::tuple{"integral of f on the lit side", &lit, &by_direction[0]},
                                                {"on the other side", &opposite, &by_direction[1]}}) {
    const Estimate a = integral->estimate(), b = counted->estimate();
    if (integral->effective_count() < kEnoughForNormal && b.mean > 0)
      continue;  // too few walks leave at grazing angles
    findings.push_back(
        statistical_finding(where, equality_p(a, b, kRounding * std::max(a.mean, b.mean)), compared(name, a, b)));
  }
}

/// At most as many photons leave as are absorbed, and of those almost none at much shorter wavelengths than the
/// excitation: 1 % more than 60 nm shorter is four times what the Stokes gate of Fluspect permits.
void check_balance(const Fluorescence& fluorescence, const Vec3& wi, double excitation_nm, const std::string& where,
                   int64_t samples, RandomStream& rng, Findings& findings) {
  constexpr double kFar_nm = 60, kMostFar = 0.01;
  const auto count = static_cast<int64_t>(kEmission_nm.max - kEmission_nm.min) + 1;  // of whole nanometres
  Moments excess, far;
  for (int64_t i = 0; i < std::max<int64_t>(samples / count, fluorescence.is_noisy() ? 20 : 1); ++i) {
    double left = 0, left_far = 0, absorbed = 0;
    for (int64_t k = 0; k < count; ++k) {
      check_stop();
      const double nm = kEmission_nm.min + double(k);
      const FluorescencePhotons photons = fluorescence.photons(wi, nm, excitation_nm, rng);
      // Unknown where matrices of a file are all that is known.
      absorbed += (std::isnan(photons.absorbed) ? 1 : photons.absorbed) / double(count);
      left += photons.lit_side + photons.opposite_side;
      if (nm < excitation_nm - kFar_nm) left_far += photons.lit_side + photons.opposite_side;
    }
    excess.add(left - absorbed), far.add(left_far - kMostFar * left);
  }
  findings.push_back(statistical_finding(
      where, at_most_p(excess.estimate(), 0, kRounding),
      fmt::format("{:.4g} more photons leave than are absorbed, of 1 at {} nm", excess.mean(), excitation_nm)));
  findings.push_back(
      statistical_finding(where, at_most_p(far.estimate(), 0, kRounding * std::abs(far.mean())),
                          fmt::format("more than {} of the photons excited at {} nm are more than {} nm shorter",
                                      kMostFar, excitation_nm, kFar_nm)));
}

}  // namespace

void check_fluorescence(const Fluorescence& fluorescence, const std::string& where, const ExaminationEffort& effort,
                        Findings& findings) {
  RandomStream rng(hash_key(effort.seed, 7));
  const int64_t samples = fluorescence.is_black() ? 0 : effort.samples;
  Verdict verdict(Law::fluorescence, where);
  const auto first = static_cast<ptrdiff_t>(findings.size());
  size_t direction = 0;
  for (const double angle_deg : effort.angles_deg)
    for (const double side : {1.0, -1.0}) {
      const Vec3 wi = sphere_direction(side * std::cos(angle_deg * std::numbers::pi / 180), 0.4);
      const double excitation_nm = kExcitations[direction % kExcitations.size()],
                   emission_nm = kEmissions[direction % kEmissions.size()];
      ++direction;
      const std::string here = fmt::format("{}, wi at {} deg on the {}, {} to {} nm", where, angle_deg,
                                           side > 0 ? "front" : "back", excitation_nm, emission_nm);
      if (samples > 0) {
        check_sides(fluorescence, wi, excitation_nm, emission_nm, here, samples, rng, findings);
        check_balance(fluorescence, wi, direction == 1 ? kExcitation_nm.max : excitation_nm, here, samples, rng,
                      findings);
      }
      for (int i = 0; i < 200; ++i) {
        const double e = std::lerp(kExcitation_nm.min, kExcitation_nm.max, rng.uniform_double()),
                     f = std::lerp(kEmission_nm.min, kEmission_nm.max, rng.uniform_double());
        const Vec3 wo = sphere_direction(i == 0 ? 0 : 2 * rng.uniform_double() - 1, 6.28 * rng.uniform_double());
        const double value = fluorescence.f(wo, wi, f, e, rng);
        const FluorescencePhotons photons = fluorescence.photons(wi, f, e, rng);
        verdict.begin_case();
        verdict.expect(std::isfinite(value) && value >= 0 && (wo.z != 0 || value == 0),
                       "f is {} from {} to {}, {} to {} nm", value, wi, wo, e, f);
        verdict.expect(photons.lit_side >= 0 && photons.opposite_side >= 0 && !(photons.absorbed < 0) &&
                           !(photons.emitted < 0) && !(photons.reabsorbed < 0) &&
                           (fluorescence.is_noisy() || !(photons.absorbed > 1 + kRounding)),
                       "numbers of photons are negative or above 1, from {}, {} to {} nm", wi, e, f);
        verdict.expect(value == 0 || fluorescence.excitation(e) > 0, "f is {} where excitation is 0, {} to {} nm",
                       value, e, f);
        verdict.expect(!fluorescence.is_black() || value == 0, "a black fluorescence emits, {} to {} nm", e, f);
      }
    }
  findings.insert(findings.begin() + first, verdict.finding());
}

}  // namespace frond
