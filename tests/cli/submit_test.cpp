#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Submit : public CommandTest {
 protected:
  void SetUp() override {
    folder_.write("scene.pbrt", R"(
LookAt 0 0 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
Material "diffuse" "rgb reflectance" [.2 .5 .1]
Shape "sphere" "float radius" .5
)");
  }
  Outcome submit(const std::string& output, const Words& more) const {
    return frond_command({"submit", path("scene.pbrt"), "-o", output, "--spp", "10", "--tasks", "3", "--no-cache"},
                         more);
  }
  void expect_refusal(const std::string& output, const Words& more, const std::string& message,
                      const std::string& folder) const {
    const Outcome o = submit(output, more);
    EXPECT_EQ(o.code, 1);
    EXPECT_THAT(o.err, HasSubstr(message));
    EXPECT_FALSE(fs::exists(folder)) << folder;
  }
};

/// Files that are written for each engine.
const std::pair<std::string, std::vector<std::string>> kFiles[] = {
    {"slurm", {"submit.sh", "render.sbatch", "merge.sbatch"}},
    {"openjd", {"template.yaml"}},
    {"snakemake", {"Snakefile"}},
};

TEST_F(Submit, WritesFilesForEachEngine) {
  for (const auto& [engine, files] : kFiles) {
    const std::string output = path("image_of_" + engine + ".exr");
    const Outcome o = submit(output, {"--engine", engine});
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_THAT(o.out, AllOf(HasSubstr(output + "." + engine), HasSubstr("3 tasks")));
    for (const std::string& file : files) {
      const std::string text = content(fs::path(output + "." + engine) / file);
      EXPECT_THAT(text, Not(ContainsRegex("@[A-Z_]+@"))) << file;
      EXPECT_THAT(text, Not(IsEmpty())) << file;
      if (engine != "slurm") {
        EXPECT_LE(std::ranges::count(text, '\n'), 60) << file;
        EXPECT_THAT(text, AllOf(HasSubstr('"' + path("scene.pbrt") + '"'), HasSubstr('"' + output + '"'),
                                HasSubstr("\"--no-cache\"")));
      }
    }
  }
}

TEST_F(Submit, SlurmHasAnOptionOfItsOwn) {
  const std::string output = path("image.exr");
  ASSERT_EQ(submit(output, {"--engine", "slurm", "--folder", path("a")}).code, 0);
  ASSERT_EQ(submit(output, {"--slurm", "--folder", path("b")}).code, 0);
  for (const std::string& file : kFiles[0].second) EXPECT_EQ(content(path("a/" + file)), content(path("b/" + file)));
}

TEST_F(Submit, NeedsOneEngine) {
  const std::string output = path("image.exr");
  expect_refusal(output, {}, "--engine is needed: slurm, openjd, snakemake", path("image.exr."));
  expect_refusal(output, {"--engine", "pbs"}, "--engine: one of slurm, openjd, snakemake is needed; \"pbs\" was given",
                 path("image.exr.pbs"));
  expect_refusal(output, {"--engine", "openjd", "--slurm"}, "--slurm excludes --engine", path("image.exr.openjd"));
}

TEST_F(Submit, RefusesNamesThatAnEngineCannotHave) {
  expect_refusal(path("{a}.exr"), {"--engine", "snakemake"}, "snakemake cannot have any of {} in the path of a result",
                 path("{a}.exr.snakemake"));
  expect_refusal(path("{{a.exr"), {"--engine", "openjd"}, "OpenJD templates cannot have control characters or {{",
                 path("{{a.exr.openjd"));
  expect_refusal(path("a\nb.exr"), {"--engine", "openjd"}, "OpenJD templates cannot have control characters or {{",
                 path("a\nb.exr.openjd"));
  for (const std::string engine : {"openjd", "snakemake"})
    expect_refusal(path("\xff.exr"), {"--engine", engine}, "need UTF-8", path("\xff.exr." + engine));
  EXPECT_EQ(submit(path("{{a}\n\xff.exr"), {"--engine", "slurm"}).code, 0);
}

TEST_F(Submit, ValuesAreNotSearchedForNames) {
  const std::string output = path("@SPP@.exr");
  ASSERT_EQ(submit(output, {"--engine", "snakemake", "--folder", path("job")}).code, 0);
  EXPECT_THAT(content(path("job/Snakefile")), HasSubstr("out = \"" + output + "\""));
}

