#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace frond {

/// A leaf under an even sky beside a grey floor.
inline constexpr std::string_view kLeafScene = R"(
LookAt 0 -1 1  0 0 0  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 64 "integer yresolution" 32
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
MakeNamedMaterial "blade" "string type" "leaf_simplified" "string specimen" "soybean"
NamedMaterial "blade"
Shape "trianglemesh" "integer indices" [0 1 2  0 2 3] "point3 P" [-.3 -.3 .1  .3 -.3 .1  .3 .3 .1  -.3 .3 .1]
Material "diffuse"
Shape "trianglemesh" "integer indices" [0 1 2  0 2 3] "point3 P" [-3 -3 0  3 -3 0  3 3 0  -3 3 0]
)";

/// The first row of a table of compare.json in which these columns have these values.
inline nlohmann::json row_of(const nlohmann::json& table, const nlohmann::json& values) {
  for (const auto& row : table) {
    nlohmann::json merged = row;
    merged.update(values);
    if (merged == row) return row;
  }
  return {};
}

}  // namespace frond
