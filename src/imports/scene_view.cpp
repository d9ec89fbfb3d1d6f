#include "imports/scene_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/precise_transform.h"

namespace frond {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// Returns the nearest point from which a camera with this field of view (tangent of its half) sees the whole bounding
/// box, with a margin. `toward` is the direction to the camera.
Vec3d viewpoint(const PlantGeometry& geometry, const Vec3d& toward, double tangent) {
  constexpr double kMargin = 1.05;
  const Vec3d center = (geometry.least + geometry.most) / 2.0, half = (geometry.most - geometry.least) / 2.0;
  const Vec3d right = normalize(cross(Vec3d{0, 0, 1}, toward)), up = cross(toward, right);
  double distance = 1e-6;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p{corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z};
    const double off_axis = std::max(std::abs(dot(p, right)), std::abs(dot(p, up)));
    distance = std::max(distance, off_axis * kMargin / tangent + dot(p, toward));
  }
  return center + toward * distance;
}

/// Returns coordinates with the digits of 32-bit floats, or to a tenth of a millimetre if that is more.
std::string digits(const Vec3d& p) {
  const auto number = [](double x) { return is_far({x, 0, 0}) ? fmt::format("{:.4f}", x) : fmt::format("{:.9g}", x); };
  return fmt::format("{} {} {}", number(p.x), number(p.y), number(p.z));
}

/// Where a light or a camera is in the scene, and its axes -z and y, of any length.
struct Placement {
  Vec3d at, forward, up;
  Placement(const std::array<double, 12>& to_world, const NodeMap& to_scene, const Vec3d& origin) {
    const NodeMap map = to_scene.after({to_world});
    at = map.point({0, 0, 0}) + origin;
    forward = map.vector({0, 0, -1});
    up = map.vector({0, 1, 0});
  }
};

/// LookAt, camera and film by the model's camera. The longer side of the image has 800 pixels.
std::string camera_of(const ImportedCamera& camera, const Placement& place, double scale, const std::string& stem) {
  constexpr double kPixels = 800;
  const auto [x, y] = camera.half;
  const double longer = std::max(x, y);
  const std::string kind =
      camera.is_orthographic
          ? fmt::format("\"orthographic\" \"float screenwindow\" [ {0:.9g} {1:.9g} {2:.9g} {3:.9g} ]", -x * scale,
                        x * scale, -y * scale, y * scale)
          : fmt::format("\"perspective\" \"float fov\" {:.9g}", 2 * std::atan(std::min(x, y)) * kDegrees);
  return fmt::format(
      "LookAt {}   {}   {}\n"
      "Camera {}\n"
      "Film \"rgb\" \"integer xresolution\" {} \"integer yresolution\" {} \"string filename\" \"{}.png\"\n",
      digits(place.at), digits(place.at + normalize(place.forward)), digits(normalize(place.up)), kind,
      std::max(std::lround(kPixels * x / longer), 1l), std::max(std::lround(kPixels * y / longer), 1l), stem);
}

/// Camera that sees all of the model, from the front (-y) and above.
std::string default_camera(const PlantGeometry& geometry, const std::string& stem) {
  constexpr double kTangent = 0.2679491924;  // of half the field of view, 15 degrees
  const Vec3d center = (geometry.least + geometry.most) / 2.0;
  return fmt::format(
      "LookAt {}   {}   0 0 1\n"
      "Camera \"perspective\" \"float fov\" 30\n"
      "Film \"rgb\" \"integer xresolution\" 800 \"integer yresolution\" 800 \"string filename\" \"{}.png\"\n",
      digits(viewpoint(geometry, normalize(Vec3d{0.35, -1, 0.35}), kTangent) + geometry.origin),
      digits(center + geometry.origin), stem);
}

/// An intensity grows with the square of lengths, so that the model is lit as in its own units.
std::string light_of(const ImportedLight& light, const Placement& place, double scale) {
  const auto color = [&light](const char* name, double factor) {
    return fmt::format("\"rgb {}\" [ {:.9g} {:.9g} {:.9g} ]", name, light.color[0] * factor, light.color[1] * factor,
                       light.color[2] * factor);
  };
  const Vec3d forward = normalize(place.forward);
  if (light.type == ImportedLight::Type::distant)
    return fmt::format("LightSource \"distant\" {} \"point3 from\" [ 0 0 0 ] \"point3 to\" [ {} ]\n", color("L", 1),
                       digits(forward));
  const std::string from = fmt::format("{} \"point3 from\" [ {} ]", color("I", scale * scale), digits(place.at));
  if (light.type == ImportedLight::Type::point) return fmt::format("LightSource \"point\" {}\n", from);
  return fmt::format(
      "LightSource \"spot\" {} \"point3 to\" [ {} ] \"float coneangle\" {:.9g} \"float conedeltaangle\" {:.9g}\n", from,
      digits(place.at + forward), light.outer * kDegrees, (light.outer - light.inner) * kDegrees);
}

}  // namespace

/// The sky has an even radiance of 0.4 and a sun; a horizontal white surface has the value 1 in both.
std::string scene_view(const ImportedScene& scene, const PlantGeometry& geometry, const NodeMap& to_scene, double scale,
                       const std::string& stem) {
  const auto placement = [&](const auto& object) { return Placement(object.to_world, to_scene, geometry.origin); };
  std::string text = "Scale -1 1 1  # right-handed space\n";
  text += scene.cameras.empty() ? default_camera(geometry, stem)
                                : camera_of(scene.cameras[0], placement(scene.cameras[0]), scale, stem);
  text +=
      "Sampler \"lattice\" \"integer pixelsamples\" 64\n"
      "Integrator \"path\" \"integer maxdepth\" 64\n\n"
      "WorldBegin\n\n";
  if (scene.lights.empty())
    return text +
           "# Sun and sky: a horizontal white surface has the value 1. Without \"illuminance\" they are in physical "
           "units.\n"
           "LightSource \"sky\" \"float elevation\" 50 \"float azimuth\" 230 \"float albedo\" 0.2 \"float "
           "illuminance\" "
           "3.14159\n\n";
  text += "# The model's lights, in cd and lx: frond render --exposure auto makes the image visible.\n";
  for (const ImportedLight& light : scene.lights) text += light_of(light, placement(light), scale);
  return text + "\n";
}

}  // namespace frond
