#include "scene/format/parser.h"

#include <algorithm>
#include <set>

#include "core/log.h"
#include "core/math/random.h"
#include "core/parallel.h"
#include "scene/format/description_builder.h"
#include "scene/format/directives.h"
#include "system/file_bytes.h"
#include "system/gzip.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

/// Returns the canonical path, to detect cycles through links; the path itself if that fails.
fs::path real_path(const fs::path& path) {
  std::error_code error;
  const fs::path result = fs::weakly_canonical(path, error);
  return error ? path : result;
}

/// Reads scene files and the files that they include.
class SceneReader {
 public:
  SceneReader(SceneDescription& scene, const Log& log, Problems& problems)
      : scene_(scene), log_(log), problems_(problems), builder_(scene, log) {}

  /// Reads the main file, or one of several consecutive files.
  void read_main(const std::string& text, const fs::path& path) {
    problems_.attempt([&] { end_ = read(text, path, nullptr); });
  }
  /// Reports what is missing at the end of the last file.
  void finish() {
    problems_.attempt([this] { builder_.finish(end_, problems_); });
  }

 private:
  static constexpr size_t kDeepest = 64;
  static constexpr size_t kMostBytes = size_t{1} << 30;  ///< read again, from files that are included several times
  static constexpr size_t kLeastBytes = 1 << 15;         ///< that a file which is read again counts as

  Location read(const std::string& bytes, const fs::path& path, Tokenizer* outer);
  void read_directive(Tokenizer& tokens, DirectiveContext& context);
  void include(Tokenizer& tokens);
  void import(Tokenizer& tokens, const Location& where);
  fs::path next_file(Tokenizer& tokens, std::string_view directive, Location& where) const;
  void check_include(const fs::path& path, const Location& where) const;

  SceneDescription& scene_;
  const Log& log_;
  Problems& problems_;
  DescriptionBuilder builder_;
  ParameterReader parameters_;
  struct OpenFile {
    fs::path path, real;
  };
  std::vector<OpenFile> open_files_;  // from the main file to the one being read
  std::set<fs::path> seen_;           // real paths
  size_t repeated_bytes_ = 0;
  bool limit_reached_ = false;  // nothing further is read
  Location end_;
};

/// Reads one file. Returns the location of its end.
Location SceneReader::read(const std::string& bytes, const fs::path& path, Tokenizer* outer) {
  scene_.files.push_back(path);
  scene_.content_hash = hash_bytes(bytes, scene_.content_hash);
  const auto name = std::make_shared<const std::string>(path.string());
  std::string unpacked;
  if (is_gzip(bytes)) unpacked = unpack_gzip(bytes, path.string(), {name, 1, 1});
  if (!seen_.insert(real_path(path)).second)
    repeated_bytes_ += std::max(is_gzip(bytes) ? unpacked.size() : bytes.size(), kLeastBytes);
  if (repeated_bytes_ > kMostBytes) {
    limit_reached_ = scene_.is_incomplete = true;
    fail({name, 1, 1},
         "the scene includes files again with more than {} GB in all, each counted as {} kB or more; an object with "
         "instances is read once",
         kMostBytes >> 30, kLeastBytes >> 10);
  }
  Tokenizer tokens(is_gzip(bytes) ? unpacked : bytes, name, outer);
  if (!open_files_.empty() && !tokens.at_end()) check_begins_scene(tokens.peek(), tokens.where(tokens.peek()));
  DirectiveContext context{tokens, parameters_, builder_, log_};
  open_files_.push_back({path, real_path(path)});
  while (!limit_reached_ && !tokens.at_end()) {
    check_stop();
    const Token word = tokens.peek();
    if (!problems_.attempt([&] { read_directive(tokens, context); })) tokens.skip_to_directive(word, is_directive);
  }
  open_files_.pop_back();
  return tokens.where(tokens.peek());
}

/// Executes one directive. On an error, continues at the next one.
void SceneReader::read_directive(Tokenizer& tokens, DirectiveContext& context) {
  const Token word = tokens.next(), argument = tokens.peek();
  try {
    if (word.kind == Token::Kind::word && word.text == "Include")
      include(tokens);
    else if (word.kind == Token::Kind::word && word.text == "Import")
      import(tokens, tokens.where(word));
    else
      execute(word, context);
  } catch (const InputError&) {
    if (argument.kind == Token::Kind::string) scene_.unread.emplace(argument.text);
    if (word.text == "Include" || word.text == "Import") scene_.is_incomplete = true;
    if (word.text == "ObjectBegin") builder_.refused_object_begin(tokens.where(word));
    throw;
  }
}

