#include "cli/app.h"

#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/pbrt_options.h"
#include "jobs/record/command_line.h"
#include "scene/format/words.h"

namespace frond {
namespace {

/// Columns of the terminal that help is printed to, or those of a page.
size_t help_width() {
  constexpr size_t kPage = 100, kLeast = 50;
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? std::max(kLeast, size_t(size.ws_col))
                                                                           : kPage;
}

/// `head`, then the words of `text` from `column` on, in lines that end before the width.
std::string hanging(std::string head, const std::string& text, size_t column) {
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

class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { label("Positionals", "Arguments"); }
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return CLI::detail::find_and_replace(Formatter::make_help(app, std::move(name), mode), "\n\n\n", "\n\n");
  }
  std::string make_description(const CLI::App* app) const override { return hanging("", app->get_description(), 0); }
  std::string make_usage(const CLI::App* app, std::string name) const override {
    if (!app->get_parent()) return "Usage: " + name + " [OPTIONS] COMMAND ...\n";
    return hanging("Usage:", usage(find_job(app->get_name())), 7);
  }
  std::string make_footer(const CLI::App* app) const override {
    if (!app->get_parent()) return app->get_footer() + '\n';
    return app->get_footer().empty() ? "" : hanging("", app->get_footer(), 0);
  }
  std::string make_subcommand(const CLI::App* sub) const override {
    constexpr size_t kColumn = 22;
    return hanging("  " + sub->get_name(), sub->get_description(), kColumn);
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
    return hanging(head + option->get_option_text(), option->get_description(), kColumn);
  }
};

/// Values are read by Arguments: CLI11 collects their words.
CLI::Option* add_option(CLI::App& app, const JobParam& p) {
  const std::string names = p.positional ? std::string(p.name) : fmt::format("{}", fmt::join(option_names(p), ","));
  const std::string doc = documented(p);
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

bool is_own(const JobInfo& job, const JobParam& p) {
  return std::ranges::any_of(job.params, [&p](const JobParam& own) { return &own == &p; });
}

bool is_of_session(const JobInfo& job, const JobParam& p) {
  return std::ranges::any_of(session_params(job.session), [&p](const JobParam& own) { return &own == &p; });
}

}  // namespace

Arguments Command::arguments() const {
  Arguments args(params_of(*job), command_spelling);
  for (const auto& [param, option] : options) {
    std::vector<std::string> words = option->results();
    if (words.empty()) continue;
    if (param->kind == ArgumentKind::flag) words = {words.back()};
    args.set(param->name, words);
  }
  return args;
}

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

}  // namespace frond
