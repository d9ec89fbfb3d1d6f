#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/film/film.h"

namespace frond {

// Cryptomatte, specification 1.2.0 (Friedman and Jones, Psyop, 2015): https://github.com/Psyop/Cryptomatte

/// Names of the surfaces, or groups of surfaces, of MatteKeys.
struct MatteNames {
  std::vector<std::string> materials = {};  ///< by index
  /// Names of objects, each with the first number of the instances that have it, ascending.
  std::vector<std::pair<uint64_t, std::string>> objects = {};

  /// Name of a material, or an object's name with the number of its instance: "leaf.17".
  std::string name(MatteKey key) const;
};

/// MurmurHash3_x86_32 with seed 0 (Appleby, public domain).
uint32_t murmur3(std::string_view bytes);
/// Hash of a name as the float of a pixel, which is finite and normalized.
float matte_id(std::string_view name);

/// Number of surfaces of a pixel that the channels hold: those that cover most of it.
inline constexpr size_t kMatteRanks = 6;

/// Names of the channels of a layer: LAYER00.R to LAYER02.A, pairs of an ID and its coverage.
std::vector<std::string> matte_channels(std::string_view layer);
/// Values of these channels.
std::vector<float> matte_values(const std::vector<Matte>& mattes, const MatteNames& names);
/// Attributes of a file: name of the layer, and a manifest of the names in list `list` of the film.
std::map<std::string, std::string> matte_attributes(std::string_view layer, const Film& film, size_t list,
                                                    const MatteNames& names);

}  // namespace frond
