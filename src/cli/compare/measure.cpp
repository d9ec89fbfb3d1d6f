#include "cli/compare/measure.h"

#include <algorithm>
#include <bit>

#include "cli/compare/paper_manner.h"
#include "cli/compare/reference_store.h"
#include "cli/progress.h"
#include "core/random.h"

namespace frond::compare {
namespace {

/// No candidate shares a seed with the reference, or a part of its noise would look like agreement.
enum SeedUse : uint64_t { kCandidateSeed = 1, kReferenceSeed = 3, kTimingSeed = 5 };

PairedRender pair_of(const Study& study, const Candidate& candidate, SeedUse use) {
  const uint64_t base = study.seed();
  return {study, candidate, hash_key(base, uint64_t{use}), hash_key(base, uint64_t{use} + 1)};
}

/// The two renders of a method as pictures.
struct PicturePair {
  std::array<Picture, 2> half;

  PicturePair(const PairedRender& render, const ColorManager& colors)
      : half{picture_of(render.film(0), render.scene().wavelengths().film_space(), colors),
             picture_of(render.film(1), render.scene().wavelengths().film_space(), colors)} {}
  RenderPair channel(size_t c) const { return {half[0].channels[c], half[1].channels[c]}; }
  Picture mean() const { return mean_of(half[0], half[1]); }
};

std::array<RenderError, kChannels> errors_of(const PicturePair& renders, const PicturePair& reference,
                                             std::span<const float> use) {
  std::array<RenderError, kChannels> errors;
  for (size_t c = 0; c < 3; ++c) errors[c] = render_error(renders.channel(c), reference.channel(c), use);
  errors[kRgb] = frond::mean_of(std::span(errors).first(3));
  errors[kLuminance] = render_error(renders.channel(3), reference.channel(3), use);
  return errors;
}

/// Measures against one reference.
class Bench {
 public:
  Bench(const PairedRender& reference, double exposure_stops)
      : reference_(reference, colors_),
        leaf_(leaf_mask(reference.film(0))),
        exposure_stops_(exposure_stops),
        shown_(display_image(reference_.mean(), exposure_stops, colors_)) {}

  Rung rung(const PairedRender& render) const {
    const PicturePair pictures(render, colors_);
    return {render.samples(), render.cost(), errors(pictures), flip(pictures.half[0])};
  }
  PicturePair pictures(const PairedRender& render) const { return {render, colors_}; }

  void describe_reference(Reference& r) const {
    const ErrorTable table = errors(reference_);
    for (size_t region = 0; region < kRegions; ++region)
      for (size_t c = 0; c < kChannels; ++c) r.noise[region][c] = table[region][c].reference_noise;
    r.flip = mean_flip(display_image(reference_.half[0], exposure_stops_, colors_),
                       display_image(reference_.half[1], exposure_stops_, colors_));
    r.picture = reference_.mean();
  }

 private:
  ErrorTable errors(const PicturePair& pictures) const {
    return {errors_of(pictures, reference_, {}), errors_of(pictures, reference_, leaf_)};
  }
  double flip(const Picture& picture) const {
    return mean_flip(shown_, display_image(picture, exposure_stops_, colors_));
  }

