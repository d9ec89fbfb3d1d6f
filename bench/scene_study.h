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

/// How far one render is from what the reference converges to, in one channel.
struct ChannelAccuracy {
  RenderError error;
  Estimate offset;  ///< mean over the pixels of render minus reference: a change of brightness shows here first
};

struct Accuracy {
  std::array<ChannelAccuracy, 3> channels;  ///< red, green and blue of linear SMPTE-C
  MeanSquare noise;                         ///< mean of the three
};

/// A scene at a small size and at the wavelengths 608, 551 and 455 nm, in which one leaf model stands for another. What
/// it is asked for is made once.
class SceneStudy {
 public:
  static constexpr int kPixels = 64;                              ///< of the image's longer side
  static constexpr uint64_t kSamples = 32;                        ///< of each pixel, where errors are told
  static constexpr const char* kReference = "abm,mode=weighted";  ///< the analog walk's expectation, with less noise
  static constexpr uint64_t kReferenceSamples = 4 * kSamples;
  static constexpr size_t kRepeats = 4;  ///< of two renders of each, so that few bright pixels do not decide

  /// `name`: of a folder in scenes/.
  explicit SceneStudy(const std::string& name);

  /// `material` in place of every leaf.
  const Scene& scene(const std::string& material);
  const FilmSettings& film() const { return study_.film(); }
  /// After `kSamples` samples a pixel. Films are kept in the folder FROND_BENCH_CACHE, if that is set, for other
  /// processes of this program.
  const Accuracy& accuracy(const std::string& material);

 private:
  /// No candidate shares a seed with the reference.
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
