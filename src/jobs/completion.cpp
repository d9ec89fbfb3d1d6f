#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <regex>

#include "jobs/record/command_line.h"
#include "jobs/support/templates.h"
#include "leaf/tissue/specimens.h"
#include "render/film/channels.h"
#include "render/plugins.h"
#include "report/text_output.h"
#include "scene/format/words.h"

namespace frond {

// `frond completion`: shell scripts, and the completions that they request. Completions follow from the records of the
// jobs, so that the scripts need no update for a new option.

namespace {

using enum ArgumentKind;
using Words = std::vector<std::string>;
using Offers = std::map<std::string, std::string>;  ///< completions and their descriptions

constexpr std::string_view kShells[] = {"bash", "zsh", "fish"};
constexpr JobParam kCompletionParams[] = {
    JobParam("shell", text, "Shell that the script is for.",
             {.choices = kShells, .positional = true, .required = true}),
    JobParam("words", texts, "Command line whose last word to complete. Used by the scripts.", {.positional = true}),
    JobParam("output", text, "File to write; - is standard output.",
             {.type = "FILE", .default_value = "-", .aliases = "o", .path = PathUse::write}),
};
/// Stands for the name of a command, the first positional argument of `frond`.
constexpr JobParam kCommand("command", text, "", {.type = "COMMAND"});

/// Returns completions for a parameter that is not a path. Removes from `value` the prefix that completions do not
/// replace, such as "MATERIAL=".
Offers offered_values(const JobParam& p, std::string& value) {
  Offers offers;
  std::string type = value_name(p);
  const auto add = [&](bool is_value, std::string_view word, std::string_view doc) {
    if (is_value) offers.emplace(word, first_sentence(doc));
  };
  if (type == "SWAP" && value.find('=') != std::string::npos) type = "MATERIAL";
  if (p.type == "SWAP" || type == "CHANNELS") value.erase(0, value.find_last_of("=,") + 1);
  for (const std::string_view choice : p.choices) add(true, choice, "");
  for (const JobInfo* job : all_jobs()) add(type == "COMMAND" || type == "PLUGIN", job->name, job->doc);
  for (const leaf::Specimen& s : leaf::kSpecimens) add(type == "SPECIMEN", s.name, s.doc);
  for (const ChannelInfo& channel : all_channels()) add(type == "CHANNELS", channel.name, channel.doc);
  std::string kind = type == "FILTER" ? "pixel filter" : type;
  std::ranges::transform(kind, kind.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  const Registry registry = load_registry({});
  for (const PluginInfo* info : all_plugins(registry))
    add(type == "PLUGIN" || info->kind == kind, info->name, info->doc);
  return offers;
}

/// Place of the last word of a command line.
struct LastWord {
  CommandParams command;            ///< whose parameters may come
  const JobParam* param = nullptr;  ///< whose value the word is
  std::string value;                ///< the word, or what follows an option's "="
};

/// Returns the option of this name if it takes a value; nullptr if there is none.
const JobParam* option_of(const CommandParams& command, const std::string& name) {
  for (const JobParam* p : command.options)
    if (std::ranges::count(option_names(*p), name) > 0 && p->kind != flag) return p;
  return nullptr;
}

/// Returns the command and the option that the last word of a command line belongs to.
LastWord last_word(const Words& given) {
  static const std::regex kParted("\n([=:])(\n|$)");  // bash splits "--spp=4" into three words
  LastWord last{frond_params(), nullptr, {}};
  auto& [command, param, value] = last;
  command.arguments = {&kCommand};
  const JobParam* option = nullptr;  // whose value the next word is
  const Words words = split(std::regex_replace(fmt::format("{}", fmt::join(given, "\n")), kParted, "$1"), '\n');
  for (size_t i = 1; i < words.size(); ++i) {
    value = words[i];
    if (param = std::exchange(option, nullptr); param) continue;
    if (value.starts_with('-')) {
      const size_t end = value.starts_with("--") ? value.find('=') : 2;
      const JobParam* named = option_of(command, value.substr(0, end));
      if (end < value.size())
        param = named;
      else if (named && named->implied.empty())
        option = named;
      if (param) value.erase(0, value[end] == '=' ? end + 1 : end);
    } else if (!command.arguments.empty()) {
      param = command.arguments[0];
      if (param->kind != texts) command.arguments.erase(command.arguments.begin());
    }
    if (param != &kCommand || i + 1 == words.size()) continue;
    const auto job = std::ranges::find(all_jobs(), value, &JobInfo::name);
    command = job == all_jobs().end() ? CommandParams{} : command_params(**job);
  }
  return last;
}

/// Returns completions of the last word, one a line; FILE, FOLDER or SCENE if the shell is to complete a path.
std::string completions(const Words& given, bool documented) {
  auto [command, param, value] = last_word(given);
  if (param && param->path != PathUse::none)
    return (param->type == "SCENE" || param->type == "FOLDER" ? value_name(*param) : "FILE") + "\n";
  Offers offers = param ? offered_values(*param, value) : Offers{};
  for (const JobParam* p : command.options)
    for (const std::string& name : option_names(*p))
      if (!param && value.starts_with('-')) offers.emplace(name, first_sentence(p->doc));
  const std::string last = given.back() == "=" ? "" : given.back();
  std::string lines;
  for (const auto& [word, doc] : offers)
    if (word.starts_with(value))
      lines += last.substr(0, last.rfind(value)) + word + (documented && !doc.empty() ? "\t" + doc : "") + "\n";
  return lines;
}

/// The job: prints a shell's script, or the completions that the script requests.
Result completion(const JobRun& run) {
  const std::string shell = run.args.text("shell"), output = run.args.text("output");
  std::string made(shell == "bash" ? bash_completion : shell == "zsh" ? zsh_completion : fish_completion);
  if (run.args.given("words")) made = completions(run.args.texts("words"), shell != "bash");
  if (output == "-") return {.text = made, .is_requested = true};
  write_text(output, made);
  return {};
}

}  // namespace

extern const JobInfo kCompletionJob("completion", "Shell",
                                    "Print a script that completes frond's command line in a shell.", "",
                                    kCompletionParams, SessionUse::none, completion);

}  // namespace frond
