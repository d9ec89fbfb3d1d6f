#include "cli/output.h"

#include "cli/spectral_image.h"
#include "core/error.h"
#include "scene/image_file.h"
#include "spectra/matrix3.h"

namespace frond {
namespace {

/// Rows of the matrix that the manager's conversion is, found by converting the unit vectors.
Matrix3 matrix_of(const ColorManager& colors, std::string_view from, std::string_view to) {
  std::array<float, 9> unit{1, 0, 0, 0, 1, 0, 0, 0, 1};
  colors.convert(unit, from, to);
  Matrix3 m;
  for (size_t column = 0; column < 3; ++column)
    for (size_t row = 0; row < 3; ++row) m.row[row][column] = double(unit[3 * column + row]);
  return m;
}

/// Diagonal of m c m^T; the covariance c as 00 11 22 01 02 12.
Triple variance_after(const Matrix3& m, const std::array<double, 6>& c) {
  Triple v{};
  for (size_t i = 0; i < 3; ++i) {
    const Triple& r = m.row[i];
    v[i] = r[0] * r[0] * c[0] + r[1] * r[1] * c[1] + r[2] * r[2] * c[2] +
           2 * (r[0] * r[1] * c[3] + r[0] * r[2] * c[4] + r[1] * r[2] * c[5]);
  }
  return v;
}

/// Brighter values than the file can hold become its largest, not infinite.
float held(double value, double largest) { return float(std::clamp(value, -largest, largest)); }

Image linear_image(const Film& film, const Matrix3& to_output) {
  const double largest = film.settings().largest_value();
  const Crop& crop = film.settings().crop;
  Image image(crop.width(), crop.height(), {"R", "G", "B", "variance.R", "variance.G", "variance.B", "leaf"});
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Triple rgb = to_output * film.mean(crop.x0 + x, crop.y0 + y);
      const Triple variance = variance_after(to_output, film.covariance(crop.x0 + x, crop.y0 + y));
      for (size_t c = 0; c < 3; ++c) {
        image.at(x, y, c) = held(rgb[c], largest);
        image.at(x, y, 3 + c) = held(variance[c], largest);
      }
      image.at(x, y, 6) = float(film.leaf_fraction(crop.x0 + x, crop.y0 + y));
    }
  return image;
}

/// What the image's R, G and B are in, before any display transform.
std::string linear_space(const OutputDetails& details) {
  const std::string& space = details.color_space.empty() ? details.film_space : details.color_space;
  return space == kXyzName ? "linear sRGB" : space;
}

}  // namespace

void check_display_choice(const std::string& path, const ColorManager& colors, const DisplayChoice& choice) {
  if (!is_exr(path)) return colors.check_names(choice.display, choice.view);
  if (!choice.display.empty() || !choice.view.empty())
    fail({}, "--display and --view are for .png and .jpg: {} holds linear values", path);
}

void write_display_image(const std::string& path, const Image& image, std::string_view space,
                         const ColorManager& colors, const DisplayChoice& choice,
                         const std::map<std::string, std::string>& text) {
  Image shown(image.width, image.height, {"R", "G", "B"});
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < 3; ++c) shown.at(x, y, c) = image.at(x, y, c);
  colors.display(shown.pixels, space, choice.display, choice.view);
  write_image(path, shown, {.color_space = "", .text = text});
}

ImageOutput::ImageOutput(std::string path, DisplayChoice display)
    : path_(std::move(path)), display_(std::move(display)) {
  check_writable(path_);
  check_display_choice(path_, colors_, display_);
}

void ImageOutput::check(const OutputDetails& details) const {
  check_channels(details.film_space);
  if (details.film_space.empty()) return;
  const std::string space = linear_space(details);
  matrix_of(colors_, details.film_space, space);
  if (!is_exr(path_)) colors_.check_display(space, display_.display, display_.view);
}

void ImageOutput::check_channels(std::string_view film_space) const {
  if (film_space.empty() && !is_exr(path_))
    fail({}, "{}: bands are no picture, and go to an .exr file; frond convert --bands makes a picture of three of them",
         path_);
}

void ImageOutput::write(const Film& film, const OutputDetails& details) const {
  if (details.film_space.empty()) {
    write_bands(film, details);
    return;
  }
  const std::string space = linear_space(details);
  const Image image = linear_image(film, matrix_of(colors_, details.film_space, space));
  if (is_exr(path_))
    write_exr(film, image, space, details.attributes);
  else
    write_display_image(path_, image, space, colors_, display_, details.attributes);
}

void ImageOutput::write_bands(const Film& film, const OutputDetails& details) const {
  check_channels(details.film_space);
  auto attributes = spectral_attributes(details.bands);
  attributes.insert(details.attributes.begin(), details.attributes.end());
  write_exr(film, spectral_image(film, details.bands), preview_space(details.bands), attributes);
}

void ImageOutput::write_exr(const Film& film, const Image& image, const std::string& space,
                            const std::map<std::string, std::string>& attributes) const {
  const FilmSettings& settings = film.settings();
  write_image(path_, image, {space, attributes, settings.crop.x0, settings.crop.y0, settings.width, settings.height},
              settings.half ? ExrDepth::half : ExrDepth::single);
}

}  // namespace frond
