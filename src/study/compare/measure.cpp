#include "study/compare/measure.h"

#include <algorithm>
#include <bit>

#include "core/log.h"
#include "core/math/random.h"
#include "core/messages/counted.h"
#include "instruments/errors/flip.h"
#include "study/compare/film_images.h"
#include "study/compare/paper_manner.h"
#include "study/compare/reference_store.h"

namespace frond::compare {
namespace {

/// No candidate shares a seed with the reference: shared noise would appear as agreement.
enum SeedUse : uint64_t { kCandidateSeed = 1, kReferenceSeed = 3, kTimingSeed = 5 };

PairedRender pair_of(const Study& study, const Candidate& candidate, SeedUse use, size_t pairs = 1) {
  const uint64_t base = study.seed();
  return {study, candidate, hash_key(base, uint64_t{use}), hash_key(base, uint64_t{use} + 1), pairs};
}

/// The two renders of a method as images.
using ImagePair = std::array<Image, 2>;

/// Returns the means that relative errors refer to. Throws InputError for a mean that is not above 0.
MeanTable means_of(const ImagePair& reference, const ChannelList& channels, std::span<const float> leaf) {
  MeanTable means;
  const std::array<std::span<const float>, kRegions> uses{std::span<const float>{}, leaf};
  for (size_t region = 0; region < kRegions; ++region) {
    if (!uses[region].empty() && std::ranges::none_of(uses[region], [](float share) { return share > 0.5f; })) continue;
    for (size_t c = 0; c < reference[0].channels.size(); ++c) {
      means[region].push_back(frond::mean_of({reference[0].plane(c), reference[1].plane(c)}, uses[region]));
      if (!(means[region].back() > 0))
        fail({},
             "the reference's mean in {} over {} pixels is {:.3g}: no error is relative to that, leave out --relative",
             channels.names[kFirst + c], kRegionNames[region], means[region].back());
    }
  }
  return means;
}

/// Returns the errors, relative to the reference's means if there are any.
ErrorTable errors_of(const ImagePair& renders, const ImagePair& reference, size_t film_channels,
                     std::span<const float> leaf, const MeanTable& means) {
  ErrorTable errors{std::vector<RenderError>(kFirst), std::vector<RenderError>(kFirst)};
  for (size_t c = 0; c < renders[0].channels.size(); ++c) {
    const auto a1 = renders[0].plane(c), a2 = renders[1].plane(c);
    const auto b1 = reference[0].plane(c), b2 = reference[1].plane(c);
    errors[kAll].push_back(render_error({a1, a2}, {b1, b2}));
    errors[kLeaf].push_back(render_error({a1, a2}, {b1, b2}, leaf));
  }
  for (size_t region = 0; region < kRegions; ++region)
    for (size_t c = 0; c < means[region].size(); ++c) {
      RenderError& error = errors[region][kFirst + c];
      error = in_unit(means[region][c], error);
    }
  for (auto& region : errors) region[kTogether] = frond::mean_of(std::span(region).subspan(kFirst, film_channels));
  return errors;
}

/// Measures candidates against one reference.
class Bench {
 public:
  Bench(const PairedRender& reference, const Request& request)
      : channels_(channels_of(reference.scene())),
        reference_(images(reference)),
        leaf_(leaf_mask(reference.film(0))),
        error_unit_(request.error_unit()),
        means_(error_unit_.is_relative() ? means_of(reference_, channels_, leaf_) : MeanTable{}),
        exposure_stops_(request.exposure_stops.value_or(fitting_exposure(shown_mean(reference_)))),
        display_(display(shown_mean(reference_))) {}

  CandidateRun run(const PairedRender& render) const {
    const ImagePair pair = images(render);
    return {render.samples(), render.cost(), errors(pair), flip(display_, pair[0])};
  }
  Image shown_first(const PairedRender& render) const { return shown(images(render)[0], channels_); }
  Image shown_mean(const PairedRender& render) const { return shown_mean(images(render)); }

  Reference described(const Candidate& candidate, const PairedRender& render) const {
    Reference r{.candidate = candidate, .samples = render.samples(), .cost = render.cost()};
    const ErrorTable table = errors(reference_);
    for (size_t region = 0; region < kRegions; ++region)
      for (const RenderError& e : table[region]) r.noise[region].push_back(e.reference_noise);
    r.mean = means_;
    r.flip = flip(display(shown(reference_[0], channels_)), reference_[1]);
    r.image = shown_mean(reference_);
    return r;
  }
  const ChannelList& channels() const { return channels_; }
  const ErrorUnit& error_unit() const { return error_unit_; }
  double exposure_stops() const { return exposure_stops_; }

