#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/plugin_module.h"
#include "spectra/cie.h"

namespace led {
namespace {

using namespace frond;

constexpr Param kParams[] = {
    {.name = "I",
     .kind = ParamKind::illuminant,
     .default_value = std::array<double, 3>{1, 1, 1},
     .doc = "Radiant intensity along the axis; spectra are normalised to luminance 1."},
    {.name = "scale", .kind = ParamKind::real, .default_value = 1, .range = kAtLeastZero, .doc = "Factor."},
    {.name = "from", .kind = ParamKind::point3, .default_value = std::array<double, 3>{0, 0, 0}, .doc = "Position."},
    {.name = "to",
     .kind = ParamKind::point3,
     .default_value = std::array<double, 3>{0, 0, 1},
     .doc = "Point on the axis of the beam."},
    {.name = "beamangle",
     .kind = ParamKind::real,
     .default_value = 120,
     .unit = "degrees",
     .range = {1, 120},
     .doc = "Full angle at half the intensity, as data sheets have it; 120: a bare chip, by Lambert's law."},
};

/// A point that shines with the intensity I cos^m of the angle from its axis, as LEDs are modelled (Moreno and Sun 2008).
class Led final : public Light {
 public:
  Led(const Params& p, const Transform& world_from_light)
      : intensity_(p.spectrum("I")),
        scale_(float(p.real("scale"))),
        position_(world_from_light.point(p.vec3("from"))),
        exponent_(std::log(0.5) / std::log(std::cos(p.real("beamangle") / 2 * std::numbers::pi / 180))) {
    const Vec3 from = p.vec3("from"), to = p.vec3("to");
    if (from == to) fail(p.where("to"), "\"from\" and \"to\" are the same point: the light has no direction");
    axis_ = normalize_any(world_from_light.vector(to - from));
  }

  std::optional<LightSample> sample(const Vec3& p, Vec2, const SampledWavelengths& lambda) const override {
    const Vec3 d = position_ - p;
    const float distance = length(d);
    if (distance == 0) return {};
    const Vec3 wi = d / distance;
    const float cos_angle = -dot(wi, axis_);
    if (cos_angle <= 0) return {};
    const float intensity = scale_ * std::pow(cos_angle, float(exponent_));
    return LightSample{intensity_->sample(lambda) * (intensity / (distance * distance)), wi, distance, 1};
  }
  bool is_delta() const override { return true; }
  double power(float) const override {
    return photometric(*intensity_) * double(scale_) * 2 * std::numbers::pi / (exponent_ + 1);
  }
  std::optional<LightBounds> bounds() const override {
    return LightBounds{.min = position_, .max = position_, .axis = axis_, .cos_spread = 1, .cos_reach = 0};
  }
  const Spectrum& emission() const override { return *intensity_; }

 private:
  SpectrumPtr intensity_;
  float scale_;
  Vec3 position_, axis_;
  double exponent_;
};

const LightInfo kLed{{"light", "led", "A lamp whose beam has a width.",
                      "Moreno and Sun 2008, Modeling the radiation pattern of LEDs", kParams},
                     make_light<Led>};
const LightInfo* const kLights[] = {&kLed};

}  // namespace
}  // namespace led

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module{.lights = led::kLights};
  return &module;
}
