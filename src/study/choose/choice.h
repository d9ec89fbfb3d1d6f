#pragma once

#include <optional>

#include "core/log.h"
#include "study/choose/pilot.h"

namespace frond::choose {

/// That all bounds of a choice hold together.
inline constexpr double kConfidence = 0.95;

/// The RMS that an image's bias may have, by a pilot.
struct RmsBounds {
  double low = 0, high = 0;
};

/// What a pilot found of one answer to one open_choice, with the base answer to all others.
struct OptionResult {
  std::string name;
  double price = 1, noise = 1;  ///< as in Screening::Single
  double estimate = 0;          ///< RMS of its bias against the base
  RmsBounds bias;               ///< and where it may lie
  double cpu_us_per_path = 0;   ///< as it happened; nothing hangs on it
};

/// The answer to one open_choice, and why.
struct Answer {
  std::string open_choice;
  bool is_leaf = true;
  std::string chosen;
  double share = 0;  ///< of the pixels, that see this leaf first
  std::string base;
  std::vector<OptionResult> findings;  ///< from the cheapest to the base
  std::vector<Refusal> refused;
};

/// Answers that were measured against the reference, because they seemed to be the cheapest that would do.
struct Trial {
  std::vector<std::string> answers;  ///< in the order of the open_choices
  RmsBounds bias;
  uint64_t samples = 0;  ///< a pixel of the pilot, in each of two renders
};

/// What was chosen for a scene.
struct Choice {
  enum class Ground : uint8_t {
    met,           ///< shown to meet the request
    nothing_meets  ///< no cheaper model could be shown to: what counts as right is taken
  };
  Ground ground = Ground::met;
  double rms = 0;               ///< what was asked for
  RmsBounds bias;               ///< of what was chosen, against the reference; 0 for the reference itself
  double bias_estimate = 0;     ///< what was measured of it
  bool out_of_samples = false;  ///< the pilot's limit kept cheaper answers from being shown
  std::string reference;
  std::vector<Answer> answers;
  std::vector<Trial> trials;  ///< the last one is what was chosen, where that meets the request
  /// How noise falls; seconds are samples by price, in the base's.
  std::vector<ConvergencePoint> noise, reference_noise;
  uint64_t samples = 0;        ///< a pixel, that the render is to have
  uint64_t pilot_samples = 0;  ///< a pixel of the pilot, in each of two renders
  size_t comparisons = 0;      ///< bounds that hold together
  PilotCost pilot;

  /// Of one render with the scene's own number of samples.
  double noise_rms() const;
  /// A pixel, that bring the bias that was measured and noise at its upper bound down to what was asked for.
  double samples_needed() const;
  /// The same for the reference, which has noise alone.
  double reference_samples_needed() const;
  /// CPU time that the reference takes to that error, over that of what was chosen.
  double time_saved() const;

 private:
  Effort effort() const;
  Effort reference_effort() const;
};

/// What was chosen.
struct Chosen {
  Choice choice;
  std::shared_ptr<const Scene> scene;  ///< of the pilots; the render shares its geometry
};

/// Writes into the description the cheapest answers to what it leaves open that meet its leaves' "maxrms", the smallest
/// of them. Nothing where no leaf is open, or where wavelengths have no colours (with a warning). Throws InputError.
std::optional<Chosen> choose_models(const ChoiceTask& task, const Ladder& ladder, const Log& log);

/// The same by the standard ladder, for an image of so many samples a pixel (0: the scene's). Tells the session's log,
/// and writes into the request what the header is to say, and the colour space, which the choice of wavelengths shall
/// not change.
std::optional<Chosen> choose_for(Session& session, SceneDescription& description, uint64_t samples,
                                 ImageRequest& request);

}  // namespace frond::choose
