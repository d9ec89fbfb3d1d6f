#include "lights/light_params.h"

#include <fmt/format.h>

#include <limits>

#include "core/error.h"

namespace frond {

std::optional<double> stated_total(const Params& p, std::string_view name) {
  if (!p.given(name)) return {};
  const double total = p.real(name);
  if (total > 0) return total;
  p.warn(name, fmt::format("\"{}\" {} counts as not given, as in pbrt-v4: the light has its own", name, total));
  return {};
}

/// `unit_total` is the total at scale 1. Throws InputError if it is 0, or if the scale is too large for a float.
float light_scale(const Params& p, std::string_view total, double unit_total) {
  const std::optional<double> stated = stated_total(p, total);
  if (!stated) return float(p.real("scale"));
  if (!(unit_total > 0)) fail(p.where(total), "the light is black: it has no {} to scale", total);
  const double scale = p.real("scale") * *stated / unit_total;
  if (!(scale <= double(std::numeric_limits<float>::max())))
    fail(p.where(total), "the light has the {} {:.4g} at scale 1: the factor to the stated one is beyond {:.2g}", total,
         unit_total, std::numeric_limits<float>::max());
  return float(scale);
}

}  // namespace frond
