#include "scene/parser.h"

#include <algorithm>

#include "core/log.h"
#include "core/random.h"
#include "scene/description_builder.h"
#include "scene/directives.h"
#include "system/file_bytes.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

/// Reads a file and, where it says so, others.
class SceneReader {
 public:
  SceneReader(SceneDescription& scene, const Log& log) : scene_(scene), log_(log), builder_(scene, log) {}

  void read_main(const std::string& text, const fs::path& path) { builder_.finish(read(text, path)); }

 private:
  static constexpr size_t kDeepest = 64;

  Location read(const std::string& text, const fs::path& path);
  void include(Tokenizer& tokens);
  void check_include(const fs::path& path, const Location& where) const;

  SceneDescription& scene_;
  const Log& log_;
  DescriptionBuilder builder_;
  ParameterReader parameters_;
  std::vector<fs::path> open_files_;  // from the main file to the one being read
};

fs::path real_path(const fs::path& path) {
  std::error_code error;
  const fs::path result = fs::weakly_canonical(path, error);
  return error ? path : result;
}

/// Returns the place of the end.
Location SceneReader::read(const std::string& text, const fs::path& path) {
  scene_.files.push_back(path);
  scene_.content_hash = hash_bytes(text, scene_.content_hash);
  open_files_.push_back(path);
  Tokenizer tokens(text, std::make_shared<const std::string>(path.string()));
  DirectiveContext context{tokens, parameters_, builder_, log_};
  while (tokens.peek().kind != Token::Kind::end) {
    const Token word = tokens.next();
    if (word.kind == Token::Kind::word && word.text == "Include")
      include(tokens);
    else
      carry_out(word, context);
  }
  open_files_.pop_back();
  return tokens.where(tokens.peek());
}

void SceneReader::include(Tokenizer& tokens) {
  const Token name = read_quoted(tokens, "Include");
  const Location where = tokens.where(name);
  const fs::path path = scene_.resolve(tokens.text_of(name), where);
  check_include(path, where);
  read(read_file_bytes(path, where), path);
}

void SceneReader::check_include(const fs::path& path, const Location& where) const {
  if (open_files_.size() >= kDeepest) fail(where, "includes are nested more than {} deep", kDeepest);
  const auto is_same = [target = real_path(path)](const fs::path& open) { return real_path(open) == target; };
  const auto first = std::find_if(open_files_.begin(), open_files_.end(), is_same);
  if (first == open_files_.end()) return;
  std::string chain;
  for (auto file = first; file != open_files_.end(); ++file) chain += file->string() + " -> ";
  fail(where, "include cycle: {}{}", chain, first->string());
}

}  // namespace

SceneDescription parse_scene(const fs::path& path, const Log& log) {
  if (path == "-") return parse_scene_text(read_standard_input(), "standard input", log);
  return parse_scene_text(read_file_bytes(path, {}), path.string(), log);
}

SceneDescription parse_scene_text(const std::string& text, const std::string& name, const Log& log) {
  SceneDescription scene;
  SceneReader(scene, log).read_main(text, name);
  return scene;
}

fs::path SceneSettings::resolve(const std::string& name, const Location& where) const {
  const fs::path path = name;
  if (path.is_absolute() || !where.file) return path;
  const fs::path beside = (fs::path(*where.file).parent_path() / path).lexically_normal();
  std::error_code error;
  if (fs::exists(beside, error) || files.empty()) return beside;
  const fs::path from_main = (files.front().parent_path() / path).lexically_normal();
  return fs::exists(from_main, error) ? from_main : beside;
}

}  // namespace frond
