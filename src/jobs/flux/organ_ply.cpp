#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "jobs/flux/energy_tables.h"
#include "report/polar_map.h"
#include "system/atomic_file.h"

namespace frond {
namespace {

static_assert(std::endian::native == std::endian::little, "the PLY files are little endian");

using Color = std::array<unsigned char, 3>;

/// Colour of a value between 0 and 1.
Color viridis(double value) {
  const double at = std::clamp(std::isnan(value) ? 0 : value, 0.0, 1.0) * double(kViridis.size() - 1);
  const auto i = std::min(size_t(at), kViridis.size() - 2);
  Color color{};
  for (size_t c = 0; c < 3; ++c) {
    const auto channel = [c](int rgb) { return double(rgb >> (16 - 8 * int(c)) & 0xff); };
    color[c] = static_cast<unsigned char>(
        std::lround(std::lerp(channel(kViridis[i]), channel(kViridis[i + 1]), at - double(i))));
  }
  return color;
}

/// Appends the bytes of a value.
template <class T>
void append(std::vector<unsigned char>& bytes, const T& value) {
  const auto* first = reinterpret_cast<const unsigned char*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

/// Light for each unit of an organ's area, by band: absorbed W/m^2, umol/(m^2 s), then the same of the incident light;
/// last the sunlit share.
std::vector<float> light_of(const FluxMeasurement& measurement, const Organs& organs, uint64_t number) {
  const size_t bands = measurement.bands.size();
  std::vector<float> light;
  const double per_area = measurement.target_area / double(organs.areas()[number - 1]);
  for (size_t band = 0; band < bands; ++band) {
    const OrganShare& share = measurement.energy->organs[(number - 1) * bands + band];
    const IncidentBand& incident = measurement.energy->incident[band];
    light.push_back(float(share.energy.mean * incident.energy.total * per_area));
    light.push_back(float(share.photons.mean * incident.photons.total * per_area));
    light.push_back(float(share.incident_energy.mean * incident.energy.total * per_area));
    light.push_back(float(share.incident_photons.mean * incident.photons.total * per_area));
  }
  light.push_back(float(measurement.energy->sunlit_organs[number - 1].mean));
  return light;
}

/// Returns the light that is shown as the brightest: that of the 98th percentile of the faces, since single organs
/// that few paths met have large errors.
double brightest(std::vector<float> values) {
  constexpr double kShown = 0.98;
  std::erase_if(values, [](float v) { return !std::isfinite(v); });
  if (values.empty()) return 1;
  const auto at = values.begin() + ptrdiff_t(kShown * double(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at > 0 ? double(*at) : 1;
}

}  // namespace

/// Each face has vertices of its own, so that a vertex has one colour and the numbers of one face.
size_t write_organ_ply(const std::string& path, const FluxMeasurement& measurement, const Organs& organs) {
  // The first pass counts the faces and finds the range of the colours, which the head states.
  std::vector<float> first_band;
  size_t faces = 0;
  bool is_far = false;  // map coordinates, which floats would round
  const size_t others = organs.visit_triangles([&](const std::array<Vec3d, 3>& corners, uint64_t number) {
    constexpr double kLargest = 10000;
    ++faces;
    is_far = is_far || std::max({std::abs(corners[0].x), std::abs(corners[0].y), std::abs(corners[0].z)}) > kLargest;
    first_band.push_back(number == 0 ? NAN : light_of(measurement, organs, number)[0]);
  });
  const double white = brightest(std::move(first_band));
  std::string numbers;  // of faces, and of their vertices, of which Blender alone reads properties
  for (const Band& band : measurement.bands)
    for (const char* what : {"_w_m2", "_umol_m2_s", "_incident_w_m2", "_incident_umol_m2_s"})
      numbers += fmt::format("property float {}{}\n", band.name, what);
  numbers += "property float sunlit_share\n";
  const char* const colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string_view kind = kOrganKinds[size_t(organs.kind())];
  const std::string head = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment absorbed light by {0}; colours from 0 to {1:.6g} W/m2 of {2}\n"
      "element vertex {3}\nproperty {4} x\nproperty {4} y\nproperty {4} z\n{5}{6}"
      "element face {7}\nproperty list uchar int vertex_indices\n{5}property float quality\n{6}property int {0}\n"
      "end_header\n",
      kind, white, measurement.bands[0].name, 3 * faces, is_far ? "double" : "float", colors, numbers, faces);
  std::vector<unsigned char> vertices, of_faces;
  int32_t next = 0;
  const std::vector<float> dark(4 * measurement.bands.size() + 1, NAN);
  (void)organs.visit_triangles([&](const std::array<Vec3d, 3>& corners, uint64_t number) {
    const std::vector<float> light = number == 0 ? dark : light_of(measurement, organs, number);
    const Color color = viridis(double(light[0]) / white);
    for (const Vec3d& corner : corners) {
      is_far ? append(vertices, corner) : append(vertices, to_float(corner));
      append(vertices, color);
      for (const float value : light) append(vertices, value);
    }
    of_faces.push_back(3);
    for (int k = 0; k < 3; ++k) append(of_faces, next++);
    append(of_faces, color);
    append(of_faces, light[0]);
    for (const float value : light) append(of_faces, value);
    append(of_faces, int32_t(number));
  });
  NewFile file(path);
  file.write(std::vector<unsigned char>(head.begin(), head.end()));
  file.write(vertices);
  file.write(of_faces);
  file.finish();
  return others;
}

}  // namespace frond
