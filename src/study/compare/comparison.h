#pragma once

#include <array>
#include <optional>

#include "instruments/errors/convergence.h"
#include "instruments/errors/render_error.h"
#include "study/compare/candidate.h"
#include "study/compare/channels.h"
#include "study/compare/cutoff.h"
#include "study/compare/error_unit.h"
#include "study/compare/film_images.h"
#include "study/compare/paired_render.h"

namespace frond::compare {

/// Which pixels: all, or those that see a leaf.
enum Region : size_t { kAll, kLeaf, kRegions };
inline constexpr std::array<const char*, kRegions> kRegionNames{"all", "leaf"};

/// By region and place in a ChannelList.
using ErrorTable = std::array<std::vector<RenderError>, kRegions>;

/// By region and the channels of an image (those of a ChannelList from kFirst on). Of a region without pixels: none.
using MeanTable = std::array<std::vector<double>, kRegions>;

/// One candidate after so many samples a pixel.
struct CandidateRun {
  uint64_t samples = 0;
  RenderCost cost;  ///< of one render
  ErrorTable errors = {};
  std::optional<double> flip = {};  ///< mean FLIP of one render against the reference; none of bands
};

/// A candidate in the paper's manner (paper_manner.h), timed alone.
struct PaperTiming {
  Candidate candidate;
  double depth;  ///< where the trees end
  CutoffFit end;
  double cpu_seconds_per_sample = 0;
};

/// What was measured of one candidate.
struct CandidateResult {
  Candidate candidate;
  std::string wavelengths;
  double setup_cpu_seconds = 0;
  std::vector<CandidateRun> runs = {};
  std::optional<PaperTiming> paper = {};
  Image early = {}, late = {};  ///< as shown: one render at `Comparison::early_samples`; both after the last run

  /// Bias is that of the last run, where noise hides the least of it.
  Convergence convergence(Region region, size_t channel = kTogether) const;
};

struct Reference {
  Candidate candidate;
  uint64_t samples = 0;                                      ///< of each of two renders
  uint64_t cached_samples = 0;                               ///< of these, from the cache
  RenderCost cost;                                           ///< of one render
  std::array<std::vector<MeanSquare>, kRegions> noise = {};  ///< of the mean of the two, by place in the ChannelList
  MeanTable mean = {};              ///< in the ChannelList's unit, where errors are relative to it; else empty
  std::optional<double> flip = {};  ///< between the two: twice the noise of what candidates are compared with
  Image image = {};                 ///< as shown
};

/// What the user wants to know.
struct Request {
  std::vector<double> rms = {};                      ///< errors to meet, over all channels and all pixels
  std::optional<std::array<double, 3>> target = {};  ///< RMS of red, green and blue for speed-up (c)
  std::optional<double> exposure_stops = {};
  bool relative = false;  ///< errors, `rms` among them, over the reference's mean (error_unit.h); not with `target`

  ErrorUnit error_unit() const { return ErrorUnit(relative); }
};

/// Everything that a report tells.
struct Comparison {
  double exposure_stops = 0;  ///< by which images and FLIP are brightened
  std::string scene, command, machine;
  int width = 0, height = 0;
  ChannelList channels;
  double foliar_ratio = 0;
  std::vector<std::string> leaves;
  Request request;
  Reference reference;
  std::vector<CandidateResult> candidates;
  uint64_t early_samples = 0;
  std::string leaf_by_leaf;  ///< a sentence on what is enough for `Request::rms` of each leaf alone; empty: not asked
  double wall_seconds = 0, cpu_seconds = 0;
};

inline Convergence CandidateResult::convergence(Region region, size_t channel) const {
  std::vector<ConvergencePoint> points;
  for (const CandidateRun& r : runs)
    points.push_back({double(r.samples), r.cost.cpu_seconds, r.errors[region][channel].noise});
  return {std::move(points), runs.back().errors[region][channel].bias};
}

}  // namespace frond::compare
