#pragma once

#include <set>
#include <string>
#include <string_view>

#include "imports/imported_loss.h"

namespace frond {

/// Returns the statements of a material file (MTL) that the import reads, in the form that the reader library needs.
/// Adds the others, if they change the look of materials that are `used`, to `losses`, and the names of all to
/// `defined`.
std::string read_statements(std::string_view text, const std::set<std::string>& used, LossList& losses,
                            std::set<std::string>& defined);

}  // namespace frond
