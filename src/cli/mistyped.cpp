#include "cli/mistyped.h"

#include <CLI/CLI.hpp>

#include "core/error.h"

namespace frond {
namespace {

bool is_option(std::string_view word) { return word.starts_with("--") && word.size() > 2; }

std::string unknown_command(const std::string& word, const CLI::App& app) {
  std::vector<std::string_view> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return fmt::format("there is no command \"{}\"{}", word, suggestion(word, names));
}

/// `word` without its "=value".
std::string unknown_option(std::string_view word, const std::string& command_name, const CLI::App& command) {
  std::vector<std::string_view> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  const std::string_view match = nearest(word.substr(2), names);
  return fmt::format(
      "{} has no option {}; {}", command_name, word,
      match.empty() ? command_name + " --help prints what it has" : fmt::format("did you mean --{}?", match));
}

std::string unknown_option_of(const CLI::App& command, const std::string& name) {
  for (const std::string& word : command.remaining())
    if (is_option(word)) return unknown_option(std::string_view(word).substr(0, word.find('=')), name, command);
  return "";
}

}  // namespace

std::string mistyped(const CLI::App& app) {
  const auto words = app.remaining();
  const auto commands = app.get_subcommands();
  if (commands.empty() && !words.empty() && !words[0].starts_with('-')) return unknown_command(words[0], app);
  if (const std::string message = unknown_option_of(app, app.get_name()); !message.empty()) return message;
  return commands.empty() ? "" : unknown_option_of(*commands[0], app.get_name() + " " + commands[0]->get_name());
}

}  // namespace frond
