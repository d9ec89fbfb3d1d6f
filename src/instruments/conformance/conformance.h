#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/bsdf.h"
#include "instruments/sphere.h"

namespace frond {

/// Laws that every BSDF and every material plug-in must obey. A BSDF is exact if it is not stochastic and its samples
/// report an exact pdf.
enum class Law : uint8_t {
  parameters,     ///< a plugin reads every parameter it declares and no other, and can be made from its defaults
  sampling,       ///< exact: directions of `sample` are distributed as `pdf` (chi-square over bins of the sphere)
  agreement,      ///< exact: f and pdf of a sample equal `f` and `pdf` for its direction
  normalisation,  ///< exact: `pdf` integrates to the share of calls of `sample` that give a direction, delta lobes
                  ///< apart; not exact: to 1, or less if there are delta lobes
  energy,         ///< exitant power is at most the incident power at each wavelength; equal for materials claimed to
                  ///< be lossless
  flags,          ///< sides and lobes are as the flags state
  values,         ///< all finite and not negative, densities of samples positive; nothing scatters at cos theta = 0;
                  ///< nothing is thrown
  lanes,          ///< lanes that are not active hold 0, also those that were retired on the path
  reciprocity,    ///< f(a, b) = f(b, a), where claimed; with the squares of the indices of refraction (Bsdf)
  unbiasedness,   ///< not exact: in every bin and on each side, the mean weight of `sample` is the integral of f |cos
                  ///< theta|
  streams,        ///< not exact: the noise of f is drawn from its stream, not from its directions
  coverage,       ///< `pdf` is positive wherever f is
  fluorescence,   ///< no more photons leave than are absorbed, none of much more energy; f integrates to their number
};

/// Name and text of a law in reports.
struct LawInfo {
  Law law;
  std::string_view name, text;
};

/// In the order of the enumeration.
inline constexpr std::array<LawInfo, 13> kLaws{{
    {Law::parameters, "parameters", "every declared parameter is read and no other; the values are accepted"},
    {Law::sampling, "sampling", "exact BSDFs: sample's directions follow pdf"},
    {Law::agreement, "agreement", "exact BSDFs: a sample's f and pdf are those of f() and pdf()"},
    {Law::normalisation, "normalisation", "pdf integrates to the share of samples that have a direction"},
    {Law::energy, "energy", "exitant power is at most the incident power; equal if lossless"},
    {Law::flags, "flags", "sides and lobes agree with the flags"},
    {Law::values, "values", "all finite, none negative; nothing scatters at cos theta = 0 or throws"},
    {Law::lanes, "lanes", "wavelengths that are not active hold 0"},
    {Law::reciprocity, "reciprocity", "f(a, b) = f(b, a), where claimed"},
    {Law::unbiasedness, "unbiasedness", "other BSDFs: sample's mean weights are the integrals of f |cos theta|"},
    {Law::streams, "streams", "other BSDFs: the noise of f comes from its stream, not from directions"},
    {Law::coverage, "coverage", "pdf is positive wherever f is"},
    {Law::fluorescence, "fluorescence", "no more photons leave than are absorbed, none of much more energy"},
}};
/// Name of a law, as in kLaws.
std::string_view law_name(Law law);

/// Results of a law over the sphere of wi for one wo: for each patch the number found and the number expected.
struct SphereMap {
  /// A patch and its two numbers.
  struct Patch {
    SphereBox box;
    double found = 0, expected = 0;
  };
  Vec3 wo;
  std::string found, expected;  ///< names of the numbers; empty `expected`: nothing to compare with
  std::vector<Patch> patches;
};

/// Probability with which an error of the size that is called detectable would have been found.
inline constexpr double kPower = 0.95;

/// Measured value of a test, and the smallest error that it would have found.
struct Measure {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::string_view quantity;  ///< name of `value`, such as "directional albedo"; empty: nothing is measured
  double value = kNone, standard_error = kNone;
  /// The smallest error found with the probability kPower by a test at this level; may be empty.
  std::function<double(double level)> detectable_at = {};
  double detectable = kNone;  ///< set by `apply_false_alarm_rate`
};

/// The outcome of one test of one law.
struct Finding {
  Law law;
  std::string where;    ///< the object tested: plug-in, parameters, wavelengths, direction
  std::string message;  ///< the comparison, with its numbers
  double p_value = 1;   ///< of a statistical test; 0 or 1 for any other
  bool statistical = false;
  bool passed = true;                              ///< set by `apply_false_alarm_rate`
  std::shared_ptr<const SphereMap> map = nullptr;  ///< if ExaminationEffort requests maps and the law has directions
  Measure measure = {};
  std::string parameters = {};            ///< label of the set of parameters
  double wavelength_nm = Measure::kNone;  ///< of a test of one wavelength
  double theta_deg = Measure::kNone;      ///< of wo from the normal, above 90 on the back; NaN: several directions
};
using Findings = std::vector<Finding>;

/// Claims about a material beyond the laws of all materials. The direction in which f conserves energy is a flag
/// (Lobes::from_light).
struct Claims {
  bool lossless = false;  ///< absorbs nothing: exitant power equals incident power
  bool reciprocal = false;
};

/// Effort for one BSDF. Directions `wo` lie at each of the angles on both sides.
struct ExaminationEffort {
  int samples = 20000;  ///< calls of `sample` for each direction
  std::vector<double> angles_deg = {0, 30, 60, 80, 89};
  uint64_t seed = 1;
  bool maps = false;  ///< keep a SphereMap with each finding
  /// The law of energy draws further samples, up to kMostRounds times `samples`, until it would find this excess over 1
  /// with the probability kPower. 0: no further samples.
  double excess = 0.05;
  double false_alarm_rate = 1e-6;  ///< of a report, as `apply_false_alarm_rate` takes it
};
inline constexpr int kMostRounds = 50;

/// Tests all laws of a BSDF. `where` is the start of each finding's text. Call `apply_false_alarm_rate` afterwards.
Findings examine(const Bsdf& bsdf, const SampledWavelengths& lambda, const Claims& claims,
                 const ExaminationEffort& effort, const std::string& where);

/// Sets `passed` of all findings; returns the p-value below which a finding fails. `false_alarm_rate`: probability that
/// any law is reported broken although all hold, over all findings together.
double apply_false_alarm_rate(Findings& findings, double false_alarm_rate);

/// Summary of all findings on one law.
struct LawSummary {
  LawInfo law;
  int tests = 0, failures = 0;
  const Finding* worst = nullptr;    ///< the finding with the smallest p
  const Finding* largest = nullptr;  ///< the finding with the largest measured value; nullptr: nothing was measured
  double least_detectable = Measure::kNone;  ///< smallest error that one of the tests would have found
};
/// Returns a summary for each law, in the order of kLaws.
std::vector<LawSummary> summarise(std::span<const Finding> findings);

/// Smallest factor on f, the same in all tests, that the law of energy would have found with the probability kPower;
/// not finite if it was not tested or nothing scatters.
double detectable_factor(std::span<const Finding> findings);

/// Laws with at least one finding that did not pass.
std::set<Law> broken_laws(std::span<const Finding> findings);
/// Returns a line for each finding that did not pass, up to 20.
std::string failures_text(std::span<const Finding> findings);

}  // namespace frond
