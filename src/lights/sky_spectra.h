#pragma once

#include <algorithm>
#include <vector>

#include "core/spectrum.h"
#include "lights/sky_model.h"

namespace frond {

/// Spectra of the sun's disc and of the sky, linear between the same points. A look-up takes constant time, while that
/// of a TabulatedSpectrum, a binary search for each lane and spectrum, took longer than all other calls of the light.
class SkySpectra {
 public:
  struct Sample {
    SampledSpectrum sky, disc;
  };
  SkySpectra() = default;
  SkySpectra(const SkyModel& model, double sky_factor, double disc_factor) : first_(float(model.nm.front())) {
    for (size_t i = 0; i < model.nm.size(); ++i)
      points_.push_back({float(model.nm[i]), float(model.diffuse[i] * sky_factor),
                         float(model.direct_normal[i] * disc_factor),
                         i + 1 < model.nm.size() ? float(1 / (model.nm[i + 1] - model.nm[i])) : 0});
    const auto bins = size_t((model.nm.back() - model.nm.front()) / kBin_nm) + 1;
    for (size_t bin = 0, i = 0; bin < bins; ++bin) {
      while (i + 2 < points_.size() && double(points_[i + 1].nm) <= model.nm.front() + double(bin) * kBin_nm) ++i;
      guide_.push_back(uint8_t(i));
    }
  }
  Sample at(const SampledWavelengths& lambda) const {
    if (lambda.count == kLanes) {
      // Not written lane by lane, since the load of the register would then wait for the stores (HACKING.md).
      const Values a = at(lambda.nm[0]), b = at(lambda.nm[1]), c = at(lambda.nm[2]), d = at(lambda.nm[3]);
      return {SampledSpectrum(Float4{a.sky, b.sky, c.sky, d.sky}),
              SampledSpectrum(Float4{a.disc, b.disc, c.disc, d.disc})};
    }
    Sample s;
    for (int lane = 0; lane < lambda.count; ++lane) {
      const Values v = at(lambda.nm[size_t(lane)]);
      s.sky[lane] = v.sky, s.disc[lane] = v.disc;
    }
    return s;
  }

 private:
  struct Values {
    float sky, disc;
  };
  Values at(float lambda_nm) const {
    const float nm = std::clamp(lambda_nm, first_, points_.back().nm);
    size_t i = guide_[size_t((nm - first_) * float(1 / kBin_nm))];
    if (nm >= points_[i + 1].nm && i + 2 < points_.size()) ++i;  // at most one point in a bin
    const Point &low = points_[i], &high = points_[i + 1];
    const float t = (nm - low.nm) * low.per_nm;
    return {low.sky + t * (high.sky - low.sky), low.disc + t * (high.disc - low.disc)};
  }

  static constexpr double kBin_nm = 2.5;  ///< less than the distance of any two points
  struct Point {
    float nm, sky, disc;
    float per_nm;  ///< 1 / distance to the next point
  };
  float first_ = 0;
  std::vector<Point> points_;
  std::vector<uint8_t> guide_;  ///< the last point up to the begin of each bin
};

}  // namespace frond
