// .leaf files, by the header for other renderers. Inputs lack the checksum at the end, which no mutation would match.

#include <optional>

#include "core/math/random.h"
#include "exports/cpp/frond_leaf.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

namespace {

std::string with_checksum(std::string_view bytes) {
  const uint64_t checksum = hash_bytes(bytes);
  return std::string(bytes).append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
}

}  // namespace

FROND_FUZZ_TARGET(leaf_file, bytes) {
  std::optional<Leaf> leaf;
  try {
    leaf.emplace(with_checksum(bytes), "a.leaf");
  } catch (const std::runtime_error& error) {
    fuzz::require(std::string_view(error.what()).starts_with("a.leaf: "), "an error names the file");
    return;
  }
  const std::vector<float>& nm = leaf->wavelengths_nm();
  fuzz::require(!nm.empty(), "there is a wavelength");
  for (const double lambda_nm : {0.0, double(nm.front()), (double(nm.front()) + double(nm.back())) / 2, 1e9})
    for (const double depth : {0.0, 0.5, 1e9}) {
      const Leaf::At at = leaf->at(lambda_nm, depth);
      for (const double z : {1.0, 0.6, -0.6, 1e-9, 0.0}) {
        const Leaf::Direction w{std::sqrt(1 - z * z), 0, z};
        leaf->f(at, w, {0, 0, 1});
        leaf->f(at, w, {-w.x, 0, -w.z});
        leaf->pdf(at, w, leaf->sample(at, w, 0.5, 0.5, 0.5).leaving);
        leaf->sample(at, w, 0, 0.999, 0);
      }
    }
}
