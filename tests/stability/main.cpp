#include <fmt/format.h>

#include <cstdio>
#include <cstring>

#include "tests/stability/cases.h"

/// Runs every case. Prints a line for each cell, or the page with --markdown; exits with 1 if a cell is unexpected.
int main(int argc, char** argv) {
  using namespace frond::stability;
  const bool markdown = argc == 2 && std::strcmp(argv[1], "--markdown") == 0;
  if (argc > 1 && !markdown) {
    fmt::print(stderr, "usage: frond_stability [--markdown]\n");
    return 2;
  }
  const std::vector<Theme> themes{incidence(),  ends_of_ranges(), outside_ranges(), absorption(),  indices(),
                                  dispersion(), directions(),     table_files(),    instruments(), tails(),
                                  scenes(),     skies(),          media(),          measured(),    hair(),
                                  subsurface(), fluorescence()};
  fmt::print("{}", markdown ? to_markdown(themes) : to_text(themes));
  const std::vector<std::string> list = surprises(themes);
  for (const std::string& line : list) fmt::print(stderr, "UNEXPECTED: {}\n", line);
  return list.empty() ? 0 : 1;
}
