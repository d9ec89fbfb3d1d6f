#include <CLI/CLI.hpp>

#include "cli/commands.h"

namespace frond {
namespace {

void list() {
  const Registry registry = builtin_registry();
  std::string_view kind;
  for (const PluginInfo* info : all_plugins(registry)) {
    if (info->kind != kind) fmt::print("{}{}\n", kind.empty() ? "" : "\n", info->kind);
    kind = info->kind;
    fmt::print("  {:<20} {}\n", info->name, info->doc);
  }
}

}  // namespace

void add_list_command(CLI::App& app) {
  app.add_subcommand("list", "List every plugin that a scene can name.")->callback(list);
}

}  // namespace frond
