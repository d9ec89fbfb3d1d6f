#include <fnmatch.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "leaf/tissue/leaf_numbers.h"

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
    {"cameras", {"core", "spectra"}},
    {"lights", {"core", "spectra", "image"}},
    {"media", {"core", "system", "spectra", "textures"}},
    {"shapes", {"core", "system"}},
    {"textures", {"core", "spectra", "image"}},
    {"scene", {"core", "system", "spectra", "image", "cameras", "lights", "media", "shapes", "textures"}},
    {"integrators", {"core", "spectra", "media", "scene"}},
    {"render", {"core", "system", "spectra", "image", "scene", "integrators", "materials", "instruments"}},
    {"instruments", {"core", "spectra"}},
    {"exports", {"core", "system", "spectra", "leaf", "image", "lights", "shapes", "textures", "scene", "instruments"}},
    {"imports", {"core", "system", "image", "shapes", "scene"}},
    {"models", {"core", "system", "imports"}},
    {"radiometry", {"core", "system", "spectra", "scene", "integrators", "instruments", "render"}},
    {"report", {"core", "system", "spectra", "leaf", "instruments", "radiometry"}},
    {"study", {"core", "system", "spectra", "image", "textures", "scene", "render", "instruments", "report"}},
    {"jobs",
     {"core", "system", "spectra", "leaf", "materials", "image", "cameras", "textures", "scene", "integrators",
      "render", "instruments", "exports", "imports", "radiometry", "report", "study"}},
    {"cli", {"core", "system", "scene", "render", "report", "jobs"}},
};

/// Inside a layer that has folders: what each folder may include of the same layer, besides itself. "" is what lies in
/// the layer itself.
const std::map<std::string, Layers> kAllowedInside{
    {"core", {{"units", {}}, {"math", {"units"}}, {"", {"math", "units"}}, {"messages", {"", "units"}}}},
    {"scene", {{"format", {}}, {"geometry", {}}, {"", {"format", "geometry"}}}},
    {"spectra", {{"", {}}, {"color", {""}}, {"wavelengths", {"", "color"}}}},
    {"leaf",
     {{"tissue", {}},
      {"walk", {"tissue"}},
      {"solve", {"tissue"}},
      {"table", {"tissue", "walk", "solve"}},
      {"fluorescence", {"tissue", "walk", "solve", "table"}},
      {"fit", {"tissue", "solve", "table"}},
      {"plates", {"tissue", "fit"}}}},
    {"materials", {{"lobes", {}}, {"measured", {"lobes"}}, {"", {"lobes", "measured"}}}},
    {"render", {{"film", {}}, {"parts", {"film"}}, {"", {"film", "parts"}}}},
    {"instruments", {{"errors", {}}, {"", {"errors"}}, {"conformance", {"", "errors"}}}},
    {"exports", {{"", {}}, {"mitsuba", {""}}}},
    {"study", {{"", {}}, {"compare", {""}}, {"compare/report", {"compare", ""}}, {"choose", {""}}}},
    {"jobs",
     {{"record", {}},
      {"leaf", {}},
      {"support", {"record", "leaf"}},
      {"submit", {"support"}},
      {"flux", {"record", "support"}},
      {"", {"record", "leaf", "support", "submit", "flux"}}}},
};

struct Include {
  std::filesystem::path by, of;  ///< relative to src
};

std::vector<Include> all_includes(const std::filesystem::path& src) {
  static const std::regex include(R"re(^\s*#include\s+"([^"]+)")re");
  std::vector<Include> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(src)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path());
    std::smatch match;
    for (std::string line; std::getline(in, line);)
      if (std::regex_search(line, match, include))
        found.push_back({std::filesystem::relative(entry.path(), src), match[1].str()});
  }
  return found;
}

std::string layer_of(const std::filesystem::path& file) { return file.begin()->string(); }
/// Within its layer; "" of a file in the layer itself.
std::string folder_of(const std::filesystem::path& file) {
  const auto folder = std::filesystem::relative(file.parent_path(), layer_of(file)).string();
  return folder == "." ? "" : folder;
}

/// "file: includes" lines of every include that is not permitted, and folders that are in no table.
std::set<std::string> violations(const std::vector<Include>& includes, const Layers& allowed,
                                 const std::map<std::string, Layers>& inside) {
  std::set<std::string> found;
  for (const auto& [by, of] : includes) {
    const std::string layer = layer_of(by), folder = folder_of(by);
    const std::string text = by.string() + ": " + of.string();
    const auto rule = allowed.find(layer);
    if (rule == allowed.end()) {
      found.insert(layer + ": unknown layer");
    } else if (layer != layer_of(of)) {
      if (!rule->second.contains(layer_of(of))) found.insert(text);
    } else if (const auto folders = inside.find(layer); folders == inside.end()) {
      if (!folder.empty()) found.insert(layer + "/" + folder + ": unknown folder");
    } else if (const auto here = folders->second.find(folder); here == folders->second.end()) {
      found.insert(layer + "/" + folder + ": unknown folder");
    } else if (folder != folder_of(of) && !here->second.contains(folder_of(of))) {
      found.insert(text);
    }
  }
  return found;
}

