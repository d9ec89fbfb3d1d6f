#include "imports/scene_stream.h"

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace frond {
namespace {

constexpr std::string_view kMagic = "frond import 4\n";

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T> || requires {
  std::tuple_size<T>::value;
};  // or an array
template <class T>
concept Sequence = requires {
  typename T::allocator_type;
};  // a vector or a string

/// Plain values are copied as they are: both processes run on one machine. Vectors follow their length.
class Writer {
 public:
  template <class T>
  void operator()(const T& value) {
    if constexpr (Plain<T>) {
      raw(&value, sizeof value);
    } else if constexpr (Sequence<T>) {
      (*this)(uint64_t(value.size()));
      using Element = typename T::value_type;
      if constexpr (Plain<Element>) {
        raw(value.data(), value.size() * sizeof(Element));
      } else {
        for (const Element& e : value) (*this)(e);
      }
    } else {
      visit(value, *this);
    }
  }
  std::string bytes;

 private:
  void raw(const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); }
};

/// Throws std::runtime_error at the end of the bytes.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  void operator()(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      uint8_t byte = 0;  // any value may have been written
      raw(&byte, 1);
      value = byte != 0;
    } else if constexpr (Plain<T>) {
      raw(&value, sizeof value);
    } else if constexpr (Sequence<T>) {
      uint64_t count = 0;
      (*this)(count);
      using Element = typename T::value_type;
      if (count > rest_.size() / (Plain<Element> ? sizeof(Element) : 1)) throw std::runtime_error("it ends too soon");
      value.resize(count);
      if constexpr (Plain<Element>) {
        raw(value.data(), count * sizeof(Element));
      } else {
        for (Element& e : value) (*this)(e);
      }
    } else {
      visit(value, *this);
    }
  }
  bool at_end() const { return rest_.empty(); }

 private:
  void raw(void* to, size_t size) {
    if (size > rest_.size()) throw std::runtime_error("it ends too soon");
    if (size > 0) std::memcpy(to, rest_.data(), size);
    rest_.remove_prefix(size);
  }
  std::string_view rest_;
};

/// Calls `io` with each member: the one list of members for both directions.
template <class T, class Io>
void visit(T& v, Io& io) {
  using Type = std::remove_const_t<T>;
  const auto each = [&io](auto&... members) { (io(members), ...); };
  if constexpr (std::is_same_v<Type, ImportedImage>) {
    each(v.name, v.bytes, v.extension);
  } else if constexpr (std::is_same_v<Type, ImportedTexture>) {
    each(v.image, v.uv_set, v.to_image, v.wrap);
  } else if constexpr (std::is_same_v<Type, ImportedMaterial>) {
    each(v.name, v.color, v.opacity, v.alpha, v.cutoff, v.color_texture, v.opacity_texture, v.normal_texture,
         v.normal_scale, v.metalness, v.roughness, v.transmission, v.transmitted, v.transmission_texture,
         v.transmitted_texture, v.ior, v.thickness, v.emission, v.emission_texture, v.has_two_sides);
  } else if constexpr (std::is_same_v<Type, ImportedLoss>) {
    each(v.what, v.count, v.materials, v.is_surface);
  } else if constexpr (std::is_same_v<Type, ImportedMesh>) {
    each(v.name, v.material, v.positions, v.normals, v.uvs, v.triangles);
  } else if constexpr (std::is_same_v<Type, ImportedNode>) {
    each(v.name, v.parent, v.to_parent, v.meshes);
  } else if constexpr (std::is_same_v<Type, ImportedLight>) {
    each(v.type, v.color, v.inner, v.outer, v.to_world);
  } else if constexpr (std::is_same_v<Type, ImportedCamera>) {
    each(v.is_orthographic, v.half, v.to_world);
  } else {
    static_assert(std::is_same_v<Type, ImportedScene>);
    each(v.images, v.materials, v.meshes, v.nodes, v.lights, v.cameras, v.origin, v.losses, v.warnings);
  }
}

void check(bool good, const char* problem) {
  if (!good) throw std::runtime_error(problem);
}

template <class T>
void check_finite(const T& values, const char* problem) {
  for (const auto v : values) check(std::isfinite(v), problem);
}

void check_material(const ImportedMaterial& m, size_t images) {
  for (const ImportedTexture* t : m.textures()) {
    check(t->image >= -1 && t->image < int64_t(images), "a material names an image that does not exist");
    check_finite(t->to_image, "a texture has a transform that is not finite");
    check(t->wrap <= ImportedTexture::Wrap::mirror, "a texture has an unknown wrap mode");
  }
  check(m.alpha <= ImportedMaterial::Alpha::blend, "a material has an unknown alpha mode");
  constexpr const char* kProblem = "a material has a value that is not finite";
  check_finite(m.color, kProblem);
  check_finite(m.transmitted, kProblem);
  check_finite(m.normal_scale, kProblem);
  check_finite(m.emission, kProblem);
  check_finite(std::array{m.opacity, m.cutoff, m.metalness, m.roughness, m.transmission, m.ior, m.thickness}, kProblem);
}

void check_mesh(const ImportedMesh& m, size_t materials) {
  check(m.material < materials, "a mesh names a material that does not exist");
  check(m.normals.empty() || m.normals.size() == m.positions.size(), "a mesh has too few normals");
  check(m.uvs.empty() || m.uvs.size() == m.positions.size(), "a mesh has too few texture coordinates");
  for (const auto& p : m.positions) check_finite(p, "a vertex has a position that is not finite");
  for (const auto& t : m.triangles)
    for (const uint32_t i : t) check(i < m.positions.size(), "a triangle has a vertex that does not exist");
}

}  // namespace

std::string encode(const ImportedScene& scene) {
  Writer writer;
  writer.bytes = kMagic;
  writer(scene);
  return std::move(writer.bytes);
}

ImportedScene decode(std::string_view bytes) {
  check(bytes.starts_with(kMagic), "it has no header");
  Reader reader(bytes.substr(kMagic.size()));
  ImportedScene scene;
  reader(scene);
  check(reader.at_end(), "it goes on after its end");
  for (const double x : scene.origin) check(std::isfinite(x), "its origin is not finite");
  for (const auto& m : scene.materials) check_material(m, scene.images.size());
  for (const auto& m : scene.meshes) check_mesh(m, scene.materials.size());
  for (const ImportedLight& light : scene.lights) {
    check(light.type <= ImportedLight::Type::distant, "a light has an unknown type");
    for (const double v : light.color) check(v >= 0 && std::isfinite(v), "a light has a colour that is not finite");
    check(light.inner >= 0 && light.inner <= light.outer && light.outer <= 4, "a light has a cone without size");
    check_finite(light.to_world, "a light has a transform that is not finite");
  }
  for (const ImportedCamera& camera : scene.cameras) {
    for (const double v : camera.half) check(v > 0 && std::isfinite(v), "a camera has an image without size");
    check_finite(camera.to_world, "a camera has a transform that is not finite");
  }
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const ImportedNode& node = scene.nodes[i];
    check(node.parent >= -1 && node.parent < int64_t(i), "a node precedes its parent");
    check_finite(node.to_parent, "a node has a transform that is not finite");
    for (const uint32_t m : node.meshes) check(m < scene.meshes.size(), "a node names a mesh that does not exist");
  }
  return scene;
}

}  // namespace frond
