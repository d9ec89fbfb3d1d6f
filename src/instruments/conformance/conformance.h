#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/bsdf.h"
#include "instruments/sphere.h"

namespace frond {

/// What every BSDF and every material plugin must obey. An exact BSDF is one that is not stochastic and whose samples
/// say that their pdf is the density.
enum class Law : uint8_t {
  parameters,     ///< a plugin reads every parameter it declares and no other, and can be made from its defaults
  sampling,       ///< exact: directions of `sample` are distributed as `pdf` (chi-square over bins of the sphere)
  agreement,      ///< exact: f and pdf of a sample are those of `f` and `pdf` for its direction
  normalisation,  ///< exact: `pdf` integrates to the share of calls of `sample` that give a direction, delta lobes
                  ///< apart; not exact: to 1, or less if there are delta lobes
  energy,         ///< no more power comes out than went in, at each wavelength; just as much where nothing is said to
                  ///< absorb
  flags,          ///< what flags say of sides and lobes holds
  values,         ///< all finite and not negative, densities of samples positive; nothing scatters at cos theta = 0
  lanes,          ///< lanes that are not active hold 0
  reciprocity,    ///< f(a, b) = f(b, a), where claimed; with the squares of the indices of refraction (Bsdf)
  unbiasedness,   ///< not exact: in every bin and on each side, the mean weight of `sample` is the integral of f |cos
                  ///< theta|
  streams,        ///< not exact: the noise of f is drawn from its stream, not from its directions
  coverage,       ///< `pdf` is positive wherever f is
};

/// A law as a report has it.
struct LawInfo {
  Law law;
  std::string_view name, text;
};

/// In the order of the enumeration.
inline constexpr std::array<LawInfo, 12> kLaws{{
    {Law::parameters, "parameters", "every declared one is read and no other, and these values work"},
    {Law::sampling, "sampling", "exact BSDFs: sample's directions follow pdf"},
    {Law::agreement, "agreement", "exact BSDFs: a sample's f and pdf are those of f() and pdf()"},
    {Law::normalisation, "normalisation", "pdf integrates to how often sample gives a direction"},
    {Law::energy, "energy", "no more comes out than went in; as much, where lossless"},
    {Law::flags, "flags", "what flags say of sides and lobes is so"},
    {Law::values, "values", "all finite, none negative; nothing scatters at cos theta = 0"},
    {Law::lanes, "lanes", "wavelengths that are not active hold 0"},
    {Law::reciprocity, "reciprocity", "f(a, b) = f(b, a), where claimed"},
    {Law::unbiasedness, "unbiasedness", "other BSDFs: sample's mean weights are the integrals of f |cos theta|"},
    {Law::streams, "streams", "other BSDFs: the noise of f comes from its stream, not from directions"},
    {Law::coverage, "coverage", "pdf is positive wherever f is"},
}};
std::string_view law_name(Law law);

/// Where over the sphere of wi a law was looked at, for one wo: a number for each patch, and what it should be.
struct SphereMap {
  struct Patch {
    SphereBox box;
    double found = 0, expected = 0;
  };
  Vec3 wo;
  std::string found, expected;  ///< what the numbers are; no `expected`: there is nothing to compare with
  std::vector<Patch> patches;
};

/// The outcome of one test of one law.
struct Finding {
  Law law;
  std::string where;    ///< what was tested: plugin, parameters, wavelengths, direction
  std::string message;  ///< what was compared
  double p_value = 1;   ///< of a statistical test; 0 or 1 for any other
  bool statistical = false;
  bool passed = true;                              ///< set by `judge`
  std::shared_ptr<const SphereMap> map = nullptr;  ///< if ExaminationEffort asks for maps and the law has directions
};
using Findings = std::vector<Finding>;

/// What is known of a material beyond what all of them owe. Which way round f conserves energy, its flags say
/// (Lobes::from_light).
struct Claims {
  bool lossless = false;  ///< absorbs nothing: as much comes out as goes in
  bool reciprocal = false;
};

/// How much work goes into one BSDF. Directions `wo` lie at each of the angles on both sides.
struct ExaminationEffort {
  int samples = 20000;  ///< of `sample` for each direction
  std::vector<double> angles_deg = {0, 30, 60, 80, 89};
  uint64_t seed = 1;
  bool maps = false;  ///< keep a SphereMap with each finding
};

/// Runs all laws that a BSDF can be asked about. `where` begins the text of each finding. `judge` comes after.
Findings examine(const Bsdf& bsdf, const SampledWavelengths& lambda, const Claims& claims,
                 const ExaminationEffort& effort, const std::string& where);

/// Sets `passed`, and returns the p-value below which a finding fails. `false_alarm_rate` is that of all the findings
/// together: the chance that any law is said to be broken though all hold.
double judge(Findings& findings, double false_alarm_rate);

/// What all findings say of one law.
struct LawSummary {
  LawInfo law;
  int tests = 0, failures = 0;
  const Finding* worst = nullptr;  ///< that of the smallest p
};
/// One for each law, in the order of kLaws.
std::vector<LawSummary> summarise(std::span<const Finding> findings);

std::set<Law> broken_laws(std::span<const Finding> findings);
/// A line for each finding that did not pass, up to 20.
std::string failures_text(std::span<const Finding> findings);

}  // namespace frond
