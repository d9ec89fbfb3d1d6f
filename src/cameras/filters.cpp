#include <cmath>
#include <functional>

#include "core/filter.h"
#include "core/math/distribution.h"

namespace frond {
namespace {

constexpr Interval kFilterSizes{1e-6, 1e6};
/// Limits the radius of splatting, so that a sample reaches at most half a tile.
constexpr float kWidestSplat = 8.5f;

/// Quantile of the triangle distribution on [-1, 1].
float sample_tent(float u) { return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(std::max(0.f, 2 - 2 * u)); }

/// Filter radius along x and y, pixels.
Vec2 radius_of(const Params& p) {
  return {static_cast<float>(p.real("xradius")), static_cast<float>(p.real("yradius"))};
}

/// Base of all filters: the product of a function of x and the same function of y.
class ProductFilter : public Filter {
 public:
  explicit ProductFilter(const Params& p) : radius_(radius_of(p)) {
    const std::string word = p.string("reconstruction");
    if (word == "auto") return;
    reconstruction_ = word == "splatting" ? Reconstruction::splatting : Reconstruction::importance;
    if (reconstruction_ == Reconstruction::splatting && std::max(radius_.x, radius_.y) > kWidestSplat)
      fail(p.where("reconstruction"), "\"splatting\" takes filters with radii of {} pixels at most", kWidestSplat);
  }
  bool stays_in_pixel() const final { return radius_.x <= 0.5f && radius_.y <= 0.5f; }
  Vec2 radius() const final { return radius_; }
  Vec2 evaluate_axes(Vec2 offset) const final {
    return {evaluate_axis(offset.x, radius_.x), evaluate_axis(offset.y, radius_.y)};
  }
  std::optional<Reconstruction> reconstruction() const final { return reconstruction_; }

 protected:
  /// Returns the value at an offset within the radius; both in pixels.
  virtual double value(double offset, double radius) const = 0;

 private:
  /// Returns the value along one axis; 0 beyond the radius.
  float evaluate_axis(float offset, float radius) const {
    return std::abs(offset) > radius ? 0 : float(value(double(offset), double(radius)));
  }
  Vec2 radius_;
  std::optional<Reconstruction> reconstruction_;
};

/// Samples are uniform over the radius, with weight 1.
class BoxFilter final : public ProductFilter {
 public:
  using ProductFilter::ProductFilter;
  Sample sample(Vec2 u) const override { return {{(2 * u.x - 1) * radius().x, (2 * u.y - 1) * radius().y}, 1}; }

 private:
  double value(double, double) const override { return 1; }
};

/// Samples are exactly proportional to the filter, so that all weights are 1.
class TriangleFilter final : public ProductFilter {
 public:
  using ProductFilter::ProductFilter;
  Sample sample(Vec2 u) const override { return {{sample_tent(u.x) * radius().x, sample_tent(u.y) * radius().y}, 1}; }

 private:
  double value(double offset, double radius) const override { return 1 - std::abs(offset) / radius; }
};

/// Tabulates the function once for each axis and samples it by its absolute value.
class TabulatedFilter final : public ProductFilter {
 public:
  using Shape = std::function<double(double offset, double radius)>;
  TabulatedFilter(const Params& p, Shape shape)
      : ProductFilter(p), shape_(std::move(shape)), x_(radius().x, shape_), y_(radius().y, shape_) {
    if (!x_.is_usable() || !y_.is_usable())
      fail(p.where(), "this filter is 0 within its radius; change its parameters");
  }
  /// Returns an offset and its weight. The weight is negative in the negative lobes of a filter.
  Sample sample(Vec2 u) const override {
    const auto [x, wx] = x_.sample(u.x);
    const auto [y, wy] = y_.sample(u.y);
    return {{x, y}, wx * wy};
  }

 private:
  double value(double offset, double radius) const override { return shape_(offset, radius); }

  /// Piecewise constant table of the filter along one axis; samples have the density of its absolute value (pbrt 4th
  /// ed., 8.8.2).
  class Axis {
   public:
    Axis(float radius, const Shape& value)
        : radius_(radius), cells_(tabulate(radius, value)), magnitude_(absolute(cells_)) {
      double sum = 0, absolute_sum = 0;
      for (const float c : cells_) sum += c, absolute_sum += std::abs(c);
      weight_ = static_cast<float>(absolute_sum / sum);
    }
    /// False if the filter integrates to 0 or less: its weights could not be normalized.
    bool is_usable() const { return std::isfinite(weight_) && weight_ > 0; }
    /// Returns an offset in pixels and a weight, whose expected value is 1.
    std::pair<float, float> sample(float u) const {
      const auto [cell, fraction, pdf] = magnitude_.sample(u);
      const float t = (static_cast<float>(cell) + fraction) / static_cast<float>(cells_.size());
      return {(2 * t - 1) * radius_, cells_[cell] < 0 ? -weight_ : weight_};
    }