/// Included tokens continue the including file: state changes persist.
void SceneReader::include(Tokenizer& tokens) {
  Location where;
  const fs::path path = next_file(tokens, "Include", where);
  read(read_file_bytes(path, where), path, &tokens);
}

/// An imported file has its own tokenizer and state. If it is unreadable, the scene is incomplete.
void SceneReader::import(Tokenizer& tokens, const Location& where) {
  Location name_where;
  const fs::path path = next_file(tokens, "Import", name_where);
  builder_.import_begin(where);
  if (!problems_.attempt([&] { read(read_file_bytes(path, name_where), path, nullptr); })) scene_.is_incomplete = true;
  builder_.import_end();
}

/// Reads and resolves the file name of Include or Import.
fs::path SceneReader::next_file(Tokenizer& tokens, std::string_view directive, Location& where) const {
  const Token name = read_quoted(tokens, directive);
  where = tokens.where(name);
  const fs::path path = scene_.resolve(tokens.text_of(name), where);
  check_include(path, where);
  return path;
}

/// Throws InputError for an include cycle or for too deep nesting.
void SceneReader::check_include(const fs::path& path, const Location& where) const {
  if (open_files_.size() >= kDeepest) fail(where, "includes are nested more than {} deep", kDeepest);
  const auto first = std::ranges::find(open_files_, real_path(path), &OpenFile::real);
  if (first == open_files_.end()) return;
  std::string chain;
  for (auto file = first; file != open_files_.end(); ++file) chain += file->path.string() + " -> ";
  fail(where, "include cycle: {}{}", chain, first->path.string());
}

}  // namespace

SceneDescription parse_scene(const std::vector<fs::path>& paths, const Log& log, Problems& problems) {
  SceneDescription scene;
  SceneReader reader(scene, log, problems);
  for (const fs::path& path : paths)
    problems.attempt([&] {
      if (path == "-")
        reader.read_main(read_standard_input(), "standard input");
      else
        reader.read_main(read_file_bytes(path, {}), path);
    });
  reader.finish();
  return scene;
}

/// Throws all errors together.
SceneDescription parse_scene(const fs::path& path, const Log& log) {
  Problems problems;
  SceneDescription scene = parse_scene(std::vector{path}, log, problems);
  problems.check();
  return scene;
}

namespace {

/// `main` lists the files already searched, the main file first.
bool contains_world(SceneSettings& main, const fs::path& path) {
  if (std::ranges::find(main.files, path) != main.files.end()) return false;
  main.files.push_back(path);
  std::string text = read_file_bytes(path, {});
  if (is_gzip(text)) text = unpack_gzip(text, path.string(), {});
  Tokenizer tokens(text, std::make_shared<const std::string>(path.string()));
  while (!tokens.at_end()) {
    const Token word = tokens.peek();
    const bool is_word = word.kind == Token::Kind::word;
    if (is_word && word.text == "WorldBegin") return true;
    Problems ignored;
    bool holds = false;
    const bool is_right = ignored.attempt([&] {
      tokens.next();
      if (!is_word || word.text != "Include") return;
      const Token name = tokens.next();
      holds = contains_world(main, main.resolve(tokens.text_of(name), tokens.where(name)));
    });
    if (holds) return true;
    if (!is_right) tokens.skip_to_directive(word, is_directive);
  }
  return false;
}

}  // namespace

/// An unreadable file counts as a scene, so that its error is reported for that scene.
bool contains_world(const fs::path& path) {
  if (path == "-") return false;
  bool holds = false;
  Problems problems;
  SceneSettings main;
  return !problems.attempt([&] { holds = contains_world(main, path); }) || holds;
}

SceneDescription parse_scene_text(const std::string& text, const std::string& name, const Log& log) {
  Problems problems;
  SceneDescription scene;
  SceneReader reader(scene, log, problems);
  reader.read_main(text, name);
  reader.finish();
  problems.check();
  return scene;
}

}  // namespace frond
