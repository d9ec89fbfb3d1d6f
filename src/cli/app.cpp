#include "cli/app.h"

#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "cli/pbrt_options.h"
#include "core/error.h"
#include "core/log.h"
#include "jobs/record/command_line.h"
#include "jobs/record/pbrt_options.h"
#include "report/text_output.h"
#include "scene/format/words.h"

namespace frond {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  frond render scenes/soybean-front/scene.pbrt --wavelengths smpte -o leaf.png\n"
    "  frond compare scenes/soybean-front/scene.pbrt --quick -o report\n"
    "frond COMMAND --help prints the options of a command.\n"
    "frond SCENE.pbrt is short for frond render SCENE.pbrt.";

/// Returns the width of help in columns: the terminal's, or 100 if the output is not a terminal.
size_t help_width() {
  constexpr size_t kPage = 100, kLeast = 50;
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? std::max(kLeast, size_t(size.ws_col))
                                                                           : kPage;
}

/// Returns `head` followed by `text` as a block that begins at `column`. Lines are wrapped at help_width().
std::string hanging_indent(std::string head, const std::string& text, size_t column) {
  const size_t width = help_width();
  const std::string indent(column, ' ');
  std::string result;
  if (head.size() >= column && !head.empty() && column > 0) {
    result = head + '\n';
    head = indent;
  }
  head.resize(std::max(head.size(), column), ' ');
  bool is_first = true;
  for (const std::string& word : split(text, ' ')) {
    if (!is_first && head.size() + 1 + word.size() > width) {
      result += head + '\n';
      head = indent;
      is_first = true;
    }
    head += (is_first ? "" : " ") + word;
    is_first = false;
  }
  return result + head + '\n';
}

/// Formats help from the records of jobs. CLI11's own formatter does not wrap lines.
class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { label("Positionals", "Arguments"); }
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return CLI::detail::find_and_replace(Formatter::make_help(app, std::move(name), mode), "\n\n\n", "\n\n");
  }
  std::string make_description(const CLI::App* app) const override {
    return hanging_indent("", app->get_description(), 0);
  }
  std::string make_usage(const CLI::App* app, std::string name) const override {
    if (!app->get_parent()) return "Usage: " + name + " [OPTIONS] COMMAND ...\n";
    return hanging_indent("Usage:", usage(find_job(app->get_name())), 7);
  }
  std::string make_footer(const CLI::App* app) const override {
    if (!app->get_parent()) return app->get_footer() + '\n';
    return app->get_footer().empty() ? "" : hanging_indent("", app->get_footer(), 0);
  }
  std::string make_subcommand(const CLI::App* sub) const override {
    constexpr size_t kColumn = 22;
    return hanging_indent("  " + sub->get_name(), sub->get_description(), kColumn);
  }
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    constexpr size_t kColumn = 30;
    std::string head = "  " + option->get_name(is_positional);
    if (!is_positional) {
      std::vector<std::string> names;
      for (const std::string& name : option->get_snames()) names.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      head = fmt::format("  {}", fmt::join(names, ","));
    }
    return hanging_indent(head + option->get_option_text(), option->get_description(), kColumn);
  }
};

/// Adds an option that only collects words. Arguments parses and checks them, for the command line as for Python.
CLI::Option* add_option(CLI::App& app, const JobParam& p) {
  const std::string names = p.positional ? std::string(p.name) : fmt::format("{}", fmt::join(option_names(p), ","));
  const std::string doc = parameter_help(p);
  if (p.kind == ArgumentKind::flag) return app.add_flag(names, doc);
  if (!p.implied.empty())
    return app.add_flag(fmt::format("{}{{{}}}", names, p.implied), doc)
        ->option_text(fmt::format("[={}]", value_name(p)));
  CLI::Option* option = app.add_option(
      names, [](const CLI::results_t&) { return true; }, doc);
  if (p.positional)
    option->option_text(p.kind == ArgumentKind::texts ? " ..." : "");
  else
    option->option_text(fmt::format(" {}{}", value_name(p), p.required ? " (required)" : ""));
  if (p.positional && p.kind != ArgumentKind::texts) return option->expected(1);
  return option->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(p.positional);
}

/// Whether the parameter belongs to the job itself and not to its session or to the job that it extends.
bool is_own(const JobInfo& job, const JobParam& p) {
  return std::ranges::any_of(job.params, [&p](const JobParam& own) { return &own == &p; });
}

bool is_of_session(const JobInfo& job, const JobParam& p) {
  return std::ranges::any_of(session_params(job.session), [&p](const JobParam& own) { return &own == &p; });
}

/// A job as a subcommand of CLI11.
struct Command {
  const JobInfo* job;
  CLI::App* app;
  std::vector<std::pair<const JobParam*, CLI::Option*>> options;
};

/// Passes the words of the command line to the job's records. Throws InputError for an invalid value.
Arguments arguments_of(const Command& command) {
  Arguments args(params_of(*command.job), command_spelling);
  for (const auto& [param, option] : command.options) {
    std::vector<std::string> words = option->results();
    if (words.empty()) continue;
    if (param->kind == ArgumentKind::flag) words = {words.back()};
    args.set(param->name, words);
  }
  return args;
}

