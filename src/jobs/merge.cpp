#include <fmt/format.h>

#include "core/messages/counted.h"
#include "jobs/support/display_params.h"
#include "render/image_output.h"
#include "render/parts/part_file.h"

namespace frond {

// `frond merge`: combines parts of one render (docs/many_machines.md).

namespace {

using enum ArgumentKind;

constexpr JobParam kMergeParams[] = {
    files_param("parts", "Parts of one render, without common samples."),
    output_param("Image to write: .exr (linear), .png or .jpg (through the display transform).", false, "part"),
    JobParam("part", text, "Part to write instead of an image.", {.type = "FILE", .path = PathUse::write}),
    JobParam("allow-holes", flag, "Write an image although samples or pixels are missing."),
    kDisplayParam,
    kViewParam,
    kExposureParam,
    kWhiteParam,
};

/// Throws InputError, or warns with --allow-holes, if samples or pixels are missing.
void check_holes(const RenderPart& whole, const JobRun& run) {
  const std::string missing = missing_samples_text(whole);
  if (missing.empty()) return;
  if (!run.args.flag("allow-holes"))
    fail({}, "no part has {}; {} writes the image without them", missing, run.args.spelled("allow-holes"));
  run.log().warn({}, fmt::format("no part has {}", missing));
}

/// Writes the image of the merged parts, with warnings about missing samples.
void write_merged(const RenderPart& whole, const ImageOutput& output, const JobRun& run) {
  check_holes(whole, run);
  if (lacks_neighboring_samples(whole.film))
    run.log().warn({},
                   "pixels at the edges lack samples of neighbouring pixels within the filter's radius: other parts of "
                   "the image contain them");
  if (const std::string text = unsampled_text(whole.film); !text.empty()) run.log().warn({}, text);
  const auto& exposure = output.display().exposure;
  report_exposure(run, exposure && exposure->is_auto, output.write(whole.film, finished_format(whole)), output.path());
}

/// The job: merges all parts in memory, then writes an image or a part.
Result merge(const JobRun& run) {
  const Arguments& args = run.args;
  if (!args.given("output") && !args.given("part"))
    fail({}, "merge: {} or {} is needed", args.spelled("output"), args.spelled("part"));
  std::optional<ImageOutput> output;
  if (args.given("output")) output.emplace(args.text("output"), display_choice(args));
  const auto parts = args.texts("parts");
  const RenderPart whole = merge_parts({parts.begin(), parts.end()});
  if (output)
    write_merged(whole, *output, run);
  else  // holes are allowed: further parts may be merged with this one
    write_part(args.text("part"), whole.header, whole.film);
  // Such samples count as the film's largest value or as black.
  const uint64_t lost = whole.film.not_finite();
  if (lost > 0)
    run.log().warn(
        {}, fmt::format("{} too bright for the film, or not finite", counted(lost, "sample was", "samples were")));
  const SampleCount samples = sample_count(whole.film);
  run.log().info(fmt::format("{}: {}, {} per pixel, {:.2f} s of CPU", output ? output->path() : args.text("part"),
                             counted(parts.size(), "part"),
                             samples.least == samples.most
                                 ? counted(samples.most, "sample")
                                 : fmt::format("{} to {} samples", samples.least, samples.most),
                             whole.header.statistics.cpu_seconds));
  return {.facts = {{"least_samples", double(samples.least)},
                    {"most_samples", double(samples.most)},
                    {"cpu_seconds", whole.header.statistics.cpu_seconds}}};
}

}  // namespace

extern const JobInfo kMergeJob("merge", "Cluster", "Merge parts of a render, written by frond render --part.", "",
                               kMergeParams, SessionUse::none, merge);

}  // namespace frond
