#include "leaf/table/table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <numbers>

#include "core/log.h"
#include "leaf/table/cache_file.h"
#include "leaf/table/lookup.h"
#include "leaf/table/table_cache.h"
#include "leaf/tissue/specimens.h"
#include "tests/leaf/statistics.h"

namespace frond::leaf {
namespace {

namespace fs = std::filesystem;

constexpr size_t kDegrees = 181;

TableRequest request_of(std::string_view specimen, TableMethod method, int rays = 500) {
  return {.params = find_specimen(specimen)->params, .wavelengths_nm = {608, 551, 455}, .method = method, .rays = rays};
}

TEST(Solver, GivesTheCheckFigures) {
  struct {
    double lambda_nm, r, t, r_abaxial, t_abaxial;
  } constexpr kFigures[] = {{455, 0.04514, 0.01753, 0.21745, 0.01485},
                            {550, 0.07592, 0.14742, 0.23045, 0.14498},
                            {605, 0.05446, 0.10064, 0.21641, 0.09502},
                            {800, 0.44167, 0.45604, 0.40437, 0.51735}};
  const TissueModel soybean(find_specimen("soybean")->params);
  for (const auto& f : kFigures) {
    const std::vector<Shares> s = solve(soybean.at(f.lambda_nm), std::array{8.0, 172.0});
    // Solved by another program from constants with fewer nodes.
    EXPECT_NEAR(s[0].surface + s[0].subsurface, f.r, 3e-4) << f.lambda_nm;
    EXPECT_NEAR(s[0].transmitted, f.t, 3e-4) << f.lambda_nm;
    EXPECT_NEAR(s[1].surface + s[1].subsurface, f.r_abaxial, 3e-4) << f.lambda_nm;
    EXPECT_NEAR(s[1].transmitted, f.t_abaxial, 3e-4) << f.lambda_nm;
  }
}

/// Figures of the program of the model's authors: soybean from above at 8 degrees, a million rays, absorption by Beer's
/// law. Standard errors are 0.0005 at most.
TEST(Solver, MeetsTheAuthorsFigures) {
  struct {
    double lambda_nm, r, t;
  } constexpr kFigures[] = {{550, 0.07596, 0.14765}, {750, 0.4211, 0.4422}, {800, 0.44096, 0.45714}};
  const TissueModel soybean(find_specimen("soybean")->params);
  for (const auto& f : kFigures) {
    const Shares s = solve(soybean.at(f.lambda_nm), std::array{8.0})[0];
    EXPECT_NEAR(s.surface + s.subsurface, f.r, 4 * 0.0005) << f.lambda_nm;
    EXPECT_NEAR(s.transmitted, f.t, 4 * 0.0005) << f.lambda_nm;
  }
}

/// Leaves that differ in it alone may share a table.
TEST(Solver, SharesDoNotHangOnTheCuticlesShape) {
  const ThreadPool pool(2);
  for (const std::string_view specimen : {"soybean", "maize"}) {
    TableRequest request = request_of(specimen, TableMethod::solve);
    request.theta_deg = {0, 40, 80, 100, 180};
    const Table own = make_table(request, pool);
    request.params.cuticle_aspect = 0;
    EXPECT_EQ(make_table(request, pool).shares, own.shares) << specimen;
    EXPECT_EQ(make_table(request, pool).error, own.error) << specimen;
  }
}

/// Both sides, grazing angles above all.
std::vector<double> test_angles() {
  std::vector<double> angles = even_steps(0, 180, 4);
  for (const double grazing : {85.0, 86.0, 87.0, 89.0, 89.9, 90.1, 91.0, 93.0, 95.0}) angles.push_back(grazing);
  return angles;
}

void expect_converged(const Tissue& tissue, double tolerance, const std::string& what) {
  const auto angles = test_angles();
  const int nodes = solver_nodes(tissue);
  const auto coarse = solve(tissue, angles), fine = solve(tissue, angles, 2 * nodes);
  for (size_t i = 0; i < angles.size(); ++i) {
    EXPECT_EQ(coarse[i].surface, fine[i].surface);
    EXPECT_NEAR(coarse[i].subsurface, fine[i].subsurface, tolerance) << what << " at " << angles[i];
    EXPECT_NEAR(coarse[i].transmitted, fine[i].transmitted, tolerance) << what << " at " << angles[i];
  }
}

TEST(Solver, IsNearItsAnswerAtTwiceTheNodes) {
  for (const char* specimen : {"soybean", "maize"})
    for (const bool sieve : {false, true}) {
      TissueParams params = find_specimen(specimen)->params;
      params.sieve_and_detour = sieve;
      const TissueModel model(params);
      for (const double nm : {455.0, 551.0, 608.0, 680.0, 800.0}) expect_converged(model.at(nm), 1e-5, specimen);
    }
}

TEST(Solver, ConvergesAsStatedForOtherLobes) {
  struct {
    double aspect, tolerance;
  } constexpr kStated[] = {{0, 4e-4}, {0.5, 4e-5}, {2.5, 1e-5}, {20, 1e-5}, {100, 1e-5}};
  for (const auto& [aspect, tolerance] : kStated)
    for (const char* specimen : {"soybean", "maize"}) {
      TissueParams params = find_specimen(specimen)->params;
      params.epidermis_aspect = params.spongy_aspect = params.palisade_aspect = aspect;
      const TissueModel model(params);
      expect_converged(model.at(455), tolerance, fmt::format("{} with lobes of {}", specimen, aspect));
    }
}

TEST(Solver, UnifacialLeafHasEqualSides) {
  const TissueModel maize(find_specimen("maize")->params);
  const auto s = solve(maize.at(551), std::array{0.0, 30.0, 89.0, 91.0, 150.0, 180.0});
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(s[i].subsurface, s[5 - i].subsurface, 1e-14);
    EXPECT_NEAR(s[i].transmitted, s[5 - i].transmitted, 1e-14);
  }
}

TEST(Solver, LeafThatAbsorbsNothingLosesNothing) {
  for (const char* specimen : {"soybean", "maize"}) {
    TissueParams params = find_specimen(specimen)->params;
    params.mesophyll_fraction = 0;
    const TissueModel model(params);
    for (const Shares& s : solve(model.at(800), std::array{0.0, 45.0, 90.0, 91.0, 180.0}))
      EXPECT_NEAR(s.surface + s.subsurface + s.transmitted, 1, 1e-12);
  }
}

TEST(Table, WalksAndSolutionAgreeAtEveryDegree) {
  constexpr int kRays = 3000;
  const double limit = test::z_limit(2 * 3 * 181 * 3);
  for (const char* specimen : {"soybean", "maize"}) {
    const ThreadPool pool(2);
    const Table walked = make_table(request_of(specimen, TableMethod::monte_carlo, kRays), pool);
    const Table solved = make_table(request_of(specimen, TableMethod::solve), pool);
    const auto expect_close = [&](double measured, double exact, size_t i) {
      // Few counts are far from normal: half a count and the score test's variance, that of the exact value.
      const double slack = limit * std::sqrt(exact * (1 - exact) / kRays) + (limit * limit / 6 + 0.5) / kRays;
      EXPECT_NEAR(measured, exact, slack) << specimen << " degree " << i % kDegrees;
    };
    for (size_t i = 0; i < walked.shares.size(); ++i) {
      expect_close(walked.shares[i].surface, solved.shares[i].surface, i);
      expect_close(walked.shares[i].subsurface, solved.shares[i].subsurface, i);
      expect_close(walked.shares[i].transmitted, solved.shares[i].transmitted, i);
    }
  }
}

TEST(Table, IsTheSameToTheBitForAnyNumberOfThreads) {
  for (const TableMethod method : {TableMethod::monte_carlo, TableMethod::solve}) {
    const TableRequest request = request_of("soybean", method);
    EXPECT_EQ(make_table(request, ThreadPool(1)).shares, make_table(request, ThreadPool(3)).shares);
  }
}

TEST(Table, WavelengthDoesNotDependOnItsCompany) {
  TableRequest request = request_of("soybean", TableMethod::monte_carlo);
  const Table all = make_table(request, ThreadPool(2));
  request.wavelengths_nm = {551};
  const Table one = make_table(request, ThreadPool(2));
  EXPECT_TRUE(std::equal(one.shares.begin(), one.shares.end(), all.shares.begin() + kDegrees));
}

TEST(Table, GrazingLightIsAllReflected) {
  for (const TableMethod method : {TableMethod::monte_carlo, TableMethod::solve}) {
    const Table table = make_table(request_of("soybean", method, 10), ThreadPool(1));
    EXPECT_EQ(table.at(0, 90).surface, 1);
    EXPECT_EQ(table.at(0, 90).subsurface, 0);
    EXPECT_EQ(table.at(0, 90).transmitted, 0);
  }
}

class TableCache : public testing::Test {
 protected:
  void SetUp() override {
    dir_ =
        fs::temp_directory_path() / ("frond-table-" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(dir_);
  }
  void TearDown() override { fs::remove_all(dir_); }

  Table get(const TableRequest& request) const {
    return cached_table(request, "test", ThreadPool(1), silent_log(), dir_);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> result;
    for (const auto& entry : fs::directory_iterator(dir_)) result.push_back(entry.path());
    return result;
  }

  fs::path dir_;
};

TEST_F(TableCache, GivesBackTheSameBits) {
  const TableRequest request = request_of("maize", TableMethod::solve);
  const Table made = get(request), read = get(request);
  EXPECT_EQ(made.shares, read.shares);
  EXPECT_EQ(made.wavelengths_nm, read.wavelengths_nm);
  EXPECT_EQ(made.error, read.error);
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(TableCache, IsReadWhereItStands) {
  const TableRequest request = request_of("soybean", TableMethod::monte_carlo, 10);
  Table planted = make_table(request, ThreadPool(1));
  planted.shares[7].transmitted = 0.125;
  get(request);
  std::ofstream(files().at(0)) << seal(planted, describe(request));
  EXPECT_EQ(get(request).shares[7].transmitted, 0.125);
}

TEST_F(TableCache, KeepsTablesOfDifferentRequestsApart) {
  const TableRequest request = request_of("soybean", TableMethod::monte_carlo, 10);
  std::vector<TableRequest> others(6, request);
  others[0].params.number("lignin") += 1e-9;
  others[1].params.sieve_and_detour = true;
  others[2].wavelengths_nm[1] += 1;
  others[3].rays = 11;
  others[4].seed = 1;
  others[5].method = TableMethod::solve;
  get(request);
  for (const TableRequest& other : others) get(other);
  EXPECT_EQ(files().size(), 7u);
}

TEST_F(TableCache, MakesADamagedFileAnew) {
  const TableRequest request = request_of("soybean", TableMethod::monte_carlo, 50);
  const Table sound = get(request);
  const fs::path file = files().at(0);
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::string flipped = text;
  flipped[text.size() / 2] ^= 1;
  for (const std::string& damaged : {std::string(), text.substr(0, text.size() / 2), flipped, text + "0,455,0,0,0\n"}) {
    std::ofstream(file) << damaged;
    EXPECT_EQ(get(request).shares, sound.shares);
    Table again;
    std::ifstream repaired(file);
    EXPECT_TRUE(unseal(std::string{std::istreambuf_iterator<char>(repaired), {}}, describe(request), again));
  }
}

TEST_F(TableCache, CountsAWellSealedFileThatIsNoTableAsDamaged) {
  const TableRequest request = request_of("soybean", TableMethod::monte_carlo, 10);
  const Table sound = get(request);
  std::ofstream(files().at(0)) << with_checksum(describe(request) + "theta_deg,wavelength_nm,Rs,Rd,T\n0,551,2,0,0\n");
  EXPECT_EQ(get(request).shares, sound.shares);
  EXPECT_EQ(get(request).shares, sound.shares);
}

TEST_F(TableCache, KnowsWhatWasUsedAndMakesRoom) {
  const TableRequest request = request_of("soybean", TableMethod::monte_carlo, 10);
  get(request);
  const fs::path kept = files().at(0), left_over = dir_ / ".frond-1-0.tmp";
  std::ofstream(left_over) << "half";
  const auto long_ago = fs::last_write_time(kept) - std::chrono::hours(99);
  for (const fs::path& file : {kept, left_over}) fs::last_write_time(file, long_ago);
  get(request);
  EXPECT_GT(fs::last_write_time(kept), long_ago);
  EXPECT_TRUE(fs::exists(left_over));
  get(request_of("soybean", TableMethod::monte_carlo, 11));
  EXPECT_FALSE(fs::exists(left_over));
  EXPECT_EQ(files().size(), 2u);
}

TEST_F(TableCache, DoesWithoutAFileThatCannotBeRead) {
  const TableRequest request = request_of("soybean", TableMethod::monte_carlo, 10);
  const Table sound = get(request);
  const fs::path file = files().at(0);
  fs::remove(file);
  for (const char* target : {"/proc/self/mem", "gone", "/dev/zero"}) {
    fs::create_symlink(target, file);
    EXPECT_EQ(get(request).shares, sound.shares) << target;
    fs::remove(file);
  }
}

TEST_F(TableCache, DoesWithoutADiskThatCannotBeWritten) {
  const TableRequest request = request_of("soybean", TableMethod::monte_carlo, 10);
  const Table table = cached_table(request, "test", ThreadPool(1), silent_log(), "/proc/none");
  EXPECT_EQ(table.shares, make_table(request, ThreadPool(1)).shares);
}

double cos_degrees(double theta) { return std::cos(theta * std::numbers::pi / 180); }

void expect_near(const SampledShares& looked_up, int lane, const Shares& exact, double tolerance, double theta) {
  EXPECT_NEAR(looked_up.surface[lane], exact.surface, tolerance) << theta;
  EXPECT_NEAR(looked_up.subsurface[lane], exact.subsurface, tolerance) << theta;
  EXPECT_NEAR(looked_up.transmitted[lane], exact.transmitted, tolerance) << theta;
}

TEST(TableLookup, IsRightBetweenDegreesAndAtGrazing) {
  for (const char* specimen : {"soybean", "maize"}) {
    const TableRequest request = request_of(specimen, TableMethod::solve);
    const TableLookup lookup = TableLookup::for_lanes(make_table(request, ThreadPool(2)));
    const TissueModel model(request.params);
    std::vector<double> angles = even_steps(0.25, 179.9, 1.5);
    for (const double grazing : even_steps(85.05, 94.95, 0.11)) angles.push_back(grazing);
    for (int lane = 0; lane < 3; ++lane) {
      const std::vector<Shares> exact = solve(model.at(request.wavelengths_nm[static_cast<size_t>(lane)]), angles);
      for (size_t i = 0; i < angles.size(); ++i) {
        const SampledShares s = lookup(static_cast<float>(cos_degrees(angles[i])), {});
        expect_near(s, lane, exact[i], 1e-4, angles[i]);
      }
    }
  }
}

/// Error of shares that are looked up.
struct LookupError {
  double largest = 0, squares = 0;
  int count = 0;

  void add(float found, double exact) {
    const double error = std::abs(static_cast<double>(found) - exact);
    largest = std::max(largest, error), squares += error * error, ++count;
  }
  double rms() const { return std::sqrt(squares / count); }
};

/// Rs, Rd, T over angles that are even in degrees, both sides, three wavelengths.
std::array<LookupError, 3> lookup_errors(const std::string& specimen, double step_deg) {
  TableRequest request = request_of(specimen, TableMethod::solve);
  request.theta_deg = even_steps(0, 180, step_deg);
  const TableLookup lookup = TableLookup::for_lanes(make_table(request, ThreadPool(2)));
  const TissueModel model(request.params);
  const std::vector<double> angles = even_steps(0.125, 179.9, 0.25);
  std::array<LookupError, 3> errors;
  for (int lane = 0; lane < 3; ++lane) {
    const auto exact = solve(model.at(request.wavelengths_nm[static_cast<size_t>(lane)]), angles);
    for (size_t i = 0; i < angles.size(); ++i) {
      const SampledShares s = lookup(static_cast<float>(cos_degrees(angles[i])), {});
      errors[0].add(s.surface[lane], exact[i].surface);
      errors[1].add(s.subsurface[lane], exact[i].subsurface);
      errors[2].add(s.transmitted[lane], exact[i].transmitted);
    }
  }
  return errors;
}

/// Figures of docs/file_formats.md, rounded up to two digits.
TEST(TableLookup, IsAsFarOffForEachStepAsStated) {
  struct {
    std::string specimen;
    double step_deg;
    std::array<double, 3> largest, rms;
  } const kStated[] = {{"soybean", 1, {4.8e-5, 3.2e-5, 6.3e-6}, {1.4e-5, 1.2e-5, 1.5e-6}},
                       {"soybean", 5, {6.9e-3, 2.7e-3, 9.2e-4}, {1.2e-3, 3.3e-4, 1.1e-4}},
                       {"soybean", 15, {7.4e-2, 2.6e-2, 9.8e-3}, {2.1e-2, 4.9e-3, 2.0e-3}},
                       {"maize", 1, {4.8e-5, 4.3e-6, 4.8e-6}, {1.4e-5, 1.3e-6, 1.5e-6}},
                       {"maize", 5, {6.9e-3, 6.3e-4, 5.3e-4}, {1.2e-3, 7.9e-5, 6.0e-5}},
                       {"maize", 15, {7.4e-2, 6.4e-3, 5.5e-3}, {2.2e-2, 1.3e-3, 1.1e-3}}};
  for (const auto& [specimen, step_deg, largest, rms] : kStated) {
    const auto errors = lookup_errors(specimen, step_deg);
    for (size_t i = 0; i < errors.size(); ++i) {
      const std::string what = fmt::format("{}, {} degrees, share {}", specimen, step_deg, i);
      EXPECT_LE(errors[i].largest, largest[i]) << what;
      EXPECT_LE(errors[i].rms(), rms[i]) << what;
      EXPECT_GE(errors[i].rms(), rms[i] * 0.9) << what << ": the page says too much";
    }
  }
}

TEST(TableLookup, InterpolatesWavelengths) {
  TableRequest request = request_of("maize", TableMethod::solve);
  request.wavelengths_nm = {500, 510, 520};
  const Table table = make_table(request, ThreadPool(2));
  const TableLookup lookup = TableLookup::for_spectra(table);
  SampledWavelengths lambda;
  lambda.count = 4;
  lambda.nm = {500, 515, 520, 512};
  for (const size_t degree : {0u, 40u, 140u}) {
    const SampledShares s = lookup(static_cast<float>(cos_degrees(static_cast<double>(degree))), lookup.select(lambda));
    const auto blend = [&](double part) {
      const Shares &a = table.at(1, degree), &b = table.at(2, degree);
      return Shares{a.surface + part * (b.surface - a.surface), a.subsurface + part * (b.subsurface - a.subsurface),
                    a.transmitted + part * (b.transmitted - a.transmitted)};
    };
    expect_near(s, 0, table.at(0, degree), 1e-4, 0);
    expect_near(s, 1, blend(0.5), 1e-4, 0);
    expect_near(s, 2, blend(1), 1e-4, 0);
    expect_near(s, 3, blend(0.2), 1e-4, 0);
  }
}

TEST(TableLookup, KeepsEnergyThatNothingAbsorbs) {
  TableRequest request = request_of("soybean", TableMethod::monte_carlo, 20);
  request.params.mesophyll_fraction = 0;
  const TableLookup lookup = TableLookup::for_lanes(make_table(request, ThreadPool(1)));
  for (int i = -1000; i <= 1000; ++i) {
    const SampledShares s = lookup(static_cast<float>(i) / 1000, {});
    for (int lane = 0; lane < 3; ++lane) {
      EXPECT_GE(std::min({s.surface[lane], s.subsurface[lane], s.transmitted[lane]}), 0);
      EXPECT_NEAR(s.surface[lane] + s.subsurface[lane] + s.transmitted[lane], 1, 1e-6);
    }
  }
}

TEST_F(TableCache, ThatCannotBeLookedIntoIsNone) {
  const TableRequest request = request_of("soybean", TableMethod::monte_carlo, 5);
  const Table table = cached_table(request, "test", ThreadPool(1), silent_log(), std::string(300, 'x'));
  EXPECT_FALSE(table.shares.empty());
}

}  // namespace
}  // namespace frond::leaf
