#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "leaf/tissue/specimens.h"
#include "render/plugins.h"

namespace frond {
namespace {

void list(const std::vector<std::string>& plugins) {
  const Registry registry = load_registry(plugins);
  std::string_view kind;
  for (const PluginInfo* info : all_plugins(registry)) {
    if (info->kind != kind) fmt::print("{}{}\n", kind.empty() ? "" : "\n", info->kind);
    kind = info->kind;
    fmt::print("  {:<20} {}\n", info->name, info->doc);
  }
}

void list_specimens() {
  for (const leaf::Specimen& s : leaf::kSpecimens) fmt::print("  {:<20} {} {}\n", s.name, s.doc, s.source);
}

}  // namespace

void add_list_command(CLI::App& app) {
  auto* command = app.add_subcommand("list", "List every plugin that a scene can name.");
  auto plugins = std::make_shared<std::vector<std::string>>();
  add_plugin_option(*command, *plugins);
  auto what = std::make_shared<std::string>();
  command->add_option("what", *what, "specimens: the leaves that \"string specimen\" can name.")
      ->check(CLI::IsMember({"specimens"}));
  command->callback([plugins, what] { what->empty() ? list(*plugins) : list_specimens(); });
}

}  // namespace frond
