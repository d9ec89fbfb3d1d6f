#include "spectra/color/rgb_upsampling.h"

#include <cmath>

#include "spectra/analytic.h"
#include "spectra/cie.h"

namespace frond {
namespace {

constexpr Interval kNotNegative{0, std::numeric_limits<double>::infinity()};

/// XYZ under D65 of luminance 1 of the hat functions at the nodes: reflectances that are 1 at a node and fall linearly
/// to 0 at its neighbours. Nodes are spaced by a whole number of nanometres over kCieRange_nm.
struct Response {
  std::vector<Triple> at_node;
  double step_nm;

  explicit Response(int step) : step_nm(step) {
    const int length_nm = int(kCieRange_nm.max - kCieRange_nm.min);
    at_node.resize(static_cast<size_t>(length_nm / step) + 1);
    const double offset = 0.5 / std::sqrt(3.0);  // two-point Gauss rule, exact for cubics
    for (int nm = 0; nm < length_nm; ++nm)
      for (const double side : {-offset, offset}) add(nm + 0.5 + side, 0.5);
  }
  void add(double from_start_nm, double weight) {
    const double nm = kCieRange_nm.min + from_start_nm, x = from_start_nm / step_nm, t = x - std::floor(x);
    const Triple bar = cie_xyz(nm);
    const size_t i = static_cast<size_t>(x);
    for (size_t c = 0; c < 3; ++c) {
      const double xyz = weight * bar[c] * double(unit_d65()->at(static_cast<float>(nm)));
      at_node[i][c] += (1 - t) * xyz;
      at_node[i + 1][c] += t * xyz;
    }
  }
};

/// Response with few nodes, for the first iterations.
const Response& coarse_response() {
  static const Response r(5);
  return r;
}
/// Response with enough nodes for the steep edges of the reflectances of pure colours.
const Response& fine_response() {
  static const Response r(1);
  return r;
}

/// Difference between the XYZ of a reflectance and the target, and its derivatives by the coefficients.
struct Residual {
  Triple xyz;
  Matrix3 jacobian;
  double square() const { return xyz[0] * xyz[0] + xyz[1] * xyz[1] + xyz[2] * xyz[2]; }
  double largest() const { return std::max({std::abs(xyz[0]), std::abs(xyz[1]), std::abs(xyz[2])}); }
};

Residual residual(const Response& response, const Triple& c, const Triple& target) {
  Residual r{{-target[0], -target[1], -target[2]}, {}};
  const auto& nodes = response.at_node;
  const double step = 2 / static_cast<double>(nodes.size() - 1);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const double t = static_cast<double>(i) * step - 1, x = (c[0] * t + c[1]) * t + c[2];
    const double root = std::sqrt(1 + x * x), slope = 0.5 / (root * root * root);
    const double s = x < 0 ? 0.5 / (root * (root - x)) : 0.5 + 0.5 * x / root;
    for (size_t k = 0; k < 3; ++k) {
      r.xyz[k] += nodes[i][k] * s;
      const double d = nodes[i][k] * slope;
      r.jacobian.row[k][0] += d * t * t;
      r.jacobian.row[k][1] += d * t;
      r.jacobian.row[k][2] += d;
    }
  }
  return r;
}

/// Returns the Levenberg-Marquardt step: the Gauss-Newton step for damping 0, a short step along the negative gradient
/// for large damping.
Triple levenberg_marquardt_step(const Residual& r, double damping) {
  const auto& j = r.jacobian.row;
  Matrix3 normal;
  Triple gradient{};
  for (size_t a = 0; a < 3; ++a) {
    for (size_t k = 0; k < 3; ++k) gradient[a] -= j[k][a] * r.xyz[k];
    for (size_t b = 0; b < 3; ++b)
      for (size_t k = 0; k < 3; ++k) normal.row[a][b] += j[k][a] * j[k][b];
  }
  for (size_t a = 0; a < 3; ++a) normal.row[a][a] *= 1 + damping;
  return inverse(normal) * gradient;
}

/// Returns the coefficients of the flat reflectance of luminance y, the start of the iteration; exact for greys.
Triple initial_coefficients(double y) {
  y = std::clamp(y, 1e-6, 1 - 1e-6);
  return {0, 0, (y - 0.5) / std::sqrt(y * (1 - y))};
}

/// With larger coefficients the edges of the reflectance are narrower than the spacing of the nodes.
constexpr double kLargestCoefficient = 2000;

bool is_smooth(const Triple& c) {
  return std::all_of(c.begin(), c.end(), [](double x) { return std::abs(x) <= kLargestCoefficient; });
}

/// Improves the coefficients `c` by Levenberg-Marquardt steps; returns the remaining error, the largest in X, Y or Z.
double minimise_residual(const Response& response, const Triple& target, double damping, Triple& c) {
  constexpr double kSolved = 1e-7, kStuck = 1e9;
  constexpr int kMostSteps = 50;
  Residual best = residual(response, c, target);
  for (int i = 0; i < kMostSteps && best.largest() > kSolved && damping < kStuck; ++i) {
    const Triple d = levenberg_marquardt_step(best, damping);
    const Triple next{c[0] + d[0], c[1] + d[1], c[2] + d[2]};
    const Residual r = residual(response, next, target);
    const bool better = is_smooth(next) && r.square() < best.square();  // false for NaN
    damping *= better ? 0.1 : 4;
    if (better) c = next, best = r;
  }
  return best.largest();
}

/// Returns the XYZ that a reflectance of this colour must have. It is adapted to the white of the tabulated D65, which
/// differs in the fourth digit from the rounded one of the standards; without this, greys would not be flat.
Triple target_xyz(const ColorSpace& space, const Triple& rgb) {
  static const Matrix3 to_table_white = bradford(kD65White.xyz(), to_xyz(*unit_d65()));
  return to_table_white * (space.xyz_from_rgb * rgb);
}

bool is_grey(const Triple& rgb) { return rgb[0] == rgb[1] && rgb[1] == rgb[2]; }

/// Grey of any size.
SpectrumPtr flat(double value) { return std::make_shared<ConstantSpectrum>(static_cast<float>(value), kCieRange_nm); }

/// Multiple of a smooth reflectance.
class ReflectanceSpectrum final : public Spectrum {
 public:
  ReflectanceSpectrum(SigmoidPolynomial s, double scale) : reflectance_(s), scale_(static_cast<float>(scale)) {}
  float at(float lambda_nm) const override { return scale_ * reflectance_.at(lambda_nm); }
  Interval range_nm() const override { return kCieRange_nm; }
  float max_value() const override { return scale_ * reflectance_.max_value(); }

