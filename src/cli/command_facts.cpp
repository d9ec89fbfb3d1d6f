#include "cli/command_facts.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "scene/words.h"

namespace frond {
namespace {

/// CLI11 puts what a value's checks say behind its type: "TEXT:{on,off}", "INT:INT in [1 - 1024]".
void read_type(const std::string& name, OptionFacts& facts) {
  const size_t colon = name.find(':');
  facts.type = name.substr(0, colon);
  if (colon == std::string::npos) return;
  const std::string check = name.substr(colon + 1);
  const size_t range = check.find(" in ["), dash = check.find(" - ");
  if (check.starts_with('{') && check.ends_with('}'))
    facts.choices = split(check.substr(1, check.size() - 2), ',');
  else if (range != std::string::npos && dash != std::string::npos && check.ends_with(']'))
    facts.limits.push_back(fmt::format("From {} to {}.", check.substr(range + 5, dash - range - 5),
                                       check.substr(dash + 3, check.size() - dash - 4)));
}

std::string names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::ranges::sort(names);  // the set's order is that of addresses
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string repeated(const std::string& value, int count) {
  std::string result = value;
  for (int i = 1; i < count; ++i) result += (value.starts_with('-') ? " " : ",") + value;
  return result;
}

OptionFacts facts_of(const CLI::Option& option) {
  OptionFacts facts{.doc = option.get_description(), .required = option.get_required()};
  const bool takes_value = option.get_items_expected_max() > 0 && option.get_type_size() != 0;
  if (takes_value) read_type(option.get_type_name(), facts);
  facts.repeats = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  if (option.get_positional()) {
    facts.value = option.get_name(true, false);
  } else {
    for (const std::string& name : option.get_snames()) facts.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
    if (takes_value)
      facts.value = facts.repeats ? facts.type : repeated(facts.type, std::max(option.get_expected_min(), 1));
    if (facts.repeats) facts.limits.push_back("May be given more than once.");
  }
  if (!facts.choices.empty()) facts.limits.push_back(fmt::format("One of {}.", fmt::join(facts.choices, ", ")));
  if (!option.get_default_str().empty()) facts.limits.push_back("Default: " + option.get_default_str());
  if (!option.get_needs().empty()) facts.limits.push_back("Needs " + names_of(option.get_needs()) + ".");
  if (!option.get_excludes().empty()) facts.limits.push_back("Not with " + names_of(option.get_excludes()) + ".");
  return facts;
}

CommandFacts facts_of(const CLI::App& app, const std::string& name) {
  CommandFacts facts{.name = name, .doc = app.get_description(), .footer = app.get_footer()};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // not in --help
    (option->get_positional() ? facts.words : facts.options).push_back(facts_of(*option));
  }
  return facts;
}

}  // namespace

std::vector<CommandFacts> command_facts(const CLI::App& app) {
  std::vector<CommandFacts> commands{facts_of(app, "")};
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty()) commands.push_back(facts_of(*command, command->get_name()));
  return commands;
}

std::string first_sentence(const std::string& doc) {
  const size_t end = doc.find(". ");
  std::string text = end == std::string::npos ? doc : doc.substr(0, end);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

}  // namespace frond
