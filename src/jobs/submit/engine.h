#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace frond {

/// File that `frond submit` writes for an engine.
struct EngineFile {
  std::string_view name;
  std::string_view content;  ///< with @NAMES@, which are replaced by values
  bool is_executable = false;
};

/// Engine: program that schedules the tasks of a job on one or several machines. One record describes each.
struct Engine {
  std::string_view name;         ///< value of --engine
  std::string_view advice = "";  ///< what to do before the job is started: the end of a sentence, or ""
  std::vector<EngineFile> files;
  /// Command that starts the job and renders what is missing; @FOLDER@ is the job's folder.
  std::vector<std::string> command;
  bool is_queue = false;     ///< the command ends once the job is submitted, not when the image is there
  std::string_view program;  ///< what the command needs in PATH
  std::string_view package;  ///< command that installs the program
  /// Returns a word as a literal of the language of the files. Throws InputError for a word that they cannot have.
  std::string (*literal)(const std::string& word);
  std::string_view separator;  ///< between literals
  /// Characters that the path of the image must not have: the engine would replace what is between them.
  std::string_view reserved = "";
};

/// Returns all engines. This is the only list of them.
std::span<const Engine> engines();

/// Returns the engine's command for the job in this folder.
std::vector<std::string> command_of(const Engine& engine, const std::filesystem::path& folder);

/// Returns the text with each @NAME@ replaced by its value. Values are not searched for names.
std::string filled(std::string_view text, std::span<const std::pair<std::string, std::string>> values);

}  // namespace frond
