#include "imports/scene_import.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/messages/counted.h"
#include "imports/model_reader.h"
#include "imports/scene_view.h"
#include "scene/geometry/instance_writer.h"
#include "shapes/ply_writer.h"
#include "system/new_files.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostDirectives = 1000;      ///< instances of an object; more are a table
constexpr size_t kMostSearched = 10'000'000;  ///< triangles, for double sheets
constexpr double kSheetDistance = 1e-3;       ///< largest distance of double sheets, relative to the model's size

/// Map of a model to the scene: z is up.
NodeMap to_scene(const ImportOptions& options) {
  const double s = options.scale;
  if (options.z_is_up) return {{s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0}};
  return {{s, 0, 0, 0, 0, 0, -s, 0, 0, s, 0, 0}};
}

/// Returns the model's name for a comment: a line break in it would begin directives.
std::string comment_name(const fs::path& model) {
  std::string name = model.filename().string();
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ') c = '_';
  return name;
}

/// Whether a material by --leaf replaces the surface of a material of the model.
bool is_replaced(const std::string& name, const std::vector<MaterialRule>& rules) {
  return std::ranges::any_of(rules, [&name](const MaterialRule& rule) { return matches_pattern(rule.pattern, name); });
}

/// Writes the directives and files of a model.
class SceneWriter {
 public:
  SceneWriter(const ImportOptions& options, const PlantMaterials& materials, const std::string& stem, NewFiles& folder)
      : options_(options), materials_(materials), stem_(stem), folder_(folder) {}

  std::string plant(const PlantGeometry& geometry) {
    text_ = fmt::format(
        "# Written by frond {}: frond import {}. Materials and shapes; z is up. A scene in this folder includes it by\n"
        "#   Include \"{}-plant.pbrt\"\n\n{}\n",
        FROND_VERSION, comment_name(options_.model), stem_, materials_.text);
    begin_at(geometry.origin);
    for (const PlantMesh& mesh : geometry.meshes) shape(mesh, materials_.emission[mesh.material]);
    end_at(geometry.origin);
    for (const PlantObject& object : geometry.objects) {
      const std::string name = unique(plain_name(object.name), objects_);
      text_ += fmt::format("\nObjectBegin \"{}\"\n", name);
      for (const PlantMesh& mesh : object.meshes) shape(mesh, "");
      text_ += "ObjectEnd\n";
      begin_at(geometry.origin);
      object.instances.size() > kMostDirectives ? table(object, name) : directives(object, name);
      end_at(geometry.origin);
    }
    return std::move(text_);
  }

 private:
  static std::string unique(const std::string& name, std::set<std::string>& taken) {
    std::string result = name;
    for (int i = 2; !taken.insert(result).second; ++i) result = fmt::format("{}-{}", name, i);
    return result;
  }

  /// Begins a block of shapes with coordinates relative to `origin`, unless that is 0.
  void begin_at(const Vec3d& origin) {
    if (origin == Vec3d{}) return;
    text_ += fmt::format(
        "# The model is in map coordinates: its files are relative to this point, in 32-bit floats.\n"
        "AttributeBegin\nTranslate {} {} {}\n",
        origin.x, origin.y, origin.z);
  }
  void end_at(const Vec3d& origin) {
    if (origin != Vec3d{}) text_ += "AttributeEnd\n";
  }

  void shape(const PlantMesh& mesh, const std::string& emission) {
    constexpr size_t kMostVertices = 2'147'483'647;  // an index of a PLY file is an int
    if (mesh.p.size() > kMostVertices) fail({}, "\"{}\" has {} vertices, more than 2^31", mesh.name, mesh.p.size());
    const std::string file = stem_ + "-files/" + unique(plain_name(mesh.name), files_) + ".ply";
    folder_.write(file, ply_file(mesh));
    text_ += fmt::format(
        "AttributeBegin\n  NamedMaterial \"{}\"\n{}  Shape \"plymesh\" \"string filename\" \"{}\"{}\n"
        "AttributeEnd\n",
        materials_.names[mesh.material], emission, file, materials_.alpha[mesh.material]);
  }

