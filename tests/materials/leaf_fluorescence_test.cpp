#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "instruments/fluorescence_matrix.h"
#include "instruments/goniophotometer.h"
#include "tests/leaf/statistics.h"
#include "tests/materials/support.h"
#include "tests/support/input_error.h"

namespace frond::test {
namespace {

using test::number;
using ::testing::HasSubstr;

std::shared_ptr<const Fluorescence> fluorescence_of(std::string_view material, std::vector<ParsedParam> params) {
  Resolver resolver;
  const MaterialInfo& info = material_info(material);
  const auto made = info.make(Params(info, {std::string(material), {}, std::move(params)}, resolver));
  const auto strategy =
      test::make_plugin(PluginTable<WavelengthsInfo>("wavelengths", builtin_wavelengths()).get("smpte", {}), {});
  ThreadPool pool(2);
  const auto* fluorescent = dynamic_cast<const FluorescentMaterial*>(made.get());
  return fluorescent ? fluorescent->fluorescence({*strategy, pool, silent_log(), {}}) : nullptr;
}

ParsedParam yield(double value) { return number("float", "fluorescence", {value}); }

FluorescenceMatrix matrix_of(const Fluorescence& fluorescence, int64_t rays, int threads = 2) {
  return measure_fluorescence(
      fluorescence, {30, {410, 433, 500, 605, 682, 700}, {650, 684, 701, 722, 743, 800}, rays, 3}, ThreadPool(threads));
}

/// Cells are independent: the squares of their scores, over the matrix, have a chi-square distribution.
TEST(LeafFluorescence, OfAbmIsThatOfLeafSolved) {
  for (const char* specimen : {"soybean", "maize"}) {
    const std::vector<ParsedParam> params{words("specimen", {specimen}), yield(0.02)};
    std::vector<ParsedParam> weighted = params;
    weighted.push_back(words("mode", {"weighted"}));
    const auto solved = fluorescence_of("leaf_solved", params);
    EXPECT_FALSE(solved->is_noisy());
    const FluorescenceMatrix exact = matrix_of(*solved, 2);
    EXPECT_EQ(exact.rays, 0);
    for (const auto& walk_params : {params, weighted}) {
      const auto walks = fluorescence_of("abm", walk_params);
      EXPECT_TRUE(walks->is_noisy());
      EXPECT_EQ(walks->emission_shape(), solved->emission_shape());
      const FluorescenceMatrix m = matrix_of(*walks, 10'000);
      double squares = 0;
      int scores = 0;
      for (size_t i = 0; i < m.cells.size(); ++i)
        for (const auto side : {&FluorescenceMatrix::Cell::lit_side, &FluorescenceMatrix::Cell::opposite_side}) {
          const auto &walked = m.cells[i].*side, &mean = exact.cells[i].*side;
          EXPECT_EQ(mean.variance, 0);
          const double z = (walked.mean - mean.mean) / walked.standard_error();
          squares += z * z, ++scores;
        }
      EXPECT_LT(std::abs(z_of_chi_square(squares, scores)), z_limit(4)) << specimen;
    }
  }
}

TEST(LeafFluorescence, ConservesPhotons) {
  const auto solved = fluorescence_of("leaf_solved", {yield(1)});
  const FluorescenceMatrix m = matrix_of(*solved, 2);
  for (size_t e = 0; e < m.excitation_nm.size(); ++e) {
    const auto integral = [&](auto member) { return m.integral(e, member).mean; };
    const double emitted = integral(&FluorescenceMatrix::Cell::emitted);
    const double rest = integral(&FluorescenceMatrix::Cell::reabsorbed) +
                        integral(&FluorescenceMatrix::Cell::lit_side) +
                        integral(&FluorescenceMatrix::Cell::opposite_side);
    EXPECT_NEAR(rest, emitted, 1e-6 * emitted);
  }
}

TEST(LeafFluorescence, IsProportionalToTheYield) {
  RandomStream rng(1);
  const Vec3 wi{0.6f, 0, 0.8f}, wo{0, 0.28f, -0.96f};
  const auto one = fluorescence_of("leaf_solved", {yield(0.01)}), two = fluorescence_of("leaf_solved", {yield(0.02)});
  EXPECT_GT(one->f(wo, wi, 740, 440, rng), 0);
  EXPECT_DOUBLE_EQ(two->f(wo, wi, 740, 440, rng), 2 * one->f(wo, wi, 740, 440, rng));
  EXPECT_FALSE(one->is_black());
  EXPECT_GT(one->excitation(440), 0);
  for (const char* name : {"abm", "leaf_solved"}) {
    const auto none = fluorescence_of(name, {yield(0)});
    EXPECT_TRUE(none->is_black());
    EXPECT_EQ(none->f(wo, wi, 740, 440, rng), 0);
    EXPECT_EQ(none->photons(wi, 740, 440, rng).lit_side, 0);
  }
}

TEST(LeafFluorescence, NeedsChlorophyll) {
  RandomStream rng(2);
  std::vector<ParsedParam> params{yield(0.01), number("float", "chlorophylla", {0}),
                                  number("float", "chlorophyllb", {0})};
  const auto without = fluorescence_of("leaf_solved", params);
  EXPECT_EQ(without->photons({0, 0, 1}, 740, 440, rng).lit_side, 0);
  EXPECT_EQ(without->excitation(440), 0);
  // A pigment of a file takes its place.
  const TestFolder folder("fluorescing_pigments");
  const std::string file = folder.write("chlorophyll.csv", "nm,m2\n360,1000\n2500,1000\n");
  params.push_back(words("pigments", {file})), params.push_back(number("float", "pigmentconcentrations", {3}));
  EXPECT_EQ(fluorescence_of("leaf_solved", params)->excitation(440), 0);
  params.push_back(number("integer", "fluorescingpigments", {1}));
  EXPECT_GT(fluorescence_of("leaf_solved", params)->photons({0, 0, 1}, 740, 440, rng).lit_side, 0);
}

TEST(LeafFluorescence, TakesAnEmissionFile) {
  const TestFolder folder("emission");
  const std::string file = folder.write("line.csv", "nm,density\n719,0\n720,5\n721,0\n");
  RandomStream rng(3);
  const auto line = fluorescence_of("leaf_solved", {yield(0.01), words("emission", {file})});
  EXPECT_EQ(line->emission_shape(), "line");
  EXPECT_EQ(line->photons({0, 0, 1}, 740, 440, rng).emitted, 0);
  const FluorescencePhotons photons = line->photons({0, 0, 1}, 720, 440, rng);
  EXPECT_NEAR(photons.emitted, 0.01 * photons.absorbed, 1e-9);
  const std::string dark = folder.write("dark.csv", "nm,density\n400,1\n500,1\n");
  EXPECT_THAT(error_of([&] { fluorescence_of("abm", {words("emission", {dark})}); }),
              HasSubstr("is 0 from 640 to 850"));
}

TEST(LeafFluorescence, IsThatOfOneTissue) {
  for (const char* name : {"abm", "leaf_solved"})
    EXPECT_THAT(error_of([&] {
                  fluorescence_of(name, {yield(0.01), texture("chlorophylla", {"1:3"})});
                }),
                HasSubstr("give its parameters as numbers"));
  EXPECT_EQ(fluorescence_of("diffuse", {}), nullptr);
}

const std::string kMatrices =
    "excitation_nm,emission_nm,Mb,Mf\n450,700,1e-4,2e-4\n450,740,3e-4,4e-4\n650,700,5e-4,0\n650,740,7e-4,8e-4\n";

/// Matrices of a file are Lambertian emission of every leaf model, with textures too.
TEST(LeafFluorescence, TakesMatrices) {
  const TestFolder folder("matrices");
  const ParsedParam file = words("fluorescencematrices", {folder.write("leaf.csv", kMatrices)});
  RandomStream rng(4);
  for (const char* name : {"abm", "leaf_solved", "leaf_simplified", "leaf_lambert", "leaf"}) {
    const auto given = fluorescence_of(name, {file, texture("chlorophylla", {"1:3"})});
    EXPECT_EQ(given->emission_shape(), "matrices of leaf.csv");
    EXPECT_FALSE(given->is_black());
    EXPECT_FALSE(given->is_noisy());
    for (const Vec3& wi : {Vec3{0, 0, 1}, Vec3{0.6f, 0, -0.8f}}) {
      const FluorescencePhotons photons = given->photons(wi, 740, 450, rng);
      EXPECT_DOUBLE_EQ(photons.lit_side, 3e-4);
      EXPECT_DOUBLE_EQ(photons.opposite_side, 4e-4);
      EXPECT_TRUE(std::isnan(photons.absorbed) && std::isnan(photons.emitted) && std::isnan(photons.reabsorbed));
      for (const Vec3& wo : {Vec3{0, 0, 1}, Vec3{0, -0.8f, 0.6f}, Vec3{0.28f, 0, -0.96f}})
        EXPECT_DOUBLE_EQ(given->f(wo, wi, 740, 450, rng), ((wo.z > 0) == (wi.z > 0) ? 3e-4 : 4e-4) / std::numbers::pi);
    }
    EXPECT_EQ(given->f({0, 0, 1}, {0, 0, 1}, 760, 450, rng), 0);
    EXPECT_GT(given->excitation(500), 0);
    EXPECT_EQ(given->excitation(700), 0);
    EXPECT_DOUBLE_EQ(fluorescence_of(name, {file, number("float", "fluorescencescale", {0.2})})
                         ->photons({0, 0, 1}, 740, 450, rng)
                         .lit_side,
                     0.6e-4);
    EXPECT_DOUBLE_EQ(fluorescence_of(name, {file, words("fluorescenceunit", {"energy"})})
                         ->photons({0, 0, 1}, 740, 450, rng)
                         .lit_side,
                     3e-4 * 740 / 450);
  }
}

TEST(LeafFluorescence, OfTablesIsByMatricesAlone) {
  const TestFolder folder("tables");
  const ParsedParam file = words("fluorescencematrices", {folder.write("leaf.csv", kMatrices)});
  const ParsedParam table =
      words("tablefile", {folder.write("t.csv", "theta_deg,wavelength_nm,Rs,Rd,T\n8,551,.04,.1,.2\n")});
  for (const char* name : {"leaf_simplified", "leaf_lambert"}) {
    EXPECT_TRUE(fluorescence_of(name, {})->is_black());
    EXPECT_EQ(fluorescence_of(name, {})->emission_shape(), "none");
    EXPECT_THAT(error_of([&] { fluorescence_of(name, {yield(0.01)}); }), HasSubstr("give \"fluorescencematrices\""));
    EXPECT_FALSE(fluorescence_of(name, {table, file})->is_black());
  }
  for (const char* name : {"fluorescencescale", "fluorescenceunit"}) {
    const ParsedParam given =
        std::string_view(name) == "fluorescenceunit" ? words(name, {"energy"}) : number("float", name, {2});
    EXPECT_THAT(error_of([&] { fluorescence_of("leaf_lambert", {given}); }), HasSubstr("has no effect without"));
  }
}

/// Reflectance and transmittance are those of the leaf without fluorescence, to the bit.
TEST(LeafFluorescence, ChangesNothingElse) {
  for (const char* name : {"abm", "leaf_solved", "leaf_simplified", "leaf_lambert"}) {
    Ready with(name, {yield(1)}), without(name, {});
    for (uint64_t i = 0; i < 100; ++i) {
      RandomStream a(i), b(i);
      const auto s = with.bsdf().sample({0.6f, 0, 0.8f}, 0.3f, {0.2f, 0.7f}, a);
      const auto t = without.bsdf().sample({0.6f, 0, 0.8f}, 0.3f, {0.2f, 0.7f}, b);
      ASSERT_EQ(s.has_value(), t.has_value());
      if (!s) continue;
      EXPECT_TRUE(s->wi == t->wi && s->f == t->f && s->pdf == t->pdf) << name;
    }
  }
}

/// What a goniophotometer finds over the directions of a side is Mb or Mf. The scores of the walks' patches against the
/// solution have a chi-square distribution.
TEST(FluorescenceByDirection, AddsUpToTheMatrix) {
  const auto solved = fluorescence_of("leaf_solved", {yield(0.01)}), walked = fluorescence_of("abm", {yield(0.01)});
  const DetectorSphere sphere(10, 8);
  const ThreadPool pool(2);
  for (const double theta_deg : {8.0, 130.0}) {
    const Beam beam{theta_deg, 440, nullptr, 685};
    RandomStream rng(5);
    const FluorescencePhotons photons = solved->photons(toward_light(beam), 685, 440, rng);
    const auto exact = measure_fluorescence_f(*solved, beam, sphere, 2, 1, pool);
    EXPECT_TRUE(exact.is_integrated());
    EXPECT_NEAR(exact.share(true).mean, photons.lit_side, 2e-4 * photons.lit_side);
    EXPECT_NEAR(exact.share(false).mean, photons.opposite_side, 2e-4 * photons.opposite_side);
    const auto noisy = measure_fluorescence_f(*walked, beam, sphere, 160'000, 1, pool);
    EXPECT_EQ(noisy.rays, 160'000);
    double squares = 0;
    for (size_t i = 0; i < sphere.size(); ++i) {
      const double z = (noisy.f(i).mean - exact.f(i).mean) / noisy.f(i).standard_error();
      squares += z * z;
    }
    EXPECT_LT(std::abs(z_of_chi_square(squares, int(sphere.size()))), z_limit(4));
    const auto again = measure_fluorescence_f(*walked, beam, sphere, 160'000, 1, ThreadPool(1));
    for (size_t i = 0; i < sphere.size(); ++i) EXPECT_EQ(again.f(i).mean, noisy.f(i).mean);
  }
  EXPECT_THAT(error_of([&] {
                measure_fluorescence_f(*walked, {8, 440, nullptr, 685}, sphere, 100, 1, pool);
              }),
              HasSubstr("100 rays are fewer than 2 for each of 80 patches"));
}

TEST(FluorescenceMatrix, IsTheSameForAnyNumberOfThreads) {
  const auto walks = fluorescence_of("abm", {yield(0.01)});
  const FluorescenceMatrix one = matrix_of(*walks, 100, 1), three = matrix_of(*walks, 100, 3);
  for (size_t i = 0; i < one.cells.size(); ++i) EXPECT_EQ(one.cells[i].lit_side.mean, three.cells[i].lit_side.mean);
}

}  // namespace
}  // namespace frond::test