  ColorManager colors_;
  PicturePair reference_;
  std::vector<float> leaf_;
  double exposure_stops_;
  DisplayImage shown_;
};

/// Kept on disk from time to time: what was rendered is not lost when the program is ended.
void render_reference(PairedRender& render, const ReferenceStore& store, const Plan& plan, const ThreadPool& pool,
                      Reference& reference) {
  store.load(render);
  reference.cached_samples = render.samples();
  constexpr uint64_t kFirstStep = 256;
  while (render.samples() < plan.reference_samples) {
    const uint64_t next = std::min(plan.reference_samples, std::max(kFirstStep, 2 * render.samples()));
    ProgressLine line(plan.quiet);
    render.advance_to(next, pool, std::ref(line));
    store.save(render);
  }
  reference.samples = render.samples();
  reference.cost = render.cost();
}

std::vector<PairedRender> prepared(const Study& study, const std::vector<Candidate>& candidates) {
  std::vector<PairedRender> renders;
  for (const Candidate& c : candidates) renders.push_back(pair_of(study, c, kCandidateSeed));
  return renders;
}

void warn_of_lost_samples(const PairedRender& render, const Candidate& candidate, const Log& log) {
  if (const int64_t count = render.film(0).not_finite() + render.film(1).not_finite(); count > 0)
    log.warn({}, fmt::format("{}: {} samples were too bright for a number, or none at all, and count as black",
                             candidate.label, count));
}

void climb(std::vector<PairedRender>& renders, const Plan& plan, const Bench& bench, const ThreadPool& pool,
           const Log& log, Comparison& result) {
  for (uint64_t samples = 1; samples <= plan.top_samples; samples *= 2) {
    for (size_t i = 0; i < renders.size(); ++i) {
      {
        ProgressLine line(plan.quiet);
        renders[i].advance_to(samples, pool, std::ref(line));
      }
      Subject& subject = result.subjects[i];
      subject.rungs.push_back(bench.rung(renders[i]));
      if (samples == result.early_samples) subject.early = bench.pictures(renders[i]).half[0];
      const Rung& r = subject.rungs.back();
      log.info(fmt::format("{}: {} samples, {:.3g} s of CPU, RMS {:.5f}, FLIP {:.4f}", subject.candidate.label, samples,
                           r.cost.cpu_seconds, r.errors[kAll][kRgb].total.root(), r.flip));
    }
  }
  for (size_t i = 0; i < renders.size(); ++i) {
    result.subjects[i].late = bench.pictures(renders[i]).mean();
    warn_of_lost_samples(renders[i], plan.candidates[i], log);
  }
}

/// A sample's CPU time hardly hangs on how many there are.
constexpr uint64_t kTimingSamples = 8;

void time_in_the_papers_manner(const Study& study, const Plan& plan, const ThreadPool& pool, Comparison& result) {
  const uint64_t samples = std::min(kTimingSamples, plan.top_samples);
  const PaperManner manner(study, plan.candidates.front(), samples, pool);
  std::vector<std::pair<PaperTiming*, PairedRender>> renders;
  for (Subject& subject : result.subjects)
    if ((subject.paper = manner.of(subject.candidate)))
      renders.emplace_back(&*subject.paper, pair_of(study, subject.paper->candidate, kTimingSeed));
  for (uint64_t n = 1; n <= samples; ++n)
    for (auto& [timing, render] : renders) render.advance_to(n, pool, {});
  for (auto& [timing, render] : renders) timing->cpu_seconds_per_sample = render.cost().cpu_seconds / double(samples);
}

}  // namespace

Comparison measure(const Study& study, const Plan& plan, const Request& request, const ThreadPool& pool,
                   const Log& log) {
  Comparison result;
  result.request = request;
  result.leaves = study.leaves();
  result.early_samples = std::bit_floor(std::max<uint64_t>(1, plan.top_samples / 16));
  auto renders = prepared(study, plan.candidates);
  PairedRender reference_render = pair_of(study, plan.reference, kReferenceSeed);
  result.reference.candidate = plan.reference;
  const ReferenceStore store(plan.cache, study.identity(plan.reference), log);
  render_reference(reference_render, store, plan, pool, result.reference);
  warn_of_lost_samples(reference_render, plan.reference, log);
  const Bench bench(reference_render, request.exposure_stops);
  bench.describe_reference(result.reference);
  result.width = result.reference.picture.width, result.height = result.reference.picture.height;
  result.foliar_ratio = reference_render.film(0).foliar_ratio();
  log.info(fmt::format("reference {}: 2 x {} samples ({} from the cache), its own noise RMS {:.5f}, taken out below",
                       plan.reference.text, result.reference.samples, result.reference.cached_samples,
                       result.reference.noise[kAll][kRgb].root()));
  for (size_t i = 0; i < renders.size(); ++i)
    result.subjects.push_back({.candidate = plan.candidates[i],
                               .wavelengths = renders[i].scene().wavelengths_name(),
                               .setup_cpu_seconds = renders[i].setup_cpu_seconds()});
  climb(renders, plan, bench, pool, log, result);
  time_in_the_papers_manner(study, plan, pool, result);
  return result;
}

}  // namespace frond::compare
