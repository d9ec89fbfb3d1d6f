#include "models/gltf_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace frond {
namespace {

using Json = nlohmann::json;
using std::numbers::pi;

/// Adds a loss, and returns nothing.
std::nullopt_t report_lost(GltfLosses& losses, const std::string& what) {
  losses.add(what);
  return std::nullopt;
}

}  // namespace

/// Intensities are photometric: cd of points and spots, lx of directional lights; the defaults are the extension's.
std::optional<ImportedLight> gltf_light(const Json& document, const Json& node, GltfLosses& losses) {
  const Json *use = extension(node, "KHR_lights_punctual"), *all = extension(document, "KHR_lights_punctual");
  if (!use) return {};
  const Json* light = all ? element(*all, "lights", integer(*use, "light")) : nullptr;
  if (!light) return report_lost(losses, "light that does not exist (KHR_lights_punctual)");
  losses.check("light", *light);
  const std::string_view type = text(*light, "type");
  ImportedLight result;
  if (type == "directional")
    result.type = ImportedLight::Type::distant;
  else if (type == "spot")
    result.type = ImportedLight::Type::spot;
  else if (type != "point")
    return report_lost(losses, "light of an unknown type (KHR_lights_punctual)");
  const auto color = numbers(*light, "color", {1, 1, 1});
  const double intensity = number(*light, "intensity", 1);
  for (size_t i = 0; i < 3; ++i) result.color[i] = std::max(color[i] * intensity, 0.);
  if (result.type != ImportedLight::Type::spot) return result;
  static const Json kNone = Json::object();
  const Json* spot = member(*light, "spot");
  if (spot) losses.check("spot", *spot);
  result.outer = std::clamp(number(spot ? *spot : kNone, "outerConeAngle", pi / 4), 1e-3, pi / 2);
  result.inner = std::clamp(number(spot ? *spot : kNone, "innerConeAngle", 0), 0., result.outer);
  return result;
}

/// Without an aspect ratio the image is square.
std::optional<ImportedCamera> gltf_camera(const Json& document, const Json& node, GltfLosses& losses) {
  if (!member(node, "camera")) return {};
  const Json* camera = element(document, "cameras", integer(node, "camera"));
  if (!camera) return report_lost(losses, "camera that does not exist");
  losses.check("camera", *camera);
  const bool is_orthographic = text(*camera, "type") == "orthographic";
  const char* const kind = is_orthographic ? "orthographic" : "perspective";
  const Json* lens = member(*camera, kind);
  if (lens) losses.check(kind, *lens);
  ImportedCamera result{.is_orthographic = is_orthographic};
  if (lens && is_orthographic) {
    result.half = {std::abs(number(*lens, "xmag", 0)), std::abs(number(*lens, "ymag", 0))};
  } else if (lens) {
    const double y = std::tan(std::min(number(*lens, "yfov", 0), pi) / 2);
    result.half = {y * number(*lens, "aspectRatio", 1), y};
  }
  constexpr double kLeast = 1e-6, kMost = 1e6;
  const auto is_usable = [](double v) { return v > kLeast && v < kMost; };
  if (!std::ranges::all_of(result.half, is_usable) ||
      std::abs(std::log(result.half[0] / result.half[1])) > std::log(100))
    return report_lost(losses, "camera without a usable field of view");
  return result;
}

}  // namespace frond
