#pragma once

#include "image/display_image.h"
#include "render/film/image_format.h"

namespace frond {

/// Image file of a render. It is constructed before rendering, so that errors of the path and of the display transform
/// are reported first.
class ImageOutput {
 public:
  /// Throws InputError if the path cannot be written, and as check_display_choice does.
  ImageOutput(std::string path, DisplayChoice display);

  /// Throws InputError if the film's channels are bands, that is, `film_space` is empty, and the file is PNG or JPEG.
  void check_channels(std::string_view film_space) const;

  /// Throws InputError if the display or view does not support the image's colour space, or for bands in PNG or JPEG.
  void check(const ImageFormat& format) const;

  /// Writes the image. EXR: all channels of film_image, linear. PNG and JPEG: R G B after exposure and display
  /// transform; returns their exposure. Throws InputError if the file cannot be written.
  std::optional<AppliedExposure> write(const Film& film, const ImageFormat& format) const;

  /// True if `write` rounds colours or bands to 16-bit floats.
  bool rounds_to_halves(const Film& film) const;

  const std::string& path() const { return path_; }
  const DisplayChoice& display() const { return display_; }

 private:
  std::string path_;
  DisplayChoice display_;
  ColorManager colors_;
};

}  // namespace frond
