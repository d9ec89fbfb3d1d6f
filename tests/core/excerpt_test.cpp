#include "core/messages/excerpt.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/log.h"
#include "core/messages/problems.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

Location place_in(const fs::path& file) { return {std::make_shared<const std::string>(file.string()), 3, 1}; }

TEST(Excerpt, WordsOfOtherFilesAreShownUpToForty) {
  const Location own = place_in("/nowhere/scene.pbrt");
  EXPECT_EQ(excerpt("short", own), "short");
  EXPECT_EQ(excerpt(std::string(50, 'a'), own), std::string(40, 'a') + "...");
  EXPECT_EQ(excerpt(std::string(39, 'a') + "\xc3\xa9", own), std::string(39, 'a') + "...") << "no half of an é";
}

TEST(Excerpt, WordsOfForeignFilesAreShownUpToEight) {
  const fs::path file = fs::temp_directory_path() / "frond-excerpt-foreign";
  std::ofstream(file) << "x";
  const fs::path link = fs::temp_directory_path() / "frond-excerpt-link";
  fs::remove(link);
  fs::create_symlink(file, link);
  EXPECT_FALSE(is_foreign(file));
  mark_foreign(link);
  for (const fs::path& name : {file, link, fs::temp_directory_path() / "." / file.filename()}) {
    EXPECT_TRUE(is_foreign(name)) << name;
    EXPECT_EQ(excerpt("0123456789", place_in(name)), "01234567...");
    EXPECT_STREQ(InputError(place_in(name), "unknown \"0123456789\"; there are \"a\" and \"abcdefghi").what(),
                 (name.string() + ":3:1: unknown \"01234567...\"; there are \"a\" and \"abcdefgh...").c_str());
  }
  EXPECT_STREQ(InputError({}, "unknown \"0123456789\"").what(), "unknown \"0123456789\"");
  fs::remove(link);
  fs::remove(file);
}

TEST(Excerpt, ControlCharactersAreEscaped) {
  EXPECT_EQ(escaped("a\nb\rc\td\x1b[2J\x7f"), "a\\nb\\rc\\td\\x1b[2J\\x7f");
  EXPECT_EQ(printable("a\nb\tc\x1b"), "a\nb\tc\\x1b");
  EXPECT_STREQ(InputError(place_in("a\nb"), "name \"c\nfrond: d\"").what(), "a\\nb:3:1: name \"c\\nfrond: d\"");
}

TEST(Excerpt, EachErrorOfSeveralIsALine) {
  Problems problems;
  problems.add(InputError({}, "one\ntwo"));
  problems.add(InputError({}, "three"));
  try {
    problems.check();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "one\\ntwo\nthree");
  }
}

}  // namespace
}  // namespace frond
