#include <benchmark/benchmark.h>

#include <map>
#include <numbers>

#include "core/sampling.h"
#include "instruments/given_wavelengths.h"
#include "instruments/sweep.h"
#include "render/plugins.h"
#include "tests/laws/setup.h"

/// What a call of a BSDF costs, for every material at its defaults, those of FROND_PLUGIN_PATH included. Names and
/// arguments stay from release to release.
namespace frond {
namespace {

const PluginTable<MaterialInfo>& materials() {
  static const Registry registry = load_registry({});
  return registry.materials;
}

ParsedParam word(const std::string& name, const std::string& value) {
  ParsedParam p;
  p.type = "string", p.name = name, p.values = std::vector<std::string>{value};
  return p;
}

/// Defaults, stand-ins for what has none, and tables that are solved: walks would take minutes.
std::unique_ptr<Material> make(const MaterialInfo& info, const Preparation& preparation) {
  PlainResolver resolver([](const std::string& name) -> std::shared_ptr<Material> {
    PlainResolver nothing([](const std::string&) { return nullptr; });
    const MaterialInfo& child = materials().get(name == "one" ? "diffuse" : "diffusetransmission", {});
    return child.make(Params(child, {}, nothing));
  });
  const SweepOptions options{.pinned = {word("tablemethod", "solve")}, .random_corners = 0, .random_points = 0};
  auto made = info.make(Params(info, parameter_sweep(info, options).front().plugin, resolver));
  made->prepare(preparation);
  return made;
}

/// A BSDF at one hit of a material that is ready.
class Ready {
 public:
  Ready(const MaterialInfo& info, std::vector<float> nm)
      : wavelengths_(std::move(nm)), setup_(wavelengths_), material_(make(info, setup_.preparation)) {
    const Hit hit{.p = {}, .ng = {0, 0, 1}, .shading = Frame::around({0, 0, 1}), .at = {{0.5f, 0.5f}}};
    bsdf_ = material_->evaluate(hit, wavelengths_.sample(0), arena_);
  }
  const Bsdf& bsdf() const { return *bsdf_; }

  /// Made once for each material and number of wavelengths.
  static const Ready& get(const MaterialInfo& info, int64_t lanes) {
    static std::map<std::pair<const MaterialInfo*, int64_t>, std::unique_ptr<Ready>> all;
    auto& entry = all[{&info, lanes}];
    if (!entry) entry = std::make_unique<Ready>(info, wavelengths(lanes));
    return *entry;
  }

 private:
  static std::vector<float> wavelengths(int64_t lanes) {
    if (lanes == 1) return {551};
    if (lanes == 3) return {608, 551, 455};
    return {430, 500, 570, 640};
  }

