#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace frond {

/// An option, or a word without a name, as --help has it.
struct OptionFacts {
  std::vector<std::string> names = {};    ///< with their dashes; empty: a word without one
  std::string value = {};                 ///< what it takes, such as FILE; a word's name; empty: a flag
  std::vector<std::string> choices = {};  ///< all that it takes; empty: anything
  std::string type = {};                  ///< FILE, SCENE, MATERIAL, INT, ...
  std::string doc = {};
  std::vector<std::string> limits = {};  ///< sentences: its range, its default, what it needs
  bool required = false, repeats = false;
};

struct CommandFacts {
  std::string name = {};  ///< empty: frond itself
  std::string doc = {}, footer = {};
  std::vector<OptionFacts> words = {}, options = {};
};

/// What the man pages and the shells' completions are made of: frond itself, then its commands.
std::vector<CommandFacts> command_facts(const CLI::App& app);

/// Up to the first full stop.
std::string first_sentence(const std::string& doc);

}  // namespace frond
