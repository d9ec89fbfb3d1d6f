#include "system/file_bytes.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"

namespace frond {
namespace {

const Location kHere{std::make_shared<const std::string>("scene.pbrt"), 3, 7};

std::string refusal(const std::filesystem::path& path, std::string_view what = {}) {
  return error_of([&] { read_file_bytes(path, kHere, what); });
}

TEST(FileBytes, AreAllThatAFileHolds) {
  const TestFolder folder("file_bytes");
  std::string bytes(200'000, '\n');
  bytes[70'000] = '\0', bytes.back() = '\r';
  EXPECT_EQ(read_file_bytes(folder.write("some", bytes), {}), bytes);
  EXPECT_EQ(read_file_bytes(folder.write("none", ""), {}), "");
}

TEST(FileBytes, AreNotReadFromWhatIsNoFile) {
  const TestFolder folder("file_bytes");
  EXPECT_EQ(refusal("gone.txt"), "scene.pbrt:3:7: there is no file gone.txt");
  EXPECT_EQ(refusal("/dev/zero"), "scene.pbrt:3:7: /dev/zero is not a regular file");
  EXPECT_EQ(refusal(folder.name_of(".")), "scene.pbrt:3:7: " + folder.name_of(".") + " is a folder, not a file");
  std::filesystem::create_symlink("itself", folder.name_of("itself"));
  EXPECT_EQ(refusal(folder.name_of("itself")),
            "scene.pbrt:3:7: cannot open " + folder.name_of("itself") + ": Too many levels of symbolic links");
}

TEST(FileBytes, AreCalledWhatTheyWereToBe) {
  EXPECT_EQ(refusal("gone.csv", "leaf table"),
            "scene.pbrt:3:7: cannot read leaf table \"gone.csv\": No such file or directory");
  EXPECT_EQ(refusal("/dev/zero", "leaf table"),
            "scene.pbrt:3:7: cannot read leaf table \"/dev/zero\": it is no regular file");
  EXPECT_EQ(refusal("/", "leaf table"), "scene.pbrt:3:7: cannot read leaf table \"/\": it is a folder");
}

}  // namespace
}  // namespace frond
