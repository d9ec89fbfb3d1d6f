#include "media/medium_params.h"

#include <algorithm>

#include "spectra/analytic.h"

namespace frond {

Coefficients::Coefficients(const Params& p)
    : Coefficients(p.spectrum("sigma_a"), p.spectrum("sigma_s"), find_param(p.info(), "scale") ? p.real("scale") : 1) {}

/// "temperatureoffset" takes precedence over its older name.
Temperature::Temperature(const Params& p) : scale_(float(p.real("temperaturescale"))) {
  const bool is_old = p.given("temperaturecutoff") && !p.given("temperatureoffset");
  offset_ = float(p.real(is_old ? "temperaturecutoff" : "temperatureoffset"));
}

SampledSpectrum Temperature::emission(float value, const SampledWavelengths& lambda) const {
  // Above 1e6 K the shape of a visible spectrum does not change: the Rayleigh-Jeans limit.
  constexpr float kLeast = 100, kMost = 1e6f;  // kelvin
  const float kelvin = (value - offset_) * scale_;
  if (!(kelvin > kLeast)) return {};
  return BlackbodySpectrum(double(std::min(kelvin, kMost))).sample(lambda);
}

MediumBox medium_box(const Params& p, const Transform& world_from_medium) {
  Bounds bounds;
  bounds.add(p.vec3("p0"));
  bounds.add(p.vec3("p1"));
  for (int axis = 0; axis < 3; ++axis)
    if (!(bounds.min[axis] < bounds.max[axis]))
      fail(p.where("p1"), "the box from \"p0\" to \"p1\" has no extent along {}", "xyz"[axis]);
  return {bounds, world_from_medium};
}

std::array<int, 3> grid_size(const Params& p, std::string_view name, size_t unit) {
  const std::array<int, 3> n{p.integer("nx"), p.integer("ny"), p.integer("nz")};
  const double needed = double(n[0]) * n[1] * n[2];
  const size_t count = p.reals(name).size() / unit;
  if (double(count) != needed)
    fail(p.where(name), "\"{}\" has {} values, nx ny nz = {} x {} x {} = {:.0f} are needed", name, count, n[0], n[1],
         n[2], needed);
  return n;
}

}  // namespace frond