/// The first cycle among the tables' names, or "".
std::string cycle_in(const Layers& layers) {
  std::set<std::string> done;
  while (done.size() < layers.size()) {
    const auto next = std::ranges::find_if(layers, [&done](const auto& layer) {
      return !done.contains(layer.first) &&
             std::ranges::all_of(layer.second, [&done](const std::string& of) { return done.contains(of); });
    });
    if (next == layers.end())
      return std::ranges::find_if(layers, [&done](const auto& l) { return !done.contains(l.first); })->first + " ...";
    done.insert(next->first);
  }
  return "";
}

const std::filesystem::path kSrc = FROND_SOURCE_DIR "/src";

TEST(Architecture, IncludesPointOneWay) {
  const std::vector<Include> includes = all_includes(kSrc);
  EXPECT_GT(includes.size(), 1000u);
  EXPECT_EQ(violations(includes, kAllowed, kAllowedInside), std::set<std::string>{});
}

TEST(Architecture, TheTablesHaveNoCycle) {
  EXPECT_EQ(cycle_in(kAllowed), "");
  for (const auto& [layer, folders] : kAllowedInside) EXPECT_EQ(cycle_in(folders), "") << layer;
  EXPECT_EQ(cycle_in({{"a", {"b"}}, {"b", {"a"}}, {"c", {}}}), "a ...");
}

/// Rows of a Markdown table whose first column is `name` and whose last is what it includes.
Layers table_of(const std::string& page, const std::string& after) {
  static const std::regex word(R"re(`([a-z]+)`)re");
  const auto words = [](const std::string& text) {
    std::set<std::string> found;
    for (std::sregex_iterator i(text.begin(), text.end(), word), end; i != end; ++i) found.insert((*i)[1]);
    return found;
  };
  Layers table;
  std::istringstream in(page.substr(page.find(after)));
  std::string line;
  while (std::getline(in, line) && !line.starts_with("|---")) {
  }
  while (std::getline(in, line) && line.starts_with("| `")) {
    const size_t end = line.rfind('|'), last = line.rfind('|', end - 1);
    const std::string name = *words(line.substr(0, line.find('|', 1))).begin();
    table[name] = words(line.substr(last, end - last));
  }
  return table;
}

TEST(Architecture, ThePageHasTheSameTable) {
  std::ifstream in(FROND_SOURCE_DIR "/docs/architecture.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  Layers modules = table_of(page, "## Modules");
  EXPECT_EQ(modules["jobs"], std::set<std::string>{"cli"}) << "all but";
  modules["jobs"] = kAllowed.at("jobs");
  EXPECT_EQ(modules, kAllowed);
}

TEST(Architecture, AnIncludeTheOtherWayIsFound) {
  const std::vector<Include> includes = all_includes(kSrc);
  Layers stricter = kAllowed;
  stricter["spectra"].clear();
  EXPECT_FALSE(violations(includes, stricter, kAllowedInside).empty());
  auto inside = kAllowedInside;
  inside["scene"][""].erase("geometry");
  EXPECT_EQ(violations(includes, kAllowed, inside).count("scene/scene.h: scene/geometry/geometry.h"), 1u);
  inside["scene"].erase("format");
  EXPECT_EQ(violations(includes, kAllowed, inside).count("scene/format: unknown folder"), 1u);
}

// Longer files and fuller folders must be divided.
TEST(Architecture, FilesAndFoldersAreSmall) {
  constexpr int kMostLines = 500, kMostFiles = 40;
  std::map<std::filesystem::path, int> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSrc)) {
    if (!entry.is_regular_file()) continue;
    const int in_folder = ++files[entry.path().parent_path()];
    EXPECT_LE(in_folder, kMostFiles) << entry.path().parent_path();
    const auto extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream in(entry.path());
    const auto lines = std::count(std::istreambuf_iterator<char>(in), {}, '\n');
    EXPECT_LE(lines, kMostLines) << entry.path();
  }
  EXPECT_GT(files.size(), 20u);
}

