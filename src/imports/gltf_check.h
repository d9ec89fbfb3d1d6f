#pragma once

#include <string_view>
#include <vector>

#include "imports/imported_loss.h"

namespace frond {

/// Compares the JSON of a glTF file (.gltf, .glb) with the record of what the import reads (gltf_properties.h). Returns
/// the losses of the objects that its scene has. Throws std::runtime_error, with the place in the JSON, for required
/// extensions that are not read, and for geometry that the reader library would misread.
std::vector<ImportedLoss> check_gltf(std::string_view file);

}  // namespace frond
