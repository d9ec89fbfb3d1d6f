#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "render/film/film_tile.h"
#include "scene/format/description.h"

namespace frond {

/// All that decides a pixel's value but which of its samples there are, field by field: the program, the scene, the
/// files that it names, wavelengths, seed. Renders of one identity can be added up.
class Identity {
 public:
  struct Field {
    std::string name, value;
    friend bool operator==(const Field&, const Field&) = default;
  };
  void add(std::string name, std::string value) { fields_.push_back({std::move(name), std::move(value)}); }
  const std::vector<Field>& fields() const { return fields_; }
  uint64_t hash() const;

  /// What differs first, for people: `seed: 1 here, 2 there`. Empty where nothing does.
  std::string difference(const Identity& other, const std::string& here, const std::string& there) const;

  friend bool operator==(const Identity&, const Identity&) = default;

 private:
  std::vector<Field> fields_;
};

/// What decides an image's pixels beside its description.
struct ImageFacts {
  std::vector<std::filesystem::path> plugins;  ///< shared objects
  uint64_t seed;
  ParsedPlugin wavelengths;  ///< the description's, with its parameters
  FilmFormat format;
  std::string color_space;
  std::string command;  ///< what asks for the image
};

/// The identity of such an image of the description. Reads every file that the description names, and frond's own
/// code.
Identity identity_of(const SceneDescription& description, const ImageFacts& facts);

}  // namespace frond
