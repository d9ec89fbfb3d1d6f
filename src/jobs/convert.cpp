#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "image/not_finite.h"
#include "image/rgb_file.h"
#include "image/spectral_layout.h"
#include "jobs/support/display_params.h"

namespace frond {

// `frond convert`: mean of images, exposure and display transform.

namespace {

using enum ArgumentKind;

constexpr JobParam kConvertParams[] = {
    files_param("images", "EXR files of one size and colour space."),
    output_param("Image to write: .png, .jpg or .exr; it has the channels R, G and B.", true),
    JobParam(
        "bands", text,
        "The three bands to display as red, green and blue, by wavelength in nm or by name, such as 850,650,550 or "
        "nir,red,green; white in equal-energy light is 1.",
        {.type = "R,G,B"}),
    JobParam("exposure", text,
             "Change of exposure, a number from -64 to 64, or auto: a light meter, which makes the mean luminance mid "
             "grey (docs/color.md).",
             {.type = "STOPS", .default_value = "0", .unit = "stops"}),
    kWhiteParam,
    kDisplayParam,
    kViewParam,
    JobParam("color-space", text,
             "Colour space of images that do not state one, as after other programs, such as linear SMPTE-C or XYZ; by "
             "default linear sRGB (Rec. 709), as OpenEXR defines."),
};

/// Returns the linear name of --color-space.
std::string space_of(const Arguments& args) {
  const std::string name = args.text("color-space");
  if (name.empty() || name == kXyzName) return name;
  return std::string(color_space(name, {}).linear_name);
}

/// Returns --bands. Throws InputError unless there are three.
std::vector<std::string> bands_of(const Arguments& args) {
  std::vector<std::string> bands;
  std::istringstream words(args.text("bands"));
  for (std::string word; std::getline(words, word, ',');) bands.push_back(word);
  if (bands.size() != 3)
    fail({}, "{} takes three bands, as in 850,650,550 or nir,red,green; {} were given", args.spelled("bands"),
         bands.size());
  return bands;
}

/// Reads an image in linear RGB: its own colours, or three of its bands.
LinearFile read_colors(const std::string& path, const JobRun& run) {
  constexpr const char* kDefault = "linear sRGB";
  if (run.args.given("bands")) {
    const std::vector<std::string> bands = bands_of(run.args);
    ImageFile file = read_image(path, {});
    return {.path = path,
            .space = kDefault,
            .image = false_color_image(file, path, bands),
            .leaf = {},
            .seed = {},
            .left_out = std::move(file.left_out)};
  }
  const std::string given = space_of(run.args);
  LinearFile file = read_linear(path, given.empty() ? kDefault : given);
  if (file.is_assumed && given.empty())
    run.log().warn({}, fmt::format("{} does not state its colour space: {} is assumed; {} sets another one", path,
                                   kDefault, run.args.spelled("color-space")));
  if (!file.is_assumed && !given.empty() && given != file.space)
    run.log().warn({}, fmt::format("{} states its colour space, {}: {} has no effect", path, file.space,
                                   run.args.spelled("color-space")));
  return file;
}

/// Reads an image, and names what it has beside its finite colours.
LinearFile read(const std::string& path, const JobRun& run) {
  LinearFile file = read_colors(path, run);
  for (const std::string& message : file.left_out) run.log().warn({}, message);
  if (const std::string text = not_finite_text(file.image); !text.empty())
    run.log().warn(
        {}, fmt::format("{} holds {}: {}", path, text,
                        is_exr(run.args.text("output")) ? "so does the mean" : "NaN is shown black, infinity white"));
  return file;
}

/// Returns the mean of the images. Throws InputError unless all have one size and one colour space.
LinearFile mean_of(const std::vector<std::string>& paths, const JobRun& run) {
  LinearFile mean = read(paths[0], run);
  for (size_t i = 1; i < paths.size(); ++i) {
    const LinearFile next = read(paths[i], run);
    check_same_size(mean, next);
    if (next.space != mean.space)
      fail({}, "{} is in {}, {} in {}: only images of one colour space are averaged", mean.path, mean.space, next.path,
           next.space);
    mean.correlated_pixels = std::max(mean.correlated_pixels, next.correlated_pixels);
    for (size_t k = 0; k < mean.image.pixels.size(); ++k) mean.image.pixels[k] += next.image.pixels[k];
  }
  return mean;
}

/// Returns the attribute with the light of the first image's scene, for an automatic white balance. Throws InputError
/// if the image has none.
std::map<std::string, std::string> light_attributes(const JobRun& run, const DisplayChoice& display,
                                                    const std::vector<std::string>& paths) {
  if (!display.white || !display.white->is_auto) return {};
  const ImageHeader header = read_image(paths[0], {}).header;
  const auto light = header.text.find(kLightWhiteKey);
  if (light == header.text.end() || !parse_chromaticity(light->second))
    fail({}, "{} auto: {} does not state the light of its scene, as images of frond render do; give a temperature",
         run.args.spelled("white-balance"), paths[0]);
  return {*light};
}

/// Returns the exposure that a light meter chooses for the mean of a sum of images.
double metered_stops(const LinearFile& sum, size_t count) {
  Image mean = sum.image;
  for (float& v : mean.pixels) v /= float(count);
  return measure_exposure(mean, sum.space).stops;
}

/// The job: averages the images, applies the exposure, and writes the mean.
Result convert(const JobRun& run) {
  const std::string output = run.args.text("output");
  const ExposureChoice exposure = exposure_choice(run.args);
  const DisplayChoice display{run.args.text("display"), run.args.text("view"), {}, white_choice(run.args)};
  check_writable(output);
  const ColorManager colors;
  check_display_choice(output, colors, display);
  const auto paths = run.args.texts("images");
  LinearFile mean = mean_of(paths, run);
  const double stops = exposure.is_auto ? metered_stops(mean, paths.size()) : exposure.stops;
  const float scale = float(std::exp2(stops) / double(paths.size()));
  for (float& v : mean.image.pixels) v *= scale;
  std::map<std::string, std::string> attributes{{"frond:version", FROND_VERSION}};
  std::map<std::string, std::string> of_display = light_attributes(run, display, paths);
  if (run.args.given("exposure"))
    attributes["frond:exposure"] = of_display["frond:exposure"] = fmt::format("{:.6g}", stops);
  if (mean.correlated_pixels > 1) attributes["frond:correlated_pixels"] = fmt::format("{:.3f}", mean.correlated_pixels);
  std::optional<AppliedExposure> applied;
  if (is_exr(output))
    write_image(output, mean.image, {mean.space, attributes});
  else
    applied = write_display_image(output, mean.image, mean.space, colors, display, of_display);
  if (exposure.is_auto) applied = AppliedExposure{stops, {}};
  report_exposure(run, exposure.is_auto, applied, output);
  return {};
}

}  // namespace

extern const JobInfo kConvertJob("convert", "Images",
                                 "Average linear images, and write the mean as EXR or through a display transform.", "",
                                 kConvertParams, SessionUse::none, convert);

}  // namespace frond