 private:
  SigmoidPolynomial reflectance_;
  float scale_;
};

/// Multiple of a smooth reflectance times D65 of luminance 1.
class IlluminantSpectrum final : public Spectrum {
 public:
  IlluminantSpectrum(SigmoidPolynomial s, double scale)
      : reflectance_(s), scale_(static_cast<float>(scale)), white_(unit_d65()) {}
  float at(float lambda_nm) const override { return scale_ * reflectance_.at(lambda_nm) * white_->at(lambda_nm); }
  Interval range_nm() const override { return kCieRange_nm; }
  float max_value() const override { return scale_ * reflectance_.max_value() * white_->max_value(); }  // a bound

 private:
  SigmoidPolynomial reflectance_;
  float scale_;
  SpectrumPtr white_;
};

std::string shown(const ColorSpace& space, const Triple& rgb) {
  return fmt::format("rgb ({}, {}, {}) of color space \"{}\"", rgb[0], rgb[1], rgb[2], space.name);
}

void check(const ColorSpace& space, const Triple& rgb, Interval range, const Location& where) {
  for (const double v : rgb)
    if (!range.contains(v) || !std::isfinite(v))
      fail(where, "{} lies outside {} to {}", shown(space, rgb), range.min, range.max);
}

}  // namespace

float SigmoidPolynomial::max_value() const {
  const float ends = std::max(sigmoid(c2_ - c1_ + c0_), sigmoid(c2_ + c1_ + c0_));
  const float vertex = c2_ < 0 ? c1_ / (-2 * c2_) : 2;
  return std::abs(vertex) < 1 ? std::max(ends, sigmoid((c2_ * vertex + c1_) * vertex + c0_)) : ends;
}

SigmoidFit fit_reflectance(const ColorSpace& space, const Triple& rgb) {
  const Triple target = target_xyz(space, rgb);
  Triple c = initial_coefficients(target[1]);
  minimise_residual(coarse_response(), target, 1e-3, c);
  const double error = minimise_residual(fine_response(), target, 1e-7, c);
  return {SigmoidPolynomial(c), error};
}

double reflectance_error(const ColorSpace& space, const Triple& rgb, const SigmoidPolynomial& reflectance) {
  return residual(fine_response(), reflectance.coefficients(), target_xyz(space, rgb)).largest();
}

/// The multiple is doubled until a reflectance of the scaled colour exists.
ScaledReflectance fit_scaled(const ColorSpace& space, const Triple& rgb, const Location& where) {
  const double largest = std::max({rgb[0], rgb[1], rgb[2]});
  for (double room = 2; room <= 64; room *= 2) {
    const double scale = room * largest;
    const SigmoidFit fit = fit_reflectance(space, Triple{rgb[0] / scale, rgb[1] / scale, rgb[2] / scale});
    if (fit.error * room <= kLargestFitError) return {fit.reflectance, scale};
  }
  fail(where, "{} is purer than any light can be", shown(space, rgb));
}

void refine_reflectance(const ColorSpace& space, const Triple& rgb, bool from_flat, Triple& c) {
  const Triple target = target_xyz(space, rgb);
  if (from_flat) c = initial_coefficients(target[1]);
  minimise_residual(coarse_response(), target, from_flat ? 1e-3 : 1e-6, c);
}

SpectrumPtr rgb_albedo(const ColorSpace& space, const Triple& rgb, const Location& where,
                       const std::function<void(const std::string&)>& warn) {
  check(space, rgb, {0, 1}, where);
  if (is_grey(rgb)) return flat(rgb[0]);
  const SigmoidFit fit = fit_reflectance(space, rgb);
  if (fit.error > kLargestFitError)
    warn(fmt::format("{} is brighter and purer than a surface can be: it is the nearest, with XYZ off by {:.3f}",
                     shown(space, rgb), fit.error));
  return std::make_shared<ReflectanceSpectrum>(fit.reflectance, 1);
}

SpectrumPtr rgb_unbounded(const ColorSpace& space, const Triple& rgb, const Location& where) {
  check(space, rgb, kNotNegative, where);
  if (is_grey(rgb)) return flat(rgb[0]);
  const ScaledReflectance s = fit_scaled(space, rgb, where);
  return std::make_shared<ReflectanceSpectrum>(s.reflectance, s.scale);
}

SpectrumPtr rgb_illuminant(const ColorSpace& space, const Triple& rgb, const Location& where) {
  check(space, rgb, kNotNegative, where);
  if (is_grey(rgb)) return std::make_shared<ScaledSpectrum>(unit_d65(), rgb[0]);
  const ScaledReflectance s = fit_scaled(space, rgb, where);
  return std::make_shared<IlluminantSpectrum>(s.reflectance, s.scale);
}

}  // namespace frond
