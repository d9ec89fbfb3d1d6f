#include "cli/table_words.h"

#include <map>

#include "core/error.h"

namespace frond {
namespace {

std::string_view material_of(const std::string& word) {
  for (const std::string_view name : {kSimplified, kSolved})
    if (word == name) return name;
  fail({}, "\"{}\" is neither a material that looks up a table, {} or {}, nor name=value of a leaf", word, kSimplified,
       kSolved);
}

/// A render makes its own table by these; here the command's options say the same.
void check_has_no_option(const std::string& name) {
  static const std::map<std::string, std::string_view> kOptions{{"tablemethod", "--method solve or montecarlo"},
                                                                {"tablerays", "--rays"},
                                                                {"tablestep", "--angles first:last:step"}};
  if (name == "tablefile") fail({}, "a table is made of a leaf, not of a \"tablefile\"");
  if (const auto option = kOptions.find(name); option != kOptions.end())
    fail({}, "\"{}\" is for renders that make their table: use {}", name, option->second);
}

void check_leaf(const std::vector<std::string>& words) {
  std::map<std::string, std::string> given;
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('=')),
                      value = word.substr(std::min(word.size(), name.size() + 1));
    check_has_no_option(name);
    if (const auto [first, is_new] = given.emplace(name, value); !is_new)
      fail({}, "\"{}\" is given twice, as {} and as {}", name, first->second, value);
  }
}

}  // namespace

TableWords parse_table_words(std::vector<std::string> words, const std::string& specimen) {
  TableWords result;
  if (!words.empty() && words[0].find('=') == std::string::npos) {
    result.material = material_of(words[0]);
    words.erase(words.begin());
  }
  if (!specimen.empty()) words.push_back("specimen=" + specimen);
  check_leaf(words);
  result.leaf = std::move(words);
  return result;
}

}  // namespace frond