// A comment says why, or states an invariant, a unit or a source.
TEST(Architecture, OneLineInTenIsAComment) {
  static const std::regex comment(R"re(^\s*//|///<)re");
  std::map<std::string, std::pair<int, int>> lines;  // of each module: comments, all that are not empty
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSrc)) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    auto& [comments, all] = lines[std::filesystem::relative(entry.path(), kSrc).begin()->string()];
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      all += line.find_first_not_of(' ') != line.npos;
      comments += std::regex_search(line, comment);
    }
  }
  EXPECT_GT(lines.size(), 15u);
  for (const auto& [module, count] : lines) EXPECT_GE(10 * count.first, count.second) << "src/" << module;
}

TEST(Architecture, ImageAndColourLibrariesStayInTheFilesThatNeedThem) {
  static const std::regex heavy(
      R"re(#include\s+["<](OpenImageIO/|OpenEXR/|OpenColorIO/|webp/|CLI/|nlohmann/|embree[34]/|scene/geometry/embree))re");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(FROND_SOURCE_DIR "/src")) {
    const std::string name = entry.path().filename().string();  // gltf_json.h: of a program of its own
    if (entry.path().extension() != ".h" || name.starts_with("embree") || name == "gltf_json.h") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) EXPECT_FALSE(std::regex_search(line, heavy)) << entry.path();
  }
}

/// Names in the root of the repository: those that git tracks, or in an archive of the sources all that .gitignore does
/// not name.
std::set<std::string> names_in_root() {
  std::set<std::string> names;
  if (FILE* listed = std::filesystem::exists(FROND_SOURCE_DIR "/.git")
                         ? popen("git -C '" FROND_SOURCE_DIR "' ls-files -z 2>/dev/null", "r")
                         : nullptr) {
    std::string text;
    for (int c; (c = std::fgetc(listed)) != EOF;) text += char(c);
    pclose(listed);
    std::istringstream in(text);
    for (std::string path; std::getline(in, path, '\0');) names.insert(path.substr(0, path.find('/')));
  }
  if (!names.empty()) return names;
  std::vector<std::string> ignored{".git"};
  std::ifstream in(FROND_SOURCE_DIR "/.gitignore");
  for (std::string line; std::getline(in, line);) {
    std::erase(line, '/');
    if (!line.empty()) ignored.push_back(line);
  }
  for (const auto& entry : std::filesystem::directory_iterator(FROND_SOURCE_DIR)) {
    const std::string name = entry.path().filename().string();
    if (std::ranges::none_of(ignored, [&](const std::string& i) { return fnmatch(i.c_str(), name.c_str(), 0) == 0; }))
      names.insert(name);
  }
  return names;
}

/// A file named -q lay there for months: an option's value that a command took for a file.
TEST(Architecture, TheRootHoldsWhatIsListedHere) {
  std::istringstream listed(
      ".ci .clang-format .clang-tidy .gitattributes .github .gitignore CHANGELOG.md CITATION.cff CMakeLists.txt "
      "CMakePresets.json CONTRIBUTING.md Dockerfile HACKING.md LICENSE LICENSES NOTICE README.md REUSE.toml "
      "SECURITY.md bench "
      "cmake "
      "docs examples exports leaf_benchmark measurements mkdocs.yml packaging pyproject.toml python scenes scripts src "
      "tests");
  const std::set<std::string> allowed(std::istream_iterator<std::string>(listed), {});
  const std::set<std::string> found = names_in_root();
  EXPECT_TRUE(found.contains("CMakeLists.txt"));
  for (const std::string& name : found) EXPECT_TRUE(allowed.contains(name)) << name;
}

/// Names of the materials of src/materials that state to be leaf models (MaterialInfo::leaf).
std::set<std::string> names_of_leaf_models() {
  static const std::regex name(R"re(\{"material",\s*"(\w+)")re");
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kSrc / "materials")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    std::smatch match;
    if (text.find("LeafModel{.reference") != text.npos && std::regex_search(text, match, name)) names.insert(match[1]);
  }
  return names;
}

/// Code distinguishes leaf models by their records only, so that models of shared objects are treated equally.
TEST(Architecture, LeafModelsAreNamedByMaterialsAndExportsAlone) {
  const std::set<std::string> names = names_of_leaf_models();
  EXPECT_GE(names.size(), 4u);
  std::string any;
  for (const std::string& name : names) any += (any.empty() ? "" : "|") + name;
  const std::regex literal("\"[^\"]*\\b(" + any + ")\\b[^\"]*\"");
  EXPECT_TRUE(std::regex_search("run(\"material abm,mode=x\")", literal));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSrc)) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    const std::string layer = layer_of(std::filesystem::relative(entry.path(), kSrc));
    if (layer == "materials" || layer == "exports") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);)
      EXPECT_FALSE(std::regex_search(line, literal)) << entry.path() << ": " << line;
  }
}

