#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace frond {
namespace {

using Layers = std::map<std::string, std::set<std::string>>;

/// The direction of includes, as docs/architecture.md states it: what each layer may include besides itself.
const Layers kAllowed{
    {"core", {}},
    {"system", {"core"}},
    {"spectra", {"core", "system"}},
    {"leaf", {"core", "system", "spectra"}},
    {"materials", {"core", "system", "spectra", "leaf"}},
    {"image", {"core", "system", "spectra"}},
    {"openimageio", {"core", "system", "image"}},
    {"scene", {"core", "system", "spectra", "image"}},
    {"integrators", {"core", "spectra", "scene"}},
    {"render", {"core", "system", "spectra", "image", "scene", "integrators", "materials", "instruments"}},
    {"instruments", {"core", "spectra"}},
    {"exports", {"core", "system", "spectra", "instruments"}},
    {"radiometry", {"core", "system", "spectra", "scene", "instruments", "render"}},
    {"report", {"core", "system", "spectra", "leaf", "instruments", "radiometry"}},
    {"study", {"core", "system", "spectra", "image", "scene", "render", "instruments", "report"}},
    {"jobs",
     {"core", "system", "spectra", "leaf", "materials", "image", "scene", "integrators", "render", "instruments",
      "exports", "radiometry", "report", "study"}},
    {"cli", {"core", "system", "scene", "render", "report", "jobs"}},
};

/// "file: includes" lines of every include that `allowed` does not permit.
std::set<std::string> violations(const std::filesystem::path& src, const Layers& allowed) {
  static const std::regex include(R"re(^\s*#include\s+"([a-z_]+)/([^"]+)")re");
  std::set<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(src)) {
    if (!entry.is_regular_file()) continue;
    const auto relative = std::filesystem::relative(entry.path(), src);
    const std::string layer = relative.begin()->string();
    const auto rule = allowed.find(layer);
    if (rule == allowed.end()) {
      found.insert(relative.string() + ": unknown layer");
      continue;
    }
    std::ifstream in(entry.path());
    std::smatch match;
    for (std::string line; std::getline(in, line);)
      if (std::regex_search(line, match, include) && match[1] != layer && !rule->second.contains(match[1]))
        found.insert(relative.string() + ": " + match[1].str() + "/" + match[2].str());
  }
  return found;
}

TEST(Architecture, IncludesPointOneWay) {
  EXPECT_EQ(violations(FROND_SOURCE_DIR "/src", kAllowed), std::set<std::string>{});
}

TEST(Architecture, AnIncludeTheOtherWayIsFound) {
  Layers stricter = kAllowed;
  stricter["spectra"].clear();
  EXPECT_FALSE(violations(FROND_SOURCE_DIR "/src", stricter).empty());
}

TEST(Architecture, ImageAndColourLibrariesStayInTheFilesThatNeedThem) {
  static const std::regex heavy(
      R"re(#include\s+["<](OpenImageIO/|OpenEXR/|OpenColorIO/|CLI/|nlohmann/|embree[34]/|scene/geometry/embree))re");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(FROND_SOURCE_DIR "/src")) {
    if (entry.path().extension() != ".h" || entry.path().filename().string().starts_with("embree")) continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) EXPECT_FALSE(std::regex_search(line, heavy)) << entry.path();
  }
}

// Linking it takes 0.3 s: it is opened where a picture needs it (image/image_codec.h).
TEST(Architecture, OpenImageIOIsCalledByItsRoomAlone) {
  int includes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(FROND_SOURCE_DIR "/src")) {
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);)
      if (line.starts_with("#include <OpenImageIO/")) {
        ++includes;
        EXPECT_EQ(entry.path().parent_path().filename(), "openimageio") << entry.path();
      }
  }
  EXPECT_GE(includes, 1);
}

// A file that is compiled for instructions which a machine may lack must not bring inline functions that the linker
// could take for other files.
TEST(Architecture, KernelsForOtherInstructionsIncludeNothingWithFunctions) {
  static const std::regex include(R"re(^\s*#include\s+(.+))re");
  static const std::regex harmless(
      R"re(<c(stddef|stdint)>|<[a-z]mmintrin\.h>|"leaf/walk/batch_(event|lanes|slots)\.h")re");
  int includes = 0;
  for (const char* file : {"batch_avx2.cpp", "batch_avx512.cpp", "batch_event.h", "batch_lanes.h", "batch_slots.h"}) {
    std::ifstream in(std::string(FROND_SOURCE_DIR "/src/leaf/walk/") + file);
    std::smatch match;
    for (std::string line; std::getline(in, line);)
      if (std::regex_search(line, match, include)) {
        ++includes;
        EXPECT_TRUE(std::regex_match(match[1].str(), harmless)) << file << ": " << line;
      }
  }
  EXPECT_GE(includes, 8);
}

}  // namespace
}  // namespace frond
