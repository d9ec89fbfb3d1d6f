#include "render/identity.h"

#include <fmt/format.h>

#include <algorithm>

namespace frond {

std::string Identity::difference(const Identity& other, const std::string& here, const std::string& there) const {
  for (const Field& field : fields_) {
    const auto same = std::ranges::find(other.fields_, field.name, &Field::name);
    if (same == other.fields_.end())
      return fmt::format("{}: {} in {}, nothing in {}", field.name, field.value, here, there);
    if (same->value != field.value)
      return fmt::format("{}: {} in {}, {} in {}", field.name, field.value, here, same->value, there);
  }
  for (const Field& field : other.fields_)
    if (std::ranges::find(fields_, field.name, &Field::name) == fields_.end())
      return fmt::format("{}: nothing in {}, {} in {}", field.name, here, field.value, there);
  return {};
}

}  // namespace frond
