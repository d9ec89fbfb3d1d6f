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

/// Set of pixels: all, or those with a leaf.
enum Region : size_t { kAll, kLeaf, kRegions };
inline constexpr std::array<const char*, kRegions> kRegionNames{"all", "leaf"};

/// Errors by region and index in a ChannelList.
using ErrorTable = std::array<std::vector<RenderError>, kRegions>;

/// Means by region and channel of an image (a ChannelList from kFirst on); empty for a region without pixels.
using MeanTable = std::array<std::vector<double>, kRegions>;

/// Measurement of a candidate after a number of samples per pixel.
struct CandidateRun {
  uint64_t samples = 0;
  RenderCost cost;  ///< of one render
  ErrorTable errors = {};
  std::optional<double> flip = {};  ///< mean FLIP of one render against the reference; empty for bands
};

/// Timing of a candidate in the paper's manner (paper_manner.h).
struct PaperTiming {
  Candidate candidate;
  double depth;  ///< largest depth of the paper's ray trees
  CutoffFit end;
  double cpu_seconds_per_sample = 0;
};

/// All measurements of one candidate.
struct CandidateResult {
  Candidate candidate;
  std::string wavelengths;
  double setup_cpu_seconds = 0;
  std::vector<CandidateRun> runs = {};
  std::optional<PaperTiming> paper = {};
  Image early = {},
        late = {};  ///< for display: one render at `Comparison::early_samples`; mean of both after the last run

  /// Returns the convergence. The bias is taken from the last run, which has the least noise.
  Convergence convergence(Region region, size_t channel = kTogether) const;
};

struct Reference {
  Candidate candidate;
  uint64_t samples = 0;         ///< in each of two renders
  uint64_t cached_samples = 0;  ///< the part of `samples` that was cached
  RenderCost cost;              ///< of one render
  std::array<std::vector<MeanSquare>, kRegions> noise =
      {};                           ///< of the mean of the two renders, by index in the ChannelList
  MeanTable mean = {};              ///< in the ChannelList's unit, if errors are relative; else empty
  std::optional<double> flip = {};  ///< between the two renders: twice the noise of the reference
  Image image = {};                 ///< for display
};

/// The user's request of a comparison.
struct Request {
  std::vector<double> rms = {};                      ///< RMS errors to meet, over all channels and pixels
  std::optional<std::array<double, 3>> target = {};  ///< RMS of red, green and blue for speed-up (c)
  std::optional<double> exposure_stops = {};
  bool relative =
      false;  ///< errors, including `rms`, are relative to the reference's mean (error_unit.h); excludes `target`

  ErrorUnit error_unit() const { return ErrorUnit(relative); }
};

/// Content of a report.
struct Comparison {
  double exposure_stops = 0;  ///< exposure of images and FLIP
  std::string scene, command, machine;
  int width = 0, height = 0;
  ChannelList channels;
  double foliar_ratio = 0;
  std::vector<std::string> leaves;
  Request request;
  Reference reference;
  std::vector<CandidateResult> candidates;
  uint64_t early_samples = 0;
  std::string leaf_by_leaf;  ///< which models of single leaves meet `Request::rms`, in a sentence; empty: not requested
  double wall_seconds = 0, cpu_seconds = 0;
};

inline Convergence CandidateResult::convergence(Region region, size_t channel) const {
  std::vector<ConvergencePoint> points;
  for (const CandidateRun& r : runs)
    points.push_back({double(r.samples), r.cost.cpu_seconds, r.errors[region][channel].noise});
  return {std::move(points), runs.back().errors[region][channel].bias};
}

}  // namespace frond::compare
