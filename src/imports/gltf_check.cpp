#include "imports/gltf_check.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>

#include "imports/gltf_accessors.h"
#include "imports/gltf_json.h"
#include "imports/gltf_properties.h"

namespace frond {
namespace {

using Json = nlohmann::json;

/// Returns an array's elements, or none.
std::vector<std::string> texts_of(const Json& object, std::string_view key) {
  std::vector<std::string> words;
  if (const Json* array = member(object, key); array && array->is_array())
    for (const Json& word : *array)
      if (word.is_string()) words.push_back(word.get<std::string>());
  return words;
}

bool has_weights(const Json& object) {
  const Json* weights = member(object, "weights");
  if (!weights || !weights->is_array()) return false;
  return std::ranges::any_of(*weights, [](const Json& w) { return w.is_number() && w.get<double>() != 0; });
}

/// Goes through the objects that the scene has, from its nodes to the images of their materials.
class GltfCheck {
 public:
  GltfCheck(const Json& document, bool is_binary) : document_(document), is_binary_(is_binary) {
    for (const std::string& name : texts_of(document, "extensionsUsed")) used_.insert(name);
  }

  std::vector<ImportedLoss> run() {
    if (!document_.is_object()) throw std::runtime_error("its JSON is no object");
    const Json* asset = member(document_, "asset");
    if (asset && text(*asset, "version").starts_with('1')) {
      losses_.add("all that the techniques of glTF 1 say");
      return losses_.all();
    }
    if (asset && !text(*asset, "minVersion").empty() && text(*asset, "minVersion") != "2.0")
      throw std::runtime_error("it needs a reader of glTF " + std::string(text(*asset, "minVersion")));
    reject_required();
    check_properties("glTF", document_);
    if (const Json* animations = member(document_, "animations"); animations && animations->size() > 1)
      losses_.add("animation", animations->size() - 1);
    if (asset) check_properties("asset", *asset);
    scenes();
    defined_.insert(used_.begin(), used_.end());
    for (const std::string& name : defined_)
      if (!is_read_extension(name) && !named_.contains(name)) losses_.add("extension " + name, 0);
    return losses_.all();
  }

 private:
  void reject_required() const {
    std::string names;
    size_t count = 0;
    for (const std::string& name : texts_of(document_, "extensionsRequired"))
      if (!is_read_extension(name)) names += (count++ == 0 ? "" : ", ") + name;
    if (count > 0)
      throw std::runtime_error(
          std::string(count == 1 ? "it requires an extension that is" : "it requires extensions that are") +
          " not read: " + names + " (extensionsRequired); export it without");
  }

  /// Reports the properties of an object that are not read. `material`: to which the object belongs; nullptr: to none.
  void check_properties(std::string_view kind, const Json& object, const std::string* material = nullptr) {
    if (!object.is_object()) return;
    for (const auto& [key, value] : object.items()) {
      if (key == "extras") continue;  // of applications
      if (key == "extensions") {
        check_extensions(kind, value, material);
        continue;
      }
      const GltfProperty* property = gltf_property(kind, key);
      if (!property) {
        record_loss("unknown property " + std::string(kind) + "." + key, material, false);
      } else if (property->use == GltfUse::lost || property->use == GltfUse::surface) {
        const bool has_effect =
            property->no_effect.empty() || value != Json::parse(property->no_effect.begin(), property->no_effect.end());
        const std::string says(property->says.empty() ? std::string(kind) + "." + key : property->says);
        if (has_effect) record_loss(says, material, property->use == GltfUse::surface);
      }
    }
  }

  /// Extensions of materials are of their surface.
  void check_extensions(std::string_view kind, const Json& all, const std::string* material) {
    if (!all.is_object()) return;
    for (const auto& [name, extension] : all.items()) {
      if (is_read_extension(name) && used_.contains(name)) {
        check_properties(name, extension, material);
        continue;
      }
      if (kind == "glTF") {  // definitions, which objects refer to
        defined_.insert(name);
        continue;
      }
      named_.insert(name);
      if (name == "KHR_lights_punctual")
        losses_.add("light (KHR_lights_punctual)");
      else
        record_loss("extension " + name, material, kind == "material");
    }
  }

  void record_loss(const std::string& what, const std::string* material, bool is_surface) {
    if (material)
      losses_.add_for_material(*material, what, !is_surface);
    else
      losses_.add(what);
  }

