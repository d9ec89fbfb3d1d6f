#include "shapes/ply_writer.h"

#include <fmt/format.h>

#include <bit>

namespace frond {
namespace {

static_assert(std::endian::native == std::endian::little, "the PLY files are little endian");

void append(std::vector<unsigned char>& bytes, const void* data, size_t size) {
  const auto* first = static_cast<const unsigned char*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

}  // namespace

std::vector<unsigned char> ply_file(const TriangleMesh& mesh) {
  std::string head = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.p.size());
  for (const char* name : {"x", "y", "z"}) head += fmt::format("property float {}\n", name);
  if (!mesh.n.empty())
    for (const char* name : {"nx", "ny", "nz"}) head += fmt::format("property float {}\n", name);
  if (!mesh.uv.empty()) head += "property float u\nproperty float v\n";
  head += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.size());
  std::vector<unsigned char> bytes(head.begin(), head.end());
  bytes.reserve(bytes.size() + mesh.p.size() * 32 + mesh.triangles.size() * 13);
  for (size_t i = 0; i < mesh.p.size(); ++i) {
    append(bytes, &mesh.p[i], sizeof(Vec3));
    if (!mesh.n.empty()) append(bytes, &mesh.n[i], sizeof(Vec3));
    if (!mesh.uv.empty()) append(bytes, &mesh.uv[i], sizeof(Vec2));
  }
  for (const auto& triangle : mesh.triangles) {
    bytes.push_back(3);
    append(bytes, triangle.data(), sizeof triangle);
  }
  return bytes;
}

}  // namespace frond
