#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <numbers>
#include <set>

#include "core/log.h"
#include "leaf/solve/solver.h"
#include "leaf/tissue/absorption.h"
#include "leaf/tissue/specimens.h"
#include "materials/leaf_params.h"
#include "tests/leaf/statistics.h"
#include "tests/materials/support.h"
#include "tests/support/input_error.h"

namespace frond::test {
namespace {

using test::number;
using ::testing::HasSubstr;

const ParsedParam kSolve = words("tablemethod", {"solve"});

TEST(LeafMaterials, ShareTheParametersOfTheLeaf) {
  for (const char* name : {"leaf", "abm", "leaf_simplified", "leaf_solved", "leaf_lambert"}) {
    const auto params = material_info(name).params;
    ASSERT_GE(params.size(), leaf_params().size());
    for (size_t i = 0; i < leaf_params().size(); ++i) EXPECT_EQ(params[i].name, leaf_params()[i].name) << name;
  }
}

TEST(LeafMaterials, RecordsHoldForTheirBsdfs) {
  for (const MaterialInfo* info : builtin_materials()) {
    if (!info->leaf || info->leaf->is_open) continue;
    Ready ready(std::string(info->name), {});
    EXPECT_EQ(any(ready.bsdf().flags() & Lobes::stochastic), info->leaf->is_noisy) << info->name;
    const auto declares = [&](std::string_view name) {
      return std::ranges::find(info->params, name, &Param::name) != info->params.end();
    };
    EXPECT_EQ(declares(LeafModel::kTableFile), info->leaf->table != LeafModel::Table::none) << info->name;
    EXPECT_TRUE(info->leaf->quiet.parameter.empty() || declares(info->leaf->quiet.parameter)) << info->name;
    const bool takes_walls = error_of([&] {
                               Ready(info->name, {texture("spongyaspect", {"1:2"})});
                             }).find("spongyaspect") == std::string::npos;
    EXPECT_EQ(takes_walls, info->leaf->accepts_wall_textures) << info->name;
  }
}

TEST(LeafMaterials, RefuseWhatIsOutOfRange) {
  for (const char* name : {"abm", "leaf_simplified"}) {
    EXPECT_THAT(error_of([&] { Ready(name, {texture("chlorophylla", {"3:300"})}); }),
                HasSubstr("texture \"3:300\" has values from 3 to 300, outside the range 0 to 100 kg/m^3"));
    EXPECT_THAT(error_of([&] { Ready(name, {number("float", "thickness", {1})}); }), HasSubstr("0.01 m"));
    EXPECT_THAT(error_of([&] { Ready(name, {words("specimen", {"soyabean"})}); }), HasSubstr("soybean, maize"));
  }
}

leaf::TissueParams read(std::vector<ParsedParam> params) {
  Resolver resolver;
  return LeafParams(Params(material_info("abm"), {"abm", {}, std::move(params)}, resolver)).tissue();
}

TEST(LeafMaterials, TakeFromTheSpecimenWhatIsNotGiven) {
  EXPECT_EQ(read({}), leaf::find_specimen("soybean")->params);
  EXPECT_EQ(read({words("specimen", {"maize"})}), leaf::find_specimen("maize")->params);
  leaf::TissueParams changed = leaf::find_specimen("maize")->params;
  changed.number("lignin") = 3;
  changed.number("otherabsorption") = 50;
  changed.sieve_and_detour = true;
  EXPECT_EQ(read({words("specimen", {"maize"}), number("float", "lignin", {3}),
                  number("float", "otherabsorption", {50}), flag("sieve", true)}),
            changed);
}

TEST(LeafMaterials, TakeALeafOfASpecimenFile) {
  const TestFolder folder("specimens");
  const std::string file = folder.write("leaves.csv", "leaf,specimen,lignin\nA,maize,3\nB,maize,4\n").string();
  leaf::TissueParams changed = leaf::find_specimen("maize")->params;
  changed.number("lignin") = 4;
  EXPECT_EQ(read({words("specimenfile", {file + ":B"})}), changed);
  changed.number("lignin") = 5;
  EXPECT_EQ(read({words("specimenfile", {file + ":B"}), number("float", "lignin", {5})}), changed);
  EXPECT_THAT(error_of([&] { read({words("specimenfile", {file + ":C"})}); }), HasSubstr("there is no leaf \"C\""));
  EXPECT_THAT(error_of([&] {
                read({words("specimenfile", {file + ":A"}), words("specimen", {"maize"})});
              }),
              HasSubstr("\"specimen\" has no effect beside \"specimenfile\""));
}

TEST(LeafParams, KnowsWhatTexturesVary) {
  Resolver resolver;
  const auto leaf = [&](std::vector<ParsedParam> params) {
    return LeafParams(Params(material_info("abm"), {"abm", {}, std::move(params)}, resolver));
  };
  EXPECT_TRUE(leaf({}).depth().is_constant());
  EXPECT_TRUE(leaf({texture("chlorophylla", {"2:2"})}).depth().is_constant());
  EXPECT_EQ(leaf({texture("chlorophylla", {"2:2"})}).tissue().number("chlorophylla"), 2);
  EXPECT_FALSE(leaf({texture("chlorophylla", {"1:2"})}).depth().is_constant());
  EXPECT_EQ(leaf({texture("spongyaspect", {"1:2"})}).cuticle_aspect(), nullptr);
  EXPECT_NE(leaf({texture("spongyaspect", {"1:2"})}).spongy_aspect(), nullptr);
}

/// Returns f for light from above, averaged if the model is stochastic.
SampledSpectrum mean_f(Ready& ready) {
  const Bsdf& bsdf = ready.bsdf({0.5f, 0.5f});
  SampledSpectrum sum;
  RandomStream random(1);
  for (int i = 0; i < 200; ++i) sum += bsdf.f({0.6f, 0, 0.8f}, {0, 0.6f, 0.8f}, random);
  return sum * (1.f / 200);
}

TEST(Leaf, IsTheModelThatItNames) {
  const auto maize = words("specimen", {"maize"});
  for (const std::string model : {"leaf_lambert", "leaf_simplified", "leaf_solved"}) {
    Ready leaf("leaf", {maize, words("model", {model})}), itself(model, {maize});
    EXPECT_EQ(mean_f(leaf)[0], mean_f(itself)[0]) << model;
  }
}

TEST(Leaf, IsTheSolvedWalkWhereNobodyChooses) {
  Ready solved("leaf_solved", {}), weighted("abm", {words("mode", {"weighted"})});
  for (const auto& params : {std::vector<ParsedParam>{}, {words("model", {"auto"})}}) {
    Ready leaf("leaf", params);
    EXPECT_EQ(mean_f(leaf)[0], mean_f(solved)[0]);
  }
  Ready walk("leaf", {words("model", {"abm"})});
  EXPECT_EQ(mean_f(walk)[0], mean_f(weighted)[0]);
  // No table holds for a leaf whose walls vary.
  Ready varied("leaf", {texture("spongyaspect", {"4:6"})}),
      walked("abm", {texture("spongyaspect", {"4:6"}), words("mode", {"weighted"})});
  EXPECT_EQ(mean_f(varied)[0], mean_f(walked)[0]);
}

TEST(Leaf, RefusesWhatItsModelRefuses) {
  EXPECT_THAT(error_of([] {
                Ready("leaf", {words("model", {"leaf_solved"}), texture("spongyaspect", {"1:2"})});
              }),
              HasSubstr("leaf_solved takes no texture for \"spongyaspect\""));
  EXPECT_THAT(error_of([] { Ready("leaf", {words("model", {"leaf_simple"})}); }), HasSubstr("leaf_simplified"));
  EXPECT_THAT(error_of([] { Ready("leaf", {number("float", "maxrms", {0})}); }), HasSubstr("outside its range 1e-06"));
}

class Pigments : public ::testing::Test {
 protected:
  Pigments() : file_(std::filesystem::temp_directory_path() / fmt::format("frond_pigment_{}.spd", getpid())) {
    std::ofstream(file_) << "400 0 500 0 550 40 600 0 700 0\n";
  }
  ~Pigments() override { std::filesystem::remove(file_); }

