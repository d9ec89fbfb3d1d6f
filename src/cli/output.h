#pragma once

#include <map>
#include <string>

#include "core/wavelengths.h"
#include "scene/film.h"
#include "scene/image_file.h"
#include "spectra/color_management.h"

namespace frond {

/// Which OpenColorIO display and view a PNG or JPEG goes through; empty: the configuration's defaults.
struct DisplayChoice {
  std::string display, view;
};

struct OutputDetails {
  std::string film_space;   ///< of the film's channels; empty: they are bands
  std::vector<Band> bands;  ///< of a film of bands
  std::string color_space;  ///< what the scene asks for, by linear name; empty: the film's own, linear sRGB for XYZ
  std::map<std::string, std::string> attributes;
};

/// Refuses names that OpenColorIO does not know, and any for an EXR, which holds linear values. Throws InputError.
void check_display_choice(const std::string& path, const ColorManager& colors, const DisplayChoice& choice);

/// R, G and B of an image that is linear in `space`, through a display transform, as PNG or JPEG.
void write_display_image(const std::string& path, const Image& image, std::string_view space,
                         const ColorManager& colors, const DisplayChoice& choice,
                         const std::map<std::string, std::string>& text);

/// Where a render goes. Made before rendering, so that what cannot be written is refused first.
class ImageOutput {
 public:
  /// Throws InputError when the path cannot be written, and as check_display_choice does.
  ImageOutput(std::string path, DisplayChoice display);

  /// Throws what `write` would throw for bands in a PNG or JPEG. Empty: the film's channels are bands.
  void check_channels(std::string_view film_space) const;

  /// Throws what `write` would throw for a display, a view or a colour space that OpenColorIO does not know, and for
  /// bands in a PNG or JPEG.
  void check(const OutputDetails& details) const;

  /// EXR: R G B, the variance of their means and the share of leaf, linear; or bands (spectral_image.h). PNG and JPEG:
  /// R G B through the display transform. Throws InputError when the image does not reach the disk.
  void write(const Film& film, const OutputDetails& details) const;

 private:
  void write_bands(const Film& film, const OutputDetails& details) const;
  void write_exr(const Film& film, const Image& image, const std::string& space,
                 const std::map<std::string, std::string>& attributes) const;

  std::string path_;
  DisplayChoice display_;
  ColorManager colors_;
};

}  // namespace frond
