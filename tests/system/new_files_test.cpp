#include "system/new_files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>

#include "system/atomic_file.h"
#include "system/file_bytes.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

/// Returns all files and folders below a folder: their relative paths and contents.
std::map<std::string, std::string> content_of(const fs::path& folder) {
  std::map<std::string, std::string> content;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    content[entry.path().lexically_relative(folder / "").string()] =
        entry.is_directory() ? "a folder" : read_file_bytes(entry.path(), {});
  return content;
}

using Content = std::map<std::string, std::string>;

class NewFilesTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.name_of(name); }
  TestFolder folder_{"new_files"};
};

TEST_F(NewFilesTest, AppearTogetherInANewFolder) {
  {
    NewFiles files(path("a/b"));
    files.write("meshes/leaf.ply", "ply");
    files.write("scene.xml", "<scene/>");
    files.folder("parts");
    EXPECT_FALSE(fs::exists(path("a")));
    files.finish();
  }
  EXPECT_EQ(content_of(path("")), (Content{{"a", "a folder"},
                                           {"a/b", "a folder"},
                                           {"a/b/meshes", "a folder"},
                                           {"a/b/meshes/leaf.ply", "ply"},
                                           {"a/b/parts", "a folder"},
                                           {"a/b/scene.xml", "<scene/>"}}));
}

TEST_F(NewFilesTest, ReplaceFilesOfAnExistingFolderAndLeaveOthers) {
  folder_.write("note", "mine");
  folder_.write("scene.xml", "old");
  fs::create_symlink("scene.xml", path("link"));
  {
    NewFiles files(path(""));
    files.write("meshes/leaf.ply", "ply");
    files.write("link", "new");
    files.write("link", "newer");
    files.finish();
  }
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(content_of(path("")), (Content{{"note", "mine"},
                                           {"scene.xml", "newer"},
                                           {"link", "newer"},
                                           {"meshes", "a folder"},
                                           {"meshes/leaf.ply", "ply"}}));
}

TEST_F(NewFilesTest, LeaveNothingWithoutFinish) {
  for (const std::string folder : {"", "a/b/"}) {
    NewFiles files(path(folder));
    files.write("meshes/leaf.ply", "ply");
  }
  EXPECT_TRUE(fs::is_empty(path("")));
}

/// One file cannot be written, at several positions of the list, in a folder that has files of the same names.
TEST_F(NewFilesTest, LeaveWhatWasThereIfOneFileHasNoPlace) {
  for (const std::string bad : {"scene.xml", "files/leaf.ply", "files"}) {
    const TestFolder folder("new_files_bad");
    folder.write("plant.pbrt", "old");
    if (bad == "files")
      folder.write("files", "a file in the folder's place");
    else
      fs::create_directories(folder.name_of(bad + "/inside"));
    const Content before = content_of(folder.name_of(""));
    const std::string message = error_of([&] {
      NewFiles files(folder.name_of(""));
      for (const char* name : {"plant.pbrt", "more/new.ply", "files/leaf.ply", "scene.xml"}) files.write(name, "new");
      files.finish();
    });
    EXPECT_NE(message.find("cannot write \"" + folder.name_of("")), std::string::npos) << message;
    EXPECT_EQ(content_of(folder.name_of("")), before) << bad;
  }
}

/// Two names of one file: the second finds that the file has gone to its place.
TEST_F(NewFilesTest, RestoreReplacedFilesIfALaterOneFails) {
  folder_.write("a/first", "old");
  const Content before = content_of(path(""));
  {
    NewFiles files(path(""));
    for (const char* name : {"a/first", "a/second", "b/third", "b/./third"}) files.write(name, "new");
    EXPECT_EQ(error_of([&] { files.finish(); }), "cannot write \"" + path("b/third") + "\": No such file or directory");
  }
  EXPECT_EQ(content_of(path("")), before);
}

TEST_F(NewFilesTest, NeverReplaceAnInputByAnyOfItsNames) {
  folder_.write("model.obj", "input");
  fs::create_hard_link(path("model.obj"), path("again.obj"));
  NewFiles files(path("."), {path("model.obj")});
  for (const char* name : {"model.obj", "again.obj"})
    EXPECT_NE(error_of([&] { files.write(name, "new"); }).find("would replace the input"), std::string::npos) << name;
}

TEST_F(NewFilesTest, NeedAFolder) {
  folder_.write("file", "");
  EXPECT_EQ(error_of([&] { NewFiles(path("file/a/b")); }),
            "cannot write \"" + path("file/a/b") + "\": \"" + path("file") + "\" is a file, a folder is needed");
}

TEST_F(NewFilesTest, OfAKilledProcessAreDeletedByTheNextOne) {
  const pid_t child = ::fork();
  if (child == 0) {
    NewFiles files(path(""));
    files.write("half", "of so");
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(std::distance(fs::directory_iterator(path("")), {}), 1);
  NewFiles files(path(""));
  files.write("whole", "all");
  files.finish();
  EXPECT_FALSE(fs::exists(path("half")));
}

TEST_F(NewFilesTest, OfTwoWritersInOneFolderDoNotTouchEachOther) {
  NewFiles first(path(""));
  first.write("first", "1");
  NewFiles second(path("./"));
  second.write("second", "2");
  second.finish();
  first.finish();
  EXPECT_EQ(read_file_bytes(path("first"), {}) + read_file_bytes(path("second"), {}), "12");
}

}  // namespace
}  // namespace frond
