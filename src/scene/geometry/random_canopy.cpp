#include "scene/geometry/random_canopy.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/math/vec.h"
#include "scene/geometry/instance_writer.h"

namespace frond {
namespace {

/// Share of a row by which a plot may be too narrow for its last row, for rounding errors.
constexpr double kWholeRows = 1e-9;

}  // namespace

double Crown::volume() const {
  constexpr double kFilled[] = {4 * kPiD / 3, 2 * kPiD / 3, 2 * kPiD};  // of an ellipsoid, a cone and a cylinder
  return kFilled[size_t(shape)] * radii.x * radii.y * radii.z;
}

uint64_t RandomCanopy::leaves() const {
  if (count > 0) return count;
  return uint64_t(std::llround(leaf_area_index * size[0] * size[1] / (leaf_area * scale * scale)));
}

double RandomCanopy::largest_position() const {
  if (ball > 0) return ball;
  double largest = 0;
  const auto add = [&largest](double x) { largest = std::max(largest, std::abs(x)); };
  for (const Crown& crown : crowns) {
    const Vec3d &c = crown.centre, &r = crown.radii;
    for (const auto& [middle, radius] : {std::pair{c.x, r.x}, {c.y, r.y}, {c.z, r.z}})
      add(middle - radius), add(middle + radius);
  }
  if (!crowns.empty()) return largest;
  for (const double x : size) add(x);
  for (const double z : heights) add(profile ? 0 : z);
  if (profile) add(profile->points().front().at), add(profile->points().back().at);
  return largest;
}

/// A distribution without density is horizontal: all angles are 0.
LeafPlacer::LeafPlacer(const RandomCanopy& canopy) : canopy_(canopy), leaves_(canopy.leaves()) {
  constexpr int kSteps = LeafAngles::kSteps;
  double filled = 0;
  for (const Crown& crown : canopy.crowns) crown_ends_.push_back(filled += crown.volume() * crown.density);
  for (double& end : crown_ends_) end /= filled;
  if (!canopy.angles->density) {
    angle_at_ = {0, 0};
    return;
  }
  // Cumulative distribution, then its inverse at equal steps.
  std::vector<double> cumulative{0};
  const double step = kPiD / 2 / kSteps;
  for (int i = 0; i < kSteps; ++i) cumulative.push_back(cumulative.back() + canopy.angles->share(i));
  size_t below = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double wanted = cumulative.back() * i / kSteps;
    while (below + 1 < size_t(kSteps) && cumulative[below + 1] < wanted) ++below;
    const double width = cumulative[below + 1] - cumulative[below];
    const double within = width > 0 ? std::clamp((wanted - cumulative[below]) / width, 0.0, 1.0) : 0;
    angle_at_.push_back((double(below) + within) * step);
  }
}

/// Returns a position that is uniform in the crown of the leaf. Crowns have their exact shares of the leaves, up to
/// rounding: leaf i belongs to the crown that holds the share (i + 1/2) / leaves.
Vec3d LeafPlacer::position_in_crown(RandomStream& random) const {
  const double share = (double(next_ - 1) + 0.5) / double(leaves_);
  const auto i =
      std::min(size_t(std::ranges::upper_bound(crown_ends_, share) - crown_ends_.begin()), crown_ends_.size() - 1);
  const Crown& crown = canopy_.crowns[i];
  const double u = random.uniform_double(), phi = 2 * kPiD * random.uniform_double(), v = random.uniform_double();
  double z = 2 * u - 1, ring = std::sqrt(v);  // in units of the half axes; first of a cylinder
  if (crown.shape == Crown::Shape::cone) {
    const double below_apex = std::cbrt(u);  // in units of the height, to which the radius is proportional
    z = 1 - 2 * below_apex, ring *= below_apex;
  } else if (crown.shape == Crown::Shape::ellipsoid) {
    const double r = std::cbrt(v);
    ring = std::sqrt(1 - z * z) * r, z *= r;
  }
  return crown.centre +
         Vec3d{crown.radii.x * ring * std::cos(phi), crown.radii.y * ring * std::sin(phi), crown.radii.z * z};
}

/// Returns a position in the layer, the rows, the crowns or the ball.
Vec3d LeafPlacer::position(RandomStream& random) const {
  const auto between = [&random](double a, double b) { return std::lerp(a, b, random.uniform_double()); };
  if (!canopy_.crowns.empty()) return position_in_crown(random);
  if (canopy_.ball == 0) {
    double x = between(0, canopy_.size[0]);
    const double y = between(0, canopy_.size[1]);
    if (const auto& rows = canopy_.rows) {
      const double count = std::floor(canopy_.size[0] / rows->spacing + kWholeRows);
      const double at = x / canopy_.size[0] * count, row = std::floor(at);
      x = (row + 0.5) * rows->spacing + (at - row - 0.5) * rows->width;
    }
    if (canopy_.profile) return {x, y, canopy_.profile->quantile(random.uniform_double())};
    return {x, y, between(canopy_.heights[0], canopy_.heights[1])};
  }
  const double z = between(-1, 1), phi = between(0, 2 * kPiD), r = canopy_.ball * std::cbrt(random.uniform_double());
  const double ring = std::sqrt(1 - z * z);
  return Vec3d{ring * std::cos(phi), ring * std::sin(phi), z} * r;
}

/// Cells have the size of the minimum distance, so that only neighbouring cells need to be searched.
LeafPlacer::Cell LeafPlacer::cell_of(const Vec3d& p) const {
  const auto at = [this](double x) { return int64_t(std::floor(x / canopy_.apart)); };
  return {at(p.x), at(p.y), at(p.z)};
}

/// Searches the 27 cells around the position.
bool LeafPlacer::try_to_place(const Vec3d& p) {
  if (canopy_.apart == 0) return true;
  const Cell middle = cell_of(p);
  for (int64_t i = -1; i <= 1; ++i)
    for (int64_t j = -1; j <= 1; ++j)
      for (int64_t k = -1; k <= 1; ++k)
        if (const auto cell = there_.find({middle[0] + i, middle[1] + j, middle[2] + k}); cell != there_.end())
          for (const Vec3d& other : cell->second)
            if (length(other - p) < canopy_.apart) return false;
  there_[middle].push_back(p);
  return true;
}

/// Each leaf has its own random stream. Positions too close to others are rejected and redrawn.
PreciseTransform::Rows LeafPlacer::place(std::span<float> values) {
  constexpr int kMostTries = 100000;
  RandomStream random(hash_key(canopy_.seed, next_++));
  const auto between = [&random](double a, double b) { return std::lerp(a, b, random.uniform_double()); };
  Vec3d at_position = position(random);
  for (int i = 1; !try_to_place(at_position); ++i) {
    if (i == kMostTries) fail({}, "there is no room for leaf {}: they are to be {:g} apart", next_, canopy_.apart);
    at_position = position(random);
  }
  const double at = random.uniform_double() * double(angle_at_.size() - 1);
  const auto i = std::min(size_t(at), angle_at_.size() - 2);
  const double theta = std::lerp(angle_at_[i], angle_at_[i + 1], at - double(i)), phi = between(0, 2 * kPiD);
  const Vec3d normal{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  const double spin = between(0, 2 * kPiD);
  for (size_t c = 0; c < canopy_.columns.size(); ++c)
    values[c] = float(between(canopy_.columns[c].range.min, canopy_.columns[c].range.max));
  return oriented_rows(at_position, normal, spin, canopy_.scale);
}

}  // namespace frond
