#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "jobs/command_line.h"
#include "jobs/completion_templates.h"
#include "leaf/tissue/specimens.h"
#include "render/channels.h"
#include "render/plugins.h"
#include "report/text_output.h"

namespace frond {
namespace {

using enum ArgumentKind;
using Words = std::vector<std::string>;

constexpr std::string_view kShells[] = {"bash", "zsh", "fish"};
constexpr JobParam kParams[] = {
    JobParam("shell", text, "Shell that the script is for.",
             {.choices = kShells, .positional = true, .required = true}),
    JobParam("output", text, "File to write; - is standard output.",
             {.type = "FILE", .default_value = "-", .aliases = "o", .path = PathUse::write}),
};

/// Words that values of a type begin with, as far as they are known when the script is made.
std::map<std::string, Words> words_by_type() {
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
  for (const JobInfo* job : all_jobs())
    for (const char* type : {"COMMAND", "PLUGIN"}) words[type].emplace_back(job->name);
  std::ranges::sort(words["PLUGIN"]);  // a name may be of two kinds
  const auto repeated = std::ranges::unique(words["PLUGIN"]);
  words["PLUGIN"].erase(repeated.begin(), repeated.end());
  return words;
}

template <class Range>
std::string joined(const Range& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

/// A command as completion sees it.
struct Completed {
  CommandParams params;
  std::string_view doc;
};

bool takes_value(const JobParam& p) { return p.kind != flag && p.implied.empty(); }

std::string type_of(const JobParam& p) {
  return p.path == PathUse::none || p.type == "SCENE" || p.type == "FOLDER" ? value_name(p) : "FILE";
}

class Completion {
 public:
  Completion() : words_(words_by_type()) {
    commands_.push_back({frond_params(), ""});
    for (const JobInfo* job : all_jobs()) commands_.push_back({command_params(*job), job->doc});
  }

  std::string bash() const {
    std::string options, values, types;
    for (const auto& [command, doc] : commands_) {
      Words names;
      for (const JobParam* option : command.options) {
        const Words own = option_names(*option);
        names.insert(names.end(), own.begin(), own.end());
        if (!takes_value(*option)) continue;
        Words cases;
        for (const std::string& name : own) cases.push_back(command.name + ":" + name);
        values += fmt::format("      {}) {} ;;\n", fmt::join(cases, " | "), bash_value(*option));
      }
      options += fmt::format("    '{}') options='{}'", command.name, joined(names));
      if (!command.arguments.empty()) options += "; " + bash_value(*command.arguments[0]);
      options += " ;;\n";
    }
    for (const auto& [type, words] : words_) types += fmt::format("    {}) choices='{}' ;;\n", type, joined(words));
    return filled(bash_completion, {{"@VALUES@", values}, {"@OPTIONS@", options}, {"@TYPES@", types}});
  }

  std::string zsh() const {
    std::string descriptions, cases, own;
    for (const JobParam* option : commands_[0].params.options) own += "    " + zsh_option(*option) + " \\\n";
    for (const auto& [command, doc] : commands_) {
      if (command.name.empty()) continue;
      descriptions += fmt::format("    '{}:{}'\n", command.name, zsh_text(doc));
      cases += fmt::format("    {})\n      _arguments", command.name);
      for (const JobParam* option : command.options) cases += " \\\n        " + zsh_option(*option);
      for (size_t i = 0; i < command.arguments.size(); ++i) {
        const JobParam& p = *command.arguments[i];
        cases += fmt::format(" \\\n        '{}:{}:{}'", p.kind == texts ? "*" : std::to_string(i + 1), p.name,
                             zsh_action(p));
      }
      cases += "\n      ;;\n";
    }
    return filled(zsh_completion, {{"@OWN@", own}, {"@COMMANDS@", descriptions}, {"@CASES@", cases}});
  }

  std::string fish() const {
    std::string lines;
    for (const auto& [command, doc] : commands_) {
      const std::string start = fmt::format("complete -c frond -n '__frond_command_is \"{}\"'", command.name);
      if (!command.name.empty())
        lines +=
            fmt::format("complete -c frond -n '__frond_command_is \"\"' -a {} -d '{}'\n", command.name, fish_text(doc));
      for (const JobParam* argument : command.arguments) lines += start + fish_value(*argument) + '\n';
      for (const JobParam* option : command.options) {
        lines += start;
        for (const std::string& name : option_names(*option))
          lines += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        if (takes_value(*option)) lines += (type_of(*option) == "FILE" ? " -r" : " -x") + fish_value(*option);
        lines += fmt::format(" -d '{}'\n", fish_text(option->doc));
      }
    }
    return filled(fish_completion, {{"@LINES@", lines}});
  }

 private:
  using Values = std::vector<std::pair<std::string, std::string>>;

  static std::string replaced(std::string text, const std::string& key, const std::string& value) {
    const size_t at = text.find(key);
    return at == std::string::npos ? text : text.replace(at, key.size(), value);
  }

  static std::string filled(std::string_view asset, const Values& values) {
    std::string text = replaced(std::string(asset), "@VERSION@", FROND_VERSION);
    for (const auto& [key, value] : values) text = replaced(std::move(text), key + "\n", value);
    return text;
  }

  /// "" where nothing is known.
  std::string words_of(const JobParam& p) const {
    if (!p.choices.empty()) return joined(p.choices);
    const auto found = words_.find(type_of(p));
    return found == words_.end() ? "" : joined(found->second);
  }

  static std::string bash_value(const JobParam& p) {
    return p.choices.empty() ? "type=" + type_of(p) : fmt::format("choices='{}'", joined(p.choices));
  }

  static std::string zsh_text(std::string_view doc) {
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
  std::string zsh_action(const JobParam& p) const {
    const std::string type = type_of(p), words = words_of(p);
    if (type == "FILE") return "_files";
    if (type == "FOLDER") return "_files -/";
    if (type == "SCENE") return "_files -g \"*.pbrt(|.gz)\"";
    if (words.empty()) return " ";
    return type == "CHANNELS" ? "_values -s , channel " + words : "(" + words + ")";
  }

  std::string zsh_option(const JobParam& p) const {
    const Words all = option_names(p);
    Words names;
    for (const std::string& name : all)
      names.push_back(takes_value(p) ? name + (name.starts_with("--") ? "=" : "+") : name);
    std::string text = p.kind == texts ? "'*'" : fmt::format("'({})'", joined(all));
    const std::string list = fmt::format("{}", fmt::join(names, ","));
    text += names.size() > 1 ? "{" + list + "}" : list;
    text += "'[" + zsh_text(p.doc) + "]";
    if (takes_value(p)) text += ":" + zsh_text(value_name(p)) + ":" + zsh_action(p);
    return text + "'";
  }

  static std::string fish_text(std::string_view doc) {
    std::string result;
    for (const char c : first_sentence(doc)) result += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
    return result;
  }

  std::string fish_value(const JobParam& p) const {
    const std::string type = type_of(p), words = words_of(p);
    if (type == "FILE") return " -F";
    if (type == "FOLDER") return " -a '(__fish_complete_directories)'";
    if (type == "SCENE") return " -a '(__fish_complete_suffix .pbrt)'";
    return words.empty() ? "" : fmt::format(" -a '{}'", words);
  }

  std::vector<Completed> commands_;
  std::map<std::string, Words> words_;
};

Result completion(const JobRun& run) {
  const std::string shell = run.args.text("shell"), output = run.args.text("output");
  const Completion made;
  const std::string script = shell == "bash" ? made.bash() : shell == "zsh" ? made.zsh() : made.fish();
  if (output == "-") return {.text = script, .is_requested = true};
  write_text(output, script);
  return {};
}

}  // namespace

extern const JobInfo kCompletionJob("completion", "Shell",
                                    "Print a script that completes frond's command line in a shell.", "", kParams,
                                    SessionUse::none, completion);

}  // namespace frond