/// Adds the options of pbrt-v4 without a function in frond. They appear in --help-pbrt and the man page, not in --help.
void add_pbrt_options(CLI::App& render) {
  for (const PbrtOption& o : kPbrtOptions) {
    CLI::Option* option = o.value[0] == '\0' ? render.add_flag(o.name)
                                             : render.add_option(o.name, [](const CLI::results_t&) { return true; });
    option->group("");  // not in --help
  }
  render.get_option("--render-coord-sys")->check(CLI::IsMember({"camera", "cameraworld", "world"}));
  const std::string doc(kHelpPbrtParam.doc);  // CLI11 modifies an lvalue that is not const
  render.add_flag(command_spelling(kHelpPbrtParam.name), doc);
}

/// Adds a subcommand for each job, made from its record.
std::vector<Command> add_commands(CLI::App& app) {
  app.formatter(std::make_shared<HelpFormatter>());
  std::vector<Command> commands;
  for (const JobInfo* job : all_jobs()) {
    CLI::App* sub = app.add_subcommand(std::string(job->name), std::string(job->doc));
    sub->group(std::string(job->group));
    sub->footer(std::string(job->details));
    Command& command = commands.emplace_back(Command{job, sub, {}});
    for (const JobParam* p : params_of(*job)) {
      CLI::Option* option = add_option(*sub, *p);
      if (is_of_session(*job, *p))
        option->group("Session");
      else if (!is_own(*job, *p))
        option->group("Of frond " + std::string(job->extends->name));
      command.options.emplace_back(p, option);
    }
    if (job->name == "render") add_pbrt_options(*sub);
  }
  return commands;
}

bool is_option(std::string_view word) { return word.starts_with("--") && word.size() > 2; }

/// Returns the error for an unknown command, with the nearest name.
std::string unknown_command(const std::string& word, const CLI::App& app) {
  std::vector<std::string_view> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return fmt::format("there is no command \"{}\"{}", word, suggestion(word, names));
}

/// Returns the error for an unknown option. `word` is the option without "=value".
std::string unknown_option(std::string_view word, const std::string& command_name, const CLI::App& command) {
  std::vector<std::string_view> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  const std::string_view match = nearest(word.substr(2), names);
  return fmt::format(
      "{} has no option {}; {}", command_name, word,
      match.empty() ? command_name + " --help prints what it has" : fmt::format("did you mean --{}?", match));
}

/// Returns the error for the first unknown long option; "" if there is none.
std::string unknown_option_of(const CLI::App& command, const std::string& name) {
  for (const std::string& word : command.remaining())
    if (is_option(word)) return unknown_option(std::string_view(word).substr(0, word.find('=')), name, command);
  return "";
}

/// Returns the error of a failed parse if it is an unknown command or long option, with a suggestion; otherwise "".
std::string unknown_word_error(const CLI::App& app) {
  const auto words = app.remaining();
  const auto commands = app.get_subcommands();
  if (commands.empty() && !words.empty() && !words[0].starts_with('-')) return unknown_command(words[0], app);
  if (const std::string message = unknown_option_of(app, app.get_name()); !message.empty()) return message;
  return commands.empty() ? "" : unknown_option_of(*commands[0], app.get_name() + " " + commands[0]->get_name());
}

/// Prints the error and returns the exit code. Help is an error for CLI11, with code 0. An unknown word is reported
/// first; CLI11 would report a missing parameter instead.
int report_parse_error(const CLI::App& app, const CLI::ParseError& error) {
  const std::string message = error.get_exit_code() == 0 ? "" : unknown_word_error(app);
  if (!message.empty()) {
    print_to_stderr("frond: " + message);
    return 1;
  }
  std::ostringstream help, problem;
  const int code = app.exit(error, help, problem);
  if (!problem.str().empty())
    print_to_stderr("frond: " + problem.str().substr(0, problem.str().find_last_not_of('\n') + 1));
  write_text("-", help.str());
  return code == 0 ? 0 : 1;
}

std::vector<std::string> long_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

}  // namespace

/// pbrt's spelling is translated before CLI11 parses the words.
std::variant<ParsedCommand, int> parse_command_line(int argc, const char* const* argv) {
  CLI::App app{"frond: a spectral path tracer for plant leaves.", "frond"};
  app.set_version_flag("--version", "frond " FROND_VERSION);
  app.require_subcommand(1);
  app.footer(kExamples);
  const std::vector<Command> commands = add_commands(app);
  const CLI::App& render = *app.get_subcommand("render");
  std::vector<std::string> words = translate_pbrt_options({argv + 1, argv + argc}, long_names(render));
  if (!words.empty() && words[0] == "help") words = {words.size() > 1 ? words[1] : "--help", "--help"};
  // "submit flux" is the command submit-flux.
  if (words.size() > 1 &&
      std::ranges::any_of(all_jobs(), [&words](const JobInfo* job) { return job->name == words[0] + "-" + words[1]; }))
    words[1] = words[0] + "-" + words[1], words.erase(words.begin());
  std::ranges::reverse(words);  // CLI11 reads the words from the end
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    return report_parse_error(app, error);
  }
  const auto chosen = std::ranges::find_if(commands, [](const Command& c) { return c.app->parsed(); });
  ParsedCommand parsed{.job = chosen->job, .arguments = arguments_of(*chosen), .pbrt_options = {}};
  if (chosen->app == &render) {
    parsed.asks_for_pbrt_help = render.count(command_spelling(kHelpPbrtParam.name)) > 0;
    for (const PbrtOption& o : kPbrtOptions)
      if (render.count(o.name) > 0) parsed.pbrt_options.push_back(&o);
  }
  return parsed;
}

}  // namespace frond
