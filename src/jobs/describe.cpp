#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "jobs/leaf/leaf_text.h"
#include "jobs/record/command_line.h"
#include "render/plugins.h"
#include "system/new_files.h"
#include "textures/normal_map.h"

namespace frond {

// `frond describe`: documentation of plug-ins and commands, from their records. docs/plugins.md, the pages that it
// lists and docs/commands.md are its output.

namespace {

using enum ArgumentKind;

constexpr JobParam kDescribeParams[] = {
    JobParam("name", text,
             "Name of a plug-in (see frond list), a kind of plug-in such as material, or a command; or a leaf with "
             "parameters, MATERIAL,specimen=maize: its contents per area and PROSPECT's numbers.",
             {.type = "PLUGIN", .positional = true}),
    JobParam("markdown", flag, "Print Markdown; without a name, for every plug-in."),
    JobParam("commands", flag, "Print Markdown for every command.", {.excludes = "markdown"}),
    JobParam(
        "pages", text,
        "Folder for Markdown pages of every plug-in: plugins.md, which lists all, and a page for each kind with the "
        "parameters.",
        {.type = "FOLDER", .path = PathUse::write, .excludes = "markdown,commands"}),
};

/// Returns the name of a parameter's type in scene files.
constexpr std::string_view type_name(ParamKind kind) {
  constexpr std::string_view kNames[] = {"bool",
                                         "integer",
                                         "float",
                                         "string",
                                         "point2",
                                         "vector2",
                                         "point3",
                                         "vector3",
                                         "normal",
                                         "rgb | spectrum | blackbody",
                                         "rgb | spectrum",
                                         "float | rgb | spectrum",
                                         "rgb",
                                         "float | texture",
                                         "rgb | spectrum | texture",
                                         "string"};
  static_assert(std::size(kNames) == size_t(ParamKind::material) + 1);
  return kNames[size_t(kind)];
}

/// Documentation of one parameter of a plug-in or a command.
struct ParamRow {
  std::string name, type, default_value, unit, range, doc;
  std::string head;  ///< syntax in a scene file or on a command line
};

/// Returns the default value as a scene file would state it; "" if there is none.
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

/// Returns the choices or the range of a plug-in's parameter; "" if any value is accepted.
std::string range_text(const Param& p) {
  if (!p.choices.empty()) return fmt::format("{}", fmt::join(p.choices, " | "));
  const bool below = std::isfinite(p.range.min), above = std::isfinite(p.range.max);
  if (below && above) return fmt::format("{:g} to {:g}", p.range.min, p.range.max);
  if (below) return fmt::format("from {:g}", p.range.min);
  if (above) return fmt::format("up to {:g}", p.range.max);
  return "";
}

/// Parameters of a plug-in. Materials also have the parameters that every material has (normal maps).
std::vector<ParamRow> param_rows(const PluginInfo& info) {
  std::vector<ParamRow> rows;
  const auto add = [&rows](std::span<const Param> params) {
    for (const Param& p : params)
      rows.push_back({std::string(p.name), std::string(type_name(p.kind)), default_text(p), std::string(p.unit),
                      range_text(p), std::string(p.doc),
                      fmt::format("\"{} {}\"{}", type_name(p.kind), p.name, p.list ? " [ ... ]" : "")});
  };
  add(info.params);
  if (info.kind == normal_bend_params.kind) add(normal_bend_params.params);
  return rows;
}

/// Returns the row of a command's parameter. Positional parameters have no dashes.
ParamRow row_of(const JobParam& p) {
  const std::string name = p.positional ? std::string(p.name) : fmt::format("{}", fmt::join(option_names(p), ", "));
  const std::string value = value_name(p);
  return {name,
          value,
          p.required ? "required" : std::string(p.default_value),
          std::string(p.unit),
          accepted_values_text(p),
          std::string(p.doc) + relations_text(p),
          name + (p.positional || value.empty() ? ""
                  : p.implied.empty()           ? " " + value
                                                : "[=" + value + "]")};
}

/// Rows of a command's table of options, in the order of its record.
std::vector<ParamRow> param_rows(std::span<const JobParam> params) {
  std::vector<ParamRow> rows;
  for (const JobParam& p : params) rows.push_back(row_of(p));
  return rows;
}

/// Returns the rows as indented text.
std::string text_of(const std::vector<ParamRow>& rows) {
  std::string text;
  for (const ParamRow& row : rows) {
    text += fmt::format("\n  {}\n      {}\n", row.head, row.doc);
    std::vector<std::string> facts;
    if (!row.default_value.empty())
      facts.push_back((row.default_value == "required" ? "" : "default ") + row.default_value);
    if (!row.range.empty()) facts.push_back(row.range);
    if (!row.unit.empty()) facts.push_back("in " + row.unit);
    text += facts.empty() ? "\n" : fmt::format("      {}\n", fmt::join(facts, "; "));
  }
  return text;
}

/// Returns the rows as a Markdown table.
std::string markdown_of(const std::vector<ParamRow>& rows, std::string_view head) {
  if (rows.empty()) return "";
  const auto escape = [](std::string_view s) {
    std::string out;
    for (const char c : s) out += c == '|' ? "\\|" : std::string(1, c);
    return out;
  };
  std::string text = fmt::format("{}\n|---|---|---|---|---|---|\n", head);
  for (const ParamRow& row : rows)
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.name, escape(row.type), row.default_value, row.unit,
                        escape(row.range), escape(row.doc));
  return text + '\n';
}

std::string text_of(const PluginInfo& info) {
  const std::string source = info.source.empty() ? "" : fmt::format("  Source: {}\n", info.source);
  return fmt::format("{} \"{}\"\n  {}\n{}", info.kind, info.name, info.doc, source) + text_of(param_rows(info));
}

std::string markdown_of(const PluginInfo& info) {
  const std::string source = info.source.empty() ? "" : fmt::format(" Source: {}.", info.source);
  return fmt::format("## {} `{}`\n\n{}{}\n\n", info.kind, info.name, info.doc, source) +
         markdown_of(param_rows(info), "| parameter | type | default | unit | range | |");
}

std::string text_of(const JobInfo& job) {
  std::vector<ParamRow> rows;
  for (const JobParam* p : params_of(job)) rows.push_back(row_of(*p));
  const std::string details = job.details.empty() ? "" : fmt::format("  {}\n", job.details);
  return fmt::format("command \"{}\"\n  {}\n{}  {}\n", job.name, job.doc, details, usage(job)) + text_of(rows);
}

/// Header of the tables of docs/commands.md.
constexpr std::string_view kCommandHead = "| parameter | value | default | unit | range or choices | description |";

std::string markdown_of(const JobInfo& job) {
  std::string text = fmt::format("### frond {}\n\n{} {}\n\n    {}\n\n", job.name, job.doc, job.details, usage(job));
  if (job.details.empty()) text.erase(text.find(" \n\n"), 1);
  text += markdown_of(param_rows(job.params), kCommandHead);
  if (job.extends) text += fmt::format("All parameters of [frond {0}](#frond-{0}) too.\n\n", job.extends->name);
  std::vector<std::string> names;
  for (const JobParam& p : session_params(job.session)) names.push_back(fmt::format("`--{}`", p.name));
  return text + fmt::format("[Common parameters](#common-parameters): {}.\n\n", fmt::join(names, ", "));
}

/// Page of the plug-ins of some kinds.
struct KindsPage {
  std::string_view file, title, contents;
  std::array<std::string_view, 4> kinds;  ///< as PluginInfo::kind; unused ones are empty
};
constexpr KindsPage kPages[] = {
    {"plugins_materials.md", "Materials", "the leaf models and pbrt-v4's materials", {"material"}},
    {"plugins_lights.md", "Lights", "lights, and surfaces that emit light", {"light", "area light"}},
    {"plugins_shapes.md", "Shapes", "meshes, quadrics, curves and tables of instances", {"shape"}},
    {"plugins_textures.md",
     "Textures",
     "numbers and spectra that vary over a surface",
     {"float texture", "spectrum texture"}},
    {"plugins_media.md", "Media", "participating media: mist, clouds, turbid canopies", {"medium"}},
    {"plugins_cameras.md",
     "Cameras and films",
     "cameras, films, samplers and pixel filters",
     {"camera", "film", "sampler", "pixel filter"}},
    {"plugins_integrators.md",
     "Integrators and wavelengths",
     "light transport and spectral sampling",
     {"integrator", "wavelengths"}},
};

/// Returns the fragment of the plug-in's heading in its page, as GitHub and MkDocs make it.
std::string anchor(const PluginInfo& info) {
  std::string text = fmt::format("{}-{}", info.kind, info.name);
  std::ranges::replace(text, ' ', '-');
  return text;
}

/// Returns the page of some kinds.
std::string kinds_page(const KindsPage& page, const Registry& registry) {
  std::string text = fmt::format(
      "# {}\n\nFor authors of scene files: {}, with all parameters. Made by `frond describe`, as are the pages of all "
      "[other plug-ins](plugins.md).\n\n",
      page.title, page.contents);
  for (const PluginInfo* info : all_plugins(registry))
    if (std::ranges::find(page.kinds, info->kind) != page.kinds.end()) text += markdown_of(*info);
  text.pop_back();
  return text;
}

/// Returns the page that lists all plug-ins. The anchors of its entries equal the anchors of the headings of the other
/// pages.
std::string plugins_page(const Registry& registry) {
  std::string text =
      "# Materials, lights, shapes and other plug-ins\n\n"
      "For authors of scene files: everything that a scene can name. The pages that these lists lead to have all "
      "parameters; [gallery](gallery.md) has images. One of them on the terminal:\n\n"
      "```sh\nfrond describe diffuse\n```\n\n"
      "```\nmaterial \"diffuse\"\n  Lambertian reflector.\n  Source: Lambert 1760\n  ...\n```\n\n"
      "Made by `frond describe --pages docs`.\n";
  for (const KindsPage& page : kPages) {
    text += fmt::format("\n## [{}]({})\n\n", page.title, page.file);
    for (const PluginInfo* info : all_plugins(registry))
      if (std::ranges::find(page.kinds, info->kind) != page.kinds.end())
        text += fmt::format("- <a id=\"{0}\"></a>{1} [`{2}`]({3}#{0}): {4}\n", anchor(*info), info->kind, info->name,
                            page.file, info->doc);
  }
  return text;
}

/// Writes the pages, all or none. Returns what to print.
std::string write_pages(const std::string& folder, const Registry& registry) {
  NewFiles files(folder);
  for (const KindsPage& page : kPages) files.write(std::string(page.file), kinds_page(page, registry));
  files.write("plugins.md", plugins_page(registry));
  files.finish();
  return fmt::format("The pages are listed in {}\n", (std::filesystem::path(folder) / "plugins.md").string());
}

/// Returns the page docs/commands.md.
std::string commands_page() {
  std::string text =
      "# Commands\n\nFor users of the command line: all commands and their parameters. Made by `frond describe "
      "--commands`; "
      "`frond COMMAND --help` and `frond man COMMAND` print the same. Examples are in the [cookbook](cookbook.md).\n\n";
  std::string_view group;
  for (const JobInfo* job : all_jobs()) {
    if (job->group != group) text += fmt::format("## {}\n\n", job->group);
    group = job->group;
    text += markdown_of(*job);
  }
  text += "## Common parameters\n\n" + markdown_of(param_rows(session_params(SessionUse::all)), kCommandHead);
  text.pop_back();
  return text;
}

/// The job: prints plug-ins by name or by kind, and commands by name.
Result describe(const JobRun& run) {
  const std::string name = run.args.text("name");
  const bool markdown = run.args.flag("markdown");
  const std::string pages = run.args.text("pages");
  if (!pages.empty() && !name.empty())
    fail({}, "{} describes every plug-in: leave out \"{}\"", run.args.spelled("pages"), name);
  if (run.args.flag("commands")) return {.text = commands_page(), .is_requested = true};
  if (name.empty() && !markdown && pages.empty())
    fail({}, "frond describe needs a name; frond list prints the names of plug-ins");
  const Registry registry = load_registry(run.context.options().plugins);
  if (!pages.empty()) return {.text = write_pages(pages, registry)};
  // No plug-in has a comma in its name.
  if (name.find(',') != name.npos) return {.text = describe_leaf(name, registry), .is_requested = true};
  std::vector<std::string_view> names;
  std::string found;
  const auto add = [&](bool is_chosen, const auto& info) {
    names.push_back(info.name);
    if (!is_chosen) return;
    if (!found.empty() && !markdown) found += '\n';
    found += markdown ? markdown_of(info) : text_of(info);
  };
  for (const PluginInfo* info : all_plugins(registry))
    add(name.empty() || info->name == name || info->kind == name, *info);
  for (const JobInfo* job : all_jobs()) add(!name.empty() && job->name == name, *job);
  if (found.empty()) {
    const std::string_view match = nearest(name, names);
    fail({}, "no plug-in or command is named \"{}\"; {}", name,
         match.empty() ? "frond list prints all" : fmt::format("did you mean \"{}\"?", match));
  }
  return {.text = found, .is_requested = true};
}

}  // namespace

extern const JobInfo kDescribeJob("describe", "Materials",
                                  "Print the parameters of a plug-in or a command: types, defaults, units and ranges.",
                                  "", kDescribeParams, SessionUse::plugins, describe);

}  // namespace frond