 private:
  ImagePair images(const PairedRender& render) const {
    return {image_of(render.film(0), render.scene(), channels_, colors_),
            image_of(render.film(1), render.scene(), channels_, colors_)};
  }
  Image shown_mean(const ImagePair& pair) const { return shown(mean_of(pair[0], pair[1]), channels_); }
  ErrorTable errors(const ImagePair& images) const {
    return errors_of(images, reference_, channels_.film_channels(), leaf_, means_);
  }
  Image display(const Image& shown) const { return display_image(shown, exposure_stops_, colors_); }
  /// FLIP models the eye and is undefined for bands.
  std::optional<double> flip(const Image& reference, const Image& image) const {
    if (channels_.are_bands()) return {};
    return mean_flip(reference, display(shown(image, channels_)));
  }

  ColorManager colors_;
  ChannelList channels_;
  ImagePair reference_;
  std::vector<float> leaf_;
  ErrorUnit error_unit_;
  MeanTable means_;
  double exposure_stops_;
  Image display_;  ///< of the reference
};

/// Renders the reference and stores it periodically, so that an interrupted program loses little. Returns the number of
/// samples that came from the store.
uint64_t render_reference(PairedRender& render, const ReferenceStore& store, const Plan& plan, const ThreadPool& pool) {
  store.load(render);
  const uint64_t cached = render.samples();
  constexpr uint64_t kFirstStep = 256;
  while (render.samples() < plan.reference_samples) {
    const uint64_t next = std::min(plan.reference_samples, std::max(kFirstStep, 2 * render.samples()));
    render.advance_to(next, pool, plan.progress);
    store.save(render);
  }
  return cached;
}

/// With fewer samples, some bands would have no path.
uint64_t first_samples(const Scene& scene) { return std::bit_ceil(samples_for_all_channels(scene)); }

void check_channels(const PairedRender& render, const Candidate& candidate, const PairedRender& reference) {
  if (same_channels(channels_of(render.scene()), channels_of(reference.scene()))) return;
  fail(
      {},
      "{}: its wavelengths \"{}\" give other channels than the reference's \"{}\": only equal channels can be compared",
      candidate.label, render.scene().wavelengths_name(), reference.scene().wavelengths_name());
}

void check_request(const Request& request, const Plan& plan, const Scene& scene) {
  if (request.target && request.relative)
    fail({}, "--target is an absolute RMS, as the paper's: it does not go with --relative, where --rms is relative");
  if (request.target && !scene.wavelengths().bands().empty())
    fail({}, "--target is an RMS of red, green and blue, wavelengths \"{}\" give bands: --rms is of all channels",
         scene.wavelengths_name());
  if (const uint64_t first = first_samples(scene); std::min(plan.top_samples, plan.reference_samples) < first)
    fail({}, "wavelengths \"{}\" show each band once in {} samples: --spp and --reference-spp are that at least",
         scene.wavelengths_name(), first);
}

std::vector<PairedRender> prepared(const Study& study, const std::vector<Candidate>& candidates,
                                   const PairedRender& reference) {
  std::vector<PairedRender> renders;
  for (const Candidate& c : candidates) {
    renders.push_back(pair_of(study, c, kCandidateSeed));
    check_channels(renders.back(), c, reference);
  }
  return renders;
}

void warn_of_lost_samples(const PairedRender& render, const Candidate& candidate, const Log& log) {
  if (const uint64_t count = render.film(0).not_finite() + render.film(1).not_finite(); count > 0)
    log.warn({}, fmt::format("{}: {} as black", candidate.label,
                             counted(count, "sample was too bright for a number, or none at all, and counts",
                                     "samples were too bright for a number, or none at all, and count")));
}

/// Returns powers of two, and the last number requested.
std::vector<uint64_t> ladder(uint64_t first, uint64_t top) {
  std::vector<uint64_t> runs;
  for (uint64_t samples = first; samples < top; samples *= 2) runs.push_back(samples);
  runs.push_back(top);
  return runs;
}

void measure_at(uint64_t samples, PairedRender& render, const Plan& plan, const Bench& bench, const ThreadPool& pool,
                const Log& log, CandidateResult& measured) {
  render.advance_to(samples, pool, plan.progress);
  measured.runs.push_back(bench.run(render));
  const CandidateRun& r = measured.runs.back();
  log.info(fmt::format("{}: {} samples, {:.3g} s of CPU, RMS {}{}", measured.candidate.label, samples,
                       r.cost.cpu_seconds, bench.error_unit().fixed(r.errors[kAll][kTogether].total.root(), 5),
                       r.flip ? fmt::format(", FLIP {:.4f}", *r.flip) : ""));
}

void measure_candidates(std::vector<PairedRender>& renders, const Plan& plan, const Bench& bench,
                        const ThreadPool& pool, const Log& log, Comparison& result) {
  const auto runs = ladder(first_samples(renders.front().scene()), plan.top_samples);
  // An early image has about a sixteenth of the samples of the last one.
  result.early_samples = runs[runs.size() > 5 ? runs.size() - 5 : 0];
  for (const uint64_t samples : runs)
    for (size_t i = 0; i < renders.size(); ++i) {
      CandidateResult& measured = result.candidates[i];
      measure_at(samples, renders[i], plan, bench, pool, log, measured);
      if (samples == result.early_samples) measured.early = bench.shown_first(renders[i]);
    }
  for (size_t i = 0; i < renders.size(); ++i) {
    result.candidates[i].late = bench.shown_mean(renders[i]);
    warn_of_lost_samples(renders[i], plan.candidates[i], log);
  }
}

/// The CPU time of a sample hardly depends on the number of samples. The few rays that a cutoff leaves are counted over
/// more samples.
constexpr uint64_t kTimingSamples = 8, kPilotFactor = 4;

void time_published_method(const Study& study, const Plan& plan, Comparison& result) {
  const uint64_t samples = std::min(kTimingSamples, plan.top_samples);
  const PaperManner manner(study, plan.candidates.front(), kPilotFactor * samples);
  std::vector<std::pair<PaperTiming*, PairedRender>> renders;
  for (CandidateResult& measured : result.candidates)
    if ((measured.paper = manner.timing(measured.candidate)))
      renders.emplace_back(&*measured.paper, pair_of(study, measured.paper->candidate, kTimingSeed));
  for (uint64_t n = 1; n <= samples; ++n)
    for (auto& [timing, render] : renders) render.advance_to(n, study.session().pool(), {});
  for (auto& [timing, render] : renders) timing->cpu_seconds_per_sample = render.cost().cpu_seconds / double(samples);
}

}  // namespace

Comparison measure(const Study& study, const Plan& plan, const Request& request) {
  const ThreadPool& pool = study.session().pool();
  const Log& log = study.session().log();
  Comparison result;
  result.request = request;
  result.leaves = study.leaves();
  PairedRender reference_render = pair_of(study, plan.reference, kReferenceSeed, plan.candidates.size() + 1);
  check_request(request, plan, reference_render.scene());
  auto renders = prepared(study, plan.candidates, reference_render);
  const ReferenceStore store(study.session().cache(), study.identity(plan.reference), log);
  const uint64_t cached = render_reference(reference_render, store, plan, pool);
  warn_of_lost_samples(reference_render, plan.reference, log);
  const Bench bench(reference_render, request);
  result.channels = bench.channels();
  result.exposure_stops = bench.exposure_stops();
  result.reference = bench.described(plan.reference, reference_render);
  result.reference.cached_samples = cached;
  result.width = result.reference.image.width, result.height = result.reference.image.height;
  result.foliar_ratio = reference_render.film(0).foliar_ratio();
  log.info(fmt::format("reference {}: 2 x {} samples ({} from the cache), its own noise RMS {}, taken out below",
                       plan.reference.text, result.reference.samples, cached,
                       bench.error_unit().fixed(result.reference.noise[kAll][kTogether].root(), 5)));
  for (size_t i = 0; i < renders.size(); ++i)
    result.candidates.push_back({.candidate = plan.candidates[i],
                                 .wavelengths = renders[i].scene().wavelengths_name(),
                                 .setup_cpu_seconds = renders[i].setup_cpu_seconds()});
  measure_candidates(renders, plan, bench, pool, log, result);
  time_published_method(study, plan, result);
  return result;
}

}  // namespace frond::compare
