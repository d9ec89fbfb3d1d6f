#include <fmt/format.h>

#include "jobs/record/job.h"
#include "leaf/tissue/specimens.h"
#include "render/plugins.h"

namespace frond {

// `frond list`: names of plug-ins and specimens.

namespace {

constexpr std::string_view kWhat[] = {"specimens"};
constexpr JobParam kListParams[] = {
    JobParam("what", ArgumentKind::text, "What to list instead of plug-ins; specimens: values of \"string specimen\".",
             {.choices = kWhat, .positional = true})};

/// Returns the specimens with their sources.
Result list_specimens() {
  Result result{.tables = {{"specimens"}}, .is_requested = true};
  for (const leaf::Specimen& s : leaf::kSpecimens) {
    result.tables[0].add("name", std::string(s.name));
    result.tables[0].add("doc", std::string(s.doc));
    result.tables[0].add("source", std::string(s.source));
    result.text += fmt::format("  {:<20} {} {}\n", s.name, s.doc, s.source);
  }
  return result;
}

/// The job: lists all plug-ins, grouped by kind.
Result list(const JobRun& run) {
  if (run.args.given("what")) return list_specimens();
  const Registry registry = load_registry(run.context.options().plugins);
  Result result{.tables = {{"plugins"}}, .is_requested = true};
  std::string_view kind;
  for (const PluginInfo* info : all_plugins(registry)) {
    if (info->kind != kind) result.text += fmt::format("{}{}\n", kind.empty() ? "" : "\n", info->kind);
    kind = info->kind;
    result.tables[0].add("kind", std::string(info->kind));
    result.tables[0].add("name", std::string(info->name));
    result.tables[0].add("doc", std::string(info->doc));
    result.text += fmt::format("  {:<20} {}\n", info->name, info->doc);
  }
  return result;
}

}  // namespace

extern const JobInfo kListJob("list", "Materials", "List all plug-ins that a scene can name.", "", kListParams,
                              SessionUse::plugins, list);

}  // namespace frond
