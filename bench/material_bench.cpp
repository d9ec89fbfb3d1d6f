#include <benchmark/benchmark.h>

#include <map>

#include "instruments/beam.h"
#include "instruments/bsdf_calls.h"
#include "instruments/given_wavelengths.h"
#include "instruments/sweep.h"
#include "render/plugins.h"
#include "tests/laws/setup.h"

/// Times of BSDF calls for every material with its defaults, including those of FROND_PLUGIN_PATH. Names and arguments
/// do not change between releases.
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

/// A material with its defaults, substitutes for parameters without one, and solved tables (walks would take minutes).
std::unique_ptr<Material> make(const MaterialInfo& info, const Preparation& preparation) {
  PlainResolver resolver([](const std::string& name) -> std::shared_ptr<Material> {
    PlainResolver nothing([](const std::string&) { return nullptr; });
    const MaterialInfo& child = materials().get(name == "one" ? "diffuse" : "diffusetransmission", {});
    return child.make(Params(child, {}, nothing));
  });
  const SweepOptions options{
      .pinned = {word("tablemethod", "solve"), word("filename", FROND_SOURCE_DIR "/tests/pbrt_reference/metal.bsdf")},
      .random_corners = 0,
      .random_points = 0};
  auto made = info.make(Params(info, parameter_sweep(info, options).front().plugin, resolver));
  made->prepare(preparation);
  return made;
}

/// A BSDF at one hit of a prepared material.
class Ready {
 public:
  Ready(const MaterialInfo& info, std::vector<float> nm)
      : wavelengths_(std::move(nm)), setup_(wavelengths_), material_(make(info, setup_.preparation)) {
    bsdf_ = material_->evaluate(flat_hit(), wavelengths_.sample(0), arena_);
  }
  const Bsdf& bsdf() const { return *bsdf_; }

  /// Made once for each material and number of wavelengths.
  static const Ready& get(const MaterialInfo& info, int64_t lanes) {
    static std::map<std::pair<const MaterialInfo*, int64_t>, std::unique_ptr<Ready>> all;
    auto& entry = all[{&info, lanes}];
    if (!entry) entry = std::make_unique<Ready>(info, benchmark_wavelengths(static_cast<int>(lanes)));
    return *entry;
  }

 private:
  GivenWavelengths wavelengths_;
  test::Setup setup_;
  std::unique_ptr<Material> material_;
  Arena arena_;
  const Bsdf* bsdf_ = nullptr;
};

/// Adds a benchmark that times call(bsdf, wo, draw, rng).
template <class Call>
void add(const MaterialInfo& info, const std::string& operation, const Call& call) {
  const auto run = [&info, call](benchmark::State& state) {
    const Vec3 wo = view_direction(static_cast<double>(state.range(0)));
    const Bsdf& bsdf = Ready::get(info, state.range(1)).bsdf();
    CallDraws draws;
    RandomStream rng(2);
    for (auto _ : state) benchmark::DoNotOptimize(call(bsdf, wo, draws.next(), rng));
  };
  const std::string name = "bsdf/" + std::string(info.name) + "/" + operation;
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->ArgNames({"theta", "wavelengths"})
      ->ArgsProduct({{0, 45, 80}, {1, 3, 4}});
}

/// Adds a benchmark of `sample` with a new direction of arrival, uniform over the sphere, in each call.
void add_sample_from_everywhere(const MaterialInfo& info) {
  const auto run = [&info](benchmark::State& state) {
    const Bsdf& bsdf = Ready::get(info, state.range(0)).bsdf();
    CallDraws draws;
    RandomStream rng(2);
    for (auto _ : state) {
      const CallDraws::Draw& draw = draws.next();
      benchmark::DoNotOptimize(bsdf.sample(draw.wo, draw.uc, draw.u, rng));
    }
  };
  benchmark::RegisterBenchmark(("bsdf/" + std::string(info.name) + "/sample_from_everywhere").c_str(), run)
      ->ArgName("wavelengths")
      ->Arg(1)
      ->Arg(3)
      ->Arg(4);
}

/// A material prepared for paths that choose their own wavelengths.
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

/// Adds a benchmark of a hit: making the BSDF with its look-ups, and one sample, for four wavelengths chosen anew in
/// each call.
void add_hit(const MaterialInfo& info) {
  const auto run = [&info](benchmark::State& state) {
    const Vec3 wo = view_direction(static_cast<double>(state.range(0)));
    const ReadyForEach& ready = ReadyForEach::get(info);
    const Hit hit = flat_hit();
    CallDraws draws;
    Arena arena;
    RandomStream rng(2);
    for (auto _ : state) {
      const CallDraws::Draw& draw = draws.next();
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
    if (info->name == "interface") continue;  // has no BSDF
    add_hit(*info);
    add_sample_from_everywhere(*info);
    add(*info, "sample", [](const Bsdf& bsdf, const Vec3& wo, const CallDraws::Draw& draw, RandomStream& rng) {
      return bsdf.sample(wo, draw.uc, draw.u, rng);
    });
    add(*info, "f", [](const Bsdf& bsdf, const Vec3& wo, const CallDraws::Draw& draw, RandomStream& rng) {
      return bsdf.f(wo, draw.wi, rng);
    });
    add(*info, "pdf", [](const Bsdf& bsdf, const Vec3& wo, const CallDraws::Draw& draw, RandomStream&) {
      return bsdf.pdf(wo, draw.wi);
    });
  }
  return true;
}();

}  // namespace
}  // namespace frond
