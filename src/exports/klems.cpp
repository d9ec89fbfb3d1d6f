#include "exports/klems.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

namespace frond {
namespace {

/// A quadrature rule.
struct Rule {
  std::vector<double> x, weight;  // on [0, 1]
};

/// Gauss-Legendre rule with N nodes.
template <int N>
Rule gauss_rule() {
  using Gauss = boost::math::quadrature::gauss<double, N>;
  Rule rule;
  for (size_t i = 0; i < Gauss::abscissa().size(); ++i)  // boost lists the non-negative half
    for (const double sign : {-1.0, 1.0}) {
      const double x = Gauss::abscissa()[i];
      if (x == 0 && sign > 0) continue;
      rule.x.push_back((1 + sign * x) / 2), rule.weight.push_back(Gauss::weights()[i] / 2);
    }
  return rule;
}

constexpr std::array kOrders{2, 3, 5, 8, 12};

/// Rules are computed once.
const Rule& rule_of(size_t level) {
  static const std::array<Rule, kOrders.size()> rules{gauss_rule<2>(), gauss_rule<3>(), gauss_rule<5>(),
                                                      gauss_rule<8>(), gauss_rule<12>()};
  return rules[level];
}

/// Position of a patch: its ring and its column within the ring.
struct Place {
  const KlemsBasis::Ring& ring;
  int column;
};

/// Returns ring and column of a patch.
Place place_of(size_t patch) {
  auto ring = KlemsBasis::kRings.begin();
  for (; patch >= size_t(ring->phis); ++ring) patch -= size_t(ring->phis);
  return {*ring, int(patch)};
}

double cosine(double deg) { return deg == 90 ? 0 : std::cos(deg * std::numbers::pi / 180); }

using Nodes = std::vector<KlemsBasis::Node>;

/// Returns the nodes of a patch at a level (index of kOrders). All are computed once.
const Nodes& nodes_of(size_t patch, size_t level) {
  static const auto all = [] {
    std::array<std::vector<Nodes>, kOrders.size()> levels;
    for (size_t l = 0; l < levels.size(); ++l)
      for (size_t p = 0; p < KlemsBasis::kPatches; ++p) levels[l].push_back(KlemsBasis::nodes(p, kOrders[l]));
    return levels;
  }();
  return all[level][patch];
}

Vec3 incoming(const Vec3& w, bool front) { return {-w.x, -w.y, front ? w.z : -w.z}; }
Vec3 outgoing(const Vec3& w, bool front) { return {w.x, w.y, front ? w.z : -w.z}; }

using Lanes = std::array<double, kLanes>;

/// Mean of f over one pair of patches, at one level.
class PairMean {
 public:
  PairMean(const ExportedBsdf::At& f, bool light_in_front, bool seen_in_front, size_t in, size_t out)
      : f_(f), light_in_front_(light_in_front), seen_in_front_(seen_in_front), in_(in), out_(out) {}

  Lanes at(size_t level) const {
    Lanes sum{};
    for (const auto& a : nodes_of(in_, level)) {
      const Vec3 light = incoming(a.w, light_in_front_);
      for (const auto& b : nodes_of(out_, level)) {
        const SampledSpectrum value = f_(light, outgoing(b.w, seen_in_front_));
        for (int i = 0; i < kLanes; ++i) sum[size_t(i)] += a.weight * b.weight * double(value[i]);
      }
    }
    return sum;
  }

