#include "scene/format/known_names.h"

#include <algorithm>

#include "core/messages/excerpt.h"

namespace frond {

std::string suggested_name(const SceneSettings& scene, std::string_view name,
                           const std::vector<std::string_view>& defined) {
  const auto foreign = std::ranges::find_if(scene.files, [](const auto& file) { return is_foreign(file); });
  if (foreign == scene.files.end()) return suggestion(name, defined);
  if (const auto match = nearest(name, defined); !match.empty())
    return fmt::format("; did you mean \"{}\"?", excerpt(match, *foreign));
  std::vector<std::string> cut;
  for (const std::string_view known : defined) cut.push_back(excerpt(known, *foreign));
  return suggestion(name, {cut.begin(), cut.end()});
}

}  // namespace frond
