#include <array>

#include "shapes/ply.h"
#include "shapes/ply_header.h"
#include "shapes/ply_source.h"
#include "system/file_range.h"
#include "system/gzip.h"

namespace frond {
namespace {

constexpr size_t kStart = 1 << 14;  ///< bytes of a file that are read
constexpr uint64_t kMostRows = 64;

/// Reads rows until the bytes end.
template <class Source>
std::vector<Vec3d> points_of(Source source, const PlyElement& element) {
  std::vector<Vec3d> points;
  for (uint64_t row = 0; row < std::min(element.count, kMostRows); ++row) {
    std::array<double, 3> p{};
    if (!source.start_row()) return points;
    for (const PlyProperty& property : element.properties) {
      double value = 0;
      if (property.count_type || !source.next(property.type, value)) return points;
      for (size_t axis = 0; axis < 3; ++axis)
        if (property.name == std::array{"x", "y", "z"}[axis]) p[axis] = value;
    }
    if (!source.end_row()) return points;
    points.push_back({p[0], p[1], p[2]});
  }
  return points;
}

/// Sample of a file in which other elements precede the vertices.
PlySample sample_whole(const std::filesystem::path& path) {
  const PlyMesh file = read_ply(path);
  PlySample sample{.points = {}, .vertices = file.mesh.p.size()};
  for (size_t i = 0; i < std::min<size_t>(file.mesh.p.size(), kMostRows); ++i)
    sample.points.push_back(to_double(file.mesh.p[i]));
  return sample;
}

}  // namespace

std::optional<PlySample> sample_ply(const std::filesystem::path& path) {
  std::string bytes = read_file_range(path, 0, kStart);
  if (is_gzip(bytes)) bytes = unpack_gzip_start(bytes);
  try {
    const auto file = std::make_shared<const std::string>(path.string());
    const PlyHeader header = read_ply_header(bytes, file);
    if (header.elements.empty() || header.elements.front().name != "vertex") return sample_whole(path);
    const PlyElement& vertex = header.elements.front();
    PlySample sample{.points = {}, .vertices = vertex.count};
    if (header.format == PlyFormat::ascii)
      sample.points = points_of(ply::AsciiSource(bytes, header, file), vertex);
    else
      sample.points = points_of(ply::BinarySource(bytes, header, file), vertex);
    return sample;
  } catch (const InputError&) {  // the mesh's reader reports it
    return {};
  }
}

}  // namespace frond