  /// pbrt's matrices are stored by columns.
  void directives(const PlantObject& object, const std::string& name) {
    for (const NodeMap& map : object.instances) {
      std::vector<double> m;
      for (size_t column = 0; column < 4; ++column) {
        for (size_t row = 0; row < 3; ++row) m.push_back(map.m[4 * row + column]);
        m.push_back(column == 3 ? 1 : 0);
      }
      text_ += fmt::format("AttributeBegin\n  ConcatTransform [ {} ]\n  ObjectInstance \"{}\"\nAttributeEnd\n",
                           fmt::join(m, " "), name);
    }
  }

  void table(const PlantObject& object, const std::string& name) {
    const std::string file = stem_ + "-files/" + unique(name, files_) + ".npy";
    InstanceWriter writer(folder_.file(file), object.instances.size(), {});
    for (const NodeMap& map : object.instances) writer.add(affine_map(map), {});
    writer.finish();
    text_ += fmt::format("Shape \"instances\" \"string object\" \"{}\" \"string filename\" \"{}\"\n", name, file);
  }

  const ImportOptions& options_;
  const PlantMaterials& materials_;
  const std::string& stem_;
  NewFiles& folder_;
  std::string text_;
  std::set<std::string> files_, objects_;
};

/// Removes the emission of materials that --leaf replaces, and names it; names images of emissions that are repeated,
/// which area lights do not do.
void settle_emission(ImportedScene& scene, const std::vector<MaterialRule>& rules) {
  LossList losses;
  for (ImportedMaterial& m : scene.materials)
    if (m.is_emitter() && is_replaced(m.name, rules)) {
      losses.add_for_material(m.name, "emission");
      m.emission = {};
      m.emission_texture = {};
    }
  std::set<uint32_t> repeated;
  for (const ImportedMesh& mesh : scene.meshes) {
    const ImportedTexture& image = scene.materials[mesh.material].emission_texture;
    constexpr float kEdge = 1e-3f;
    const auto is_outside = [](const auto& uv) {
      return std::min(uv[0], uv[1]) < -kEdge || std::max(uv[0], uv[1]) > 1 + kEdge;
    };
    if (image.image >= 0 && image.wrap != ImportedTexture::Wrap::clamp && std::ranges::any_of(mesh.uvs, is_outside))
      repeated.insert(mesh.material);
  }
  for (const uint32_t m : repeated)
    losses.add_for_material(scene.materials[m].name, "repetition of the image of the emission");
  for (const ImportedLoss& loss : losses.all()) scene.losses.push_back(loss);
  if (scene.cameras.size() > 1) scene.losses.push_back({"further camera", scene.cameras.size() - 1});
}

/// Which materials have triangles.
std::vector<bool> used_materials(const ImportedScene& scene, const PlantGeometry& geometry) {
  std::vector<bool> used(scene.materials.size());
  for (const PlantMesh& mesh : geometry.meshes) used[mesh.material] = true;
  for (const PlantObject& object : geometry.objects)
    for (const PlantMesh& mesh : object.meshes) used[mesh.material] = true;
  return used;
}

/// Which materials' second sheets are removed. Throws InputError for a pattern that matches none.
std::vector<bool> single_sided(const ImportedScene& scene, const std::vector<std::string>& patterns) {
  std::vector<bool> remove(scene.materials.size());
  for (const std::string& pattern : patterns) {
    bool is_used = false;
    for (size_t i = 0; i < remove.size(); ++i)
      if (matches_pattern(pattern, scene.materials[i].name)) remove[i] = is_used = true;
    if (!is_used) fail({}, "the model has no material \"{}\", whose second sheets are to be removed", pattern);
  }
  return remove;
}

