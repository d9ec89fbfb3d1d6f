#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "system/child_process.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Runs scripts where there is no apt-get, dpkg-query or cmake: a script that went on to install or build would fail.
class Scripts : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const std::string tool : {"sed", "dirname", "basename"})
      std::filesystem::create_symlink("/usr/bin/" + tool, tools_.name_of(tool));
  }
  ChildResult run_script(const std::vector<std::string>& words) const {
    std::vector<std::string> command{"/usr/bin/env", "-i", "PATH=" + tools_.name_of(""), "/bin/bash",
                                     FROND_SOURCE_DIR "/" + words.at(0)};
    command.insert(command.end(), words.begin() + 1, words.end());
    return run_child(command, "").value();
  }
  /// The output of a command that succeeds, without messages.
  std::string output_of(const std::vector<std::string>& words) const {
    const ChildResult r = run_script(words);
    EXPECT_EQ(r.status, 0) << ::testing::PrintToString(words);
    EXPECT_THAT(r.err, IsEmpty()) << ::testing::PrintToString(words);
    return r.out;
  }

  TestFolder tools_{"tools"};
};

TEST_F(Scripts, PrintTheirHelpAndDoNothing) {
  for (const std::string script : {"demo", "docs", "package", "test", "tidy"})
    for (const char* flag : {"-h", "--help"}) EXPECT_GT(output_of({"scripts/" + script, flag}).size(), 80u) << script;
}

TEST_F(Scripts, RefuseWordsThatTheyDoNotKnow) {
  for (const std::string script : {"demo", "docs", "package", "test", "tidy"}) {
    const ChildResult r = run_script({"scripts/" + script, "--quik"});
    EXPECT_NE(r.status, 0) << script;
    EXPECT_THAT(r.err, HasSubstr("usage: scripts/" + script));
    EXPECT_THAT(r.out, IsEmpty());
  }
}

TEST_F(Scripts, MeasurementsAreListedAndExplained) {
  const std::string list = output_of({"measurements/run"});
  EXPECT_EQ(output_of({"measurements/run", "--help"}), list);
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(FROND_SOURCE_DIR "/measurements")) {
    const std::string name = entry.path().stem().string();
    const bool is_measurement = entry.is_directory() ? exists(entry.path() / "__main__.py")
                                                     : entry.path().extension() == ".py" && name != "__init__";
    if (!is_measurement) continue;
    ++count;
    const std::string help = output_of({"measurements/run", name, "--help"});
    EXPECT_GT(help.size(), 80u) << name;
    EXPECT_THAT(list, HasSubstr("  " + name + " ")) << name;
    EXPECT_THAT(list, HasSubstr(help.substr(0, help.find('\n') + 1))) << name;
  }
  EXPECT_GT(count, 30);
}

TEST_F(Scripts, MeasurementsRefuseNamesAndOptionsThatTheyDoNotKnow) {
  for (const std::string name : {"adaptive", "many_machines", "stability"}) {
    const ChildResult r = run_script({"measurements/run", name, "--quik"});
    EXPECT_NE(r.status, 0) << name;
    EXPECT_EQ(r.err, "usage: measurements/run " + name + " --help\n");
  }
  for (const std::string name : {"stabilty", "shared", "__init__", "../scripts/demo", "bench/page"}) {
    const ChildResult r = run_script({"measurements/run", name});
    EXPECT_NE(r.status, 0) << name;
    EXPECT_THAT(r.err, HasSubstr("no measurement is named \"" + name + "\". These are:\n  adaptive")) << name;
    EXPECT_THAT(r.out, IsEmpty());
  }
}

}  // namespace
}  // namespace frond
