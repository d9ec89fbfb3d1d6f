#include "jobs/submit/engine.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "jobs/support/shell_command.h"
#include "jobs/support/templates.h"

namespace frond {
namespace {

/// Returns a string literal of JSON, which is one of Python and of YAML too.
std::string json_literal(const std::string& word) {
  try {
    return nlohmann::json(word).dump();
  } catch (const nlohmann::json::exception&) {
    fail({}, "OpenJD and Snakemake need UTF-8: \"{}\"", word);
  }
}

/// Returns a literal for an argument in an OpenJD template (specification 2023-09, <ArgString>).
std::string openjd_literal(const std::string& word) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (word.find("{{") != std::string::npos || std::ranges::any_of(word, is_control))
    fail({}, "OpenJD templates cannot have control characters or {{{{ in an argument: \"{}\"", word);
  return json_literal(word);
}

}  // namespace

std::span<const Engine> engines() {
  static const Engine kAll[] = {
      {.name = "slurm",
       .advice = "; first adapt render.sbatch in the same folder to your cluster",
       .files = {{"merge.sbatch", merge_sbatch}, {"submit.sh", submit_sh, true}, {"render.sbatch", render_sbatch}},
       .command = {"@FOLDER@/submit.sh"},
       .is_queue = true,
       .program = "sbatch",
       .package = "apt-get install slurm-client",
       .literal = shell_word,
       .separator = " "},
      {.name = "openjd",
       .files = {{"template.yaml", openjd_template}},
       .command = {"openjd", "run", "@FOLDER@/template.yaml"},
       .program = "openjd",
       .package = "pipx install openjd-cli",
       .literal = openjd_literal,
       .separator = ", "},
      {.name = "snakemake",
       .files = {{"Snakefile", snakefile}},
       .command = {"snakemake", "--snakefile", "@FOLDER@/Snakefile", "--directory", "@FOLDER@", "--cores", "all",
                   "--rerun-incomplete"},
       .program = "snakemake",
       .package = "apt-get install snakemake",
       .literal = json_literal,
       .separator = ", ",
       .reserved = "{}"},
  };
  return kAll;
}

std::vector<std::string> command_of(const Engine& engine, const std::filesystem::path& folder) {
  std::vector<std::string> command;
  const std::pair<std::string, std::string> values[] = {{"@FOLDER@", folder.string()}};
  for (const std::string& word : engine.command) command.push_back(filled(word, values));
  return command;
}

std::string filled(std::string_view text, std::span<const std::pair<std::string, std::string>> values) {
  std::string result;
  while (!text.empty()) {
    const auto value = std::ranges::find_if(values, [text](const auto& v) { return text.starts_with(v.first); });
    result += value == values.end() ? text.substr(0, 1) : std::string_view(value->second);
    text.remove_prefix(value == values.end() ? 1 : value->first.size());
  }
  return result;
}

}  // namespace frond
