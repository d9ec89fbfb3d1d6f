#include "study/compare/picture.h"

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

Picture picture_of_colors(const Film& film, std::string_view film_space, const ColorManager& colors) {
  std::vector<float> rgb;
  for_each_pixel(film, [&](int x, int y) {
    for (const double v : film.mean(x, y)) rgb.push_back(float(v));
  });
  colors.convert(rgb, film_space, kErrorSpace);
  const Crop& crop = film.settings().crop;
  Picture picture{crop.width(), crop.height(), std::vector<std::vector<float>>(4)};
  for (size_t i = 0; i < rgb.size(); i += 3) {
    for (size_t c = 0; c < 3; ++c) picture.channels[c].push_back(rgb[i + c]);
    picture.channels[3].push_back(smpte_luminance(rgb[i], rgb[i + 1], rgb[i + 2]));
  }
  return picture;
}

Picture picture_of_bands(const Film& film, const ChannelList& list) {
  const Crop& crop = film.settings().crop;
  Picture picture{crop.width(), crop.height(), std::vector<std::vector<float>>(list.bands.size())};
  for_each_pixel(film, [&](int x, int y) {
    for (size_t b = 0; b < list.bands.size(); ++b)
      picture.channels[b].push_back(float(film.band_mean(x, y, b).mean / list.white[b]));
  });
  return picture;
}

}  // namespace

Picture picture_of(const Film& film, const Scene& scene, const ChannelList& list, const ColorManager& colors) {
  return list.are_bands() ? picture_of_bands(film, list)
                          : picture_of_colors(film, scene.wavelengths().film_space(), colors);
}

Picture shown(const Picture& picture, const ChannelList& list) {
  const size_t pixels = picture.channels[0].size();
  Picture rgb{picture.width, picture.height, {3, std::vector<float>(pixels)}};
  for (size_t c = 0; c < list.film_channels(); ++c)
    for (size_t k = 0; k < 3; ++k)
      if (const auto share = float(list.shown[c][k]); share != 0)
        for (size_t i = 0; i < pixels; ++i) rgb.channels[k][i] += share * picture.channels[c][i];
  return rgb;
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

double fitting_exposure(const Picture& shown) {
  constexpr double kTarget = 0.3, kBrightest = 0.1, kMostStops = 20;
  std::vector<float> lit;
  for (size_t i = 0; i < shown.channels[0].size(); ++i)
    if (const float y = smpte_luminance(shown.channels[0][i], shown.channels[1][i], shown.channels[2][i]); y > 0)
      lit.push_back(y);
  if (lit.empty()) return 0;
  const auto place = lit.begin() + ptrdiff_t(double(lit.size() - 1) * (1 - kBrightest));
  std::ranges::nth_element(lit, place);
  return std::clamp(std::round(std::log2(kTarget / double(*place))), -kMostStops, kMostStops);
}

DisplayImage display_image(const Picture& picture, double exposure_stops, const ColorManager& colors) {
  DisplayImage image{picture.width, picture.height, interleaved(picture)};
  const float factor = float(std::exp2(exposure_stops));
  for (float& v : image.rgb) v *= factor;
  colors.convert(image.rgb, kErrorSpace, "linear sRGB");
  return image;
}

std::vector<float> leaf_mask(const Film& film) {
  std::vector<float> mask;
  for_each_pixel(film, [&](int x, int y) { mask.push_back(float(film.leaf_fraction(x, y))); });
  return mask;
}

}  // namespace frond::compare