   private:
    static constexpr int kCells = 256;
    /// Returns the values at the centres of the cells from -radius to radius.
    static std::vector<float> tabulate(float radius, const Shape& value) {
      std::vector<float> cells;
      for (int i = 0; i < kCells; ++i)
        cells.push_back(static_cast<float>(
            value((2 * (i + 0.5) / kCells - 1) * static_cast<double>(radius), static_cast<double>(radius))));
      return cells;
    }
    static std::vector<float> absolute(std::vector<float> cells) {
      for (float& c : cells) c = std::abs(c);
      return cells;
    }
    float radius_;  ///< pixels
    std::vector<float> cells_;
    Distribution1D magnitude_;
    float weight_;  ///< ratio of the integral of the absolute value to the integral
  };
  Shape shape_;
  Axis x_, y_;
};

/// Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics"; x in units of half the radius.
double mitchell(double x, double b, double c) {
  x = std::abs(x);
  if (x <= 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
  if (x <= 2)
    return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6;
  return 0;
}

/// Normalized sinc, sin(pi x) / (pi x). Near 0 it is 1 up to 2e-10.
double sinc(double x) { return std::abs(x) < 1e-5 ? 1 : std::sin(M_PI * x) / (M_PI * x); }

/// The value at the radius is subtracted, as in pbrt, so that the filter has no step at its end.
std::unique_ptr<Filter> make_gaussian(const Params& p) {
  const double sigma = p.real("sigma");
  return std::make_unique<TabulatedFilter>(p, [sigma](double x, double radius) {
    const auto g = [sigma](double v) { return std::exp(-v * v / (2 * sigma * sigma)); };
    return std::max(0.0, g(x) - g(radius));
  });
}

/// Mitchell's filter has a width of 4 of its own units, hence the factor.
std::unique_ptr<Filter> make_mitchell(const Params& p) {
  const double b = p.real("B"), c = p.real("C");
  return std::make_unique<TabulatedFilter>(p,
                                           [b, c](double x, double radius) { return mitchell(2 * x / radius, b, c); });
}

/// Lanczos window: a sinc of `tau` cycles.
std::unique_ptr<Filter> make_sinc(const Params& p) {
  const double tau = p.real("tau");
  return std::make_unique<TabulatedFilter>(p, [tau](double x, double) { return sinc(x) * sinc(x / tau); });
}

template <class T>
std::unique_ptr<Filter> make_filter(const Params& p) {
  return std::make_unique<T>(p);
}

/// Radius along one axis.
constexpr Param radius(std::string_view name, double value) {
  return {.name = name,
          .kind = ParamKind::real,
          .default_value = value,
          .unit = "pixels",
          .range = kFilterSizes,
          .doc = "Radius: half the filter's width."};
}

constexpr std::string_view kReconstructions[] = {"auto", "splatting", "importance"};
constexpr Param kReconstruction{.name = "reconstruction",
                                .kind = ParamKind::string,
                                .default_value = std::string_view("auto"),
                                .doc =
                                    "splatting: a sample counts in all pixels within the radius; importance: each "
                                    "pixel samples the filter; auto: less "
                                    "noise (docs/rendering.md).",
                                .choices = kReconstructions};

constexpr Param kBox[] = {radius("xradius", 0.5), radius("yradius", 0.5), kReconstruction};
constexpr Param kTriangle[] = {radius("xradius", 2), radius("yradius", 2), kReconstruction};
constexpr Param kGaussian[] = {radius("xradius", 1.5),
                               radius("yradius", 1.5),
                               {.name = "sigma",
                                .kind = ParamKind::real,
                                .default_value = 0.5,
                                .unit = "pixels",
                                .range = kFilterSizes,
                                .doc = "Standard deviation."},
                               kReconstruction};
constexpr Param kMitchell[] = {
    radius("xradius", 2),
    radius("yradius", 2),
    {.name = "B", .kind = ParamKind::real, .default_value = 1.0 / 3, .range = {0, 1}, .doc = "Coefficient B (blur)."},
    {.name = "C",
     .kind = ParamKind::real,
     .default_value = 1.0 / 3,
     .range = {0, 1},
     .doc = "Coefficient C (ringing)."},
    kReconstruction};
constexpr Param kSinc[] = {radius("xradius", 4),
                           radius("yradius", 4),
                           {.name = "tau",
                            .kind = ParamKind::real,
                            .default_value = 3.0,
                            .range = kFilterSizes,
                            .doc = "Number of cycles of the window."},
                           kReconstruction};

}  // namespace

extern const FilterInfo box_filter{{"pixel filter", "box", "Box: equal weight over a rectangle.", "", kBox},
                                   make_filter<BoxFilter>};
extern const FilterInfo triangle_filter{
    {"pixel filter", "triangle", "Triangle: weight that falls linearly.", "", kTriangle}, make_filter<TriangleFilter>};
extern const FilterInfo gaussian_filter{
    {"pixel filter", "gaussian", "Gaussian, shifted to end at zero.", "", kGaussian}, make_gaussian};
extern const FilterInfo mitchell_filter{
    {"pixel filter", "mitchell", "Cubic filter with negative lobes.", "Mitchell and Netravali 1988", kMitchell},
    make_mitchell};
extern const FilterInfo sinc_filter{{"pixel filter", "sinc", "Sinc with a Lanczos window.", "Lanczos window", kSinc},
                                    make_sinc};

}  // namespace frond
