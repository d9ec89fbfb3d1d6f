#pragma once

#include <string>
#include <string_view>

#include "imports/imported_scene.h"

namespace frond {

/// Returns the scene as bytes, for the parent process.
std::string encode(const ImportedScene& scene);

/// Parses the bytes of `encode`. Throws std::runtime_error unless they are complete and all indices are valid: the
/// process that wrote them has read an untrusted file.
ImportedScene decode(std::string_view bytes);

}  // namespace frond
