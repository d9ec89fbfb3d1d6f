#include "jobs/support/shell_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

namespace frond {

std::string shell_word(const std::string& word) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_-./=,:+@%").find(char(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

std::string pasted_command(const JobInfo& job, const Arguments& args) {
  std::string positional, options;
  for (const JobParam* p : args.params()) {
    if (!args.given(p->name)) continue;
    const std::string option = " --" + std::string(p->name);
    if (p->kind == ArgumentKind::flag) {
      if (args.flag(p->name)) options += option;
      continue;
    }
    // A value that begins with - looks like an option.
    for (const std::string& word : args.words(p->name))
      p->positional ? positional += ' ' + shell_word(word)
                    : options += option + (word.starts_with('-') && word != "-" ? '=' : ' ') + shell_word(word);
  }
  return fmt::format("frond {}{}{}", job.name, positional, options);
}

}  // namespace frond
