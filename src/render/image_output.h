#pragma once

#include "image/display_image.h"
#include "render/film/image_format.h"

namespace frond {

/// Where a render goes. Made before rendering, so that what cannot be written is refused first.
class ImageOutput {
 public:
  /// Throws InputError when the path cannot be written, and as check_display_choice does.
  ImageOutput(std::string path, DisplayChoice display);

  /// Throws what `write` would throw for bands in a PNG or JPEG. Empty: the film's channels are bands.
  void check_channels(std::string_view film_space) const;

  /// Throws what `write` would throw for a display or a view that does not go with the image's colours, and for bands
  /// in a PNG or JPEG.
  void check(const ImageFormat& format) const;

  /// EXR: all channels of film_image, linear. PNG and JPEG: R G B through the display transform. Throws InputError when
  /// the image does not reach the disk.
  void write(const Film& film, const ImageFormat& format) const;

  /// Whether `write` rounds the film's colours, or bands, to halves.
  bool rounds_to_halves(const Film& film) const;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  DisplayChoice display_;
  ColorManager colors_;
};

}  // namespace frond