  GivenWavelengths wavelengths_;
  test::Setup setup_;
  std::unique_ptr<Material> material_;
  Arena arena_;
  const Bsdf* bsdf_ = nullptr;
};

/// What varies from call to call, drawn beforehand.
struct Draw {
  Vec3 wi;  ///< uniform over the sphere
  Vec3 wo;  ///< on either side, by its cosine
  float uc;
  Vec2 u;
};

std::vector<Draw> draws() {
  std::vector<Draw> all(1024);
  RandomStream rng(1);
  for (Draw& draw : all) {
    const float z = 2 * rng.uniform() - 1, phi = 2 * kPi * rng.uniform(), r = std::sqrt(1 - z * z);
    draw.wi = {r * std::cos(phi), r * std::sin(phi), z};
    draw.uc = rng.uniform();
    draw.u = {rng.uniform(), rng.uniform()};
    draw.wo = sample_cosine_hemisphere({rng.uniform(), rng.uniform()});
    if (rng.uniform() < 0.5f) draw.wo.z = -draw.wo.z;
  }
  return all;
}

/// call(bsdf, wo, draw, rng) is what is measured.
template <class Call>
void add(const MaterialInfo& info, const std::string& operation, const Call& call) {
  const auto run = [&info, call](benchmark::State& state) {
    const double theta = static_cast<double>(state.range(0)) * std::numbers::pi / 180;
    const Vec3 wo{static_cast<float>(std::sin(theta)), 0, static_cast<float>(std::cos(theta))};
    const Bsdf& bsdf = Ready::get(info, state.range(1)).bsdf();
    const std::vector<Draw> all = draws();
    RandomStream rng(2);
    size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(call(bsdf, wo, all[i++ % all.size()], rng));
  };
  const std::string name = "bsdf/" + std::string(info.name) + "/" + operation;
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->ArgNames({"theta", "wavelengths"})
      ->ArgsProduct({{0, 45, 80}, {1, 3, 4}});
}

/// `sample` for paths that arrive from everywhere, each from another direction.
void add_sample_from_everywhere(const MaterialInfo& info) {
  const auto run = [&info](benchmark::State& state) {
    const Bsdf& bsdf = Ready::get(info, state.range(0)).bsdf();
    const std::vector<Draw> all = draws();
    RandomStream rng(2);
    size_t i = 0;
    for (auto _ : state) {
      const Draw& draw = all[i++ % all.size()];
      benchmark::DoNotOptimize(bsdf.sample(draw.wo, draw.uc, draw.u, rng));
    }
  };
  benchmark::RegisterBenchmark(("bsdf/" + std::string(info.name) + "/sample_from_everywhere").c_str(), run)
      ->ArgName("wavelengths")
      ->Arg(1)
      ->Arg(3)
      ->Arg(4);
}

/// A material that is ready for paths with wavelengths of their own.
class ReadyForEach {
 public:
  explicit ReadyForEach(const MaterialInfo& info) : setup_(wavelengths_), material_(make(info, setup_.preparation)) {}
  const WavelengthStrategy& wavelengths() const { return wavelengths_; }
  const Material& material() const { return *material_; }

  /// Made once for each material.
  static const ReadyForEach& get(const MaterialInfo& info) {
    static std::map<const MaterialInfo*, std::unique_ptr<ReadyForEach>> all;
    auto& entry = all[&info];
    if (!entry) entry = std::make_unique<ReadyForEach>(info);
    return *entry;
  }

 private:
  test::StratifiedWavelengths wavelengths_;
  test::Setup setup_;
  std::unique_ptr<Material> material_;
};

/// What a path pays at a hit: the BSDF is made, with what it looks up, and sampled. Four wavelengths, anew for each
/// path.
void add_hit(const MaterialInfo& info) {
  const auto run = [&info](benchmark::State& state) {
    const double theta = static_cast<double>(state.range(0)) * std::numbers::pi / 180;
    const Vec3 wo{static_cast<float>(std::sin(theta)), 0, static_cast<float>(std::cos(theta))};
    const ReadyForEach& ready = ReadyForEach::get(info);
    const Hit hit{.p = {}, .ng = {0, 0, 1}, .shading = Frame::around({0, 0, 1}), .at = {{0.5f, 0.5f}}};
    const std::vector<Draw> all = draws();
    Arena arena;
    RandomStream rng(2);
    size_t i = 0;
    for (auto _ : state) {
      const Draw& draw = all[i++ % all.size()];
      arena.reset();
      const Bsdf* bsdf = ready.material().evaluate(hit, ready.wavelengths().sample(draw.uc), arena);
      benchmark::DoNotOptimize(bsdf->sample(wo, draw.u.x, {draw.u.y, draw.uc}, rng));
    }
  };
  benchmark::RegisterBenchmark(("bsdf/" + std::string(info.name) + "/hit_and_sample").c_str(), run)
      ->ArgName("theta")
      ->Arg(0)
      ->Arg(45)
      ->Arg(80);
}

[[maybe_unused]] const bool kAdded = [] {
  for (const MaterialInfo* info : materials().all()) {
    add_hit(*info);
    add_sample_from_everywhere(*info);
    add(*info, "sample", [](const Bsdf& bsdf, const Vec3& wo, const Draw& draw, RandomStream& rng) {
      return bsdf.sample(wo, draw.uc, draw.u, rng);
    });
    add(*info, "f",
        [](const Bsdf& bsdf, const Vec3& wo, const Draw& draw, RandomStream& rng) { return bsdf.f(wo, draw.wi, rng); });
    add(*info, "pdf",
        [](const Bsdf& bsdf, const Vec3& wo, const Draw& draw, RandomStream&) { return bsdf.pdf(wo, draw.wi); });
  }
  return true;
}();

}  // namespace
}  // namespace frond