// Parts of two jobs have the same names.
TEST_F(Submit, AFolderHasOneJob) {
  ASSERT_EQ(submit(path("a.exr"), {"--engine", "openjd", "--folder", path("a job")}).code, 0);
  const Outcome o = submit(path("b.exr"), {"--engine", "snakemake", "--folder", path("a job")});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(
      o.err, AllOf(HasSubstr("already contains a job"), HasSubstr("openjd run '" + path("a job") + "/template.yaml'")));
  EXPECT_FALSE(fs::exists(path("a job/Snakefile")));
}

/// Sets PATH for the duration of its life.
class PathOf {
 public:
  explicit PathOf(const std::string& folders) : before_(std::getenv("PATH")) { setenv("PATH", folders.c_str(), 1); }
  ~PathOf() { setenv("PATH", before_.c_str(), 1); }
  PathOf(const PathOf&) = delete;
  PathOf& operator=(const PathOf&) = delete;

 private:
  std::string before_;
};

TEST_F(Submit, RunNamesAMissingProgramAndItsPackage) {
  const PathOf empty(path("nothing"));
  const std::string output = path("image.exr");
  expect_refusal(output, {"--engine", "slurm", "--run"},
                 "--run needs sbatch, which is not in PATH; to install it: apt-get install slurm-client",
                 output + ".slurm");
  expect_refusal(output, {"--engine", "openjd", "--run"},
                 "--run needs openjd, which is not in PATH; to install it: pipx install openjd-cli",
                 output + ".openjd");
  expect_refusal(output, {"--engine", "snakemake", "--run"},
                 "--run needs snakemake, which is not in PATH; to install it: apt-get install snakemake",
                 output + ".snakemake");
}

TEST_F(Submit, RunReportsHowAnEngineEndsAndHowToGoOn) {
  const fs::path fake = folder_.write("bin/openjd", "#!/bin/sh\nexit 3\n");
  fs::permissions(fake, fs::perms::owner_exec, fs::perm_options::add);
  const PathOf with_fake(path("bin"));
  const Outcome o = submit(path("image.exr"), {"--engine", "openjd", "--run"});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, HasSubstr("openjd ended with exit code 3; this renders what is missing: openjd run " +
                               path("image.exr.openjd/template.yaml")));
}

TEST_F(Submit, QuietPutsWhatAnEnginePrintsIntoAFile) {
  const auto run_with = [this](const std::string& script, const std::string& output, const Words& more) {
    const fs::path fake = folder_.write("bin/openjd", "#!/bin/sh\n" + script);
    fs::permissions(fake, fs::perms::owner_exec, fs::perm_options::add);
    const PathOf with_fake(path("bin"));
    return submit(output, joined(more, {"--engine", "openjd", "--run"}));
  };
  const std::string chatty = "echo task 1; echo task 2 >&2\n";
  const Outcome loud = run_with(chatty, path("a.exr"), {});
  EXPECT_THAT(loud.out, HasSubstr("task 1\n"));
  EXPECT_THAT(loud.err, HasSubstr("task 2\n"));
  EXPECT_FALSE(fs::exists(path("a.exr.openjd/openjd.log")));
  const Outcome silent = run_with(chatty, path("b.exr"), {"-q"});
  EXPECT_EQ(silent.code, 0);
  EXPECT_EQ(silent.out + silent.err, "");
  EXPECT_EQ(content(path("b.exr.openjd/openjd.log")), "task 1\ntask 2\n");
  const Outcome failed =
      run_with("i=0; while [ $i -lt 30 ]; do i=$((i+1)); echo line $i; done; exit 3\n", path("c.exr"), {"-q"});
  EXPECT_EQ(failed.code, 1);
  EXPECT_EQ(failed.out, "");
  EXPECT_THAT(failed.err, AllOf(HasSubstr("openjd ended with exit code 3"), HasSubstr("c.exr.openjd/openjd.log"),
                                HasSubstr("line 21 | line 22"), HasSubstr("line 30"), Not(HasSubstr("line 20"))));
  EXPECT_THAT(run_with("echo no; exit 1\n", path("d.exr"), {"-q"}).err, HasSubstr("openjd.log\": no"));
  EXPECT_THAT(run_with("exit 1\n", path("e.exr"), {"-q"}).err,
              AllOf(HasSubstr("exit code 1"), Not(HasSubstr("the end of"))));
}

}  // namespace
}  // namespace frond
