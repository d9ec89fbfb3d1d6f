#include "render/film/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>
#include <set>

namespace frond {

std::string MatteNames::name(MatteKey key) const {
  if (key < 0) {
    const auto index = size_t(-(key + 1));
    return index < materials.size() ? materials[index] : fmt::format("material.{}", index + 1);
  }
  const auto next = std::ranges::upper_bound(objects, uint64_t(key), {}, &std::pair<uint64_t, std::string>::first);
  return fmt::format("{}.{}", next == objects.begin() ? "instance" : std::prev(next)->second, key);
}

uint32_t murmur3(std::string_view bytes) {
  const auto byte = [&bytes](size_t i) { return uint32_t(static_cast<unsigned char>(bytes[i])); };
  const auto scrambled = [](uint32_t k) { return std::rotl(k * 0xcc9e2d51u, 15) * 0x1b873593u; };
  uint32_t hash = 0;
  size_t i = 0;
  for (; i + 4 <= bytes.size(); i += 4) {
    hash ^= scrambled(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
    hash = std::rotl(hash, 13) * 5 + 0xe6546b64u;
  }
  uint32_t tail = 0;
  for (size_t j = bytes.size(); j > i; --j) tail = tail << 8 | byte(j - 1);
  hash ^= scrambled(tail);  // 0 stays 0
  hash ^= uint32_t(bytes.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

namespace {

/// The specification flips the lowest bit of an exponent that would make the float denormal, infinite or not a number.
uint32_t id_bits(std::string_view name) {
  const uint32_t hash = murmur3(name), exponent = hash >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

}  // namespace

float matte_id(std::string_view name) { return std::bit_cast<float>(id_bits(name)); }

std::vector<std::string> matte_channels(std::string_view layer) {
  std::vector<std::string> names;
  for (size_t i = 0; i < kMatteRanks / 2; ++i)
    for (const char channel : {'R', 'G', 'B', 'A'}) names.push_back(fmt::format("{}{:02}.{}", layer, i, channel));
  return names;
}

std::vector<float> matte_values(const std::vector<Matte>& mattes, const MatteNames& names) {
  std::vector<float> values(2 * kMatteRanks);
  for (size_t i = 0; i < std::min(kMatteRanks, mattes.size()); ++i) {
    values[2 * i] = matte_id(names.name(mattes[i].key));
    values[2 * i + 1] = float(mattes[i].coverage);
  }
  return values;
}

std::map<std::string, std::string> matte_attributes(std::string_view layer, const Film& film, size_t list,
                                                    const MatteNames& names) {
  std::set<MatteKey> keys;
  const Crop& crop = film.settings().crop;
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x)
      for (const Matte& matte : film.mattes(x, y, list)) keys.insert(matte.key);
  nlohmann::ordered_json manifest = nlohmann::ordered_json::object();
  for (const MatteKey key : keys) {
    const std::string name = names.name(key);
    manifest[name] = fmt::format("{:08x}", id_bits(name));
  }
  const std::string prefix = fmt::format("cryptomatte/{:.7}/", fmt::format("{:08x}", murmur3(layer)));
  return {{prefix + "name", std::string(layer)},
          {prefix + "hash", "MurmurHash3_32"},
          {prefix + "conversion", "uint32_to_float32"},
          {prefix + "manifest", manifest.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace)}};
}

}  // namespace frond
