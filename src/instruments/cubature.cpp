#include "instruments/cubature.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "core/parallel.h"

namespace frond {
namespace {

constexpr int kOrder = 5;
struct Rule {
  std::array<double, kOrder> x, weight;  // on [0, 1]
};

Rule gauss_rule() {
  using Gauss = boost::math::quadrature::gauss<double, kOrder>;
  const auto& nodes = Gauss::abscissa();  // the nodes that are not negative, 0 first
  const auto& weights = Gauss::weights();
  Rule rule{};
  rule.x[0] = 0.5, rule.weight[0] = weights[0] / 2;
  for (size_t i = 1; i < nodes.size(); ++i) {
    rule.x[2 * i - 1] = (1 - nodes[i]) / 2, rule.x[2 * i] = (1 + nodes[i]) / 2;
    rule.weight[2 * i - 1] = rule.weight[2 * i] = weights[i] / 2;
  }
  return rule;
}

struct Value {
  double integral = 0, largest = 0;  // largest density at a node
};

/// A direction with its density.
struct Peak {
  double cos_theta, phi, density;
};

class Cubature {
 public:
  Cubature(const Density& density, double tolerance) : density_(density), tolerance_(tolerance) {}

  Value product_rule(const SphereBox& box) const {
    static const Rule rule = gauss_rule();
    Value value;
    for (size_t i = 0; i < kOrder; ++i)
      for (size_t j = 0; j < kOrder; ++j) {
        const double d = density_(box.at(rule.x[i], rule.x[j]));
        value.integral += rule.weight[i] * rule.weight[j] * d;
        value.largest = std::max(value.largest, d);
      }
    value.integral *= box.solid_angle();
    return value;
  }

  void refine(const SphereBox& box, const Value& whole, std::span<Peak> peaks, int depth,
              std::vector<SpherePart>& parts) const {
    check_stop();
    const double z = (box.z0 + box.z1) / 2, phi = (box.phi0 + box.phi1) / 2;
    const std::array<SphereBox, 4> quarters{{{box.z0, z, box.phi0, phi},
                                             {box.z0, z, phi, box.phi1},
                                             {z, box.z1, box.phi0, phi},
                                             {z, box.z1, phi, box.phi1}}};
    std::array<Value, 4> values;
    SpherePart part{.box = box};
    for (size_t i = 0; i < 4; ++i) {
      values[i] = product_rule(quarters[i]);
      part.integral += values[i].integral;
      part.largest = std::max(part.largest, values[i].largest);
    }
    double peak = 0;
    for (const Peak& p : peaks) peak = std::max(peak, p.density);
    const bool settled = rules_agree(whole, part) && !part.misses_lobe(peak);
    if (settled || depth == 0) {
      if (!settled) part.error = std::max(part.largest, peak) * box.solid_angle();
      parts.push_back(part);
      return;
    }
    for (size_t i = 0; i < 4; ++i) {
      const auto others = std::partition(peaks.begin(), peaks.end(), [&quarters, i](const Peak& p) {
        return quarters[i].contains(p.cos_theta, p.phi);
      });
      refine(quarters[i], values[i], peaks.first(size_t(others - peaks.begin())), depth - 1, parts);
    }
  }

 private:
  bool rules_agree(const Value& whole, const SpherePart& part) const {
    constexpr double kRelative = 1e-4;  // below it, float rounding of densities would cause subdivision
    constexpr double kUneven = 8;       // largest over mean: few nodes hit the lobe, and two rules may agree by chance
    return std::abs(part.integral - whole.integral) <= tolerance_ + kRelative * std::abs(part.integral) &&
           part.largest * part.box.solid_angle() <= tolerance_ + kUneven * part.integral;
  }

  const Density& density_;
  double tolerance_;
};

}  // namespace

std::vector<SpherePart> integrate(const SphereBox& box, const Density& density, double tolerance,
                                  std::span<const SpherePoint> peaks) {
  constexpr int kDeepest = 10;
  std::vector<Peak> known;
  known.reserve(peaks.size());
  for (const SpherePoint& p : peaks) known.push_back({p.cos_theta, p.phi, density(p.w)});
  const Cubature cubature(density, tolerance);
  std::vector<SpherePart> parts;
  cubature.refine(box, cubature.product_rule(box), known, kDeepest, parts);
  return parts;
}

double total(std::span<const SpherePart> parts) {
  double sum = 0;
  for (const SpherePart& part : parts) sum += part.integral;
  return sum;
}

double total_error(std::span<const SpherePart> parts) {
  double sum = 0;
  for (const SpherePart& part : parts) sum += part.error;
  return sum;
}

PartSampler::PartSampler(std::vector<SpherePart> parts) : parts_(std::move(parts)) {
  double area = 0;
  for (const SpherePart& part : parts_) area += part.box.solid_angle();
  const double integral = total(parts_);
  double sum = 0;
  for (const SpherePart& part : parts_) {
    const double by_area = part.box.solid_angle() / area;
    sum += integral > 0 ? (by_area + part.integral / integral) / 2 : by_area;
    cumulative_.push_back(sum);
  }
}

PartSampler::Draw PartSampler::draw(RandomStream& numbers) const {
  const double u = numbers.uniform_double() * cumulative_.back();
  const auto chosen = std::min<size_t>(
      static_cast<size_t>(std::ranges::upper_bound(cumulative_, u) - cumulative_.begin()), parts_.size() - 1);
  const double probability = cumulative_[chosen] - (chosen > 0 ? cumulative_[chosen - 1] : 0);
  const SphereBox& box = parts_[chosen].box;
  const double a = numbers.uniform_open(), b = numbers.uniform_open();
  return {box.at(a, b), probability / box.solid_angle()};
}

}  // namespace frond
