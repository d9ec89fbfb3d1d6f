#include "jobs/record/command_line.h"

#include "scene/format/words.h"

namespace frond {

/// Positional and optional parameters are separated, because help and man pages list them in two sections.
CommandParams command_params(const JobInfo& job) {
  CommandParams params{std::string(job.name), {}, {&kHelpParam}};
  for (const JobParam* p : params_of(job)) (p->positional ? params.arguments : params.options).push_back(p);
  if (job.name == "render") params.options.push_back(&kHelpPbrtParam);
  return params;
}

CommandParams frond_params() { return {"", {}, {&kHelpParam, &kVersionParam}}; }

/// Short names come first, as in the manual pages of GNU programs.
std::vector<std::string> option_names(const JobParam& p) {
  std::vector<std::string> short_names, long_names{"--" + std::string(p.name)};
  for (const std::string& alias : split(std::string(p.aliases), ','))
    if (alias.size() == 1)
      short_names.push_back("-" + alias);
    else if (!alias.empty())
      long_names.push_back("--" + alias);
  short_names.insert(short_names.end(), long_names.begin(), long_names.end());
  return short_names;
}

/// A parameter without a type is named after its kind.
std::string value_name(const JobParam& p) {
  if (!p.type.empty()) return std::string(p.type);
  constexpr const char* kNames[] = {"", "INT", "INT", "NUMBER", "NUMBERS", "TEXT", "TEXT"};
  return kNames[size_t(p.kind)];
}

std::string usage(const JobInfo& job) {
  std::string text = fmt::format("frond {} [OPTIONS]", job.name);
  for (const JobParam* p : command_params(job).arguments) {
    const std::string word = std::string(p->name) + (p->kind == ArgumentKind::texts ? "..." : "");
    text += p->required ? " " + word : " [" + word + "]";
  }
  return text;
}

std::string first_sentence(std::string_view doc) {
  const size_t end = doc.find(". ");
  std::string text(doc.substr(0, end));
  if (text.ends_with('.')) text.pop_back();
  return text;
}

}  // namespace frond