  /// The first scene is read unless the file names another.
  void scenes() {
    const Json* scenes = member(document_, "scenes");
    if (!scenes || !scenes->is_array()) return;
    if (scenes->size() > 1) losses_.add("further scene", scenes->size() - 1);
    const Json* scene = element(document_, "scenes", integer(document_, "scene").value_or(0));
    if (!scene) return;
    check_properties("scene", *scene);
    add_nodes(*scene, "nodes");
    for (size_t at = 0; at < nodes_.size(); ++at) node(nodes_[at]);
  }

  /// Each node once.
  void add_nodes(const Json& parent, std::string_view key) {
    const Json* indices = member(parent, key);
    if (!indices || !indices->is_array()) return;
    for (const Json& index : *indices)
      if (index.is_number_unsigned() && element(document_, "nodes", index.get<uint64_t>()) &&
          seen_nodes_.insert(index.get<uint64_t>()).second)
        nodes_.push_back(index.get<uint64_t>());
  }

  void node(uint64_t index) {
    const Json& node = *element(document_, "nodes", index);
    const std::string place = "nodes[" + std::to_string(index) + "]";
    check_properties("node", node);
    add_nodes(node, "children");
    if (const Json* all = member(node, "extensions"); all && member(*all, "EXT_mesh_gpu_instancing"))
      throw std::runtime_error(place +
                               " has instances by EXT_mesh_gpu_instancing, which is not read; export them as nodes");
    const auto mesh_index = integer(node, "mesh");
    const Json* mesh = element(document_, "meshes", mesh_index);
    if (!mesh) return;
    if (member(node, "skin"))
      throw std::runtime_error(place +
                               " has a skin: joints place its vertices, which is not read; apply the armature "
                               "before the export");
    if (has_weights(node) || (!member(node, "weights") && has_weights(*mesh)))
      throw std::runtime_error(place +
                               " has morph targets with weights, which are not read; apply them before the export");
    if (seen_meshes_.insert(*mesh_index).second) this->mesh(*mesh, "meshes[" + std::to_string(*mesh_index) + "]");
  }

  /// Each mesh once.
  void mesh(const Json& mesh, const std::string& place) {
    check_properties("mesh", mesh);
    const Json* primitives = member(mesh, "primitives");
    if (!primitives || !primitives->is_array()) return;
    for (size_t i = 0; i < primitives->size(); ++i)
      primitive((*primitives)[i], place + ".primitives[" + std::to_string(i) + "]");
  }

  /// Its accessors, and its material once.
  void primitive(const Json& primitive, const std::string& place) {
    check_properties("primitive", primitive);
    constexpr double kTriangles = 4, kFan = 6;
    const double mode = number(primitive, "mode", kTriangles);
    if (mode < kTriangles) return losses_.add("primitive of points or lines");
    if (mode > kFan) throw std::runtime_error(place + ": there is no mode " + std::to_string(mode));
    const Json* attributes = member(primitive, "attributes");
    const auto position = attributes ? integer(*attributes, "POSITION") : std::nullopt;
    if (!position) return losses_.add("primitive without positions");
    check_properties("attributes", *attributes);
    const auto check = [&](uint64_t accessor, AccessorUse use, const std::string& name) {
      return check_accessor(document_, accessor, use, place + ", " + name, is_binary_);
    };
    const uint64_t count = check(*position, AccessorUse::position, "POSITION");
    for (const auto& [name, index] : attributes->items()) {
      const bool is_uv = name.starts_with("TEXCOORD_");
      if ((!is_uv && name != "NORMAL") || !index.is_number_unsigned()) continue;
      const auto use = is_uv ? AccessorUse::texture_coordinates : AccessorUse::normal;
      if (check(index.get<uint64_t>(), use, name) != count)
        throw std::runtime_error(place + ", " + name + ": there are not as many as positions");
    }
    if (const auto indices = integer(primitive, "indices")) check(*indices, AccessorUse::indices, "indices");
    const auto index = integer(primitive, "material");
    const Json* material = element(document_, "materials", index);
    if (!material) return;
    const std::set<uint64_t>& sets = this->material(*index, *material);
    for (const uint64_t set : sets)
      if (!member(*attributes, "TEXCOORD_" + std::to_string(set)))
        losses_.add("image of a primitive that has no TEXCOORD_" + std::to_string(set));
    if (member(*material, "normalTexture") && member(*attributes, "TANGENT"))
      losses_.add("TANGENT of a primitive with a normal map");
  }

