#include "materials/measured/tensor_brdf.h"

#include <cmath>

#include "materials/lobes/active_lanes.h"

namespace frond {
namespace {

using Field = TensorFile::Field;

// The unit square of directions: u = sqrt(2 theta / pi), which has more nodes near the normal, and v = phi / 2 pi +
// 1/2.
float theta_to_u(float theta) { return std::sqrt(theta * (2 / kPi)); }
float u_to_theta(float u) { return u * u * (kPi / 2); }
float phi_to_v(float phi) {
  const float v = phi * (0.5f * kInvPi) + 0.5f;
  return v - std::floor(v);
}
float polar(const Vec3& w) { return std::atan2(std::hypot(w.x, w.y), w.z); }

/// Solid angle of half vectors per area of the unit square. At the normal it is 0; the bound keeps densities finite.
float half_vector_jacobian(float u, float sine) { return std::max(2 * kPi * kPi * u * sine, 1e-6f); }

std::vector<float> ascending(const TensorFile& file, const Field& field) {
  std::vector<float> nodes = file.numbers(field);
  if (std::ranges::adjacent_find(nodes, std::greater_equal()) != nodes.end())
    file.reject(fmt::format("field \"{}\" does not ascend", field.name));
  return nodes;
}

/// Checks that a field begins with these sizes and ends with a grid of at least 2 x 2.
void check_shape(const TensorFile& file, const Field& field, std::initializer_list<size_t> first) {
  if (!std::ranges::equal(first, std::span(field.shape).first(first.size())))
    file.reject(fmt::format("the shape of field \"{}\" does not fit phi_i, theta_i and wavelengths", field.name));
  if (field.shape[first.size()] < 2 || field.shape[first.size() + 1] < 2)
    file.reject(fmt::format("field \"{}\" needs a grid of 2 x 2 values or more", field.name));
}

template <class Stack>
Stack stack(const TensorFile& file, const Field& field, float least) {
  const size_t dimensions = field.shape.size();
  return Stack(file.numbers(field, least), field.shape[dimensions - 1], field.shape[dimensions - 2]);
}

/// BRDF of a tensor file, the same on both sides.
class TensorBsdf final : public Bsdf {
 public:
  TensorBsdf(const TensorBrdf& data, const SampledWavelengths& lambda)
      : data_(data), cells_(cells_of(data.nm(), lambda)), mask_(lane_mask(lambda)) {}

  Lobes flags() const override { return Lobes::reflection | Lobes::glossy; }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    if (!same_side(wo, wi)) return {};
    const Vec3 above = to_upper_side(wo, wo);
    return f(data_.outgoing(above), above, to_upper_side(wo, wi)).f;
  }

  float pdf(const Vec3& wo, const Vec3& wi) const override {
    if (!same_side(wo, wi)) return 0;
    const Vec3 above = to_upper_side(wo, wo);
    return data_.at(data_.outgoing(above), above, to_upper_side(wo, wi)).pdf;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream&) const override {
    if (wo.z == 0) return {};
    const Vec3 above = to_upper_side(wo, wo);
    const TensorBrdf::Outgoing out = data_.outgoing(above);
    const Vec3 wi = data_.sample(out, above, u);
    if (!(wi.z > 0)) return {};
    const auto [value, density] = f(out, above, wi);
    if (!(density > 0)) return {};
    return BsdfSample{value, to_upper_side(wo, wi), density, flags()};
  }

 private:
  struct Values {
    SampledSpectrum f;
    float pdf;
  };
  /// Turns directions seen from below the surface upwards, and back.
  static Vec3 to_upper_side(const Vec3& wo, const Vec3& w) { return wo.z < 0 ? -w : w; }
  Values f(const TensorBrdf::Outgoing& out, const Vec3& wo, const Vec3& wi) const {
    const TensorBrdf::At at = data_.at(out, wo, wi);
    return {data_.spectrum(out.mix, at.u, cells_) * mask_ * at.per_unit, at.pdf};
  }

  const TensorBrdf& data_;
  std::array<leaf::AxisCell, kLanes> cells_;
  SampledSpectrum mask_;
};

}  // namespace

