#include "cli/app.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/pbrt_options.h"
#include "scene/words.h"

namespace frond {
namespace {

/// Values are read by Arguments: CLI11 collects their words.
CLI::Option* add_option(CLI::App& app, const JobParam& p) {
  const std::string names = p.positional ? std::string(p.name) : fmt::format("{}", fmt::join(option_names(p), ","));
  const std::string doc = documented(p);
  if (p.kind == ArgumentKind::flag) return app.add_flag(names, doc);
  if (!p.implied.empty())
    return app.add_flag(fmt::format("{}{{{}}}", names, p.implied), doc)->type_name(fmt::format("[={}]", p.type));
  CLI::Option* option = app.add_option(names, [](const CLI::results_t&) { return true; }, doc);
  option->type_name(value_name(p));
  if (p.kind != ArgumentKind::texts) return option->expected(1);
  return option->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(p.positional);
}

bool is_own(const JobInfo& job, const JobParam& p) {
  return std::ranges::any_of(job.params, [&p](const JobParam& own) { return &own == &p; });
}

bool is_of_session(const JobInfo& job, const JobParam& p) {
  return std::ranges::any_of(session_params(job.session), [&p](const JobParam& own) { return &own == &p; });
}

}  // namespace

std::vector<std::string> option_names(const JobParam& p) {
  std::vector<std::string> short_names, long_names;
  if (p.positional) return {};
  long_names.push_back("--" + std::string(p.name));
  for (const std::string& alias : split(std::string(p.aliases), ','))
    if (alias.size() == 1)
      short_names.push_back("-" + alias);
    else if (!alias.empty())
      long_names.push_back("--" + alias);
  short_names.insert(short_names.end(), long_names.begin(), long_names.end());
  return short_names;
}

std::string value_name(const JobParam& p) {
  if (!p.type.empty()) return std::string(p.type);
  constexpr const char* kNames[] = {"", "INT", "INT", "NUMBER", "NUMBERS", "TEXT", "TEXT"};
  return kNames[size_t(p.kind)];
}

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
