#include <gmock/gmock.h>

#include <filesystem>
#include <map>

#include "system/file_bytes.h"
#include "tests/support/command_test.h"

/// Outputs of commands: no output replaces an input or another output, whatever its name, and a command that fails
/// leaves its folder as it was.
namespace frond {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kCsv = "wavelength,R,T\n500,0.1,0.1\n550,0.2,0.2\n600,0.1,0.1\n";

/// Works in a folder of its own, so that names of files can be relative.
class Outputs : public CommandTest {
 protected:
  Outputs() { fs::current_path(path("")); }
  ~Outputs() override { fs::current_path(before_); }

  std::string scene(const std::string& name, const std::string& world, const std::string& film = "") const {
    const std::string filename = film.empty() ? "" : " \"string filename\" \"" + film + '"';
    folder_.write(name, "Camera \"orthographic\"\nFilm \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 2" +
                            filename + "\nWorldBegin\nLightSource \"infinite\" \"spectrum L\" \"stdillum-E\"\n" +
                            world + "\nShape \"disk\"\n");
    return name;
  }
  /// An image with the given value.
  void image(const std::string& name) const {
    scene("image.pbrt", "Material \"diffuse\"");
    ASSERT_EQ(frond_command({"render", "image.pbrt", "-o", name, "--spp", "1", "-q", "--no-cache"}).code, 0);
  }
  /// All files by name, links and hidden files too, with their contents.
  static std::map<std::string, std::string> files() {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator("."))
      all[entry.path().string()] = entry.is_regular_file() ? read_file_bytes(entry.path(), {}) : "";
    return all;
  }
  /// Returns the message of a command that has to fail, and to leave all files as they are.
  static std::string refusal(const Words& words) {
    const auto before = files();
    const Outcome o = frond_command(words);
    EXPECT_EQ(o.code, 1) << words[0] << o.err;
    EXPECT_EQ(files(), before) << words[0];
    return o.err;
  }
  static Words render(const Words& more) {
    return joined({"render", "scene.pbrt", "--no-cache", "-q", "--spp", "1"}, more);
  }

  fs::path before_ = fs::current_path();
};

TEST_F(Outputs, TwoThatAreOneFileAreRefusedByWhateverNames) {
  scene("scene.pbrt", "Material \"diffuse\"");
  folder_.write("in.csv", kCsv);
  folder_.write("old.json", "{}");
  fs::create_hard_link("old.json", "hard.exr");
  fs::create_directory("sub");
  fs::create_directory("report");
  fs::create_directory_symlink("sub", "link");
  const std::string same = "write to the same file";
  for (const Words& names : {Words{"./o.exr", "o.exr"}, Words{"o.exr", path("o.exr")}, Words{"sub/../o.exr", "o.exr"},
                             Words{"sub/o.exr", "link/o.exr"}, Words{"hard.exr", "old.json"}})
    EXPECT_THAT(refusal(render({"-o", names[0], "--json", names[1]})), HasSubstr(same)) << names[0];
  EXPECT_THAT(refusal({"brf", "scene.pbrt", "--csv", "x", "--json", "./x"}), HasSubstr(same));
  EXPECT_THAT(refusal({"flux", "scene.pbrt", "--csv", "x", "--json", "./x"}), HasSubstr(same));
  EXPECT_THAT(refusal({"fit", "in.csv", "-o", "fit.pbrt", "--json", "./fit.pbrt"}), HasSubstr(same));
  EXPECT_THAT(refusal({"goniophotometer", "diffuse", "--wavelengths", "550", "--map", "m.svg", "--csv", "./m.svg"}),
              HasSubstr(same));
  EXPECT_THAT(refusal({"compare", "scene.pbrt", "-o", "report", "--csv", "./report/compare.csv"}), HasSubstr(same));
  EXPECT_THAT(refusal({"submit", "scene.pbrt", "-o", "a.exr", "--spp", "2", "--tasks", "2", "--slurm", "--json", "j"}),
              HasSubstr("all tasks would write this file"));
  EXPECT_THAT(refusal({"spectrophotometer", "diffuse", "--wavelengths", "550", "--csv", "-", "--json", "-"}),
              HasSubstr("only one of --csv and --json can go to standard output"));
}

