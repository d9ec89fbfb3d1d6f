#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "core/log.h"
#include "imports/double_sheets.h"
#include "imports/plant_materials.h"

namespace frond {

/// Options of `frond import`.
struct ImportOptions {
  std::filesystem::path model, scene;  ///< file to read; scene file to write, or empty: nothing is written
  std::vector<MaterialRule> rules = {};
  std::vector<std::string> textures = {};      ///< further folders with images
  double scale = 1;                            ///< scene units for one unit of the model
  bool z_is_up = false;                        ///< in the model; false: y
  bool keeps_objects = false;                  ///< as plant_geometry
  std::vector<std::string> single_sided = {};  ///< patterns of material names whose second sheets are removed
};

/// Object with several instances.
struct ImportedObject {
  std::string name;
  size_t triangles, instances;
};

/// Content of the written scene, or of the scene that would be written.
struct ImportSummary {
  std::vector<std::string> materials;  ///< names in the scene file
  std::vector<size_t> triangles;       ///< by material; triangles of an object count once
  std::vector<std::string> types;      ///< by material: "leaf (by --leaf)", "diffuse"
  size_t instances = 0, objects = 0, lights = 0;
  bool has_camera = false;                 ///< of the model
  std::vector<DoubleSheet> double_sheets;  ///< material: index in `materials`
  std::vector<std::string> left_out = {};
  std::vector<std::string> replaced = {};  ///< properties without effect, because --leaf replaces the surface
  std::vector<ImportedObject> object_list = {};
  /// By material: names of the images of colour, opacity and normals, or "".
  std::vector<std::array<std::string, 3>> images = {};
  std::array<double, 3> size{};   ///< of the model, scene units
  std::array<double, 3> least{};  ///< lower corner of its bounding box
};

/// Reads a model and, if a scene is given, writes it: SCENE.pbrt with camera and lights, SCENE-plant.pbrt with
/// materials and shapes, and the folder SCENE-files with meshes and images. The files appear together after `accept`,
/// which may throw. Throws InputError.
ImportSummary import_scene(const ImportOptions& options, const Log& log,
                           const std::function<void(const ImportSummary&)>& accept);

}  // namespace frond
