#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "system/child_process.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

/// Where there is no apt-get, dpkg-query or cmake: a script that went on to install or build would fail.
class Scripts : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const std::string tool : {"sed", "dirname", "basename"})
      std::filesystem::create_symlink("/usr/bin/" + tool, tools_.name_of(tool));
  }
  ChildResult run_script(const std::string& script, const std::string& argument) const {
    return run_child({"/usr/bin/env", "-i", "PATH=" + tools_.name_of(""), "/bin/bash",
                      FROND_SOURCE_DIR "/scripts/" + script, argument},
                     "")
        .value();
  }

  TestFolder tools_{"tools"};
};

TEST_F(Scripts, PrintTheirHelpAndDoNothing) {
  for (const char* script : {"adaptive", "demo", "docs", "package", "test", "tidy", "paper", "choosing", "validation",
                             "wavelengths", "stability", "many_machines"})
    for (const char* flag : {"-h", "--help"}) {
      const ChildResult r = run_script(script, flag);
      EXPECT_EQ(r.status, 0) << script;
      EXPECT_THAT(r.err, IsEmpty()) << script;
      EXPECT_GT(r.out.size(), 80u) << script;
    }
  EXPECT_THAT(run_script("stability", "--help").out, StartsWith("Builds frond_stability"));
}

TEST_F(Scripts, RefuseWordsThatTheyDoNotKnow) {
  for (const std::string script :
       {"adaptive", "demo", "docs", "many_machines", "package", "stability", "test", "tidy"}) {
    const ChildResult r = run_script(script, "--quik");
    EXPECT_NE(r.status, 0) << script;
    EXPECT_THAT(r.err, HasSubstr("usage: scripts/" + script));
    EXPECT_THAT(r.out, IsEmpty());
  }
}

}  // namespace
}  // namespace frond
