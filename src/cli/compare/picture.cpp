#include "cli/compare/picture.h"

#include <cmath>

#include "cli/smpte_luminance.h"

namespace frond::compare {

Picture picture_of(const Film& film, std::string_view film_space, const ColorManager& colors) {
  const Crop& crop = film.settings().crop;
  std::vector<float> rgb;
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x)
      for (const double v : film.mean(x, y)) rgb.push_back(float(v));
  colors.convert(rgb, film_space, kErrorSpace);
  Picture picture{crop.width(), crop.height(), {}};
  for (size_t i = 0; i < rgb.size(); i += 3) {
    for (size_t c = 0; c < 3; ++c) picture.channels[c].push_back(rgb[i + c]);
    picture.channels[3].push_back(smpte_luminance(rgb[i], rgb[i + 1], rgb[i + 2]));
  }
  return picture;
}

Picture mean_of(const Picture& a, const Picture& b) {
  Picture mean = a;
  for (size_t c = 0; c < mean.channels.size(); ++c)
    for (size_t i = 0; i < mean.channels[c].size(); ++i)
      mean.channels[c][i] = (a.channels[c][i] + b.channels[c][i]) / 2;
  return mean;
}

std::vector<float> interleaved(const Picture& picture) {
  std::vector<float> rgb;
  for (size_t i = 0; i < picture.channels[0].size(); ++i)
    for (size_t c = 0; c < 3; ++c) rgb.push_back(picture.channels[c][i]);
  return rgb;
}

DisplayImage display_image(const Picture& picture, double exposure_stops, const ColorManager& colors) {
  DisplayImage image{picture.width, picture.height, interleaved(picture)};
  const float factor = float(std::exp2(exposure_stops));
  for (float& v : image.rgb) v *= factor;
  colors.convert(image.rgb, kErrorSpace, "linear sRGB");
  return image;
}

std::vector<float> leaf_mask(const Film& film) {
  const Crop& crop = film.settings().crop;
  std::vector<float> mask;
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x) mask.push_back(float(film.leaf_fraction(x, y)));
  return mask;
}

}  // namespace frond::compare
