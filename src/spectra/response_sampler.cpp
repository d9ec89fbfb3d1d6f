#include "spectra/response_sampler.h"

#include <algorithm>
#include <cmath>

namespace frond {
namespace {

constexpr size_t kCells = 1024;

}  // namespace

ResponseSampler::ResponseSampler(SpectrumPtr response, const Location& where)
    : response_(std::move(response)),
      first_nm_(response_->range_nm().min),
      cell_nm_((response_->range_nm().max - first_nm_) / kCells) {
  const auto at = [this](double nm) { return double(response_->at(static_cast<float>(nm))); };
  for (size_t i = 0; i < kCells; ++i) {
    // Simpson's rule.
    const double begin = at(edge(i)), middle = at(edge(i) + cell_nm_ / 2), end = at(edge(i + 1));
    const double area = cell_nm_ * (begin + 4 * middle + end) / 6;
    if (area > 0) support_nm_ = {area_ == 0 ? edge(i) : support_nm_.min, edge(i + 1)};
    area_ += area;
    centroid_nm_ += area * (edge(i) + cell_nm_ / 2);
    cumulative_.push_back(area_);
  }
  if (!(area_ > 0)) fail(where, "this response is 0 at every wavelength");
  centroid_nm_ /= area_;
  for (double& c : cumulative_) c /= area_;
}

ResponseSampler::Sample ResponseSampler::sample(float u) const {
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), double(u));
  const auto cell = std::min(static_cast<size_t>(found - cumulative_.begin()), kCells - 1);
  const double below = cell == 0 ? 0 : cumulative_[cell - 1], share = cumulative_[cell] - below;
  const double nm = edge(cell) + cell_nm_ * std::clamp((double(u) - below) / share, 0.0, 1.0);
  // Within a cell wavelengths are drawn evenly; the response there over its mean in the cell makes up for it.
  const double density = share / cell_nm_, wanted = double(response_->at(static_cast<float>(nm))) / area_;
  return {static_cast<float>(nm), static_cast<float>(wanted / density)};
}

}  // namespace frond
