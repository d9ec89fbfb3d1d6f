#pragma once

#include <string>
#include <utility>
#include <vector>

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

  /// What differs first, for people: `seed: 1 here, 2 there`. Empty where nothing does.
  std::string difference(const Identity& other, const std::string& here, const std::string& there) const;

  friend bool operator==(const Identity&, const Identity&) = default;

 private:
  std::vector<Field> fields_;
};

}  // namespace frond
