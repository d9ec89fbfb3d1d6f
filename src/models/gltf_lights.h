#pragma once

#include <optional>

#include "imports/imported_scene.h"
#include "models/gltf_losses.h"

namespace frond {

/// Returns the light that a node has by KHR_lights_punctual; nothing, with a loss, if there is no such light.
std::optional<ImportedLight> gltf_light(const nlohmann::json& document, const nlohmann::json& node, GltfLosses& losses);

/// Returns the camera of a node; nothing, with a loss, if there is no such camera.
std::optional<ImportedCamera> gltf_camera(const nlohmann::json& document, const nlohmann::json& node,
                                          GltfLosses& losses);

}  // namespace frond
