#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "render/film/film_tile.h"
#include "scene/format/description.h"

namespace frond {

/// Identity of a render: everything that decides the value of a pixel's samples, as a list of fields (program, scene,
/// files that the scene names, wavelengths, seed). Parts can be merged if their identities are equal.
class Identity {
 public:
  struct Field {
    std::string name, value;
    friend bool operator==(const Field&, const Field&) = default;
  };
  void add(std::string name, std::string value) { fields_.push_back({std::move(name), std::move(value)}); }
  const std::vector<Field>& fields() const { return fields_; }
  /// Hash of all fields.
  uint64_t hash() const;

  /// Message about the first field that differs: `seed: 1 here, 2 there`; empty if the identities are equal.
  std::string difference(const Identity& other, const std::string& here, const std::string& there) const;

  friend bool operator==(const Identity&, const Identity&) = default;

 private:
  std::vector<Field> fields_;
};

/// Settings that decide an image's pixels in addition to the scene's description.
struct IdentityInputs {
  std::vector<std::filesystem::path> plugins;  ///< shared objects
  uint64_t seed;
  ParsedPlugin wavelengths;  ///< the wavelength strategy with its parameters
  FilmFormat format;
  std::string color_space;
  std::string command;  ///< ImageRequest::command
};

/// Identity of an image of the scene. Reads every file that the description names, and frond's own program files.
/// Throws InputError if a file cannot be read.
Identity identity_of(const SceneDescription& description, const IdentityInputs& facts);

}  // namespace frond
