#pragma once

#include <array>
#include <utility>

#include "core/params.h"
#include "core/texture.h"

namespace frond {

/// 2D texture coordinates and their derivatives over the footprint.
struct TextureCoordinates {
  Vec2 st, dst_dx, dst_dy;  ///< coordinates; their changes along x and y of the film
};

/// 2D texture mapping: by the surface's (u, v), or by the point in texture space.
class TextureMapping {
 public:
  TextureMapping(const Params& p, const TexturePlacement& placement);
  /// Whether the mapping needs the point; mapping uv needs it only for filtering.
  bool needs_point() const { return kind_ != Kind::uv; }
  /// Returns the coordinates of a point, and their changes over its footprint.
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

/// A point in texture space and its derivatives over the footprint.
struct SolidCoordinates {
  Vec3 p, dp_dx, dp_dy;
};

/// 3D texture mapping.
class SolidMapping {
 public:
  explicit SolidMapping(const TexturePlacement& placement)
      : texture_from_world_(placement.world_from_texture.inverse()) {}
  /// Transforms point and footprint to texture space.
  SolidCoordinates at(const TexturePoint& p) const {
    const Transform& t = texture_from_world_;
    return {t.point(p.p), t.vector(p.dp_dx), t.vector(p.dp_dy)};
  }

 private:
  Transform texture_from_world_;
};

/// Parameters of TextureMapping.
inline constexpr std::string_view kMappings[] = {"uv", "planar", "spherical", "cylindrical"};
inline constexpr std::array<Param, 7> kMappingParams{
    {{.name = "mapping",
      .kind = ParamKind::string,
      .default_value = std::string_view("uv"),
      .doc = "Coordinates: the surface's (u, v), or the point in the space of the Texture directive.",
      .choices = kMappings},
     {.name = "uscale", .kind = ParamKind::real, .default_value = 1.0, .doc = "Factor of u, for mapping uv."},
     {.name = "vscale", .kind = ParamKind::real, .default_value = 1.0, .doc = "Factor of v, for mapping uv."},
     {.name = "udelta",
      .kind = ParamKind::real,
      .default_value = 0.0,
      .doc = "Offset of u, for mappings uv and planar."},
     {.name = "vdelta",
      .kind = ParamKind::real,
      .default_value = 0.0,
      .doc = "Offset of v, for mappings uv and planar."},
     {.name = "v1",
      .kind = ParamKind::vector3,
      .default_value = std::array<double, 3>{1, 0, 0},
      .doc = "Vector for mapping planar: u is its dot product with the point."},
     {.name = "v2",
      .kind = ParamKind::vector3,
      .default_value = std::array<double, 3>{0, 1, 0},
      .doc = "Vector for mapping planar: v is its dot product with the point."}}};

/// Concatenates a plug-in's own parameters and those of its mapping.
template <size_t N>
constexpr std::array<Param, N + kMappingParams.size()> with_mapping(const Param (&own)[N]) {
  return [&]<size_t... I, size_t... J>(std::index_sequence<I...>, std::index_sequence<J...>) {
    return std::array<Param, N + kMappingParams.size()>{own[I]..., kMappingParams[J]...};
  }
  (std::make_index_sequence<N>(), std::make_index_sequence<kMappingParams.size()>());
}

/// For records of textures.
template <class Base, class T>
std::unique_ptr<Base> make_placed(const Params& p, const TexturePlacement& placement) {
  return std::make_unique<T>(p, placement);
}

}  // namespace frond
