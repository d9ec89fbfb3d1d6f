#include <algorithm>

#include "core/camera.h"
#include "core/error.h"
#include "core/math/vec.h"

namespace frond {
namespace {

/// Distant radiometer: each column of the film is a direction; all columns see the same rectangle, of which each row
/// sees one cell of a grid.
class DistantCamera final : public Camera {
 public:
  /// Throws InputError unless the film has one column for each direction, and as many rows of each cell of the grid.
  DistantCamera(const Params& p, const CameraPlacement& placement) : world_from_camera_(placement.world_from_camera) {
    const std::vector<double> zenith = p.reals("zenith"), azimuth = p.reals("azimuth"), target = p.reals("target");
    if (target.size() != 5)
      fail(p.where("target"), "\"target\" takes 5 values, x0 x1 y0 y1 z, {} given", target.size());
    if (!(target[0] < target[1] && target[2] < target[3])) fail(p.where("target"), "\"target\" is empty");
    if (zenith.empty()) fail(p.where("zenith"), "\"zenith\" has no value");
    if (azimuth.size() > 1 && azimuth.size() != zenith.size())
      fail(p.where("azimuth"), "\"azimuth\" takes one value, or as many as \"zenith\", which has {}: {} given",
           zenith.size(), azimuth.size());
    if (placement.width != int(zenith.size()))
      fail(p.where(), "this camera has {} directions, a column of the film for each; \"xresolution\" is {}",
           zenith.size(), placement.width);
    for (size_t i = 0; i < zenith.size(); ++i) {
      if (!(std::abs(zenith[i]) < 90)) fail(p.where("zenith"), "{} in \"zenith\" is not above the horizon", zenith[i]);
      const double phi = azimuth.empty() ? 0 : azimuth[azimuth.size() == 1 ? 0 : i];
      toward_.push_back(direction(zenith[i] * kDegree, phi * kDegree));
    }
    std::vector<int> strata = p.integers("strata");
    if (strata.empty()) strata = {1, 1};
    if (strata.size() != 2) fail(p.where("strata"), "\"strata\" takes 2 values, {} given", strata.size());
    if (placement.height % (strata[0] * strata[1]) != 0)
      fail(p.where("strata"), "\"yresolution\", {}, is not a multiple of the {} x {} \"strata\"", placement.height,
           strata[0], strata[1]);
    for (int i = 0; i < strata[0] * strata[1]; ++i) cells_.push_back({float(i % strata[0]), float(i / strata[0])});
    corner_ = {float(target[0]), float(target[2]), float(target[4])};
    rows_ = size_t(placement.height) / cells_.size();
    size_ = {float((target[1] - target[0]) / strata[0]), float((target[3] - target[2]) / strata[1])};
    distance_ = float(p.real("distance"));
  }

  /// The point on the target is a lens sample, so that it is stratified independently of the pixel position.
  Ray ray(Vec2 film, Vec2 lens) const override {
    const auto column = size_t(std::clamp(film.x, 0.f, float(toward_.size() - 1)));
    const Vec2 cell = cells_[std::min(size_t(std::max(film.y, 0.f)) / rows_, cells_.size() - 1)];
    const Vec3 on_target = corner_ + Vec3{(cell.x + lens.x) * size_.x, (cell.y + lens.y) * size_.y, 0};
    const Vec3& toward = toward_[column];
    return {world_from_camera_.point(on_target + toward * distance_),
            normalize_any(world_from_camera_.vector(-toward))};
  }
  /// The lens sample selects the point on the target.
  bool uses_lens() const override { return true; }
  /// Adjacent columns are unrelated directions, which a reconstruction filter must not mix.
  bool pixels_are_apart() const override { return true; }

 private:
  /// Returns the direction from zenith and azimuth in radians.
  static Vec3 direction(double zenith, double azimuth) {
    return {float(std::sin(zenith) * std::cos(azimuth)), float(std::sin(zenith) * std::sin(azimuth)),
            float(std::cos(zenith))};
  }

  Transform world_from_camera_;
  std::vector<Vec3> toward_;  ///< from the target to the sensor, unit
  Vec3 corner_;               ///< corner of the target with the smallest x and y, camera space
  Vec2 size_;                 ///< extent of a cell along x and y
  std::vector<Vec2> cells_;   ///< of the target: indices along x and y
  size_t rows_;               ///< number of rows of the film that see a cell, one after the other
  float distance_;            ///< from the target to the ray origins, along the direction
};

/// "target" and "distance" are lengths in camera space.
constexpr Param kDistant[] = {
    {.name = "zenith",
     .kind = ParamKind::real,
     .unit = "degrees",
     .doc = "Zenith angles of the view directions, from +z; negative angles are on the opposite side.",
     .list = true,
     .required = true,
     .quantity = PhysicalQuantity::angle},
    {.name = "azimuth",
     .kind = ParamKind::real,
     .unit = "degrees",
     .doc = "Azimuths from +x toward +y, one for each direction or one for all; by default 0.",
     .list = true},
    {.name = "target",
     .kind = ParamKind::real,
     .doc = "Rectangle that is seen, x0 x1 y0 y1 z; sampled uniformly.",
     .list = true,
     .required = true},
    {.name = "strata",
     .kind = ParamKind::integer,
     .range = {1, 1024},
     .doc =
         "Numbers of cells along x and y into which the target is divided; each is seen by equally many adjacent rows "
         "of the film. By default 1 and 1.",
     .list = true},
    {.name = "distance",
     .kind = ParamKind::real,
     .default_value = 0.0,
     .range = kAtLeastZero,
     .doc = "Distance from the target at which rays start; the scene must be below."}};

/// Factory of "distant". Throws InputError as the constructor does.
std::unique_ptr<Camera> make_distant(const Params& p, const CameraPlacement& film) {
  return std::make_unique<DistantCamera>(p, film);
}

}  // namespace

extern const CameraInfo distant_camera{
    {"camera", "distant", "Distant sensor: parallel rays, one direction for each column of the film.", "", kDistant},
    make_distant};

}  // namespace frond
