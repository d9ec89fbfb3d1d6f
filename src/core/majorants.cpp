#include "core/majorants.h"

#include <algorithm>
#include <cmath>

namespace frond {

void MajorantGrid::raise_bound(const Vec3& low, const Vec3& high, float density) {
  std::array<int, 3> first, last, c;
  const auto cell = [this](float share) { return int(std::clamp(std::floor(share * float(n_)), 0.f, float(n_ - 1))); };
  for (int axis = 0; axis < 3; ++axis) {
    if (high[axis] < 0 || low[axis] > 1) return;
    first[size_t(axis)] = cell(low[axis]), last[size_t(axis)] = cell(high[axis]);
  }
  for (c[2] = first[2]; c[2] <= last[2]; ++c[2])
    for (c[1] = first[1]; c[1] <= last[1]; ++c[1])
      for (c[0] = first[0]; c[0] <= last[0]; ++c[0]) cells_[index(c)] = std::max(cells_[index(c)], density);
}

MajorantSteps::MajorantSteps(const MajorantGrid& grid, const Ray& ray, float begin, float end,
                             const SampledSpectrum& sigma)
    : begin_(begin), end_(end), sigma_(sigma), grid_(&grid) {
  const int n = grid.cells_per_axis();
  const Vec3 at = ray.o + ray.d * begin;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = size_t(axis);
    const float d = ray.d[axis];
    cell_[i] = int(std::clamp(std::floor(at[axis] * float(n)), 0.f, float(n - 1)));
    direction_[i] = d < 0 ? -1 : 1;
    delta_[i] = 1 / (std::abs(d) * float(n));  // infinity if the ray is parallel to the axis' planes
    const float border = float(cell_[i] + (d < 0 ? 0 : 1)) / float(n);
    next_crossing_[i] = d == 0 ? INFINITY : begin + (border - at[axis]) / d;
  }
}

bool MajorantSteps::next(Step& step) {
  if (!(begin_ < end_)) return false;
  if (!grid_) {
    step = {begin_, end_, sigma_};
    begin_ = end_;
    return true;
  }
  size_t axis = next_crossing_[0] < next_crossing_[1] ? 0 : 1;
  if (next_crossing_[2] < next_crossing_[axis]) axis = 2;
  // A crossing that rounding puts before the piece's beginning gives a piece of length 0.
  const float exit = std::clamp(next_crossing_[axis], begin_, end_);
  step = {begin_, exit, sigma_ * grid_->at(cell_)};
  begin_ = exit;
  cell_[axis] += direction_[axis];
  next_crossing_[axis] += delta_[axis];
  if (cell_[axis] < 0 || cell_[axis] >= grid_->cells_per_axis()) begin_ = end_;
  return true;
}

Vec3 MediumBox::local_to_unit(const Vec3& local) const {
  const Vec3 from = local - bounds_.min, size = bounds_.max - bounds_.min;
  return {from.x / size.x, from.y / size.y, from.z / size.z};
}

/// The three pairs of planes, as in Kay and Kajiya 1986.
bool MediumBox::clip(const Ray& ray, float& begin, float& end, Ray& in_box) const {
  const Vec3 d = medium_from_world_.vector(ray.d), size = bounds_.max - bounds_.min;
  in_box = {world_to_unit(ray.o), {d.x / size.x, d.y / size.y, d.z / size.z}, ray.t_max};
  begin = 0, end = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const float o = in_box.o[axis], along = in_box.d[axis];
    if (along == 0) {
      if (o < 0 || o > 1) return false;
      continue;
    }
    const float a = -o / along, b = (1 - o) / along;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin < end;
}

}  // namespace frond