 private:
  const ExportedBsdf::At& f_;
  bool light_in_front_, seen_in_front_;
  size_t in_, out_;
};

/// Result of the adaptive integration of a pair.
struct PairIntegral {
  Lanes mean;
  double error;  ///< of pi f
  bool holds;
};

/// Raises the order until two results agree within the tolerance.
PairIntegral integrate_to_tolerance(const PairMean& pair) {
  constexpr double kAbsolute = 2e-5, kRelative = 2e-4;  // of pi f
  PairIntegral s{pair.at(0), 0, false};
  for (size_t level = 1; level < kOrders.size() && !s.holds; ++level) {
    const Lanes before = s.mean;
    s = {pair.at(level), 0, true};
    for (size_t i = 0; i < kLanes; ++i) {
      const double difference = std::numbers::pi * std::abs(s.mean[i] - before[i]);
      s.error = std::max(s.error, difference);
      s.holds = s.holds && difference <= kAbsolute + kRelative * std::numbers::pi * s.mean[i];
    }
  }
  return s;
}

}  // namespace

/// Analytic: the sphere's projected area between two polar angles, over the number of patches.
double KlemsBasis::projected_solid_angle(size_t patch) {
  const auto [ring, column] = place_of(patch);
  const double a = cosine(ring.theta_min_deg), b = cosine(ring.theta_max_deg);
  return std::numbers::pi * (a * a - b * b) / ring.phis;
}

std::vector<KlemsBasis::Node> KlemsBasis::nodes(size_t patch, int order) {
  const auto [ring, column] = place_of(patch);
  const Rule& rule = rule_of(size_t(std::ranges::find(kOrders, order) - kOrders.begin()));
  const double low = cosine(ring.theta_max_deg), high = cosine(ring.theta_min_deg);
  const double width = 2 * std::numbers::pi / ring.phis;
  std::vector<Node> nodes;
  for (size_t i = 0; i < rule.x.size(); ++i) {
    const double mu = low + rule.x[i] * (high - low), s = std::sqrt(1 - mu * mu);
    const double share = rule.weight[i] * 2 * mu / (high + low);
    const auto add = [&](double phi, double weight) {
      nodes.push_back({{float(s * std::cos(phi)), float(s * std::sin(phi)), float(mu)}, share * weight});
    };
    if (ring.phis == 1)  // even steps are Gauss's rule for periodic functions
      for (int j = 0; j < 2 * order; ++j) add(std::numbers::pi * (j + 0.5) / order, 0.5 / order);
    else
      for (size_t j = 0; j < rule.x.size(); ++j) add(width * (column - 0.5 + rule.x[j]), rule.weight[j]);
  }
  return nodes;
}

KlemsMatrices::KlemsMatrices(const ExportMaterial& material, const std::vector<double>& wavelengths_nm)
    : f_(wavelengths_nm.size() * 4 * KlemsBasis::kPatches * KlemsBasis::kPatches) {
  size_t first = 0;
  for (const std::vector<double>& run : split_into_lanes(wavelengths_nm)) {
    const ExportedBsdf bsdf(material, run);
    struct Worst {
      double error = 0;
      size_t unconverged = 0;
    };
    std::array<Worst, 4 * KlemsBasis::kPatches> worst{};
    material.pool.for_each(int64_t(worst.size()), [&](int64_t row, int) {
      const ExportedBsdf::At f(bsdf);
      const size_t in = size_t(row) % KlemsBasis::kPatches, block = size_t(row) / KlemsBasis::kPatches;
      const bool light_in_front = block < 2, reflected = block % 2 == 0;
      const LitSide lit = light_in_front ? LitSide::front : LitSide::back;
      for (size_t out = 0; out < KlemsBasis::kPatches; ++out) {
        const PairIntegral s =
            integrate_to_tolerance(PairMean(f, light_in_front, light_in_front == reflected, in, out));
        for (size_t i = 0; i < run.size(); ++i)
          f_[place(first + i, lit, reflected) + out * KlemsBasis::kPatches + in] = float(s.mean[i]);
        Worst& w = worst[size_t(row)];
        w.error = std::max(w.error, s.error);
        w.unconverged += !s.holds;
      }
    });
    for (const Worst& w : worst) error_ = std::max(error_, w.error), unconverged_ += w.unconverged;
    first += run.size();
  }
}

}  // namespace frond
