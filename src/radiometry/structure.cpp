#include "radiometry/structure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/random.h"
#include "core/math/vec.h"
#include "core/stop.h"
#include "radiometry/horizontal_irradiance.h"
#include "radiometry/leaf_points.h"
#include "radiometry/radiometer_scene.h"
#include "radiometry/ratio_sums.h"
#include "scene/scene_options.h"

namespace frond {
namespace {

Vec3d direction_of(double zenith_deg, double azimuth_deg) {
  const double theta = zenith_deg * kDegree, phi = azimuth_deg * kDegree;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Mean over all azimuths of |cos| between a direction and a normal of the inclination `alpha`, both angles in [0,
/// pi/2] (Warren Wilson 1960, New Phytologist 59:1-8).
double mean_projection(double theta, double alpha) {
  const double straight = std::cos(theta) * std::cos(alpha);
  if (theta + alpha <= std::numbers::pi / 2) return straight;
  const double psi = std::acos(std::clamp(1 / (std::tan(theta) * std::tan(alpha)), -1.0, 1.0));
  return straight * (1 + 2 / std::numbers::pi * (std::tan(psi) - psi));
}

/// Share of n rays that are gaps. Its error is unknown if all rays agree.
MeanError share_of(uint64_t gaps, uint64_t n) {
  if (n == 0) return kUnknown;
  const double p = double(gaps) / double(n);
  return {p, gaps == 0 || gaps == n ? NAN : std::sqrt(p * (1 - p) / double(n - 1))};
}

/// Returns -ln(gap) cos(zenith), the leaf area index times G and clumping; unknown for a gap fraction of 0.
MeanError contact_number(const StructureMeasurement::Direction& d) {
  if (!(d.gap.mean > 0)) return kUnknown;
  const double cosine = std::cos(d.zenith_deg * kDegree);
  return {-std::log(d.gap.mean) * cosine, d.gap.standard_error / d.gap.mean * cosine};
}

/// Divides a by the product of b and c, with independent errors.
MeanError divided(const MeanError& a, const MeanError& b, const MeanError& c) {
  if (!(a.mean > 0 && b.mean > 0 && c.mean > 0)) return kUnknown;
  const auto relative = [](const MeanError& v) { return v.standard_error / v.mean; };
  const double mean = a.mean / (b.mean * c.mean);
  return {mean, mean * std::hypot(relative(a), relative(b), relative(c))};
}

/// Miller's integral 2 int_0^(pi/2) -ln P(theta) cos(theta) sin(theta) dtheta (1967, Australian Journal of Botany
/// 15:141-144): each zenith angle stands for the angles nearest to it. Unknown for fewer than three.
MeanError effective_index(std::vector<StructureMeasurement::Direction> directions) {
  using Direction = StructureMeasurement::Direction;
  std::ranges::sort(directions, {}, &Direction::zenith_deg);
  const auto repeated = std::ranges::unique(directions, {}, &Direction::zenith_deg);
  directions.erase(repeated.begin(), repeated.end());
  if (directions.size() < 3) return kUnknown;
  double sum = 0, variance = 0, begin = 0;
  for (size_t i = 0; i < directions.size(); ++i) {
    const bool is_last = i + 1 == directions.size();
    const double end = is_last ? 90 : (directions[i].zenith_deg + directions[i + 1].zenith_deg) / 2;
    const double weight = 2 * (std::cos(begin * kDegree) - std::cos(end * kDegree));
    const MeanError contacts = contact_number(directions[i]);
    sum += weight * contacts.mean, variance += std::pow(weight * contacts.standard_error, 2);
    begin = end;
  }
  return {sum, std::sqrt(variance)};
}

/// Replaces everything that costs time and has no effect on the structure.
void simplify(const Registry& registry, const StructureRequest& request, SceneDescription& description) {
  for (MaterialDescription& m : description.materials) m.plugin = {"diffuse", m.plugin.where, {}};
  if (request.sun_deg) description.lights.clear();
  // Without a light the loader would warn of a black image. This one is no sun.
  if (description.lights.empty()) description.lights.push_back({{"infinite", {}, {}}, {}});
  prepare_for_radiometry(registry, "bands,wavelengths=550", request.period, true, description);
}

}  // namespace

struct StructureMeter::State {
  LoadedScene loaded;
  StructureRequest request;
  std::vector<uint8_t> is_counted;  ///< by material index
  Target target;
  SurfacePoints points;
  std::optional<Vec3> sun;
  std::vector<StructureMeasurement::Direction> directions = {};
  std::vector<uint64_t> gaps = {};                            ///< rays that met no leaf, by direction
  std::vector<RatioSums> projections = {}, sunlit_from = {};  ///< by direction
  RatioSums angle = {}, sunlit = {};                          ///< means over points of leaves
  std::vector<RatioSums> classes = std::vector<RatioSums>(StructureMeasurement::kClasses);
  uint64_t rays = 0;

  const Scene& scene() const { return loaded.scene(); }
  double target_area() const { return (target.x1 - target.x0) * (target.y1 - target.y0); }
  double count_of(const Vec3& p) const { return count_in_column(scene(), target, p); }
};

/// Accumulators of one block of rays and points.
class StructureMeter::Sums {
 public:
  static constexpr uint64_t kBlock = 4096;

  explicit Sums(const State& state)
      : state_(state),
        gaps(state.directions.size()),
        projections(gaps.size()),
        sunlit_from(gaps.size()),
        classes(state.classes.size()) {}

  void trace(uint64_t first, std::span<const RandomSurfacePoint> points) {
    const uint64_t seed = state_.scene().seed();
    StopPoll poll;
    for (size_t d = 0; d < gaps.size(); ++d)
      for (uint64_t i = first; i < first + points.size(); ++i) {
        poll();
        gaps[d] += is_gap(state_.directions[d], hash_key(seed, uint64_t{kRays}, uint64_t(d), i));
      }
    for (size_t i = 0; i < points.size(); ++i) {
      poll();
      add(points[i], RandomStream(hash_key(seed, uint64_t{kShadows}, first + i)));
    }
  }

  enum Use : uint64_t { kRays = 0x73747275, kPoints, kShadows };

 private:
  /// Whether a ray through a random point of the target meets no surface that counts.
  bool is_gap(const StructureMeasurement::Direction& direction, uint64_t key) const {
    constexpr int kMostPassed = 1 << 16;
    RandomStream random(key);
    const Target& t = state_.target;
    const Scene& scene = state_.scene();
    const double x = std::lerp(t.x0, t.x1, random.uniform_double()), y = std::lerp(t.y0, t.y1, random.uniform_double());
    const double azimuth = std::isnan(direction.azimuth_deg) ? 360 * random.uniform_double() : direction.azimuth_deg;
    const Vec3d up = direction_of(direction.zenith_deg, azimuth);
    Ray ray{to_float(Vec3d{x, y, t.z} + up * distance_above(scene, t, up.z) - scene.origin()), to_float(-up)};
    SurfacePoint point;
    for (int i = 0; i < kMostPassed && scene.intersect(ray, hash_key(key, uint64_t(i)), point); ++i) {
      if (state_.is_counted[point.material_id]) return false;
      ray.o = offset_origin(point.hit, ray.d);
    }
    return true;
  }

  void add(const RandomSurfacePoint& point, RandomStream random) {
    const double weight = point.weight * state_.count_of(point.p);
    if (weight == 0) return;
    const double alpha = std::acos(std::min(1.0, std::abs(double(point.ng.z)))), alpha_deg = alpha / kDegree;
    angle.add(alpha_deg, weight);
    const auto in_class = std::min(size_t(alpha_deg / 90 * double(classes.size())), classes.size() - 1);
    for (size_t c = 0; c < classes.size(); ++c) classes[c].add(c == in_class ? 1 : 0, weight);
    for (size_t d = 0; d < projections.size(); ++d) {
      const double zenith = state_.directions[d].zenith_deg, azimuth = state_.directions[d].azimuth_deg;
      const bool is_mean = std::isnan(azimuth);
      const Vec3d w = direction_of(zenith, is_mean ? 360 * random.uniform_double() : azimuth);
      projections[d].add(is_mean ? mean_projection(zenith * kDegree, alpha) : std::abs(dot(w, to_double(point.ng))),
                         weight);
      sunlit_from[d].add(is_lit(point, to_float(w), random.bits()), weight);
    }
    if (state_.sun) sunlit.add(is_lit(point, *state_.sun, random.bits()), weight);
  }

  /// Returns 1 if light from the direction `w` reaches the point, else 0.
  double is_lit(const RandomSurfacePoint& point, const Vec3& w, uint64_t key) const {
    return is_sunlit(state_.scene(), point, w, key) ? 1 : 0;
  }

  const State& state_;

 public:
  std::vector<uint64_t> gaps;
  std::vector<RatioSums> projections, sunlit_from, classes;
  RatioSums angle, sunlit;
};

StructureMeter::StructureMeter(Session& session, SceneDescription description, const StructureRequest& request) {
  if (description.has_media())
    fail(description.media.front().plugin.where,
         "structure measures surfaces only, no participating media, not even medium \"turbid\": remove the media");
  std::vector<uint8_t> is_counted = counted_materials(description, request.materials, session.registry());
  simplify(session.registry(), request, description);
  LoadedScene loaded = session.load(std::move(description));
  const Scene& scene = loaded.scene();
  const Target target = request.target ? *request.target : default_target(scene, session.log());
  check_target(scene, target);
  SurfacePoints points(scene.geometry(), is_counted);
  if (!(points.total() > 0)) fail({}, "the scene has no surface of the materials that count as leaves");
  const auto sun = request.sun_deg ? std::optional(to_float(direction_of((*request.sun_deg)[0], (*request.sun_deg)[1])))
                                   : direction_to_sun(scene.lights());
  state_ =
      std::make_unique<State>(State{std::move(loaded), request, std::move(is_counted), target, std::move(points), sun});
  const std::vector<double> azimuths = request.azimuths_deg.empty() ? std::vector<double>{NAN} : request.azimuths_deg;
  for (const double azimuth : azimuths)
    for (const double zenith : request.zeniths_deg) state_->directions.push_back({zenith, azimuth, {}, {}, {}, {}});
  state_->gaps.resize(state_->directions.size());
  state_->projections.resize(state_->directions.size());
  state_->sunlit_from.resize(state_->directions.size());
}

StructureMeter::~StructureMeter() = default;

uint64_t StructureMeter::rays() const { return state_->rays; }

const LoadedScene& StructureMeter::scene() const { return state_->loaded; }

/// Blocks are traced in rounds; their sums are added in order, so that the result does not depend on threads.
void StructureMeter::trace(uint64_t rays, ThreadPool& pool, const RenderControl& control) {
  constexpr uint64_t kBlocks = 64;
  State& s = *state_;
  RenderStatistics statistics;
  const RenderTimer timer;
  const StopScope stop(control.stop);
  const DeadlineScope deadline(control.deadline);
  for (uint64_t done = 0; done < rays && !control.is_over();) {
    const uint64_t round = std::min(rays - done, kBlocks * Sums::kBlock);
    std::vector<RandomSurfacePoint> points;
    std::vector<Sums> sums((round + Sums::kBlock - 1) / Sums::kBlock, Sums(s));
    try {
      points = s.points.draw(hash_key(s.scene().seed(), uint64_t{Sums::kPoints}), s.rays, size_t(round));
      pool.for_each(int64_t(sums.size()), [&](int64_t block, int) {
        const uint64_t begin = uint64_t(block) * Sums::kBlock;
        sums[size_t(block)].trace(s.rays + begin, std::span(points).subspan(begin).first(
                                                      std::min<size_t>(Sums::kBlock, points.size() - begin)));
      });
    } catch (const Stopped&) {  // an incomplete round does not count
      if (!control.is_over()) throw;
      break;
    }
    for (const Sums& one : sums) {
      for (size_t d = 0; d < s.gaps.size(); ++d) {
        s.gaps[d] += one.gaps[d];
        s.projections[d] += one.projections[d], s.sunlit_from[d] += one.sunlit_from[d];
      }
      for (size_t c = 0; c < s.classes.size(); ++c) s.classes[c] += one.classes[c];
      s.angle += one.angle, s.sunlit += one.sunlit;
    }
    s.rays += points.size(), done += points.size();
    statistics.paths = done;
    timer.read(statistics);
    if (control.progress) control.progress->update(double(done) / double(rays), statistics);
  }
  if (control.progress) control.progress->finish();
}

StructureMeasurement StructureMeter::read() const {
  const State& s = *state_;
  StructureMeasurement m{.directions = s.directions, .target_area = s.target_area(), .rays = s.rays};
  const MeanError weight = s.angle.mean_weight(double(s.rays));
  const double per_area = s.points.total() / m.target_area;
  m.leaf_area_index = {weight.mean * per_area, weight.standard_error * per_area};
  m.mean_angle_deg = s.angle.ratio();
  for (const RatioSums& one : s.classes) m.angles.push_back(one.ratio());
  m.sunlit = s.sunlit.ratio();
  for (size_t d = 0; d < m.directions.size(); ++d) {
    StructureMeasurement::Direction& direction = m.directions[d];
    direction.gap = share_of(s.gaps[d], s.rays);
    direction.projection = s.projections[d].ratio();
    direction.sunlit = s.sunlit_from[d].ratio();
    direction.clumping = divided(contact_number(direction), direction.projection, m.leaf_area_index);
  }
  m.effective_index = s.request.azimuths_deg.empty() ? effective_index(m.directions) : kUnknown;
  if (s.sun) {
    const double azimuth = std::atan2(double(s.sun->y), double(s.sun->x)) / kDegree;
    m.sun_deg = s.request.sun_deg.value_or(
        std::array{std::acos(std::min(1.0, double(s.sun->z))) / kDegree, azimuth < 0 ? azimuth + 360 : azimuth});
  }
  return m;
}

double StructureMeasurement::error() const {
  Moments squares;
  const auto add = [&squares](const MeanError& v) {
    if (!std::isnan(v.standard_error)) squares.add(v.standard_error * v.standard_error);
  };
  for (const Direction& d : directions) add(d.gap), add(d.sunlit);
  add(sunlit);
  return std::sqrt(squares.mean());
}

}  // namespace frond
