#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
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

}  // namespace

void add_list_command(CLI::App& app) {
  auto* command = app.add_subcommand("list", "List every plugin that a scene can name.");
  auto plugins = std::make_shared<std::vector<std::string>>();
  add_plugin_option(*command, *plugins);
  command->callback([plugins] { list(*plugins); });
}

}  // namespace frond
