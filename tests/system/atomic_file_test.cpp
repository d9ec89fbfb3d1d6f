#include "system/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "system/file_bytes.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

void replace(const fs::path& path, std::string_view text) {
  replace_file(path, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

TEST(AtomicFile, TakesThePlaceOfTheOldOne) {
  const TestFolder folder("atomic_file");
  const fs::path path = folder.write("file", "the old one, which is longer");
  replace(path, "new");
  EXPECT_EQ(read_file_bytes(path, {}), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.name_of("")), {}), 1);
}

// Processes of different containers that share a folder can have equal process ids.
TEST(AtomicFile, LeavesAloneWhatAnotherProcessOfTheSameNumberIsWriting) {
  const TestFolder folder("atomic_file");
  const std::string others = fmt::format(".frond-{}-0.tmp", ::getpid());
  folder.write(others, "half of so");
  const int writer = ::open(folder.name_of(others).c_str(), O_RDONLY);
  ASSERT_EQ(::flock(writer, LOCK_EX), 0);
  replace(folder.name_of("file"), "whole");
  EXPECT_EQ(read_file_bytes(folder.name_of(others), {}), "half of so");
  EXPECT_EQ(read_file_bytes(folder.name_of("file"), {}), "whole");
  ::close(writer);
}

TEST(AtomicFile, RemovesWhatKilledProcessesHaveLeft) {
  const TestFolder folder("atomic_file");
  folder.write(".frond-1-0.tmp", "half of so");
  folder.write(".frond-77777-3.tmp", "");
  folder.write(".frond-note", "another file");
  replace(folder.name_of("file"), "whole");
  EXPECT_FALSE(fs::exists(folder.name_of(".frond-1-0.tmp")));
  EXPECT_FALSE(fs::exists(folder.name_of(".frond-77777-3.tmp")));
  EXPECT_TRUE(fs::exists(folder.name_of(".frond-note")));
}

/// The second writer cleans the folder, which it knows by another name, while the first is writing; no name is used
/// twice.
TEST(AtomicFile, LeavesAloneWhatIsBeingWritten) {
  const TestFolder folder("atomic_file");
  const fs::path path = folder.name_of("first");
  NewFile first(path);
  replace(folder.name_of("./second"), "whole");
  first.finish();
  EXPECT_TRUE(fs::exists(path));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.name_of("")), {}), 2);
}

TEST(AtomicFile, LeavesNothingIfTheProcessEnds) {
  const TestFolder folder("atomic_file");
  if (const int file = ::open(folder.name_of("").c_str(), O_TMPFILE | O_WRONLY, 0666); file >= 0)
    ::close(file);
  else
    GTEST_SKIP() << "the file system has no files without a name";
  const pid_t child = ::fork();
  if (child == 0) {
    NewFile file(folder.name_of("file"));
    file.write({reinterpret_cast<const unsigned char*>("half"), 4});
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(fs::is_empty(folder.name_of("")));
}

TEST(AtomicFile, LeavesAloneFilesOfOthers) {
  const TestFolder folder("atomic_file");
  for (const char* name : {".frond-notes.tmp", ".frond-1-0.tmp.old", "frond-1-0.tmp"}) folder.write(name, "");
  replace(folder.name_of("file"), "whole");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.name_of("")), {}), 4);
}

TEST(AtomicFile, SaysWhyNot) {
  const TestFolder folder("atomic_file");
  const std::string missing = folder.name_of("missing"), path = missing + "/file";
  EXPECT_EQ(error_of([&] { replace(path, "new"); }),
            "cannot write \"" + path + "\": there is no folder \"" + missing + "\"");
  EXPECT_EQ(error_of([&] { replace("/dev/full", "new"); }), "cannot write \"/dev/full\": it is no regular file");
}

}  // namespace
}  // namespace frond
