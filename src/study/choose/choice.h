#pragma once

#include <array>
#include <optional>

#include "core/log.h"
#include "study/choose/pilot.h"

namespace frond::choose {

/// Joint confidence of all bounds of a selection.
inline constexpr double kConfidence = 0.95;

/// Bounds of the RMS of an image's bias, estimated by a pilot.
struct RmsBounds {
  double low = 0, high = 0;
};

/// Result of a pilot for one option of an open choice, with the reference option for all other choices.
struct OptionResult {
  std::string name;
  double price = 1, noise = 1;  ///< as in Screening::Single
  double estimate = 0;          ///< estimated RMS bias
  RmsBounds bias;               ///< bounds of the RMS bias
  double cpu_us_per_path = 0;   ///< as measured; does not influence the selection
};

/// The selected option of one open choice, and the results behind it.
struct Answer {
  std::string open_choice;
  bool is_leaf = true;
  std::string chosen;
  double share = 0;  ///< share of the pixels whose first hit is this leaf
  std::string reference;
  std::vector<OptionResult> findings;  ///< sorted from the cheapest to the reference; empty without a pilot
  std::vector<Refusal> refused;
};

/// A combination of options that was measured against the reference, because screening predicted it to be the cheapest
/// that meets the request.
struct Trial {
  std::vector<std::string> answers;  ///< in the order of the open choices
  RmsBounds bias;
  uint64_t samples = 0;  ///< per pixel of the pilot, in each of two renders
};

/// Error of the selected options by cause, estimated from each alone.
struct Causes {
  double wavelengths = 0, leaves = 0;     ///< RMS
  std::array<double, 3> mean_shift = {};  ///< mean change of each channel by the wavelengths alone
};

/// The models selected for a scene, and the measurements behind the selection. Errors are in linear SMPTE-C (white: 1)
/// or, if `is_relative`, in units of each channel's mean over the image.
struct Choice {
  enum class Ground : uint8_t {
    met,        ///< cheaper options were shown to meet the request
    reference,  ///< none was: the reference options are used
    no_gain,    ///< a pilot could cost as much as it could save: likewise
    no_time     ///< the time limit ended the pilot: likewise
  };
  Ground ground = Ground::met;
  double rms = 0;  ///< requested RMS error
  bool is_relative = false;
  RmsBounds bias;            ///< of the selected options against the reference; 0 for the reference itself
  double bias_estimate = 0;  ///< measured RMS bias
  Causes causes;
  bool out_of_samples = false;  ///< the pilot's sample limit prevented cheaper options from being shown
  std::vector<Answer> answers;
  std::vector<Trial> trials;  ///< the last one is the selection, if it meets the request
  /// Convergence of the noise. Seconds are samples times price, in units of the reference.
  std::vector<ConvergencePoint> noise, reference_noise;
  uint64_t samples = 0;        ///< per pixel, in the final render
  uint64_t pilot_samples = 0;  ///< per pixel of the pilot, in each of two renders
  size_t comparisons = 0;      ///< number of bounds that hold jointly
  PilotCost pilot;
  double price = 1;              ///< of a sample of the selected options, relative to the reference
  double reference_seconds = 0;  ///< CPU time of the final render with the reference, by the pilot's measurement

  /// Whether the pilot has measured noise.
  bool has_noise() const { return !noise.empty() && !reference_noise.empty(); }
  /// Returns the RMS noise of one render with the scene's number of samples.
  double noise_rms() const;
  /// Returns the samples per pixel at which measured bias and the upper bound of the noise together meet the request.
  double samples_needed() const;
  /// Returns the same for the reference, which has noise only.
  double reference_samples_needed() const;
  /// CPU seconds of the final render with the selected options, the pilot included, by the pilot's measurement.
  double net_seconds() const { return price * reference_seconds + pilot.cpu_seconds; }

 private:
  Effort effort() const;
  Effort reference_effort() const;
};

/// The result of choose_models.
struct Chosen {
  Choice choice;
  std::shared_ptr<const Scene> scene;  ///< the pilot's scene, whose geometry the render shares
};

/// Selects the cheapest options of all open choices that meet the smallest error that a leaf of the scene states, and
/// writes them into the description. Returns nullopt if no leaf is open, or, with a warning, if the wavelengths have no
/// colours. Throws InputError.
std::optional<Chosen> choose_models(const ChoiceTask& task, const Ladder& ladder, const Log& log);

/// Selects from the standard ladder. Logs the selection to the session's log. Writes the image's header attributes into
/// the request, and the colour space, which must not depend on the selected wavelengths.
std::optional<Chosen> choose_for(const ChoiceTask& task, ImageRequest& request);

}  // namespace frond::choose
