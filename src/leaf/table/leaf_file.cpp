#include "leaf/table/leaf_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "core/math/random.h"
#include "leaf/table/exit_weights.h"
#include "leaf/table/surface_scaling.h"
#include "leaf/tissue/lobe.h"

namespace frond::leaf {
namespace {

void add_surface(LeafFile& leaf) {
  if (!leaf.is_reciprocal) {
    const TabulatedLobe lobe(leaf.exponent);
    for (const double c : CosineNodes::cosines()) leaf.surface.push_back(static_cast<float>(lobe.kept_share(c)));
    return;
  }
  const auto [least, most] = std::ranges::minmax_element(leaf.index);
  const SurfaceScaling scaling({leaf.exponent, leaf.exponent}, {double(*least), double(*most)});
  const auto place = scaling.position(static_cast<float>(leaf.exponent));
  for (const float n : leaf.index)
    for (const double c : CosineNodes::cosines())
      leaf.surface.push_back(scaling.at(place, static_cast<float>(c), Float4{n, n, n, n})[0]);
}

void add_series(LeafFile& leaf, const ModeTable& spectrum) {
  const size_t places = leaf.side() * leaf.side();
  for (const bool from_below : {false, true})
    for (const bool crosses : {false, true}) {
      size_t& modes = leaf.modes[from_below][crosses];
      for (const LeafModes& column : spectrum.modes) modes = std::max(modes, column.series(from_below, crosses).size());
      std::vector<float>& values = leaf.series[from_below][crosses];
      values.assign(spectrum.modes.size() * modes * places, 0);
      for (size_t c = 0; c < spectrum.modes.size(); ++c) {
        const auto& series = spectrum.modes[c].series(from_below, crosses);
        for (size_t m = 0; m < series.size(); ++m)
          std::ranges::copy(series[m], values.begin() + std::ptrdiff_t((c * modes + m) * places));
      }
    }
}

void add_ways(LeafFile& leaf, const ModeTable& spectrum) {
  const size_t side = leaf.side(), depths = std::max<size_t>(1, leaf.depths.size());
  const Measure measure = leaf.is_reciprocal ? Measure::plain : Measure::over_inner_cosine;
  for (size_t c = 0; c < spectrum.modes.size(); ++c) {
    const std::vector<double> weights = exit_weights(double(leaf.index[c / depths]), leaf.cells, measure);
    for (const bool below : {false, true})
      for (size_t i = 0; i < side; ++i)
        for (const bool crosses : {false, true}) {
          const double* h = &spectrum.modes[c].series(below, crosses)[0][i * side];
          leaf.ways[below].push_back(static_cast<float>(std::inner_product(weights.begin(), weights.end(), h, 0.0)));
        }
  }
}

class Writer {
 public:
  explicit Writer(std::string& bytes) : bytes_(bytes) {}
  void add(uint32_t value) { append(&value, sizeof value); }
  void add(const std::vector<float>& values) { append(values.data(), values.size() * sizeof(float)); }
  void add(const std::vector<double>& values) { add(std::vector<float>(values.begin(), values.end())); }

 private:
  static_assert(std::endian::native == std::endian::little);
  void append(const void* data, size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string& bytes_;
};

}  // namespace

LeafFile make_leaf_file(const ModeTableRequest& request, const ModeTable& spectrum, double exponent) {
  LeafFile leaf;
  leaf.is_reciprocal = spectrum.is_reciprocal;
  leaf.cells = static_cast<size_t>(spectrum.cells);
  leaf.exponent = exponent;
  leaf.wavelengths_nm = request.wavelengths_nm;
  leaf.depths = request.depths.depths();
  const size_t depths = std::max<size_t>(1, leaf.depths.size());
  for (size_t c = 0; c < spectrum.index.size(); c += depths) leaf.index.push_back(float(spectrum.index[c]));
  add_surface(leaf);
  add_series(leaf, spectrum);
  add_ways(leaf, spectrum);
  return leaf;
}

std::string leaf_file_bytes(const LeafFile& leaf) {
  std::string bytes = "FRONDLF1";
  Writer writer(bytes);
  writer.add(uint32_t(leaf.is_reciprocal));
  writer.add(uint32_t(leaf.cells));
  writer.add(uint32_t(leaf.wavelengths_nm.size()));
  writer.add(uint32_t(leaf.depths.size()));
  for (const auto& of_side : leaf.modes)
    for (const size_t modes : of_side) writer.add(uint32_t(modes));
  writer.add(std::vector<float>{static_cast<float>(leaf.exponent)});
  writer.add(leaf.wavelengths_nm);
  writer.add(leaf.depths);
  writer.add(leaf.index);
  writer.add(leaf.surface);
  for (const auto& of_side : leaf.series)
    for (const std::vector<float>& values : of_side) writer.add(values);
  for (const std::vector<float>& values : leaf.ways) writer.add(values);
  const uint64_t checksum = hash_bytes(bytes);
  writer.add(uint32_t(checksum));
  writer.add(uint32_t(checksum >> 32));
  return bytes;
}

}  // namespace frond::leaf
