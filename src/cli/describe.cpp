#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "render/plugins.h"
#include "scene/normal_map.h"

namespace frond {
namespace {

constexpr std::string_view type_name(ParamKind kind) {
  switch (kind) {
    case ParamKind::boolean:
      return "bool";
    case ParamKind::integer:
      return "integer";
    case ParamKind::real:
      return "float";
    case ParamKind::string:
      return "string";
    case ParamKind::point2:
      return "point2";
    case ParamKind::vector2:
      return "vector2";
    case ParamKind::point3:
      return "point3";
    case ParamKind::vector3:
      return "vector3";
    case ParamKind::normal3:
      return "normal";
    case ParamKind::illuminant:
      return "rgb | spectrum | blackbody";
    case ParamKind::albedo:
      return "rgb | spectrum";
    case ParamKind::unbounded:
      return "float | rgb | spectrum";
    case ParamKind::float_texture:
      return "float | texture";
    case ParamKind::spectrum_texture:
      return "rgb | spectrum | texture";
    case ParamKind::material:
      return "string";
  }
  return "";
}

std::string default_text(const Param& p) {
  if (p.required) return "required";
  struct Print {
    std::string operator()(std::monostate) const { return ""; }
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::string_view v) const { return fmt::format("\"{}\"", v); }
    std::string operator()(const std::array<double, 3>& v) const { return fmt::format("{}", fmt::join(v, " ")); }
    std::string operator()(int v) const { return fmt::format("{}", v); }
    std::string operator()(double v) const { return fmt::format("{:g}", v); }
  };
  return std::visit(Print(), p.default_value);
}

std::string range_text(const Param& p) {
  if (!p.choices.empty()) return fmt::format("{}", fmt::join(p.choices, " | "));
  const bool below = std::isfinite(p.range.min), above = std::isfinite(p.range.max);
  if (below && above) return fmt::format("{:g} to {:g}", p.range.min, p.range.max);
  if (below) return fmt::format("from {:g}", p.range.min);
  if (above) return fmt::format("up to {:g}", p.range.max);
  return "";
}

/// With those that any material takes.
std::vector<Param> params_of(const PluginInfo& info) {
  std::vector<Param> params(info.params.begin(), info.params.end());
  const auto& bends = normal_bend_params.params;
  if (info.kind == normal_bend_params.kind) params.insert(params.end(), bends.begin(), bends.end());
  return params;
}

/// One record, two prints: aligned text for a terminal, a Markdown section for the docs.
void print_text(const PluginInfo& info) {
  fmt::print("{} \"{}\"\n  {}\n", info.kind, info.name, info.doc);
  if (!info.source.empty()) fmt::print("  After: {}\n", info.source);
  for (const Param& p : params_of(info)) {
    fmt::print("\n  \"{} {}\"{}\n      {}\n", type_name(p.kind), p.name, p.list ? " [ ... ]" : "", p.doc);
    std::vector<std::string> facts;
    if (const auto text = default_text(p); !text.empty()) facts.push_back(p.required ? text : "default " + text);
    if (const auto text = range_text(p); !text.empty()) facts.push_back(text);
    if (!p.unit.empty()) facts.push_back("in " + std::string(p.unit));
    if (!facts.empty()) fmt::print("      {}", fmt::join(facts, "; "));
    fmt::print("\n");
  }
}

void print_markdown(const PluginInfo& info) {
  fmt::print("## {} `{}`\n\n{}", info.kind, info.name, info.doc);
  if (!info.source.empty()) fmt::print(" After: {}.", info.source);
  fmt::print("\n\n");
  const std::vector<Param> params = params_of(info);
  if (params.empty()) return;
  fmt::print("| parameter | type | default | unit | range | |\n|---|---|---|---|---|---|\n");
  const auto escape = [](std::string_view s) {
    std::string out;
    for (const char c : s) out += c == '|' ? "\\|" : std::string(1, c);
    return out;
  };
  for (const Param& p : params)
    fmt::print("| `{}` | {} | {} | {} | {} | {} |\n", p.name, escape(type_name(p.kind)), default_text(p), p.unit,
               escape(range_text(p)), p.doc);
  fmt::print("\n");
}

struct DescribeOptions {
  std::string name;
  bool markdown = false;
  std::vector<std::string> plugins;
};

void describe(const DescribeOptions& options) {
  const auto& [name, markdown, plugins] = options;
  const Registry registry = load_registry(plugins);
  const auto all = all_plugins(registry);
  std::vector<std::string_view> names;
  bool found = false;
  if (markdown && name.empty()) fmt::print("# Plugins\n\nMade by `frond describe --markdown`.\n\n");
  for (const PluginInfo* info : all) {
    names.push_back(info->name);
    const bool chosen = name.empty() ? markdown : info->name == name || info->kind == name;
    if (!chosen) continue;
    if (found && !markdown) fmt::print("\n");
    found = true;
    markdown ? print_markdown(*info) : print_text(*info);
  }
  if (!found) fail({}, "nothing is called \"{}\"{}", name, suggestion(name, names));
}

}  // namespace

void add_describe_command(CLI::App& app) {
  auto* command = app.add_subcommand("describe", "Print a plugin's parameters: types, defaults, units and ranges.");
  auto o = std::make_shared<DescribeOptions>();
  command->add_option("name", o->name, "A plugin's name (see frond list), or a kind such as material.")
      ->type_name("PLUGIN");
  command->add_flag("--markdown", o->markdown, "Print Markdown; without a name, of every plugin.");
  add_plugin_option(*command, o->plugins);
  command->callback([o] {
    if (o->name.empty() && !o->markdown) fail({}, "frond describe takes the name of a plugin; frond list prints them");
    describe(*o);
  });
}

}  // namespace frond