  const std::filesystem::path file_;
};

TEST_F(Pigments, AddTheirAbsorption) {
  const leaf::TissueParams plain = read({});
  const leaf::TissueParams red = read({words("pigments", {file_}), number("float", "pigmentconcentrations", {2})});
  EXPECT_NEAR(leaf::absorption_coefficient(red, 540) - leaf::absorption_coefficient(plain, 540), 2 * 32, 1e-3);
  EXPECT_EQ(leaf::absorption_coefficient(red, 450), leaf::absorption_coefficient(plain, 450));
}

TEST_F(Pigments, AreNeededInPairsAndWithinTheirData) {
  EXPECT_THAT(error_of([&] { Ready("abm", {words("pigments", {file_})}); }),
              HasSubstr("1 pigments have 0 concentrations"));
  EXPECT_THAT(error_of([&] {
                Ready("abm", {words("pigments", {file_}), number("float", "pigmentconcentrations", {2})}, "hero");
              }),
              HasSubstr("from 400 to 700 nm"));
  EXPECT_THAT(error_of([&] {
                Ready("abm", {words("pigments", {"no.spd"}), number("float", "pigmentconcentrations", {2})});
              }),
              HasSubstr("no.spd"));
}

/// Mean weight of `sample`: the albedo at each wavelength.
struct Albedo {
  std::array<Estimate, 3> reflected, transmitted;
};

Albedo albedo(Ready& leaf, const Vec3& wo, int samples) {
  Albedo result;
  RandomStream rng(3);
  const Bsdf& bsdf = leaf.bsdf();
  for (int i = 0; i < samples; ++i) {
    const auto s = bsdf.sample(wo, rng.uniform(), {rng.uniform(), rng.uniform()}, rng);
    for (int lane = 0; lane < 3; ++lane) {
      const float weight = s ? s->f[lane] * std::abs(s->wi.z) / s->pdf : 0;
      const bool reflects = s && same_side(wo, s->wi);
      result.reflected[static_cast<size_t>(lane)].add(reflects ? weight : 0);
      result.transmitted[static_cast<size_t>(lane)].add(reflects ? 0 : weight);
    }
  }
  return result;
}

/// Mean weights of `scatter`, and of the lobes that are the surface's.
std::array<Estimate, 2> scattered(Ready& leaf, const Vec3& incident) {
  std::array<Estimate, 2> all_and_surface;
  std::vector<Scattered> rays(40000);
  RandomStream rng(7);
  leaf.bsdf().scatter(incident, rng, rays);
  for (const Scattered& ray : rays) {
    all_and_surface[0].add(ray.weight[1]);
    all_and_surface[1].add(any(ray.lobe & Lobes::surface) ? ray.weight[1] : 0);
  }
  return all_and_surface;
}

/// Error of look-ups in tables, as measured with the tables.
constexpr double kLookupError = 1e-4;

TEST(LeafSimplified, AlbedoIsThatOfItsTable) {
  constexpr std::array kAngles_deg{0.0, 40.0, 80.0, 110.0, 180.0};
  const double limit = z_limit(2 * static_cast<int>(kAngles_deg.size()) * 3 * 2);
  const auto expect_close = [&](const Estimate& measured, double exact, double theta_deg) {
    EXPECT_NEAR(measured.mean(), exact, limit * measured.standard_error() + 2 * kLookupError) << theta_deg;
  };
  const leaf::TissueModel model(leaf::find_specimen("soybean")->params);
  for (const bool surface_direct : {true, false}) {
    Ready leaf("leaf_simplified", {kSolve, flag("surfacedirect", surface_direct)});
    for (const double theta_deg : kAngles_deg) {
      const double theta = theta_deg * std::numbers::pi / 180;
      const Vec3 wo{static_cast<float>(std::sin(theta)), 0, static_cast<float>(std::cos(theta))};
      const Albedo measured = albedo(leaf, wo, 40000);
      for (size_t lane = 0; lane < 3; ++lane) {
        const leaf::Tissue tissue = model.at(leaf.lambda().nm[lane]);
        const leaf::Shares exact = leaf::solve(tissue, std::array{theta_deg})[0];
        expect_close(measured.reflected[lane], exact.surface + exact.subsurface, theta_deg);
        expect_close(measured.transmitted[lane], exact.transmitted, theta_deg);
      }
    }
  }
}

TEST(LeafSimplified, LeavesTheSurfaceToFollowedRaysIfTold) {
  Ready all("leaf_simplified", {kSolve}), published("leaf_simplified", {kSolve, flag("surfacedirect", false)});
  RandomStream rng(1);
  const Vec3 wo = normalize(Vec3{1, 0, 1}), mirror = normalize(Vec3{-1, 0, 1}), below = -mirror;
  const leaf::TissueModel model(leaf::find_specimen("soybean")->params);
  const leaf::Tissue tissue = model.at(608);
  const leaf::Shares exact = leaf::solve(tissue, std::array{45.0})[0];
  EXPECT_GT(all.bsdf().f(wo, mirror, rng)[0], published.bsdf().f(wo, mirror, rng)[0]);
  EXPECT_NEAR(published.bsdf().f(wo, mirror, rng)[0], exact.subsurface / std::numbers::pi, 1e-5);
  EXPECT_NEAR(published.bsdf().f(wo, below, rng)[0], exact.transmitted / std::numbers::pi, 1e-5);
  EXPECT_EQ(all.bsdf().f(wo, below, rng), published.bsdf().f(wo, below, rng));
}

TEST(LeafSimplified, TakesItsTableFromAFile) {
  const TestFolder folder("leaf_table");
  const std::string columns = "theta_deg,wavelength_nm,Rs,Rd,T\n";
  const auto file = [&](const std::string& rows) {
    return words("tablefile", {folder.write("t.csv", columns + rows)});
  };
  const Vec3 wo = normalize(Vec3{0, 1, 2}), below{0, 0, -1};
  RandomStream rng(1);
  Ready grey("leaf_simplified", {file("8,551,.04,.1,.2\n")});
  Ready spectral("leaf_simplified", {file("8,300,.04,.1,.2\n8,900,.04,.1,.8\n")}, "hero");
  for (int lane = 0; lane < 3; ++lane) EXPECT_NEAR(grey.bsdf().f(wo, below, rng)[lane], 0.2 / std::numbers::pi, 1e-6);
  for (int lane = 0; lane < 4; ++lane) {
    const double nm = spectral.lambda().nm[static_cast<size_t>(lane)];
    EXPECT_NEAR(spectral.bsdf().f(wo, below, rng)[lane], (nm / 1000 - 0.1) / std::numbers::pi, 1e-6);
  }
  EXPECT_THAT(error_of([&] { Ready("leaf_simplified", {file("8,500,0,0,0\n8,600,0,0,0\n")}); }),
              HasSubstr("is known from 500 to 600 nm, the render needs 455 to 608 nm"));
  EXPECT_THAT(error_of([&] { Ready("leaf_simplified", {file("8,455,0,0,0\n8,608,0,0,0\n")}, "hero"); }),
              HasSubstr("is known from 455 to 608 nm, the render needs 360 to 830 nm; --wavelengths smpte renders 608, "
                        "551 and 455 nm"));
  EXPECT_THAT(error_of([&] { Ready("leaf_simplified", {file("8,551,1,1,1\n")}); }),
              HasSubstr("t.csv:2:1: Rs + Rd + T"));
}

/// R and T are those measured, whatever share of R the surface has.
TEST(LeafSimplified, TakesMeasurementsAsTheyAre) {
  const TestFolder folder("measured");
  const ParsedParam csv = words("tablefile", {folder.write("m.csv", "nm,R,T\n400,0.03,0.2\n700,0.03,0.2\n")});
  constexpr int kSamples = 1 << 14;
  for (const auto& [given, surface] : {std::pair{-1.0, 0.03}, std::pair{0.01, 0.01}, std::pair{0.0, 0.0}}) {
    std::vector<ParsedParam> params{csv};
    if (given >= 0) params.push_back(number("float", "tablesurface", {given}));
    Ready leaf("leaf_simplified", params);
    const Vec3 wo = normalize(Vec3{0, std::tan(8 * float(std::numbers::pi) / 180), 1});
    RandomStream rng(1);
    // The two diffuse lobes are Lambertian: away from the mirror direction their f is all there is.
    const Vec3 aside = normalize(Vec3{1, 0, 0.02f}), below{0, 0, -1};
    EXPECT_NEAR(double(leaf.bsdf().f(wo, below, rng)[0]), 0.2 / std::numbers::pi, 1e-6);
    EXPECT_NEAR(double(leaf.bsdf().f(wo, aside, rng)[0]), (0.03 - surface) / std::numbers::pi, 2e-4) << given;
    // Mean weight of samples: R + T = 0.23, exactly for each sample of a lobe that is drawn in proportion.
    double sum = 0, squares = 0;
    for (int i = 0; i < kSamples; ++i) {
      const float uc = rng.uniform();
      const float u = rng.uniform(), v = rng.uniform();
      const auto s = leaf.bsdf().sample(wo, uc, {u, v}, rng);
      const double weight = s ? double(s->f[0] * std::abs(s->wi.z) / s->pdf) : 0;
      sum += weight, squares += weight * weight;
    }
    const double mean = sum / kSamples, error = std::sqrt((squares / kSamples - mean * mean) / kSamples);
    EXPECT_NEAR(mean, 0.23, 5 * error + 1e-6) << given;  // 5 sigma: false alarms 6e-7
  }
}

TEST(LeafSimplified, SharesAFileWithThoseOfItsWavelengthsAlone) {
  const TestFolder folder("leaf_table");
  const std::string rows = "8,300,.04,.1,.2\n8,900,.04,.1,.8\n";
  expect_sharing_changes_nothing(
      "leaf_simplified", {words("tablefile", {folder.write("t.csv", "theta_deg,wavelength_nm,Rs,Rd,T\n" + rows)})});
}

/// A file replaces the whole tissue: the warning names all parameters of the tissue, and none of the surface and the
/// direction.
TEST(LeafSimplified, SaysWhatAFileMakesMeaningless) {
  const TestFolder folder("leaf_table");
  const std::string path = folder.write("t.csv", "theta_deg,wavelength_nm,Rs,Rd,T\n8,551,.04,.1,.2\n");
  const MaterialInfo& info = material_info("leaf_simplified");
  const auto strategy =
      test::make_plugin(PluginTable<WavelengthsInfo>("wavelengths", builtin_wavelengths()).get("smpte", {}), {});
  ThreadPool pool(1);
  const ConsoleLog log;
  std::set<std::string_view> named;
  for (const Param& p : leaf_params()) {
    // Files, and what needs them.
    if (p.name.starts_with("pigment") || p.name == "emission" || p.name == "specimenfile" ||
        p.name.starts_with("fluorescence"))
      continue;
    const std::string name(p.name);
    ParsedParam given = number("float", name, {p.range.max});
    if (p.kind == ParamKind::boolean) given = flag(name, true);
    if (p.kind == ParamKind::integer) given = number("integer", name, {p.range.max});
    if (p.kind == ParamKind::string) given = words(name, {std::string(p.choices.back())});
    Resolver resolver;
    const auto material = info.make(Params(info, {"", {}, {words("tablefile", {path}), given}}, resolver));
    ::testing::internal::CaptureStderr();
    material->prepare({*strategy, pool, log, {}});
    if (::testing::internal::GetCapturedStderr().find(
            fmt::format("warning: \"{}\" has no effect with \"tablefile\"", name)) != std::string::npos)
      named.insert(p.name);
  }
  std::set<std::string_view> expected{"absorption", "sieve", "fluorescingpigments"};
  for (const leaf::LeafNumber& n : leaf::leaf_parameters()) expected.insert(n.name);
  for (const leaf::PlateNumber& n : leaf::plate_numbers()) expected.insert(n.name);
  expected.erase("cuticleaspect"), expected.erase("fluorescence");
  EXPECT_EQ(named, expected);
  for (const char* name : {"anthocyanins", "brownpigments", "drymatter", "spongyshare", "cuticlerefractivity"})
    EXPECT_TRUE(expected.contains(name));
}

/// The tables of a scene, by their lines in the log.
size_t tables_made(const std::vector<std::vector<ParsedParam>>& leaves) {
  const MaterialInfo& info = material_info("leaf_simplified");
  const auto strategy =
      test::make_plugin(PluginTable<WavelengthsInfo>("wavelengths", builtin_wavelengths()).get("smpte", {}), {});
  ThreadPool pool(1);
  const ConsoleLog log;
  SharedWork shared;
  Resolver resolver;
  std::vector<std::unique_ptr<Material>> materials;
  ::testing::internal::CaptureStderr();
  for (const auto& params : leaves) {
    materials.push_back(info.make(Params(info, {"", {}, params}, resolver)));
    for (int twice = 0; twice < 2; ++twice) materials.back()->prepare({*strategy, pool, log, {}, &shared});
  }
  const std::string messages = ::testing::internal::GetCapturedStderr();
  return static_cast<size_t>(std::ranges::count(messages, '\n'));
}

TEST(LeafSimplified, SharesTheTableOfLeavesThatAreTheSame) {
  const ParsedParam maize = words("specimen", {"maize"}), wax = number("float", "oblateness", {2});
  EXPECT_EQ(tables_made({{kSolve}, {kSolve, wax}, {kSolve}}), 1u);
  EXPECT_EQ(tables_made({{kSolve}, {kSolve, maize}, {kSolve, maize, wax}}), 2u);
  EXPECT_EQ(tables_made({{kSolve}, {kSolve, number("float", "cuticleaspect", {3})}}), 1u);
}

TEST(LeafSimplified, IsWhereATextureSaysTheLeafOfThatValue) {
  for (const char* wavelengths : {"smpte", "hero"}) {
    Ready varied(
        "leaf_simplified",
        {texture("chlorophylla", {"1:2"}), texture("thickness", {"0.0001:0.0003"}), texture("cuticleaspect", {"1:7"})},
        wavelengths);
    Ready constant("leaf_simplified",
                   {number("float", "chlorophylla", {1.5}), number("float", "thickness", {0.0002}),
                    number("float", "cuticleaspect", {4})},
                   wavelengths);
    RandomStream rng(3);
    for (const Vec3 wo : {Vec3{0, 0, 1}, normalize(Vec3{1, 0, 0.05f}), normalize(Vec3{1, 1, -1})})
      for (const Vec3 wi : {normalize(Vec3{-1, 0.1f, 0.3f}), normalize(Vec3{0.1f, 0, -1})}) {
        const SampledSpectrum f = varied.bsdf({0.5f, 0}).f(wo, wi, rng), g = constant.bsdf().f(wo, wi, rng);
        for (int lane = 0; lane < varied.lambda().count; ++lane)
          EXPECT_NEAR(f[lane], g[lane], 6e-4 + 1e-3 * double(g[lane])) << wavelengths;
        const float p = varied.bsdf({0.5f, 0}).pdf(wo, wi), q = constant.bsdf().pdf(wo, wi);
        EXPECT_NEAR(p, q, 2e-3 + 2e-3 * double(q)) << wavelengths;
      }
    EXPECT_NE(varied.bsdf({0, 0}).f({0, 0, 1}, {0, 0, -1}, rng), varied.bsdf({1, 0}).f({0, 0, 1}, {0, 0, -1}, rng));
  }
}

TEST(LeafSimplified, TablesHaveTheStepThatIsAsked) {
  const auto with_step = [](double degrees) {
    return Ready("leaf_simplified", {kSolve, number("float", "tablestep", {degrees})});
  };
  Ready plain("leaf_simplified", {kSolve}), one = with_step(1), coarse = with_step(30), uneven = with_step(40);
  RandomStream rng(1);
  for (int degrees = 0; degrees <= 180; degrees += 5) {
    const float theta = static_cast<float>(degrees * std::numbers::pi / 180);
    const Vec3 wo{std::sin(theta), 0, std::cos(theta)}, wi = normalize(Vec3{0, 1, 1});
    const SampledSpectrum f = plain.bsdf().f(wo, wi, rng), rough = coarse.bsdf().f(wo, wi, rng);
    EXPECT_EQ(one.bsdf().f(wo, wi, rng), f);
    EXPECT_EQ(uneven.bsdf().f(wo, wi, rng), rough);
    if (degrees == 90) continue;
    for (int lane = 0; lane < 3; ++lane)
      if (degrees % 30 == 0)
        EXPECT_NEAR(rough[lane], f[lane], 2e-4f * f[lane]) << degrees;
      else
        EXPECT_NE(rough[lane], f[lane]) << degrees;
  }
}

TEST(LeafSimplified, TakesTexturesOfDepthAndSurfaceAlone) {
  for (const char* name : {"epidermisaspect", "spongyaspect", "palisadeaspect"})
    EXPECT_THAT(error_of([&] { Ready("leaf_simplified", {texture(name, {"1:2"})}); }),
                HasSubstr(fmt::format("takes no texture for \"{}\": each texel would need its own table", name)));
  EXPECT_THAT(error_of([] {
                Ready("leaf_simplified", {texture("lignin", {"1:2"}), words("tablemethod", {"montecarlo"})});
              }),
              HasSubstr("are solved: leave \"tablemethod\" out"));
}

TEST(LeafSimplified, FromLightIsTheLeafTheOtherWayRound) {
  for (const bool surface_direct : {true, false}) {
    const ParsedParam direct = flag("surfacedirect", surface_direct);
    Ready traced("leaf_simplified", {direct}), light("leaf_simplified", {direct, words("incident", {"light"})});
    const Vec3 a = normalize(Vec3{0.1f, 0, 1}), b = normalize(Vec3{-2, 0.5f, 1}), c = normalize(Vec3{1, 0, -0.2f});
    RandomStream rng(1);
    for (const auto& [from, to] : {std::pair(a, b), {b, a}, {a, c}, {c, b}})
      EXPECT_EQ(light.bsdf().f(from, to, rng), traced.bsdf().f(to, from, rng));
    EXPECT_TRUE(any(light.bsdf().flags() & Lobes::from_light));
    EXPECT_FALSE(any(traced.bsdf().flags() & Lobes::from_light));
  }
}

/// For each incident direction, an instrument that illuminates the leaf at one angle measures the table's shares.
TEST(LeafSimplified, IsTheSameLeafToInstrumentsWhateverIsIncident) {
  const Vec3 incident = normalize(Vec3{1, 0, -0.4f});
  for (const bool surface_direct : {true, false}) {
    const ParsedParam direct = flag("surfacedirect", surface_direct);
    Ready traced("leaf_simplified", {direct}), light("leaf_simplified", {direct, words("incident", {"light"})});
    const auto a = scattered(traced, incident), b = scattered(light, incident);
    for (size_t i = 0; i < 2; ++i)
      EXPECT_LT(std::abs(a[i].mean() - b[i].mean()),
                z_limit(4) * std::hypot(a[i].standard_error(), b[i].standard_error()) + 1e-6)
          << i << surface_direct;
  }
}

TEST(LeafSimplified, ReflectsAllAtGrazing) {
  Ready leaf("leaf_simplified", {kSolve});
  const Albedo measured = albedo(leaf, {1, 0, 1e-7f}, 1000);
  for (const Estimate& reflected : measured.reflected) EXPECT_NEAR(reflected.mean(), 1, 2 * kLookupError);
}

TEST(LeafSimplified, ScattersNothingAlongTheLeaf) {
  Ready leaf("leaf_simplified", {kSolve});
  RandomStream rng(1);
  EXPECT_TRUE(leaf.bsdf().f({1, 0, 0}, {0, 0, 1}, rng).is_black());
  EXPECT_TRUE(leaf.bsdf().f({0, 0, 1}, {1, 0, 0}, rng).is_black());
  EXPECT_FALSE(leaf.bsdf().sample({1, 0, 0}, 0.5f, {0.5f, 0.5f}, rng));
}

/// Between angles, grazing ones above all, and between wavelengths, on both sides; as stated at kStep_nm.
TEST(LeafSimplified, InterpolatesAsWellAsStated) {
  for (const char* specimen : {"soybean", "maize"}) {
    Ready spectral("leaf_simplified", {words("specimen", {specimen}), flag("surfacedirect", false)}, "hero");
    const leaf::TissueModel model(leaf::find_specimen(specimen)->params);
    RandomStream rng(5);
    double sum = 0, count = 0;
    const auto compare = [&](double measured, double exact, double theta_deg, double nm) {
      EXPECT_NEAR(measured, exact, 8e-4) << specimen << " " << theta_deg << " " << nm;
      sum += std::abs(measured - exact), ++count;
    };
    for (int i = 0; i < 60; ++i) {
      spectral.sample_wavelengths(rng.uniform());
      const double from_normal = i % 2 ? 85 + 5 * rng.uniform_double() : 90 * rng.uniform_double();
      const double theta_deg = i % 4 < 2 ? from_normal : 180 - from_normal, theta = theta_deg * std::numbers::pi / 180;
      const Vec3 wo{static_cast<float>(std::sin(theta)), 0, static_cast<float>(std::cos(theta))};
      const float side = wo.z > 0 ? 1.f : -1.f;
      const SampledSpectrum back = spectral.bsdf().f(wo, {0, 0, side}, rng) * std::numbers::pi_v<float>;
      const SampledSpectrum through = spectral.bsdf().f(wo, {0, 0, -side}, rng) * std::numbers::pi_v<float>;
      for (int lane = 0; lane < spectral.lambda().count; ++lane) {
        const double nm = spectral.lambda().nm[static_cast<size_t>(lane)];
        const leaf::Shares exact = leaf::solve(model.at(nm), std::array{theta_deg})[0];
        compare(back[lane], exact.subsurface, theta_deg, nm);
        compare(through[lane], exact.transmitted, theta_deg, nm);
      }
    }
    EXPECT_LT(sum / count, 5e-5) << specimen;
  }
}

TEST(Abm, CarriesAllWavelengthsOnOneWalk) {
  for (const char* mode : {"analog", "weighted"}) {
    Ready leaf("abm", {words("mode", {mode})});
    const leaf::TissueModel model(leaf::find_specimen("soybean")->params);
    const double limit = z_limit(2 * 3 * 2);
    const Albedo measured = albedo(leaf, normalize(Vec3{0.7f, 0.1f, 0.6f}), 50000);
    const double theta_deg = std::acos(double(normalize(Vec3{0.7f, 0.1f, 0.6f}).z)) * 180 / std::numbers::pi;
    for (size_t lane = 0; lane < 3; ++lane) {
      const leaf::Tissue tissue = model.at(leaf.lambda().nm[lane]);
      const leaf::Shares exact = leaf::solve(tissue, std::array{theta_deg})[0];
      const Estimate &r = measured.reflected[lane], &t = measured.transmitted[lane];
      EXPECT_NEAR(r.mean(), exact.surface + exact.subsurface, limit * r.standard_error() + 1e-5) << mode << lane;
      EXPECT_NEAR(t.mean(), exact.transmitted, limit * t.standard_error() + 1e-5) << mode << lane;
    }
  }
}

TEST(Abm, SamplesEveryActiveLane) {
  Ready leaf("abm", {});
  RandomStream rng(1);
  const auto s = leaf.bsdf().sample({0, 0, 1}, 0.01f, {0.5f, 0.25f}, rng);  // off the surface
  ASSERT_TRUE(s);
  EXPECT_TRUE(s->pdf_is_approximate);
  for (int lane = 0; lane < 3; ++lane) EXPECT_GT(s->f[lane], 0) << lane;
}

TEST(Abm, IsWhereATextureSaysTheLeafOfThatValue) {
  Ready varied("abm", {texture("chlorophylla", {"1:2"}), texture("thickness", {"0.001:0.003"}),
                       texture("spongyaspect", {"2:3"}), texture("cuticleaspect", {"1:7"})});
  Ready constant("abm", {number("float", "chlorophylla", {1.5}), number("float", "thickness", {0.002}),
                         number("float", "spongyaspect", {2.5}), number("float", "cuticleaspect", {4})});
  const Vec3 wo = normalize(Vec3{0.3f, 0.2f, 0.5f}), wi = normalize(Vec3{0.3f, -0.2f, 0.8f});
  for (uint64_t key = 0; key < 300; ++key) {
    RandomStream a(key), b(key);
    const float uc = a.uniform();
    b.uniform();
    const auto s = varied.bsdf({0.5f, 0}).sample(wo, uc, {0.2f, 0.7f}, a);
    const auto t = constant.bsdf().sample(wo, uc, {0.2f, 0.7f}, b);
    const float f = varied.bsdf({0.5f, 0}).f(wo, wi, a)[1], g = constant.bsdf().f(wo, wi, b)[1];
    EXPECT_NEAR(f, g, 1e-3f * g) << key;
    ASSERT_EQ(s.has_value(), t.has_value()) << key;
    if (!s) continue;
    EXPECT_LT(length(s->wi - t->wi), 1e-4f) << key;
    EXPECT_NEAR(s->f[1], t->f[1], 1e-3f * t->f[1]) << key;
  }
}

TEST(Abm, IsTheSameLeafToInstrumentsWhateverIsIncident) {
  Ready traced("abm", {}), light("abm", {words("incident", {"light"})});
  const Vec3 incident = normalize(Vec3{1, 0, 1});
  const auto a = scattered(traced, incident), b = scattered(light, incident);
  for (size_t i = 0; i < 2; ++i) EXPECT_LT(std::abs(z_score(a[i], b[i])), z_limit(2)) << i;
  EXPECT_FALSE(any(traced.bsdf().flags() & Lobes::from_light));
  EXPECT_TRUE(any(light.bsdf().flags() & Lobes::from_light));
}

TEST(Abm, FromLightIsTheLeafTheOtherWayRound) {
  Ready traced("abm", {}), light("abm", {words("incident", {"light"})});
  const Vec3 a = normalize(Vec3{0.1f, 0, 1}), b = normalize(Vec3{2, 0.5f, 1});
  for (uint64_t key = 0; key < 20; ++key) {
    RandomStream x(key), y(key);
    EXPECT_EQ(light.bsdf().f(a, b, x), traced.bsdf().f(b, a, y));
  }
}

}  // namespace
}  // namespace frond::test
