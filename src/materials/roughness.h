#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "core/params.h"
#include "core/texture.h"
#include "materials/lobes/trowbridge_reitz.h"

namespace frond {

/// Names of the parameters of one surface's roughness, which differ between materials.
struct RoughnessNames {
  std::string_view both, u, v;
};
inline constexpr RoughnessNames kRoughnessNames{"roughness", "uroughness", "vroughness"};

/// The parameters themselves.
constexpr std::array<Param, 3> roughness_params(const RoughnessNames& names) {
  return {Param{.name = names.both,
                .kind = ParamKind::float_texture,
                .default_value = 0.0,
                .range = kAtLeastZero,
                .doc = "Roughness of the surface: the square of alpha, the width of the facets' slopes. 0: smooth."},
          Param{.name = names.u,
                .kind = ParamKind::float_texture,
                .range = kAtLeastZero,
                .doc = "Roughness along u; by default the surface's roughness."},
          Param{.name = names.v,
                .kind = ParamKind::float_texture,
                .range = kAtLeastZero,
                .doc = "Roughness along v; by default the surface's roughness."}};
}

inline constexpr Param kRemapRoughness{.name = "remaproughness",
                                       .kind = ParamKind::boolean,
                                       .default_value = true,
                                       .doc = "Use the square root of roughness as alpha; false: roughness itself."};

/// Roughness of a surface, by point, from its parameters.
class Roughness {
 public:
  Roughness(const Params& p, const RoughnessNames& names)
      : u_(p.float_texture(p.given(names.u) ? names.u : names.both)),
        v_(p.float_texture(p.given(names.v) ? names.v : names.both)),
        remap_(p.boolean("remaproughness")),
        // Equal constants along u and v are isotropic, so no direction of u is needed.
        is_along_u_((p.given(names.u) || p.given(names.v)) &&
                    !(u_->is_constant() && v_->is_constant() && u_->range().min == v_->range().min)) {
    p.float_texture(names.both);  // checked even where it does not count
  }

  /// Facets at a point; alpha = sqrt(roughness) if roughness is remapped.
  TrowbridgeReitz at(const TexturePoint& point) const {
    const float u = u_->evaluate(point);
    return {alpha(u), alpha(is_along_u_ ? v_->evaluate(point) : u)};
  }
  /// Whether the roughness is anisotropic, which requires the direction of u.
  bool has_direction() const { return is_along_u_; }

 private:
  // pbrt-v4's RoughnessToAlpha.
  float alpha(float roughness) const { return remap_ ? std::sqrt(std::max(0.f, roughness)) : roughness; }

  std::shared_ptr<const FloatTexture> u_, v_;
  bool remap_, is_along_u_;
};

/// Concatenates tables of parameters.
template <size_t... N>
constexpr auto joined(const std::array<Param, N>&... parts) {
  std::array<Param, (N + ...)> all{};
  auto end = all.begin();
  ((end = std::ranges::copy(parts, end).out), ...);
  return all;
}

}  // namespace frond
