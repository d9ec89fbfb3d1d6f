#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/parallel.h"
#include "scene/format/description.h"
#include "scene/format/unsupported.h"
#include "scene/registry.h"

namespace frond {

/// Export of a scene as files for Mitsuba 3.
struct MitsubaExport {
  std::filesystem::path folder;        ///< created if it does not exist
  std::vector<double> wavelengths_nm;  ///< one: mono variants; three, or none for 608, 551, 455: rgb; more: spectral
  std::string scene;                   ///< the scene file, for a comment
  Unsupported unsupported = {};        ///< kinds that are left out or approximated, with a warning
};

/// Writes scene.xml, meshes and textures. Throws InputErrors with all that has no equivalent in Mitsuba, each at its
/// position in the scene file, unless `unsupported` ignores it; differences are warned of. `description` must contain
/// all overrides.
void export_to_mitsuba(SceneDescription description, const Registry& registry, const MitsubaExport& request,
                       ThreadPool& pool, const Log& log, const std::filesystem::path& cache);

}  // namespace frond
