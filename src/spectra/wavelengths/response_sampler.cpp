#include "spectra/wavelengths/response_sampler.h"

#include <algorithm>
#include <cmath>

#include "spectra/wavelengths/spectrum_points.h"

namespace frond {
namespace {

/// Inverts the cumulative distribution of the density that is linear from `a` at 0 to `b` at 1: returns x with
/// distribution `u`. This form of the quadratic's root has no cancellation and holds for a = b.
double invert_line(double a, double b, double u) {
  if (u <= 0) return 0;
  const double begin = a / (a + b), end = b / (a + b);
  return u / (begin + std::sqrt(std::lerp(begin * begin, end * end, u)));
}

/// Value of a response at a wavelength within it.
double value_at(std::span<const ResponsePoint> response, double nm) {
  const auto above = std::ranges::lower_bound(response, nm, {}, &ResponsePoint::nm);
  if (above == response.end()) return response.back().value;
  if (above == response.begin() || above->nm == nm) return above->value;
  const ResponsePoint &a = above[-1], &b = *above;
  return std::lerp(a.value, b.value, (nm - a.nm) / (b.nm - a.nm));
}

double integral(std::span<const ResponsePoint> points) {
  double sum = 0;
  for (size_t i = 1; i < points.size(); ++i)
    sum += (points[i].nm - points[i - 1].nm) * (points[i].value + points[i - 1].value) / 2;
  return sum;
}

}  // namespace

ResponseSampler::ResponseSampler(std::vector<ResponsePoint> points, const Location& where)
    : points_(std::move(points)) {
  double area = 0, moment = 0;  // moment about the first point
  for (size_t i = 1; i < points_.size(); ++i) {
    const auto [begin_nm, a] = points_[i - 1];
    const auto [end_nm, b] = points_[i];
    const double width = end_nm - begin_nm, from = begin_nm - points_[0].nm;
    area += width * (a + b) / 2;
    moment += width * (from * (a + b) / 2 + width * (a + 2 * b) / 6);
    cumulative_.push_back(area);
  }
  if (!(area > 0)) fail(where, "this response is 0 at every wavelength");
  centroid_nm_ = points_[0].nm + moment / area;
  const auto rounded = [](double nm) { return double(static_cast<float>(nm)); };  // samples are floats
  support_nm_ = {rounded(points_.front().nm), rounded(points_.back().nm)};
}

float ResponseSampler::sample(float u) const {
  constexpr float kBelowOne = 1 - 0x1p-24f;
  const double wanted = double(std::min(u, kBelowOne)) * cumulative_.back();
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), wanted);
  const auto cell = static_cast<size_t>(found - cumulative_.begin());
  const double below = cell == 0 ? 0 : cumulative_[cell - 1], share = cumulative_[cell] - below;
  const auto [begin_nm, a] = points_[cell];
  const auto [end_nm, b] = points_[cell + 1];
  return static_cast<float>(std::lerp(begin_nm, end_nm, invert_line(a, b, (wanted - below) / share)));
}

std::vector<ResponsePoint> lit_response(std::span<const ResponsePoint> response, const Spectrum& light) {
  struct Factors {
    double nm, response, light;
  };
  std::vector<double> nm = points_nm(light, {response.front().nm, response.back().nm});
  for (const ResponsePoint& p : response) nm.push_back(p.nm);
  std::ranges::sort(nm);
  nm.erase(std::ranges::unique(nm).begin(), nm.end());
  std::vector<Factors> factors;
  double largest = 0;
  for (const double at : nm) {
    factors.push_back({at, value_at(response, at), double(light.at(static_cast<float>(at)))});
    largest = std::max(largest, factors.back().response * factors.back().light);
  }
  std::vector<ResponsePoint> product;
  for (size_t i = 0; i < factors.size(); ++i) {
    if (i > 0) {
      // A chord of the product of two lines misses at most a quarter of the product of their rises.
      constexpr double kWithin = 1e-6;
      const Factors &a = factors[i - 1], &b = factors[i];
      const double rises = std::abs((b.response - a.response) * (b.light - a.light));
      const double parts = std::ceil(std::sqrt(rises / (4 * kWithin * std::max(largest, rises))));
      for (double k = 1; k < parts; ++k)
        product.push_back({std::lerp(a.nm, b.nm, k / parts),
                           std::lerp(a.response, b.response, k / parts) * std::lerp(a.light, b.light, k / parts)});
    }
    product.push_back({factors[i].nm, factors[i].response * factors[i].light});
  }
  return without_margins(product);
}

double mean_under(std::span<const ResponsePoint> response, const Spectrum& spectrum) {
  return integral(lit_response(response, spectrum)) / integral(response);
}

std::vector<ResponsePoint> without_margins(std::span<const ResponsePoint> points) {
  const auto is_lit = [](const ResponsePoint& p) { return p.value != 0; };
  auto begin = std::ranges::find_if(points, is_lit);
  if (begin == points.end()) return {};
  auto end = std::find_if(points.rbegin(), points.rend(), is_lit).base();
  if (begin != points.begin()) --begin;
  if (end != points.end()) ++end;
  return {begin, end};
}

}  // namespace frond
