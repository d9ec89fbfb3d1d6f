#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "core/log.h"
#include "render/image_output.h"
#include "render/part_file.h"
#include "system/atomic_file.h"

namespace frond {
namespace {

struct MergeOptions {
  std::vector<std::string> parts;
  std::string output, part;
  DisplayChoice display;
  bool allow_holes = false, quiet = false;
};

void check_holes(const RenderPart& whole, bool allow, const Log& log) {
  const std::string missing = what_is_missing(whole);
  if (missing.empty()) return;
  if (!allow) fail({}, "{} are in none of the parts: --allow-holes makes a picture without them", missing);
  log.warn({}, fmt::format("{} are in none of the parts", missing));
}

void merge(const MergeOptions& o) {
  const ConsoleLog log(o.quiet);
  if (o.output.empty() == o.part.empty()) fail({}, "merge: -o IMAGE or --part FILE is needed, and one of them alone");
  std::optional<ImageOutput> output;
  if (o.part.empty())
    output.emplace(o.output, o.display);
  else
    check_replaceable(o.part);
  const RenderPart whole = merge_parts({o.parts.begin(), o.parts.end()});
  // More parts may still come to what becomes a part again.
  if (output) {
    check_holes(whole, o.allow_holes, log);
    if (lacks_neighbors(whole.film))
      log.warn({},
               "pixels at the edges lack samples of those beside them, which the filter reaches: other parts of the "
               "picture have them");
    output->write(whole.film, finished_picture(whole));
  } else {
    write_part(o.part, whole.header, whole.film);
  }
  if (const uint64_t count = whole.film.not_finite(); count > 0)
    log.warn({}, fmt::format("{} samples were too bright for the film, or no numbers at all", count));
  const SampleCount samples = sample_count(whole.film);
  log.info(fmt::format("{}: {} part{}, {} samples per pixel, {:.2f} s of CPU", output ? o.output : o.part,
                       o.parts.size(), o.parts.size() == 1 ? "" : "s",
                       samples.least == samples.most ? fmt::format("{}", samples.most)
                                                     : fmt::format("{} to {}", samples.least, samples.most),
                       whole.header.statistics.cpu_seconds));
}

}  // namespace

void add_merge_command(CLI::App& app) {
  auto* command = app.add_subcommand("merge", "Add up parts of a render, which frond render --part has made.");
  auto o = std::make_shared<MergeOptions>();
  command->add_option("parts", o->parts, "Parts of one render, which have no sample in common.")
      ->type_name("FILE")
      ->required();
  command->add_option("-o,--output", o->output, "Image: .exr (linear), .png or .jpg (through the display transform).")
      ->type_name("FILE");
  command->add_option("--part", o->part, "Write a part again instead of an image.")->type_name("FILE");
  command->add_flag("--allow-holes", o->allow_holes, "Make an image although samples or pixels are missing.");
  command->add_option("--display", o->display.display, "Display of PNG and JPEG output; sRGB by default.");
  command->add_option("--view", o->display.view, "View of that display.");
  command->add_flag("-q,--quiet", o->quiet, "Print nothing but errors.");
  command->callback([o] { merge(*o); });
}

}  // namespace frond
