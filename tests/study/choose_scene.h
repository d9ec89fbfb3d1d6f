#pragma once

#include <string>

namespace frond {

/// A leaf close by and another one far away, front lit; `near` and `far` are more parameters of theirs.
inline std::string two_leaves(const std::string& near, const std::string& far, int size = 48) {
  return R"(
LookAt 0 -1 0.6  0 0 0  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" )" +
         std::to_string(size) + R"( "integer yresolution" )" + std::to_string(size) + R"(
Sampler "lattice" "integer pixelsamples" 64
Integrator "path" "integer maxdepth" 6
WorldBegin
LightSource "distant" "point3 from" [0 -3 4] "point3 to" [0 0 0] "spectrum L" "stdillum-D65"
LightSource "infinite" "spectrum L" "stdillum-D65" "float scale" 0.2
MakeNamedMaterial "near" "string type" "leaf" "string specimen" "soybean" )" +
         near + R"(
MakeNamedMaterial "far" "string type" "leaf" "string specimen" "maize" )" +
         far + R"(
NamedMaterial "near"
Shape "trianglemesh" "integer indices" [0 1 2  0 2 3] "point3 P" [-.3 -.3 0  .3 -.3 0  .3 .3 .1  -.3 .3 .1]
NamedMaterial "far"
Shape "trianglemesh" "integer indices" [0 1 2  0 2 3] "point3 P" [1.2 5 1  1.4 5 1  1.4 5.1 1.2  1.2 5.1 1.2]
)";
}

}  // namespace frond