TensorBrdf::TensorBrdf(const TensorFile& file) {
  if (!file.has("spectra") && file.has("rgb"))
    file.reject("it has colours instead of spectra; use the file of the same material with spectra (_spec.bsdf)");
  phi_ = ascending(file, file.floats("phi_i", 1));
  theta_ = ascending(file, file.floats("theta_i", 1));
  nm_ = ascending(file, file.floats("wavelengths", 1));
  const Field &ndf = file.floats("ndf", 2), &sigma = file.floats("sigma", 2), &vndf = file.floats("vndf", 4),
              &luminance = file.floats("luminance", 4), &spectra = file.floats("spectra", 5);
  check_shape(file, ndf, {}), check_shape(file, sigma, {});
  check_shape(file, vndf, {phi_.size(), theta_.size()}), check_shape(file, luminance, {phi_.size(), theta_.size()});
  check_shape(file, spectra, {phi_.size(), theta_.size(), nm_.size()});
  isotropic_ = phi_.size() <= 2;
  // Files of materials with symmetries have azimuths in a part of the circle.
  if (!isotropic_ && std::abs(phi_.back() - phi_.front() - 2 * kPi) > 0.01f)
    file.reject(
        fmt::format("its azimuths phi_i span {:.4g} degrees; 360 are needed, or at most two azimuths for an "
                    "isotropic material",
                    double(phi_.back() - phi_.front()) * 180 / double(kPi)));
  ndf_ = stack<BilinearStack>(file, ndf, 0), sigma_ = stack<BilinearStack>(file, sigma, 0);
  vndf_ = stack<BilinearDensity>(file, vndf, 0), luminance_ = stack<BilinearDensity>(file, luminance, 0);
  spectra_ = stack<BilinearStack>(file, spectra, TensorFile::kAnyNumber);
}

const Bsdf* TensorBrdf::bsdf(const SampledWavelengths& lambda, Arena& arena) const {
  return arena.make<TensorBsdf>(*this, lambda);
}

TensorBrdf::Outgoing TensorBrdf::outgoing(const Vec3& wo) const {
  Outgoing out{polar(wo), std::atan2(wo.y, wo.x), {}};
  const leaf::AxisCell p = cell_of(phi_, out.phi), t = cell_of(theta_, out.theta);
  const auto columns = static_cast<uint32_t>(theta_.size());
  const uint32_t first = p.below * columns + t.below;
  out.mix.add(first, (1 - p.t) * (1 - t.t)), out.mix.add(first + 1, (1 - p.t) * t.t);
  out.mix.add(first + columns, p.t * (1 - t.t)), out.mix.add(first + columns + 1, p.t * t.t);
  return out;
}

TensorBrdf::At TensorBrdf::at(const Outgoing& out, const Vec3& wo, const Vec3& wi) const {
  const Vec3 m = normalize_any(wo + wi);
  const float sine = std::hypot(m.x, m.y), phi = std::atan2(m.y, m.x);
  const Vec2 at_m{theta_to_u(polar(m)), phi_to_v(isotropic_ ? phi - out.phi : phi)};
  const auto [u, density] = vndf_.invert(out.mix, at_m);
  const float area = sigma_.value(0, sigma_.cell({theta_to_u(out.theta), phi_to_v(out.phi)}));
  const float per_unit = area > 0 ? ndf_.value(0, ndf_.cell(at_m)) / (4 * area * wi.z) : 0;
  const float jacobian = 4 * dot(wo, m) * half_vector_jacobian(at_m.x, sine);
  return {u, per_unit, density * luminance_.value(out.mix, luminance_.cell(u)) / jacobian};
}

Vec3 TensorBrdf::sample(const Outgoing& out, const Vec3& wo, Vec2 u) const {
  const Vec2 at_m = vndf_.sample(out.mix, luminance_.sample(out.mix, u).p).p;
  const float theta = u_to_theta(at_m.x), phi = (2 * at_m.y - 1) * kPi + (isotropic_ ? out.phi : 0);
  const float sine = std::sin(theta);
  const Vec3 m{sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)};
  return normalize_any(2 * dot(wo, m) * m - wo);
}

SampledSpectrum TensorBrdf::spectrum(const SliceMix& mix, Vec2 u,
                                     const std::array<leaf::AxisCell, kLanes>& cells) const {
  const BilinearStack::Cell place = spectra_.cell(u);
  SampledSpectrum values;
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto [below, t] = cells[size_t(lane)];
    float value = 0;
    for (uint32_t i = 0; i < mix.count; ++i) {
      const size_t slice = mix.slice[i] * nm_.size() + below;
      value += mix.weight[i] * (1 - t) * spectra_.value(slice, place);
      if (t > 0) value += mix.weight[i] * t * spectra_.value(slice + 1, place);
    }
    values[lane] = std::max(0.f, value);  // measurements have noise about 0
  }
  return values;
}

std::unique_ptr<MeasuredData> read_tensor_brdf(std::string bytes, const std::string& name, const Location& where) {
  return std::make_unique<TensorBrdf>(TensorFile(std::move(bytes), name, where));
}

}  // namespace frond
