#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <bit>
#include <ctime>

#include "core/log.h"
#include "render/plugins.h"
#include "render/render_loop.h"
#include "scene/format/parser.h"
#include "scene/geometry/embree.h"
#include "scene/overrides.h"
#include "scene/scene.h"

namespace frond {
namespace {

/// Records every ray, for a replay through Embree alone.
class RecordingWorld final : public World {
 public:
  struct Record {
    Ray ray;
    bool shadow;
  };
  /// Stores the rays of a packet, because the packet has only pointers.
  struct PacketRecord {
    PacketRecord(const RayPacket& packet, bool is_shadow) : lanes(packet.lanes), shadow(is_shadow) {
      std::copy_n(packet.rays, RayPacket::kWidth, rays.begin());
      std::copy_n(packet.keys, RayPacket::kWidth, keys.begin());
    }
    RayPacket packet() const { return {rays.data(), keys.data(), lanes}; }

    std::array<Ray, RayPacket::kWidth> rays;
    std::array<uint64_t, RayPacket::kWidth> keys;
    uint32_t lanes;
    bool shadow;
  };
  explicit RecordingWorld(const World& world) : world_(world) {}
  bool intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const override {
    records_.push_back({ray, false});
    return world_.intersect(ray, key, point);
  }
  bool occluded(const Ray& ray, uint64_t key) const override {
    records_.push_back({ray, true});
    return world_.occluded(ray, key);
  }
  uint32_t intersect(const RayPacket& packet, SurfacePoint* points) const override {
    packets_.emplace_back(packet, false);
    return world_.intersect(packet, points);
  }
  uint32_t occluded(const RayPacket& packet) const override {
    packets_.emplace_back(packet, true);
    return world_.occluded(packet);
  }
  std::span<const Light* const> lights() const override { return world_.lights(); }
  std::span<const EnvironmentLight* const> environment() const override { return world_.environment(); }
  float radius() const override { return world_.radius(); }
  const WavelengthStrategy& wavelengths() const override { return world_.wavelengths(); }
  const std::vector<Record>& records() const { return records_; }
  const std::vector<PacketRecord>& packets() const { return packets_; }
  size_t rays() const {
    size_t rays = records_.size();
    for (const PacketRecord& p : packets_) rays += size_t(std::popcount(p.lanes));
    return rays;
  }

 private:
  const World& world_;
  mutable std::vector<Record> records_;
  mutable std::vector<PacketRecord> packets_;
};

/// A scene, loaded once for its benchmarks, with one thread.
struct LoadedScene {
  explicit LoadedScene(const std::string& file, std::vector<MaterialSwap> swaps = {})
      : pool(1),
        registry(builtin_registry()),
        description(described(file, std::move(swaps))),
        scene(description, registry, pool, log),
        film_settings(Scene::film_settings(description, registry)) {}

  SceneDescription described(const std::string& file, std::vector<MaterialSwap> swaps) const {
    SceneDescription d = parse_scene(std::string(FROND_SOURCE_DIR "/scenes/") + file, log);
    apply_overrides({.swaps = std::move(swaps), .wavelengths = "smpte"}, d, registry, log);
    return d;
  }
  RenderInputs job(const World& world) const {
    return {world, scene.integrator(), scene.filter(), scene.camera_sampling()};
  }
  /// An empty film for a render.
  Film film() const {
    return Film({.settings = film_settings, .exponent = film_exponent(job(scene), film_settings.exposure)});
  }

  const Log& log = silent_log();
  ThreadPool pool;
  Registry registry;
  SceneDescription description;
  Scene scene;
  FilmSettings film_settings;
};

/// leaf_simplified with a solved table, which needs no walks at load and does not change the time of the render.
const std::vector<MaterialSwap> kSolved{{"leaf", {"leaf_simplified", {{"tablemethod", "solve"}}}}};

/// CPU time and number of rays per camera path.
void render_paths(benchmark::State& state, const std::string& file, const std::vector<MaterialSwap>& swaps) {
  const LoadedScene loaded(file, swaps);
  RenderStatistics total;
  for (auto _ : state) {
    Film film = loaded.film();
    const RenderStatistics s = render(loaded.job(loaded.scene), plan_of(film, {0, 4}), film, loaded.pool);
    total.paths += s.paths, total.rays += s.rays, total.cpu_seconds += s.cpu_seconds;
    state.counters["foliar_ratio"] = film.foliar_ratio();
  }
  state.counters["us_per_path"] = total.cpu_seconds / double(total.paths) * 1e6;
  state.counters["rays_per_path"] = double(total.rays) / double(total.paths);
}

/// Traces the rays of a render, single ones and packets, through Embree alone: the share of ray tracing in the render's
/// CPU time.
void replay_rays(benchmark::State& state, const std::string& file) {
  const WorkPlan plan{{160, 160, 352, 352}, {0, 16}};  // enough rays that fit into memory
  const LoadedScene loaded(file, kSolved);
  const RecordingWorld recorder(loaded.scene);
  Film film = loaded.film();
  render(loaded.job(recorder), plan, film, loaded.pool);
  double render_seconds = 0, embree_seconds = 0;
  for (auto _ : state) {
    Film again = loaded.film();
    render_seconds += render(loaded.job(loaded.scene), plan, again, loaded.pool).cpu_seconds;
    const std::clock_t start = std::clock();
    const Geometry& geometry = loaded.scene.geometry();
    RTCRayHit query;
    for (const auto& [ray, shadow] : recorder.records())
      benchmark::DoNotOptimize(shadow ? geometry.occluded(ray, 0) : geometry.closest(ray, 0, query));
    RTCRayHit8 queries;
    for (const RecordingWorld::PacketRecord& p : recorder.packets())
      benchmark::DoNotOptimize(p.shadow ? geometry.occluded(p.packet()) : geometry.closest(p.packet(), queries));
    embree_seconds += double(std::clock() - start) / CLOCKS_PER_SEC;
  }
  const double rays = double(recorder.rays()) * double(state.iterations());
  state.counters["embree_ns_per_ray"] = embree_seconds / rays * 1e9;
  state.counters["embree_share"] = embree_seconds / render_seconds;
}

BENCHMARK_CAPTURE(render_paths, leaves_simplified, "hundred-leaves/scene.pbrt", kSolved)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(render_paths, leaves_diffusetransmission, "hundred-leaves/scene.pbrt",
                  {{"leaf", {"diffusetransmission", {}}}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(render_paths, leaves_abm, "hundred-leaves/scene.pbrt", {{"leaf", {"abm", {}}}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay_rays, closed, "hundred-leaves/closed.pbrt")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace frond