  /// Returns the sets of texture coordinates that a material needs.
  const std::set<uint64_t>& material(uint64_t index, const Json& material) {
    const auto [known, is_new] = materials_.try_emplace(index);
    std::set<uint64_t>& sets = known->second;
    if (!is_new) return sets;
    const std::string name(text(material, "name").empty() ? "unnamed" : text(material, "name"));
    check_properties("material", material, &name);
    const Json* all = member(material, "extensions");
    const Json* glossy = all && used_.contains("KHR_materials_pbrSpecularGlossiness")
                             ? member(*all, "KHR_materials_pbrSpecularGlossiness")
                             : nullptr;
    const Json* rough = member(material, "pbrMetallicRoughness");
    if (glossy) {
      record_loss("gloss", &name, true);
      if (const Json* image = member(*glossy, "diffuseTexture"))
        texture(*image, name, sets);
      else if (rough && member(*rough, "baseColorTexture"))
        throw std::runtime_error("material \"" + name +
                                 "\" has an image in pbrMetallicRoughness and none in "
                                 "KHR_materials_pbrSpecularGlossiness, which is not read; remove one of the two");
    } else if (rough) {
      check_properties("pbrMetallicRoughness", *rough, &name);
      if (const Json* image = member(*rough, "baseColorTexture")) texture(*image, name, sets);
      if (!member(*rough, "metallicRoughnessTexture")) check_roughness(*rough, name);
    }
    if (const Json* image = member(material, "normalTexture")) {
      const Json* sampler = texture(*image, name, sets);
      if (sampler && (number(*sampler, "wrapS", kRepeat) != kRepeat || number(*sampler, "wrapT", kRepeat) != kRepeat))
        record_loss("wrap mode of the normal map", &name, false);
    }
    return sets;
  }

  /// A metallic factor of 0.5 or more makes a conductor. Both factors are 1 by default, which is taken as no metal.
  void check_roughness(const Json& rough, const std::string& name) {
    const double metalness = number(rough, "metallicFactor", 1), roughness = number(rough, "roughnessFactor", 1);
    if (metalness < 0.5 && roughness < 1) record_loss("gloss", &name, true);
    if (metalness > 0 && metalness < 1) record_loss("metalness between 0 and 1 (metallicFactor)", &name, true);
    if (metalness == 1 && roughness == 1 && member(rough, "metallicFactor"))
      record_loss("metalness of a roughness of 1 (metallicFactor)", &name, true);
  }

  /// Returns the sampler of a texture that a material uses; nullptr if it has none.
  const Json* texture(const Json& use, const std::string& material, std::set<uint64_t>& sets) {
    check_properties("textureInfo", use, &material);
    const uint64_t set = integer(use, "texCoord").value_or(0);
    sets.insert(set);
    if (const Json* all = member(use, "extensions"))
      if (const Json* transform = member(*all, "KHR_texture_transform"))
        if (const auto other = integer(*transform, "texCoord"); other && *other != set)
          record_loss("texCoord of KHR_texture_transform", &material, false);
    const Json* texture = element(document_, "textures", integer(use, "index"));
    if (!texture) {
      record_loss("image of a texture that does not exist", &material, false);
      return nullptr;
    }
    check_properties("texture", *texture, &material);
    const Json* image = element(document_, "images", integer(*texture, "source"));
    if (!image)
      record_loss("image of a texture without source", &material, false);
    else
      check_properties("image", *image, &material);
    const Json* sampler = element(document_, "samplers", integer(*texture, "sampler"));
    if (!sampler) return nullptr;
    check_properties("sampler", *sampler, &material);
    if (number(*sampler, "wrapS", kRepeat) != number(*sampler, "wrapT", kRepeat))
      record_loss("wrap mode along v (wrapT)", &material, false);
    return sampler;
  }

  static constexpr double kRepeat = 10497;  // the default of both directions

  const Json& document_;
  bool is_binary_;
  LossList losses_;
  std::set<std::string> used_, defined_, named_;  ///< extensions
  std::vector<uint64_t> nodes_;                   ///< of the scene, each after its parent
  std::set<uint64_t> seen_nodes_, seen_meshes_;
  std::map<uint64_t, std::set<uint64_t>> materials_;  ///< sets of texture coordinates
};

}  // namespace

std::vector<ImportedLoss> check_gltf(std::string_view file) {
  return GltfCheck(gltf_json(file), file.starts_with("glTF")).run();
}

}  // namespace frond
