#include <benchmark/benchmark.h>

#include <numbers>

#include "leaf/table/table.h"
#include "leaf/tissue/specimens.h"
#include "leaf/walk/batch_walk.h"
#include "tests/leaf/plain_walk.h"

/// Random walks and leaf tables by method. Names and arguments do not change between releases, so that JSON files can
/// be compared (CONTRIBUTING.md).
namespace frond::leaf {
namespace {

constexpr int kWalks = 20000;

/// Input of a method, which makes kWalks walks.
struct WalkTask {
  const Tissue& tissue;
  Vec3d wo;
  Absorption absorption;
};

/// The simple loop that the tests use as a reference; analog only.
void walk_scalar(const WalkTask& task) {
  test::PlainWalk walk(task.tissue, 1);
  for (int i = 0; i < kWalks; ++i) benchmark::DoNotOptimize(walk(task.wo));
}

void walk_one_by_one(const WalkTask& task) {
  RandomStream rng(1);
  for (int i = 0; i < kWalks; ++i) benchmark::DoNotOptimize(walk(task.tissue, task.wo, task.absorption, rng));
}

void walk_in_batches(const batch::Kernel& kernel, const WalkTask& task) {
  static std::vector<BatchRay> rays(kWalks);
  walk_batch(kernel, task.tissue, task.wo, task.absorption, 1, rays);
  benchmark::DoNotOptimize(rays.data());
}

template <class Method>
void add_walk(const std::string& method, const Specimen& specimen, Absorption absorption, const Method& walks) {
  const auto run = [=, &specimen](benchmark::State& state) {
    constexpr double kTheta = 8 * std::numbers::pi / 180;
    const TissueModel model(specimen.params);
    const Tissue tissue = model.at(static_cast<double>(state.range(0)));
    for (auto _ : state) walks(WalkTask{tissue, {std::sin(kTheta), 0, std::cos(kTheta)}, absorption});
    state.SetItemsProcessed(state.iterations() * kWalks);
  };
  const std::string mode = absorption == Absorption::analog ? "analog" : "weighted";
  const std::string name = "walk/" + std::string(specimen.name) + "/" + mode + "/" + method;
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->ArgName("nm")
      ->ArgsProduct({{455, 551, 608, 800}})
      ->Unit(benchmark::kMillisecond);
}

void add_walks(const Specimen& specimen, Absorption absorption) {
  if (absorption == Absorption::analog) add_walk("plain", specimen, absorption, walk_scalar);
  add_walk("scalar", specimen, absorption, walk_one_by_one);
  for (const batch::Kernel* kernel : batch_kernels())
    add_walk("batch_" + std::string(name_of(*kernel)), specimen, absorption,
             [kernel](const WalkTask& task) { walk_in_batches(*kernel, task); });
}

/// Rays per degree: a hundredth of the paper's, whose table takes a hundred times as long.
constexpr int kTableRays = 10000;

void add_table(const Specimen& specimen, TableMethod method, const std::string& label, std::vector<double> nm) {
  const TableRequest request{
      .params = specimen.params, .wavelengths_nm = std::move(nm), .method = method, .rays = kTableRays};
  const auto run = [=](benchmark::State& state) {
    const ThreadPool pool(1);
    for (auto _ : state) benchmark::DoNotOptimize(make_table(request, pool));
  };
  const std::string name = "table/" + std::string(specimen.name) + "/" + label;
  benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond);
}

std::vector<double> visible() {
  std::vector<double> nm;
  for (double x = 360; x <= 830; x += 5) nm.push_back(x);
  return nm;
}

[[maybe_unused]] const bool kAdded = [] {
  for (const Specimen& specimen : kSpecimens) {
    add_walks(specimen, Absorption::analog);
    add_walks(specimen, Absorption::weighted);
    add_table(specimen, TableMethod::monte_carlo, "montecarlo_1e4_rays/smpte", {455, 551, 608});
    add_table(specimen, TableMethod::solve, "solve/smpte", {455, 551, 608});
    add_table(specimen, TableMethod::solve, "solve/visible_5nm", visible());
  }
  return true;
}();

}  // namespace
}  // namespace frond::leaf
