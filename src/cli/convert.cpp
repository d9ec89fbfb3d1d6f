#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "image/rgb_file.h"
#include "image/spectral_layout.h"
#include "render/image_output.h"

namespace frond {
namespace {

struct ConvertOptions {
  std::vector<std::string> inputs;
  std::string output;
  DisplayChoice display;
  std::vector<double> bands_nm;
  double exposure = 0;
};

LinearFile read(const std::string& path, const std::vector<double>& bands_nm) {
  if (bands_nm.empty()) return read_linear(path);
  return {.path = path,
          .space = "linear sRGB",
          .image = false_color_image(read_image(path, {}), path, bands_nm),
          .leaf = {},
          .seed = {}};
}

void convert(const ConvertOptions& options) {
  check_writable(options.output);
  const ColorManager colors;
  check_display_choice(options.output, colors, options.display);
  LinearFile mean = read(options.inputs[0], options.bands_nm);
  for (size_t i = 1; i < options.inputs.size(); ++i) {
    const LinearFile next = read(options.inputs[i], options.bands_nm);
    check_same_size(mean, next);
    if (next.space != mean.space)
      fail({}, "{} is in {}, {} in {}: only images of one colour space are averaged", mean.path, mean.space, next.path,
           next.space);
    mean.correlated_pixels = std::max(mean.correlated_pixels, next.correlated_pixels);
    for (size_t k = 0; k < mean.image.pixels.size(); ++k) mean.image.pixels[k] += next.image.pixels[k];
  }
  const float scale = float(std::exp2(options.exposure) / double(options.inputs.size()));
  for (float& v : mean.image.pixels) v *= scale;
  std::map<std::string, std::string> attributes{{"frond:version", FROND_VERSION}};
  if (mean.correlated_pixels > 1) attributes["frond:correlated_pixels"] = fmt::format("{:.3f}", mean.correlated_pixels);
  if (is_exr(options.output))
    write_image(options.output, mean.image, {mean.space, attributes});
  else
    write_display_image(options.output, mean.image, mean.space, colors, options.display, {});
}

}  // namespace

void add_convert_command(CLI::App& app) {
  auto* command = app.add_subcommand("convert", "Average linear images and show them through a display transform.");
  auto o = std::make_shared<ConvertOptions>();
  command->add_option("images", o->inputs, "EXR files of one size and colour space.")->type_name("FILE")->required();
  command->add_option("-o,--output", o->output, "Image: .png, .jpg or .exr.")->type_name("FILE")->required();
  auto* bands = command->add_option("--bands", o->bands_nm,
                                    "Wavelengths (nm) of three bands to show as red, green and blue, such as "
                                    "850,650,550; a white in equal-energy light is 1.");
  bands->delimiter(',')->expected(3)->check(is_positive);
  command->add_option("--exposure", o->exposure, "Stops.")->check(is_number);
  command->add_option("--display", o->display.display, "Display of PNG and JPEG output; sRGB by default.");
  command->add_option("--view", o->display.view, "View of that display.");
  command->callback([o] { convert(*o); });
}

}  // namespace frond