/// Searches meshes and objects; the results of one material are added, and those of materials of one name, which the
/// back of a leaf with a normal map has.
std::vector<DoubleSheet> find_double_sheets(const ImportedScene& scene, PlantGeometry& geometry,
                                            const std::vector<bool>& remove, const Log& log) {
  if (geometry.triangle_count() > kMostSearched) {
    log.info(fmt::format("double leaf sheets are searched up to {} triangles: not here", kMostSearched));
    return {};
  }
  const double tolerance = kSheetDistance * length(geometry.most - geometry.least);
  std::vector<DoubleSheet> all;
  bool is_complete = true;
  const auto search = [&](std::vector<PlantMesh>& meshes, double stretch) {
    const auto found = double_sheets(meshes, tolerance / stretch, remove);
    is_complete = is_complete && found.has_value();
    for (DoubleSheet sheet : found.value_or(std::vector<DoubleSheet>())) {
      sheet.apart *= stretch;
      const auto first =
          std::ranges::find(scene.materials, scene.materials[sheet.material].name, &ImportedMaterial::name);
      sheet.material = uint32_t(first - scene.materials.begin());
      const auto same = std::ranges::find(all, sheet.material, &DoubleSheet::material);
      if (same == all.end()) {
        all.push_back(sheet);
      } else {
        same->triangles += sheet.triangles;
        same->apart = std::max(same->apart, sheet.apart);
      }
    }
  };
  search(geometry.meshes, 1);
  for (PlantObject& object : geometry.objects)
    search(object.meshes, std::cbrt(std::abs(object.instances.front().determinant())));
  if (!is_complete)
    log.info("double leaf sheets are not searched where too many triangles lie at one place, as they do here");
  return all;
}

/// Warns of a model whose 32-bit floats have rounded its shape.
void warn_of_steps(const PlantGeometry& geometry, const Log& log) {
  constexpr double kVisible = 1. / 2048;
  const double reach = std::max(largest_coordinate(geometry.least), largest_coordinate(geometry.most));
  const double step = float_spacing(reach);
  if (reach <= kFar || step < kVisible * largest_coordinate(geometry.most - geometry.least)) return;
  log.warn({},
           fmt::format("its coordinates are 32-bit floats up to {:.3g} units from the origin, where their step is {:g} "
                       "units: move the model to the origin before it is exported, or export it as OBJ",
                       reach, step));
}

/// Returns the name for files beside the scene, which scene files quote.
std::string stem_of(const fs::path& scene) {
  const std::string stem = scene.stem().string();
  const bool is_quotable =
      std::ranges::none_of(stem, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '"' || c == '\\'; });
  return is_quotable ? stem : plain_name(stem);
}

/// Writes the text of the losses into the summary.
void add_losses(const ImportedScene& scene, const PlantGeometry& geometry, const PlantMaterials& materials,
                const std::vector<MaterialRule>& rules, ImportSummary& summary) {
  const auto by_rule = [&rules](const std::string& name) { return is_replaced(name, rules); };
  const auto add = [&](const ImportedLoss& loss) {
    if (!loss.is_surface || loss.materials.empty()) return summary.left_out.push_back(text_of(loss));
    ImportedLoss kept = loss, replaced = loss;
    std::erase_if(kept.materials, by_rule);
    std::erase_if(replaced.materials, std::not_fn(by_rule));
    if (!kept.materials.empty()) summary.left_out.push_back(text_of(kept));
    if (!replaced.materials.empty()) summary.replaced.push_back(text_of(replaced));
  };
  for (const ImportedLoss& loss : scene.losses) add(loss);
  for (const ImportedLoss& loss : materials.losses.all()) add(loss);
  LossList normals, colors;
  for (const ImportedMesh& mesh : scene.meshes)
    if (!mesh.normals.empty() && !has_normals(mesh)) normals.add("normals of a mesh, of which some are 0 or not given");
  for (const ImportedLoss& loss : normals.all()) add(loss);
  LossList instances;
  for (const PlantObject& object : geometry.objects)
    for (const PlantMesh& mesh : object.meshes)
      if (const ImportedMaterial& m = scene.materials[mesh.material]; m.is_emitter())
        instances.add_for_material(m.name, "emission of many instances");
  for (const ImportedLoss& loss : instances.all()) add(loss);
  for (size_t i = 0; i < materials.rules.size(); ++i)
    if (materials.rules[i] && materials.rules[i]->mapped.empty() && scene.materials[i].color_texture.image >= 0)
      colors.add_for_material(scene.materials[i].name, fmt::format("colour image {}", summary.images[i][0]));
  for (const ImportedLoss& loss : colors.all()) summary.replaced.push_back(text_of(loss));
}

