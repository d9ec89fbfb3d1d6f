#include "cli/specimen_options.h"

#include <CLI/CLI.hpp>

#include "cli/common_options.h"
#include "core/error.h"
#include "scene/words.h"

namespace frond {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  auto words = split(text, ' ');
  std::erase(words, "");
  if (words.empty()) fail({}, "--with takes a material, as in --with \"abm specimen=maize\"");
  return words;
}

}  // namespace

void add_material_options(CLI::App& command, SpecimenOptions& o) {
  command.add_option("material", o.material, "NAME [parameter=value ...] (frond list, frond describe NAME).")
      ->type_name("MATERIAL")
      ->required();
  add_plugin_option(command, o.plugins);
  command.add_option("--seed", o.seed, "Seed of all random numbers.")->check(is_seed);
  command.add_option("--threads", o.threads, "Threads; all by default. The figures do not depend on it.")
      ->check(CLI::Range(1, 1024));
  command.add_option("--cache", o.cache, "Folder for tables that materials compute; ~/.cache/frond by default.")
      ->type_name("FOLDER");
  command.add_flag("--no-cache", o.no_cache, "Keep no tables on disk.");
  command.add_flag("-q,--quiet", o.quiet, "Print nothing but errors and what was asked for.");
}

void add_specimen_options(CLI::App& command, SpecimenOptions& o) {
  add_material_options(command, o);
  command
      .add_option("--with", o.with, "One more material to measure, \"NAME [parameter=value ...]\"; may be given again.")
      ->type_name("MATERIAL")
      ->allow_extra_args(false);
}

std::vector<std::vector<std::string>> specimen_words(const SpecimenOptions& o) {
  std::vector<std::vector<std::string>> materials{o.material};
  for (const std::string& text : o.with) materials.push_back(words_of(text));
  return materials;
}

}  // namespace frond
