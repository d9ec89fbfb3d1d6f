#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace frond {

/// What every command that looks at materials without a scene is told of them.
struct SpecimenOptions {
  std::vector<std::string> material;  ///< NAME parameter=value ...
  std::vector<std::string> with;      ///< further materials, each in one word
  std::vector<std::string> plugins;   ///< shared objects
  std::string cache;
  uint64_t seed = 0;
  int threads = 0;
  bool no_cache = false, quiet = false;
};

void add_specimen_options(CLI::App& command, SpecimenOptions& options);
/// The same for commands that take one material.
void add_material_options(CLI::App& command, SpecimenOptions& options);

/// The words of each material, that of the command line first.
std::vector<std::vector<std::string>> specimen_words(const SpecimenOptions& options);

}  // namespace frond
