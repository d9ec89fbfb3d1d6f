#pragma once

#include <map>
#include <memory>
#include <string>

#include "core/log.h"
#include "instruments/errors/render_error.h"
#include "instruments/errors/statistics.h"
#include "study/compare/film_images.h"
#include "study/compare/study.h"

namespace frond {

/// Error of one render relative to the expectation of the reference, in one channel.
struct ChannelAccuracy {
  RenderError error;
  Estimate
      offset;  ///< mean over the pixels of render minus reference; the first counter to show a change of brightness
};

struct Accuracy {
  std::array<ChannelAccuracy, 3> channels;  ///< red, green and blue of linear SMPTE-C
  MeanSquare noise;                         ///< mean of the three channels
};

/// A small render of a scene at 608, 551 and 455 nm with a chosen leaf model. Scenes, references and accuracies are
/// computed once.
class SceneStudy {
 public:
  static constexpr int kPixels = 64;                              ///< along the image's longer side
  static constexpr uint64_t kSamples = 32;                        ///< per pixel, for errors
  static constexpr const char* kReference = "abm,mode=weighted";  ///< expectation of the analog walk, less noise
  static constexpr uint64_t kReferenceSamples = 4 * kSamples;
  static constexpr size_t kRepeats = 4;  ///< of two renders each, so that a few bright pixels do not decide the result

  /// `name`: a folder in scenes/.
  explicit SceneStudy(const std::string& name);

  /// The scene with `material` for every leaf.
  const Scene& scene(const std::string& material);
  const FilmSettings& film() const { return study_.film(); }
  /// Accuracy after `kSamples` samples per pixel. Films are stored in the folder FROND_BENCH_CACHE, if it is set, for
  /// other processes of this program.
  const Accuracy& accuracy(const std::string& material);

 private:
  /// Candidates and the reference have different seeds.
  enum SeedUse : uint64_t { kCandidateSeed = 1, kReferenceSeed = 3 };
  using Images = std::array<Image, 2>;

  Accuracy measure(const std::string& material);
  const std::vector<Images>& reference();
  std::vector<Images> render(const std::string& material, SeedUse use, uint64_t samples) const;

  const Log& log_ = silent_log();
  Session session_;
  compare::Study study_;
  std::map<std::string, std::shared_ptr<const Scene>> scenes_;
  std::map<std::string, Accuracy> accuracies_;
  std::vector<Images> reference_;
};

}  // namespace frond
