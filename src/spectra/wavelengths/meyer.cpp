#include "spectra/color/color_space.h"
#include "spectra/wavelengths/registry.h"
#include "spectra/wavelengths/weighted_polynomials.h"

namespace frond {
namespace {

constexpr std::string_view kWhites[] = {"published", "D65"};
constexpr Param kMeyerParams[] = {
    {.name = "white",
     .kind = ParamKind::string,
     .default_value = std::string_view("published"),
     .doc = "published: the quadrature as it is, by which D65 comes out bluish (Z is 10 % too large). D65: X, Y and Z "
            "are scaled so that D65 has its own colour.",
     .choices = kWhites},
};

/// Matrix from XYZ to Meyer's opponent space: achromatic (A), red-green (C1), blue-yellow (C2). Its axes decorrelate
/// the responses of the cones (Buchsbaum and Gottschalk 1983), so that the less important ones need fewer quadrature
/// points.
constexpr Matrix3 kOpponent{{{{-0.0177, 1.0090, 0.0073}, {-1.5370, 1.0821, 0.3209}, {0.1946, -0.2045, 0.5264}}}};

/// Orthogonal polynomials under one axis of the opponent space as a function of wavelength.
WeightedPolynomials axis(size_t row, size_t degree) {
  return {[row](double nm) { return (kOpponent * cie_xyz(nm))[row]; }, degree};
}

/// Four wavelengths (nm) and the XYZ of a unit of radiance at each.
struct Quadrature {
  std::array<float, kLanes> nm;
  std::array<Triple, kLanes> xyz;
};

/// Gaussian quadrature with 3 points for A, 2 for C1 and 1 for C2 has six wavelengths. C1's two are close to the outer
/// two of A and replace them; A's weights then follow from interpolation. The rule is exact for polynomials in
/// wavelength of degree 2 (A), 3 (C1) and 1 (C2).
Quadrature make_quadrature() {
  const WeightedPolynomials a = axis(0, 3), c1 = axis(1, 2), c2 = axis(2, 1);
  const std::vector<double> c2_nm{c2.root(1, 450)}, c1_nm{c1.root(2, 490), c1.root(2, 630)};
  const std::vector<double> a_nm{c1_nm[0], a.root(3, 560), c1_nm[1]};
  const std::vector<double> a_weights = a.rule(a_nm), c1_weights = c1.rule(c1_nm), c2_weights = c2.rule(c2_nm);
  const Matrix3 to_xyz = inverse(kOpponent);
  return {{static_cast<float>(c2_nm[0]), static_cast<float>(a_nm[0]), static_cast<float>(a_nm[1]),
           static_cast<float>(a_nm[2])},
          {to_xyz * Triple{0, 0, c2_weights[0]}, to_xyz * Triple{a_weights[0], c1_weights[0], 0},
           to_xyz * Triple{a_weights[1], 0, 0}, to_xyz * Triple{a_weights[2], c1_weights[1], 0}}};
}

class Meyer final : public WavelengthStrategy {
 public:
  explicit Meyer(const Params& p) : quadrature_(make_quadrature()) {
    lambda_.nm = quadrature_.nm;
    lambda_.pdf.fill(1);
    lambda_.active.fill(true);
    lambda_.count = kLanes;
    if (p.string("white") == "D65") normalise_to_d65();
  }

  SampledWavelengths sample(float) const override { return lambda_; }
  Interval range_nm() const override { return {double(lambda_.nm.front()), double(lambda_.nm.back())}; }
  std::span<const float> fixed_nm() const override { return lambda_.nm; }
  SensorResponse sensor(const SampledSpectrum& radiance, const SampledWavelengths&) const override {
    Triple xyz{};
    for (size_t i = 0; i < kLanes; ++i)
      for (size_t c = 0; c < 3; ++c) xyz[c] += double(radiance.v[i]) * quadrature_.xyz[i][c];
    return xyz;
  }
  std::string_view film_space() const override { return kXyzName; }

 private:
  /// Scales X, Y and Z so that D65 has its exact colour.
  void normalise_to_d65() {
    const Triple ours = sensor(unit_d65()->sample(lambda_), lambda_).color(), exact = to_xyz(*unit_d65());
    for (Triple& xyz : quadrature_.xyz)
      for (size_t c = 0; c < 3; ++c) xyz[c] *= exact[c] / ours[c];
  }

  Quadrature quadrature_;
  SampledWavelengths lambda_;
};

}  // namespace

extern const WavelengthsInfo meyer_wavelengths{
    {"wavelengths", "meyer", "456, 491, 558 and 631 nm: a quadrature of what the eye's opponent channels see.",
     "Meyer 1988, Wavelength Selection for Synthetic Image Generation", kMeyerParams},
    [](const Params& p) -> std::unique_ptr<WavelengthStrategy> { return std::make_unique<Meyer>(p); }};

}  // namespace frond
