#include "render/image_output.h"

#include "core/error.h"
#include "image/image_file.h"
#include "image/spectral_layout.h"

namespace frond {

ImageOutput::ImageOutput(std::string path, DisplayChoice display)
    : path_(std::move(path)), display_(std::move(display)) {
  check_writable(path_);
  check_display_choice(path_, colors_, display_);
}

void ImageOutput::check_channels(std::string_view film_space) const {
  if (film_space.empty() && !is_exr(path_))
    fail({},
         "{}: PNG and JPEG cannot store bands: write an .exr file, from which frond convert --bands makes an image of "
         "three bands",
         path_);
}

void ImageOutput::check(const ImageFormat& format) const {
  check_channels(format.space);
  if (!is_exr(path_)) colors_.check_display(format.space, display_.display, display_.view);
}

std::optional<AppliedExposure> ImageOutput::write(const Film& film, const ImageFormat& format) const {
  check(format);
  const Image image = film_image(film, format);
  auto attributes = format.attributes;
  if (!is_exr(path_)) {
    if (const auto command = attributes.find("frond:command"); command != attributes.end()) {
      if (!display_.display.empty()) command->second += " --display " + display_.display;
      if (!display_.view.empty()) command->second += " --view " + display_.view;
    }
    return write_display_image(path_, image, format.space, colors_, display_, attributes);
  }
  if (!format.bands.empty()) attributes.merge(spectral_attributes(format.bands));
  const FilmSettings& s = film.settings();
  std::vector<std::string> full_precision;
  for (const ChannelInfo* channel : film.format().channels.infos())
    for (std::string& name : channel->exr_names()) full_precision.push_back(std::move(name));
  const std::string space = format.space.empty() ? preview_space(format.bands) : format.space;
  write_image(
      path_, image,
      {space, attributes, s.crop.x0, s.crop.y0, s.width, s.height, full_precision, format.matrices, format.samples},
      s.half ? ExrDepth::half : ExrDepth::single);
  return {};
}

bool ImageOutput::rounds_to_halves(const Film& film) const { return is_exr(path_) && film.settings().half; }

}  // namespace frond
