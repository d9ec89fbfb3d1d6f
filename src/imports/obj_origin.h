#pragma once

#include <array>
#include <string>

namespace frond {

/// Moves the vertices of an OBJ text that lie far from its origin (is_far), as those in map coordinates do, because the
/// library that reads them rounds to 32-bit floats: subtracts their median, rounded to whole units, in double
/// precision. Returns what was subtracted; 0, with the text unchanged, if the vertices are near or are not three
/// numbers each.
std::array<double, 3> move_obj_to_origin(std::string& text);

}  // namespace frond
