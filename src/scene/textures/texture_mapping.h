#pragma once

#include <array>
#include <utility>

#include "core/params.h"
#include "core/texture.h"

namespace frond {

/// Where a point lies in a texture of two dimensions, and how that changes over the footprint.
struct TextureCoordinates {
  Vec2 st, dst_dx, dst_dy;
};

/// How textures of two dimensions are laid on surfaces: by the surface's (u, v), or by the point in the texture's
/// space.
class TextureMapping {
 public:
  TextureMapping(const Params& p, const TexturePlacement& placement);
  /// Reads the point; (u, v) alone takes none, but for filters.
  bool needs_point() const { return kind_ != Kind::uv; }
  TextureCoordinates at(const TexturePoint& point) const;

 private:
  enum class Kind : uint8_t { uv, planar, spherical, cylindrical };
  TextureCoordinates of_point(const TexturePoint& point) const;

  Kind kind_ = Kind::uv;
  Vec2 scale_, delta_;
  Vec3 v1_, v2_;
  Transform texture_from_world_;
};

inline TextureCoordinates TextureMapping::at(const TexturePoint& p) const {
  if (kind_ != Kind::uv) return of_point(p);
  const auto scaled = [this](Vec2 v) { return Vec2{scale_.x * v.x, scale_.y * v.y}; };
  return {scaled(p.uv) + delta_, scaled(p.duv_dx), scaled(p.duv_dy)};
}

/// A point and the footprint around it, in the texture's space.
struct SolidCoordinates {
  Vec3 p, dp_dx, dp_dy;
};

/// How textures of three dimensions fill space.
class SolidMapping {
 public:
  explicit SolidMapping(const TexturePlacement& placement)
      : texture_from_world_(placement.world_from_texture.inverse()) {}
  SolidCoordinates at(const TexturePoint& p) const {
    const Transform& t = texture_from_world_;
    return {t.point(p.p), t.vector(p.dp_dx), t.vector(p.dp_dy)};
  }

 private:
  Transform texture_from_world_;
};

/// The parameters of a TextureMapping.
inline constexpr std::string_view kMappings[] = {"uv", "planar", "spherical", "cylindrical"};
inline constexpr std::array<Param, 7> kMappingParams{
    {{.name = "mapping",
      .kind = ParamKind::string,
      .default_value = std::string_view("uv"),
      .doc = "By the surface's (u, v), or by the point in the space of the Texture directive.",
      .choices = kMappings},
     {.name = "uscale", .kind = ParamKind::real, .default_value = 1.0, .doc = "Factor of u; of mapping uv."},
     {.name = "vscale", .kind = ParamKind::real, .default_value = 1.0, .doc = "Factor of v; of mapping uv."},
     {.name = "udelta", .kind = ParamKind::real, .default_value = 0.0, .doc = "Added to u; of uv and planar."},
     {.name = "vdelta", .kind = ParamKind::real, .default_value = 0.0, .doc = "Added to v; of uv and planar."},
     {.name = "v1",
      .kind = ParamKind::vector3,
      .default_value = std::array<double, 3>{1, 0, 0},
      .doc = "Of planar: u is the point's product with it."},
     {.name = "v2",
      .kind = ParamKind::vector3,
      .default_value = std::array<double, 3>{0, 1, 0},
      .doc = "Of planar: v is the point's product with it."}}};

/// A plugin's own parameters and those of its mapping.
template <size_t N>
constexpr std::array<Param, N + kMappingParams.size()> with_mapping(const Param (&own)[N]) {
  return [&]<size_t... I, size_t... J>(std::index_sequence<I...>, std::index_sequence<J...>) {
    return std::array<Param, N + kMappingParams.size()>{own[I]..., kMappingParams[J]...};
  }
  (std::make_index_sequence<N>(), std::make_index_sequence<kMappingParams.size()>());
}

}  // namespace frond
