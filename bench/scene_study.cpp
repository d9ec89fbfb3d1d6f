#include "bench/scene_study.h"

#include <cstdlib>

#include "core/math/random.h"
#include "study/compare/reference_store.h"

namespace frond {
namespace {

using compare::PairedRender;

std::filesystem::path cache() {
  const char* folder = std::getenv("FROND_BENCH_CACHE");
  return folder ? folder : "";
}

compare::StudyOptions options(const std::string& name) {
  return {
      .scene = FROND_SOURCE_DIR "/scenes/" + name + "/scene.pbrt", .wavelengths = "smpte", .size = SceneStudy::kPixels};
}

std::array<Image, 2> images_of(const PairedRender& render, const ColorManager& colors) {
  const Scene& scene = render.scene();
  const compare::ChannelList channels = compare::channels_of(scene);
  return {compare::image_of(render.film(0), scene, channels, colors),
          compare::image_of(render.film(1), scene, channels, colors)};
}

/// The variance of the difference is the sum of the variances of the means of two renders and of two reference renders.
Estimate offset_of(const RenderPair& renders, const RenderPair& reference, const RenderError& error) {
  const double pixels = double(renders.first.size());
  return {image_error(renders.first, renders.second, reference.first, reference.second).mean_difference,
          (error.noise.value / 2 + error.reference_noise.value) / pixels};
}

std::array<std::vector<float>, 2> planes_of(const std::array<Image, 2>& pair, size_t c) {
  return {pair[0].plane(c), pair[1].plane(c)};
}

/// Accuracy of one channel, mean of the repeats.
ChannelAccuracy accuracy_of(std::span<const std::array<Image, 2>> candidate,
                            std::span<const std::array<Image, 2>> reference, size_t c) {
  std::vector<RenderError> errors;
  Estimate sum;
  for (size_t i = 0; i < candidate.size(); ++i) {
    const auto rendered = planes_of(candidate[i], c), right = planes_of(reference[i], c);
    const RenderPair renders{rendered[0], rendered[1]}, truth{right[0], right[1]};
    errors.push_back(render_error(renders, truth));
    sum += offset_of(renders, truth, errors.back());
  }
  const double repeats = double(candidate.size());
  return {mean_of_independent(errors), {sum.mean / repeats, sum.variance / (repeats * repeats)}};
}

}  // namespace

SceneStudy::SceneStudy(const std::string& name) : session_(log_, {.cache = cache()}), study_(session_, options(name)) {}

const Scene& SceneStudy::scene(const std::string& material) {
  auto& scene = scenes_[material];
  if (!scene) scene = study_.scene(compare::parse_candidate(material));
  return *scene;
}

const Accuracy& SceneStudy::accuracy(const std::string& material) {
  if (const auto known = accuracies_.find(material); known != accuracies_.end()) return known->second;
  return accuracies_.emplace(material, measure(material)).first->second;
}

Accuracy SceneStudy::measure(const std::string& material) {
  const std::vector<Images> candidate = render(material, kCandidateSeed, kSamples);
  Accuracy a;
  for (size_t c = 0; c < a.channels.size(); ++c) a.channels[c] = accuracy_of(candidate, reference(), c);
  a.noise = mean_of(std::array{a.channels[0].error, a.channels[1].error, a.channels[2].error}).noise;
  return a;
}

const std::vector<SceneStudy::Images>& SceneStudy::reference() {
  if (reference_.empty()) reference_ = render(kReference, kReferenceSeed, kReferenceSamples);
  return reference_;
}

std::vector<SceneStudy::Images> SceneStudy::render(const std::string& material, SeedUse use, uint64_t samples) const {
  const compare::Candidate candidate = compare::parse_candidate(material);
  const ColorManager colors;
  std::vector<Images> result;
  for (uint64_t repeat = 0; repeat < kRepeats; ++repeat) {
    const auto seed = [&](uint64_t half) { return hash_key(study_.seed(), uint64_t{use} + half, repeat); };
    PairedRender render(study_, candidate, seed(0), seed(1));
    Identity identity = study_.identity(candidate);
    identity.add("repeat", fmt::format("{} of use {}", repeat, uint64_t{use}));
    const compare::ReferenceStore store(session_.cache(), identity, log_);
    store.load(render);
    if (render.samples() < samples) {
      render.advance_to(samples, study_.session().pool(), nullptr);
      store.save(render);
    }
    result.push_back(images_of(render, colors));
  }
  return result;
}

}  // namespace frond
