#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "cli/command_facts.h"
#include "cli/commands.h"
#include "cli/completion_templates.h"
#include "leaf/tissue/specimens.h"
#include "render/channels.h"
#include "render/plugins.h"
#include "report/text_output.h"

namespace frond {
namespace {

using Words = std::vector<std::string>;

/// What is known when the script is made of the words that options of a type take.
std::map<std::string, Words> words_by_type(const std::vector<CommandFacts>& commands) {
  std::map<std::string, Words> words;
  const Registry registry = load_registry({});
  for (const PluginInfo* info : all_plugins(registry)) {
    words["PLUGIN"].emplace_back(info->name);
    if (info->kind == "material") words["MATERIAL"].emplace_back(info->name);
    if (info->kind == "integrator") words["INTEGRATOR"].emplace_back(info->name);
    if (info->kind == "wavelengths") words["WAVELENGTHS"].emplace_back(info->name);
    if (info->kind == "pixel filter") words["FILTER"].emplace_back(info->name);
  }
  for (const leaf::Specimen& s : leaf::kSpecimens) words["SPECIMEN"].emplace_back(s.name);
  for (const ChannelInfo& channel : all_channels()) words["CHANNELS"].emplace_back(channel.name);
  for (const CommandFacts& command : commands)
    if (!command.name.empty()) words["COMMAND"].push_back(command.name);
  std::ranges::sort(words["PLUGIN"]);  // a name may be of two kinds
  const auto repeated = std::ranges::unique(words["PLUGIN"]);
  words["PLUGIN"].erase(repeated.begin(), repeated.end());
  return words;
}

std::string joined(const Words& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::string replaced(std::string text, const std::string& key, const std::string& value) {
  const size_t at = text.find(key);
  return at == std::string::npos ? text : text.replace(at, key.size(), value);
}

class Completion {
 public:
  explicit Completion(const CLI::App& app) : commands_(command_facts(app)), words_(words_by_type(commands_)) {}

  std::string bash() const {
    std::string options, values, types;
    for (const CommandFacts& command : commands_) {
      Words names;
      for (const OptionFacts& option : command.options) {
        names.insert(names.end(), option.names.begin(), option.names.end());
        if (option.value.empty()) continue;
        Words cases;
        for (const std::string& name : option.names) cases.push_back(command.name + ":" + name);
        values += fmt::format("      {}) {} ;;\n", fmt::join(cases, " | "), bash_value(option));
      }
      options += fmt::format("    '{}') options='{}'", command.name, joined(names));
      if (!command.words.empty()) options += "; " + bash_value(command.words[0]);
      options += " ;;\n";
    }
    for (const auto& [type, words] : words_) types += fmt::format("    {}) choices='{}' ;;\n", type, joined(words));
    return filled(bash_completion, {{"@VALUES@", values}, {"@OPTIONS@", options}, {"@TYPES@", types}});
  }

  std::string zsh() const {
    std::string descriptions, cases;
    for (const CommandFacts& command : commands_) {
      if (command.name.empty()) continue;
      descriptions += fmt::format("    '{}:{}'\n", command.name, zsh_text(command.doc));
      cases += fmt::format("    {})\n      _arguments", command.name);
      for (const OptionFacts& option : command.options) cases += " \\\n        " + zsh_option(option);
      for (size_t i = 0; i < command.words.size(); ++i)
        cases += fmt::format(" \\\n        '{}:{}:{}'", command.words[i].repeats ? "*" : std::to_string(i + 1),
                             command.words[i].value, zsh_action(command.words[i]));
      cases += "\n      ;;\n";
    }
    std::string own;
    for (const OptionFacts& option : commands_[0].options) own += "    " + zsh_option(option) + " \\\n";
    return filled(zsh_completion, {{"@OWN@", own}, {"@COMMANDS@", descriptions}, {"@CASES@", cases}});
  }

  std::string fish() const {
    std::string lines;
    for (const CommandFacts& command : commands_) {
      const std::string start = fmt::format("complete -c frond -n '__frond_command_is \"{}\"'", command.name);
      if (!command.name.empty())
        lines += fmt::format("complete -c frond -n '__frond_command_is \"\"' -a {} -d '{}'\n", command.name,
                             fish_text(command.doc));
      for (const OptionFacts& word : command.words) lines += start + fish_value(word) + '\n';
      for (const OptionFacts& option : command.options) {
        lines += start;
        for (const std::string& name : option.names)
          lines += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        if (!option.value.empty()) lines += (option.type == "FILE" ? " -r" : " -x") + fish_value(option);
        lines += fmt::format(" -d '{}'\n", fish_text(option.doc));
      }
    }
    return filled(fish_completion, {{"@LINES@", lines}});
  }

 private:
  using Values = std::vector<std::pair<std::string, std::string>>;

  static std::string filled(std::string_view asset, const Values& values) {
    std::string text = replaced(std::string(asset), "@VERSION@", FROND_VERSION);
    for (const auto& [key, value] : values) text = replaced(std::move(text), key + "\n", value);
    return text;
  }

  const Words* words_of(const OptionFacts& option) const {
    if (!option.choices.empty()) return &option.choices;
    const auto found = words_.find(option.type);
    return found == words_.end() ? nullptr : &found->second;
  }

  static std::string bash_value(const OptionFacts& option) {
    return option.choices.empty() ? "type=" + option.type : fmt::format("choices='{}'", joined(option.choices));
  }

  static std::string zsh_text(const std::string& doc) {
    std::string result;
    for (const char c : first_sentence(doc)) {
      if (c == '\'')
        result += "'\\''";
      else
        result += (std::string_view("[]:\\").find(c) == std::string_view::npos ? "" : "\\") + std::string(1, c);
    }
    return result;
  }

  /// What completes a value: https://zsh.sourceforge.io/Doc/Release/Completion-System.html
  std::string zsh_action(const OptionFacts& option) const {
    if (option.type == "FILE") return "_files";
    if (option.type == "FOLDER") return "_files -/";
    if (option.type == "SCENE") return "_files -g \"*.pbrt(|.gz)\"";
    const Words* words = words_of(option);
    if (!words) return " ";
    return option.type == "CHANNELS" ? "_values -s , channel " + joined(*words) : "(" + joined(*words) + ")";
  }

  std::string zsh_option(const OptionFacts& option) const {
    Words names;
    for (const std::string& name : option.names)
      names.push_back(option.value.empty() ? name : name + (name.starts_with("--") ? "=" : "+"));
    const std::string list = fmt::format("{}", fmt::join(names, ","));
    std::string text = option.repeats ? "'*'" : fmt::format("'({})'", joined(option.names));
    text += names.size() > 1 ? "{" + list + "}" : list;
    text += "'[" + zsh_text(option.doc) + "]";
    if (!option.value.empty()) text += ":" + option.type + ":" + zsh_action(option);
    return text + "'";
  }

  static std::string fish_text(const std::string& doc) {
    std::string result;
    for (const char c : first_sentence(doc)) result += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
    return result;
  }

  std::string fish_value(const OptionFacts& option) const {
    if (option.type == "FILE") return " -F";
    if (option.type == "FOLDER") return " -a '(__fish_complete_directories)'";
    if (option.type == "SCENE") return " -a '(__fish_complete_suffix .pbrt)'";
    const Words* words = words_of(option);
    return words ? fmt::format(" -a '{}'", joined(*words)) : "";
  }

  std::vector<CommandFacts> commands_;
  std::map<std::string, Words> words_;
};

struct CompletionOptions {
  std::string shell, output = "-";
};

}  // namespace

void add_completion_command(CLI::App& app) {
  auto* command = app.add_subcommand("completion", "Print a script that completes frond's command line in a shell.");
  auto o = std::make_shared<CompletionOptions>();
  command->add_option("shell", o->shell, "bash, zsh or fish.")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->add_option("-o,--output", o->output, "File for it; standard output by default.")->type_name("FILE");
  command->callback([&app, o] {
    const Completion completion(app);
    write_text(o->output, o->shell == "bash"  ? completion.bash()
                          : o->shell == "zsh" ? completion.zsh()
                                              : completion.fish());
  });
}

}  // namespace frond