TEST_F(Outputs, FilesThatACommandWritesBesideAreOutputsToo) {
  scene("scene.pbrt", "Material \"diffuse\"", "film.exr");
  EXPECT_THAT(refusal(render({"--json", "./film.exr"})), AllOf(HasSubstr("--json"), HasSubstr("Film")));
  EXPECT_THAT(refusal(render({"-o", "o.exr", "--checkpoint", "60", "--json", "./o.exr.part"})),
              HasSubstr("--json and the checkpoint write to the same file"));
  EXPECT_THAT(refusal(render({"--part", "a.part", "--checkpoint", "60", "--json", "./a.part.checkpoint"})),
              HasSubstr("--json and the checkpoint write to the same file"));
  EXPECT_THAT(refusal(render({"-o", "o.exr", "--resume", "--json", "o.exr.part.lock"})), HasSubstr("the same file"));
  EXPECT_THAT(refusal({"brf", "scene.pbrt", "--csv", "x.csv", "--checkpoint", "60", "--plot", "x.csv.part"}),
              HasSubstr("chart"));
  EXPECT_THAT(refusal({"flux", "scene.pbrt", "--csv", "x.csv", "--resume", "--json", "./x.csv.part"}),
              HasSubstr("--json and the checkpoint write to the same file"));
}

TEST_F(Outputs, AFileThatTheSceneReadsIsNotReplaced) {
  image("leaf.exr");
  folder_.write("sub/spectrum.spd", "400 0.5\n700 0.5\n");
  folder_.write("world.pbrt",
                "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"leaf.exr\"\n"
                "Texture \"s\" \"spectrum\" \"constant\" \"spectrum value\" \"sub/spectrum.spd\"\n"
                "Material \"diffuse\" \"texture reflectance\" \"t\"\n");
  scene("scene.pbrt", "Include \"world.pbrt\"");
  fs::create_hard_link("leaf.exr", "hard.exr");
  fs::create_symlink("leaf.exr", "link.exr");
  for (const char* name : {"leaf.exr", "hard.exr", "link.exr"})
    EXPECT_THAT(refusal(render({"-o", name})), AllOf(HasSubstr("world.pbrt:1:"), HasSubstr("would replace the input")))
        << name;
  EXPECT_THAT(refusal(render({"-o", "o.exr", "--json", "sub/../world.pbrt"})), HasSubstr("would replace the input"));
  EXPECT_THAT(refusal(render({"-o", "o.exr", "--json", "sub/spectrum.spd"})), HasSubstr("would replace the input"));
  EXPECT_THAT(refusal({"brf", "scene.pbrt", "--csv", "leaf.exr"}), HasSubstr("would replace the input"));
  EXPECT_THAT(refusal({"spectrophotometer", "diffuse,reflectance=sub/spectrum.spd", "--wavelengths", "550", "--csv",
                       "./sub/spectrum.spd"}),
              HasSubstr("--csv would replace the input"));
  scene("scene.pbrt", "Include \"world.pbrt\"", "leaf.exr");
  EXPECT_THAT(refusal(render({})), HasSubstr("the scene's Film would replace the input"));
}

TEST_F(Outputs, TheImageThatTheFilmNamesIsReplacedByTheNextRender) {
  scene("scene.pbrt", "Material \"diffuse\"", "film.png");
  for (const Words& more : {Words{}, Words{}, Words{"-o", "film.png"}}) {
    const Outcome o = frond_command(render(more));
    EXPECT_EQ(o.code, 0) << o.err;
  }
}

TEST_F(Outputs, InputsAmongTheArgumentsAreNotReplaced) {
  folder_.write("a.csv", "x,y,z\n0,0,0\n");
  folder_.write("in.csv", kCsv);
  image("a.exr");
  ASSERT_EQ(frond_command({"render", "image.pbrt", "--part", "a.part", "--spp", "1", "-q", "--no-cache"}).code, 0);
  fs::create_directory_symlink(".", "here");
  const std::string replace = "would replace the input";
  EXPECT_THAT(refusal({"instances", "a.csv", "-o", "./a.csv"}), HasSubstr(replace));
  EXPECT_THAT(refusal({"convert", "a.exr", "-o", "./a.exr"}), HasSubstr(replace));
  EXPECT_THAT(refusal({"merge", "a.part", "--part", "here/a.part"}), HasSubstr(replace));
  EXPECT_THAT(refusal({"fit", "in.csv", "--csv", "./in.csv"}), HasSubstr(replace));
}

