#pragma once

#include <optional>

#include "leaf/table/mode_table.h"

namespace frond::leaf {

/// The reciprocal leaf nearest to that of `spectrum`, for light that has been inside:
///   f_r(i, o) = d(i) (f(i, o) + f(o, i)) / 2 d(o),
/// where the positive d, one number for each direction outside and column, is such that every incident direction of the
/// grid scatters as much light as before. A symmetric scaling of a positive kernel (Sinkhorn 1964): there is one such
/// d, and repeated square roots find it. docs/reciprocal_leaf.md.
///
/// None where a column has none, as only a file's can: one that scatters light from some directions and less than
/// none from others.
std::optional<ModeTable> make_reciprocal(const ModeTable& spectrum);

/// A table's tolerance is divided by it where the leaf is to be reciprocal: then the light that it scatters is the
/// walk's to 1e-4 between the nodes as well.
inline constexpr double kReciprocalFiner = 2;

}  // namespace frond::leaf
