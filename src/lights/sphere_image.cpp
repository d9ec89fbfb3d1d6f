#include "lights/sphere_image.h"

#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/math/equal_area.h"
#include "lights/light_params.h"

namespace frond {
namespace {

/// pbrt-v4's measure of the illuminance of an image's upper half. It is half of the actual illuminance.
double illuminance_of(const ColorImage& file) {
  const std::vector<float> luminances = luminances_of(file);
  const auto width = size_t(file.image.width);
  double sum = 0;
  for (size_t i = 0; i < luminances.size(); ++i) {
    const Vec2 center{float(i % width) + 0.5f, float(i / width) + 0.5f};
    const float cosine = sphere_from_square(center * (1 / float(width))).z;
    if (cosine > 0) sum += double(luminances[i]) * double(cosine);
  }
  return sum * 2 * std::numbers::pi / double(luminances.size());
}

}  // namespace

ColorImage read_sphere_image(const Params& p) {
  ColorImage file = read_light_image(p);
  const Image& image = file.image;
  if (image.width != image.height)
    fail(p.where("filename"),
         "the image is {} x {}: an environment is square, in pbrt-v4's equal-area map of the sphere; pbrt-v4's "
         "\"imgtool makeequiarea\" makes one of a map by latitude and longitude",
         image.width, image.height);
  return file;
}

/// As in pbrt-v4, the actual illuminance is twice the stated one, which a warning reports.
float sphere_image_scale(const Params& p, const ColorImage& file) {
  const std::optional<double> stated = stated_total(p, "illuminance");
  if (!stated) return float(p.real("scale"));
  const double own = illuminance_of(file);
  if (!(own > 0)) fail(p.where("illuminance"), "the upper half of the image is black: it has no illuminance to scale");
  p.warn("illuminance", "as in pbrt-v4, a surface under the upper half of the image gets twice this illuminance");
  const double scale = p.real("scale") * *stated / own;
  if (!(scale <= double(std::numeric_limits<float>::max())))
    fail(p.where("illuminance"), "the image has the illuminance {:.4g}: the factor to the stated one is beyond {:.2g}",
         own, std::numeric_limits<float>::max());
  return float(scale);
}

}  // namespace frond