TEST_F(Outputs, TwoScenesWithOneFilmFileAreRefused) {
  scene("a.pbrt", "Material \"diffuse\"", "film.exr");
  scene("b.pbrt", "Material \"diffuse\"", "./film.exr");
  EXPECT_THAT(refusal({"render", "a.pbrt", "b.pbrt", "--no-cache", "-q"}), HasSubstr("are both written to film.exr"));
}

/// Such as --json -q, which would write a file -q.
TEST_F(Outputs, NamesThatBeginWithADashAreRefusedWithTheFix) {
  scene("scene.pbrt", "Material \"diffuse\"");
  EXPECT_THAT(refusal({"brf", "scene.pbrt", "--json", "-q"}), AllOf(HasSubstr("--json"), HasSubstr("write ./-q")));
  EXPECT_THAT(refusal({"brf", "scene.pbrt", "--csv=--json"}), HasSubstr("write ./--json"));
  EXPECT_THAT(refusal({"goniophotometer", "diffuse", "--wavelengths", "550", "--plot", "-x.svg"}),
              HasSubstr("write ./-x.svg"));
  EXPECT_THAT(refusal({"man", "--folder", "-q"}), HasSubstr("write ./-q"));
  EXPECT_THAT(refusal({"man", "--folder", "-"}), HasSubstr("--folder: a folder is needed"));
  scene("scene.pbrt", "Material \"diffuse\"", "-film.exr");
  EXPECT_THAT(refusal({"render", "scene.pbrt", "--no-cache"}),
              AllOf(HasSubstr("scene.pbrt:2:"), HasSubstr("write ./-film.exr")));
  EXPECT_EQ(frond_command(render({"-o", "./-a.exr"})).code, 0);
  EXPECT_TRUE(fs::exists("-a.exr"));
}

TEST_F(Outputs, WhatIsNoFileIsRefused) {
  scene("scene.pbrt", "Material \"diffuse\"");
  fs::create_directory("folder.exr");
  for (const char* name : {"folder.exr", "missing/o.exr", "/dev/null", "/dev/stdout", "/dev/fd/1", "-"})
    EXPECT_THAT(refusal(render({"-o", name})), HasSubstr("frond: ")) << name;
  for (const char* name : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"})
    EXPECT_THAT(refusal({"brf", "scene.pbrt", "--csv", name}), HasSubstr("no regular file")) << name;
}

/// The first file of the export can be written, the last cannot.
TEST_F(Outputs, AFolderThatCannotBeWrittenWhollyIsLeftAsItWas) {
  scene("scene.pbrt", "Material \"diffuse\"");
  folder_.write("export/note", "mine");
  fs::create_directories("export/scene.xml");
  EXPECT_THAT(refusal({"export", "scene.pbrt", "--format", "mitsuba", "-o", "export"}),
              AllOf(HasSubstr("scene.xml"), HasSubstr("it is a folder")));
  folder_.write("file", "");
  EXPECT_THAT(refusal({"export", "scene.pbrt", "--format", "mitsuba", "-o", "file/export"}),
              HasSubstr("\"file\" is a file, a folder is needed"));
  // A medium is found after the meshes are written.
  scene("scene.pbrt", "Material \"diffuse\"\nLightSource \"point\"\nShape \"disk\"\nShape \"curve\"");
  EXPECT_THAT(refusal({"export", "scene.pbrt", "--format", "mitsuba", "-o", "new/export"}), HasSubstr("scene.pbrt:"));
  fs::create_directories("report/index.html");
  EXPECT_THAT(refusal({"compare", "scene.pbrt", "-o", "report", "--quick"}),
              AllOf(HasSubstr("index.html"), HasSubstr("it is a folder")));
  fs::create_directories("job/merge.sbatch");
  EXPECT_THAT(
      refusal({"submit", "image.pbrt", "-o", "a.exr", "--spp", "2", "--tasks", "2", "--slurm", "--folder", "job"}),
      HasSubstr("frond: "));
  fs::create_directories("man/frond-table.1");
  EXPECT_THAT(refusal({"man", "--folder", "man"}), HasSubstr("frond-table.1"));
}

}  // namespace
}  // namespace frond
