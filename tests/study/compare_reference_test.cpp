#include <gmock/gmock.h>

#include "core/log.h"
#include "study/compare/reference_store.h"
#include "tests/study/compare_scene.h"
#include "tests/support/input_error.h"

namespace frond::compare {
namespace {

struct Setting {
  explicit Setting(std::string strategy = "smpte") : wavelengths(std::move(strategy)) {}

  std::string wavelengths;
  TestFolder folder{"reference"};
  const Log& quiet = silent_log();
  mutable Session session{quiet, {.threads = 2}};
  const ThreadPool& pool = session.pool();
  Candidate walk = parse_candidate("abm");
  Study study{session,
              {.scene = folder.write("scene.pbrt", kLeafScene).string(), .wavelengths = wavelengths, .size = 16}};

  PairedRender render() const { return {study, walk, 1, 2}; }
  ReferenceStore store() const { return {folder.name_of("cache"), study.identity(walk), quiet}; }
};

bool same_bits(const PairedRender& a, const PairedRender& b) {
  return a.film(0) == b.film(0) && a.film(1) == b.film(1);
}

TEST(PairedRender, ContinuedIsTheSameAsAtOnce) {
  const Setting s;
  PairedRender steps = s.render(), at_once = s.render();
  for (const uint64_t samples : {1u, 2u, 5u}) steps.advance_to(samples, s.pool, nullptr);
  at_once.advance_to(5, s.pool, nullptr);
  EXPECT_TRUE(same_bits(steps, at_once));
}

class KeptReference : public ::testing::TestWithParam<const char*> {};

TEST_P(KeptReference, CanBeContinued) {
  const Setting s(GetParam());
  PairedRender first = s.render(), second = s.render(), at_once = s.render();
  first.advance_to(2, s.pool, nullptr);
  s.store().save(first);
  s.store().load(second);
  EXPECT_EQ(second.samples(), 2u);
  EXPECT_EQ(second.cost().cpu_seconds, first.cost().cpu_seconds);
  second.advance_to(4, s.pool, nullptr);
  at_once.advance_to(4, s.pool, nullptr);
  EXPECT_TRUE(same_bits(second, at_once));
}

INSTANTIATE_TEST_SUITE_P(OfColorsAndBands, KeptReference,
                         ::testing::Values("smpte", "bands,lambdamin=450,lambdamax=700,step=50"));

TEST(ReferenceStore, DamagedFilesCountAsNone) {
  const Setting s;
  PairedRender first = s.render(), second = s.render();
  first.advance_to(1, s.pool, nullptr);
  s.store().save(first);
  const auto file = std::filesystem::directory_iterator(s.folder.name_of("cache"))->path();
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(1000).put('x');
  s.store().load(second);
  EXPECT_EQ(second.samples(), 0u);
  std::filesystem::resize_file(file, 100);
  s.store().load(second);
  EXPECT_EQ(second.samples(), 0u);
}

TEST(ReferenceStore, AFileThatCannotBeReadCountsAsNone) {
  const Setting s;
  PairedRender first = s.render(), second = s.render();
  first.advance_to(1, s.pool, nullptr);
  s.store().save(first);
  const std::filesystem::path cache = s.folder.name_of("cache");
  const std::filesystem::path kept = std::filesystem::directory_iterator(cache)->path();
  std::filesystem::remove(kept);
  std::filesystem::create_symlink("/proc/self/mem", kept);  // a regular file that opens, but does not read
  s.store().load(second);
  EXPECT_EQ(second.samples(), 0u);
}

TEST(Study, ItsIdentityHangsOnEverythingThatDecidesThePixels) {
  const Setting s;
  const auto identity = [&](StudyOptions options, const char* candidate = "abm") {
    return Study(s.session, options).identity(parse_candidate(candidate));
  };
  const StudyOptions base{.scene = s.folder.name_of("scene.pbrt"), .wavelengths = "smpte", .size = 16};
  EXPECT_EQ(identity(base), s.study.identity(s.walk));
  StudyOptions other = base;
  other.size = 17;
  EXPECT_NE(identity(other), identity(base));
  other = base, other.seed = 1;
  EXPECT_NE(identity(other), identity(base));
  EXPECT_NE(identity(base, "abm,mode=weighted"), identity(base));
  EXPECT_NE(identity(base, "abm@wavelengths=hero"), identity(base));
  EXPECT_NE(identity(base, "abm@integrator=path,maxdepth=3"), identity(base));
  s.folder.write("scene.pbrt", std::string(kLeafScene) + "# another\n");
  EXPECT_NE(identity(base), s.study.identity(s.walk));
}

TEST(Study, ItsIdentityHangsOnWhatIsInTheFilesThatAreNamed) {
  const Setting s;
  const std::string red = s.folder.write("red.spd", "600 1  650 1").string();
  const std::string table = s.folder.write("leaf.csv", "a table").string();
  const std::string sensor = "bands,responses=" + red;
  const auto option = [&](const std::string& text) { return "Option \"string wavelengths\" \"" + text + "\"\n"; };
  const auto scene = [&](const char* name, const std::string& head) {
    return s.folder.write(name, head + std::string(kLeafScene)).string();
  };
  struct Case {
    const char* what;
    StudyOptions options;
    std::string candidate, file;
  };
  const std::string plain = scene("plain.pbrt", "");
  const std::vector<Case> cases{
      {"the comparison's wavelengths", {.scene = plain, .wavelengths = sensor}, "abm", red},
      {"the scene's wavelengths", {.scene = scene("own.pbrt", option("bands,responses=red.spd"))}, "abm", red},
      {"the candidate's wavelengths", {.scene = plain}, "abm@wavelengths=" + sensor, red},
      {"the candidate's pigment", {.scene = plain}, "abm,pigments=" + red + ",pigmentconcentrations=1", red},
      {"the candidate's table", {.scene = plain}, "leaf_simplified,tablefile=" + table, table}};
  for (const Case& c : cases) {
    const auto identity = [&] { return Study(s.session, c.options).identity(parse_candidate(c.candidate)).hash(); };
    const uint64_t before = identity();
    EXPECT_EQ(identity(), before) << c.what;
    std::ofstream(c.file, std::ios::app) << "  700 0.5\n";
    EXPECT_NE(identity(), before) << c.what;
  }
}

TEST(Study, TakesTheWholeImageOrItsPartToSize) {
  const Setting s;
  EXPECT_EQ(s.study.film().width, 16);
  EXPECT_EQ(s.study.film().height, 8);
  std::string text(kLeafScene);
  text.replace(text.find("Film \"rgb\""), 10, "Film \"rgb\" \"integer pixelbounds\" [32 64 0 32]");
  const Study part(s.session, {.scene = s.folder.write("part.pbrt", text).string(), .size = 16});
  EXPECT_EQ(part.film().width, 32);
  EXPECT_EQ(part.film().crop.x0, 16);
  EXPECT_EQ(part.film().crop.width(), 16);
}

}  // namespace
}  // namespace frond::compare
