#include "study/compare/film_images.h"

#include <algorithm>
#include <cmath>

#include "study/smpte_luminance.h"

namespace frond::compare {

namespace {

template <class Each>
void for_each_pixel(const Film& film, const Each& each) {
  const Crop& crop = film.settings().crop;
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x) each(x, y);
}

Image image_of_colors(const Film& film, std::string_view film_space, const ColorManager& colors) {
  std::vector<float> rgb;
  for_each_pixel(film, [&](int x, int y) {
    for (const double v : film.mean(x, y)) rgb.push_back(float(v));
  });
  colors.convert(rgb, film_space, kErrorSpace);
  const Crop& crop = film.settings().crop;
  Image image(crop.width(), crop.height(), {"R", "G", "B", "Y"});
  auto to = image.pixels.begin();
  for (auto from = rgb.begin(); from != rgb.end(); from += 3) {
    to = std::copy_n(from, 3, to);
    *to++ = smpte_luminance(from[0], from[1], from[2]);
  }
  return image;
}

Image image_of_bands(const Film& film, const ChannelList& list) {
  const Crop& crop = film.settings().crop;
  Image image(crop.width(), crop.height(), {list.names.begin() + kFirst, list.names.end()});
  auto to = image.pixels.begin();
  for_each_pixel(film, [&](int x, int y) {
    for (size_t b = 0; b < list.bands.size(); ++b) *to++ = float(film.band_mean(x, y, b).mean / list.white[b]);
  });
  return image;
}

}  // namespace

Image image_of(const Film& film, const Scene& scene, const ChannelList& list, const ColorManager& colors) {
  return list.are_bands() ? image_of_bands(film, list)
                          : image_of_colors(film, scene.wavelengths().film_space(), colors);
}

Image shown(const Image& image, const ChannelList& list) {
  const size_t pixels = size_t(image.width) * size_t(image.height), channels = image.channels.size();
  Image rgb(image.width, image.height, {"R", "G", "B"});
  for (size_t c = 0; c < list.film_channels(); ++c)
    for (size_t k = 0; k < 3; ++k)
      if (const auto share = float(list.shown[c][k]); share != 0)
        for (size_t i = 0; i < pixels; ++i) rgb.pixels[3 * i + k] += share * image.pixels[channels * i + c];
  return rgb;
}

Image mean_of(const Image& a, const Image& b) {
  Image mean = a;
  for (size_t i = 0; i < mean.pixels.size(); ++i) mean.pixels[i] = (a.pixels[i] + b.pixels[i]) / 2;
  return mean;
}

double fitting_exposure(const Image& shown) {
  constexpr double kTarget = 0.3, kBrightest = 0.1, kMostStops = 20;
  std::vector<float> lit;
  for (size_t i = 0; i < shown.pixels.size(); i += 3)
    if (const float y = smpte_luminance(shown.pixels[i], shown.pixels[i + 1], shown.pixels[i + 2]); y > 0)
      lit.push_back(y);
  if (lit.empty()) return 0;
  const auto place = lit.begin() + ptrdiff_t(double(lit.size() - 1) * (1 - kBrightest));
  std::ranges::nth_element(lit, place);
  return std::clamp(std::round(std::log2(kTarget / double(*place))), -kMostStops, kMostStops);
}

Image display_image(const Image& shown, double exposure_stops, const ColorManager& colors) {
  Image image = shown;
  const float factor = float(std::exp2(exposure_stops));
  for (float& v : image.pixels) v *= factor;
  colors.convert(image.pixels, kErrorSpace, "linear sRGB");
  return image;
}

std::vector<float> leaf_mask(const Film& film) {
  std::vector<float> mask;
  for_each_pixel(film, [&](int x, int y) { mask.push_back(float(film.leaf_fraction(x, y))); });
  return mask;
}

}  // namespace frond::compare
