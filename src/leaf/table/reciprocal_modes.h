#pragma once

#include <optional>

#include "leaf/table/mode_table.h"

namespace frond::leaf {

/// Returns the reciprocal leaf closest to the leaf of `spectrum`, for light that has been inside:
///   f_r(i, o) = d(i) (f(i, o) + f(o, i)) / 2 d(o),
/// where the positive d, one number for each direction outside and column, is such that every incident direction of the
/// grid scatters as much light as before. This symmetric scaling of a positive kernel has one solution (Sinkhorn 1964),
/// found by repeated square roots. docs/leaf_models.md.
///
/// None if a column has no such d. This happens only for a file's table that scatters light from some directions and a
/// negative share from others.
std::optional<ModeTable> make_reciprocal(const ModeTable& spectrum);

/// Divisor of a table's tolerance for a reciprocal leaf: the light that it scatters is then the walk's to 1e-4 between
/// the nodes too.
inline constexpr double kReciprocalFiner = 2;

}  // namespace frond::leaf
