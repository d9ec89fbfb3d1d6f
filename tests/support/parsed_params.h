#pragma once

#include "core/params.h"

/// Parameters as a parser gives them, without a place.
namespace frond::test {

inline ParsedParam words(std::string name, std::vector<std::string> values) {
  return {"string", std::move(name), {}, {}, std::move(values)};
}
inline ParsedParam word(std::string name, std::string value) { return words(std::move(name), {std::move(value)}); }
inline ParsedParam real(std::string name, double value) {
  return {"float", std::move(name), {}, {}, std::vector<double>{value}};
}
inline ParsedParam texture(std::string name, std::vector<std::string> textures) {
  return {"texture", std::move(name), {}, {}, std::move(textures)};
}
inline ParsedParam flag(std::string name, bool value) {
  return {"bool", std::move(name), {}, {}, std::vector<bool>{value}};
}
/// The same value at every wavelength.
inline ParsedParam level(std::string name, double value) {
  return {"spectrum", std::move(name), {}, {}, std::vector<double>{300, value, 3000, value}};
}

}  // namespace frond::test