TEST(Architecture, CLI11IsIncludedOnce) {
  std::set<std::string> by;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSrc)) {
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);)
      if (line.starts_with("#include <CLI/")) by.insert(std::filesystem::relative(entry.path(), kSrc).string());
  }
  EXPECT_EQ(by, std::set<std::string>{"cli/app.cpp"});
}

/// Two types of one name in one namespace are one to the linker, which takes the functions of either for both.
TEST(Architecture, TypesOfOneNameAreDefinedOnce) {
  static const std::regex opens(R"re(^namespace ?([a-z_:]*) ?\{)re"),
      type(R"re(^(?:struct|class|enum class) (\w+)(?: final)?(?: : [^;]*)? \{)re");
  std::map<std::string, std::set<std::string>> defined;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSrc)) {
    if (!entry.is_regular_file()) continue;
    std::vector<std::string> namespaces;
    std::ifstream in(entry.path());
    std::smatch match;
    for (std::string line; std::getline(in, line);) {
      if (std::regex_search(line, match, opens))
        namespaces.push_back(match[1].length() > 0 ? match[1].str() : "unnamed in " + entry.path().string());
      else if (line.starts_with("}  // namespace") && !namespaces.empty())
        namespaces.pop_back();
      else if (std::regex_search(line, match, type)) {
        std::string name;
        for (const std::string& n : namespaces) name += n + "::";
        defined[name + match[1].str()].insert(std::filesystem::relative(entry.path(), kSrc).string());
      }
    }
  }
  EXPECT_GT(defined.size(), 400u);
  for (const auto& [name, files] : defined)
    EXPECT_EQ(files.size(), 1u) << name << ": " << testing::PrintToString(files);
}

/// Lines that name one of `names` as a string or as an identifier (drymatter: dry_matter too), but not in a comment or
/// within a sentence. `line` is a comment's start in the language.
std::set<std::string> lines_with(const std::set<std::string>& names, const std::string& text,
                                 const std::string& comment) {
  static const std::regex literal(R"re("((?:[^"\\]|\\.)*)")re"), word(R"re([A-Za-z_][A-Za-z_0-9]*)re");
  std::set<std::string> found;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::set<std::string> used;
    for (std::sregex_iterator i(line.begin(), line.end(), literal), end; i != end; ++i) used.insert((*i)[1]);
    std::string code = std::regex_replace(line, literal, "");
    code.erase(std::min(code.size(), code.find(comment)));
    for (std::sregex_iterator i(code.begin(), code.end(), word), end; i != end; ++i) {
      std::string name = i->str();
      std::erase(name, '_');
      used.insert(name);
    }
    if (std::ranges::any_of(used, [&](const std::string& u) { return names.contains(u); })) found.insert(line);
  }
  return found;
}

/// A constituent is a row of the table in leaf/tissue: code that names one would miss the next one. core/units knows by
/// PhysicalQuantity in which other units the literature gives a quantity.
TEST(Architecture, ConstituentsAreNamedInTheirTableAlone) {
  std::set<std::string> names{"chlorophyll", "carotenoid", "anthocyanin", "brownpigment"};
  for (const leaf::LeafNumber& n : leaf::kLeafNumbers)
    if (n.absorbs()) names.insert(std::string(n.name));
  names.erase("water");  // of clouds, as well
  EXPECT_TRUE(names.contains("drymatter"));
  const auto of = [](const char* text) { return std::string(text); };
  EXPECT_EQ(lines_with(names, of("f(\"lignin\");\ng(p.dry_matter);\nh(\"lignin is x\");  // lignin\n"), "//"),
            (std::set<std::string>{"f(\"lignin\");", "g(p.dry_matter);"}));
  static const std::regex docstring(R"re("""[^"]*(?:"[^"]+)*""")re");
  int read = 0;
  for (const char* folder : {"/src", "/python/src", "/python/frond"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(FROND_SOURCE_DIR) + folder)) {
      const std::string path = entry.path().string(), extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp" && extension != ".py") continue;
      if (path.find("/leaf/tissue/") != path.npos || path.find("/core/units/") != path.npos) continue;
      std::ifstream in(entry.path());
      std::string text{std::istreambuf_iterator<char>(in), {}};
      if (extension == ".py") text = std::regex_replace(text, docstring, "");
      EXPECT_EQ(lines_with(names, text, extension == ".py" ? "#" : "//"), std::set<std::string>{}) << path;
      ++read;
    }
  EXPECT_GT(read, 700);
}

// Linking OpenImageIO takes 0.3 s: it is loaded when an image needs it (image/image_codec.h).
TEST(Architecture, OpenImageIOIsCalledByItsModuleAlone) {
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