/// Returns the names of a material's images that are read: of colour, opacity and normals.
std::array<std::string, 3> images_of(const ImportedScene& scene, const ImportedMaterial& m,
                                     const std::string& alpha_parameter) {
  const auto name = [&scene](const ImportedTexture& t) {
    return t.image < 0 ? std::string() : scene.images[size_t(t.image)].name;
  };
  const bool has_map = alpha_parameter.starts_with(" \"texture");
  const ImportedTexture& opacity = m.opacity_texture.image >= 0 ? m.opacity_texture : m.color_texture;
  return {name(m.color_texture), has_map ? name(opacity) : "", name(m.normal_texture)};
}

/// Returns the summary of what is to be written.
ImportSummary summary_of(const ImportOptions& options, const ImportedScene& scene, const PlantGeometry& geometry,
                         const PlantMaterials& materials, const std::vector<DoubleSheet>& sheets) {
  const Vec3d size = geometry.most - geometry.least;
  ImportSummary summary{.materials = materials.names,
                        .triangles = std::vector<size_t>(scene.materials.size()),
                        .types = materials.types,
                        .instances = geometry.instance_count(),
                        .objects = geometry.objects.size(),
                        .lights = scene.lights.size(),
                        .has_camera = !scene.cameras.empty(),
                        .double_sheets = sheets,
                        .size = {size.x, size.y, size.z}};
  const Vec3d least = geometry.least + geometry.origin;
  summary.least = {least.x, least.y, least.z};
  for (size_t i = 0; i < scene.materials.size(); ++i)
    summary.images.push_back(images_of(scene, scene.materials[i], materials.alpha[i]));
  add_losses(scene, geometry, materials, options.rules, summary);
  const auto count = [&summary](const std::vector<PlantMesh>& meshes) {
    for (const PlantMesh& mesh : meshes) summary.triangles[mesh.material] += mesh.triangles.size();
  };
  count(geometry.meshes);
  for (const PlantObject& object : geometry.objects) {
    count(object.meshes);
    size_t triangles = 0;
    for (const PlantMesh& mesh : object.meshes) triangles += mesh.triangles.size();
    summary.object_list.push_back({object.name, triangles, object.instances.size()});
  }
  return summary;
}

}  // namespace

ImportSummary import_scene(const ImportOptions& options, const Log& log,
                           const std::function<void(const ImportSummary&)>& accept) {
  if (!options.scene.empty() && options.scene.extension() != ".pbrt")
    fail({}, "the scene \"{}\" needs the extension .pbrt", options.scene.string());
  ImportedScene scene = read_model(options.model);
  settle_emission(scene, options.rules);
  for (const std::string& warning : scene.warnings) log.warn({}, warning);
  PlantGeometry geometry = plant_geometry(scene, to_scene(options), options.keeps_objects);
  warn_of_steps(geometry, log);
  if (geometry.flat_nodes > 0)
    log.warn({}, fmt::format("{} no inverse", counted(geometry.flat_nodes, "node is left out: its transform has",
                                                      "nodes are left out: their transforms have")));
  const auto sheets = find_double_sheets(scene, geometry, single_sided(scene, options.single_sided), log);
  const std::string stem = stem_of(options.scene);
  PlantImages images(scene.images, options.model, options.textures, stem + "-files", log);
  const PlantMaterials materials = plant_materials(scene, used_materials(scene, geometry), options.rules, images, log);
  const ImportSummary summary = summary_of(options, scene, geometry, materials, sheets);
  accept(summary);
  if (options.scene.empty()) return summary;

  std::vector<fs::path> inputs = images.inputs();
  inputs.push_back(options.model);
  NewFiles folder(options.scene.parent_path(), inputs);
  for (const PlantFile& file : images.files()) folder.write(file.path, file.bytes);
  folder.write(stem + "-plant.pbrt", SceneWriter(options, materials, stem, folder).plant(geometry));
  const std::string head =
      fmt::format("# Written by frond {}: frond import {}. z is up; the model is {:.6g} x {:.6g} x {:.6g} units.\n\n",
                  FROND_VERSION, comment_name(options.model), summary.size[0], summary.size[1], summary.size[2]);
  folder.write(options.scene.filename().string(),
               head + scene_view(scene, geometry, to_scene(options), options.scale, stem) +
                   fmt::format("Include \"{}-plant.pbrt\"\n", stem));
  folder.finish();
  return summary;
}

}  // namespace frond
