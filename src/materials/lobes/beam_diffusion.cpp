#include "materials/lobes/beam_diffusion.h"

#include <cmath>

#include "core/math/vec.h"
#include "materials/lobes/catmull_rom.h"
#include "materials/lobes/fresnel.h"

namespace frond {
namespace {

constexpr int kDepths = 100;  // of the beam

/// Depth of a quantile of the light that a beam loses: midpoints of equal shares.
double depth(int i, double sigma) { return -std::log1p(-(i + 0.5) / kDepths) / sigma; }

/// BeamMedium with sigma_t = 1.
struct BeamMedium {
  double albedo, g, eta;
  double inside, inside2;  ///< first and second moment of the Fresnel reflectance from inside

  /// Light that leaves at a radius after one scattering: the beam's points below the cone of total reflection.
  double single_scattering(double r) const {
    const double nearest = r * std::sqrt(std::max(0.0, eta * eta - 1));
    double sum = 0;
    for (int i = 0; i < kDepths; ++i) {
      const double z = nearest + depth(i, 1), way = std::hypot(r, z), cosine = z / way;
      // The beam comes from above: light that returns has the cosine -cosine of the scattering angle.
      const double base = 1 + g * g + 2 * g * cosine;
      const double phase = (1 - g * g) / (4 * kPiD * base * std::sqrt(base));
      const double leaves = 1 - double(fresnel_dielectric(float(cosine), float(1 / eta)));
      sum += albedo * std::exp(-(way + nearest)) / (way * way) * phase * leaves * cosine;
    }
    return sum / kDepths;
  }

  /// Light that leaves at a radius after more scatterings: a dipole for each point of the beam, with Grosjean's
  /// diffusion coefficient.
  double multiple_scattering(double r) const {
    const double sigma_a = 1 - albedo, reduced = albedo * (1 - g), sigma_t = sigma_a + reduced;
    const double diffusion = (2 * sigma_a + reduced) / (3 * sigma_t * sigma_t);
    const double decay = std::sqrt(sigma_a / diffusion);
    const double boundary = -2 * diffusion * (1 + 3 * inside2) / (1 - 2 * inside);
    const double of_fluence = (1 - 2 * inside) / 4, of_flux = (1 - 3 * inside2) / 2;
    double sum = 0;
    for (int i = 0; i < kDepths; ++i) {
      const double real = depth(i, sigma_t), mirrored = 2 * boundary - real;
      const double to_real = std::hypot(r, real), to_mirrored = std::hypot(r, mirrored);
      const double real_decay = std::exp(-decay * to_real), mirrored_decay = std::exp(-decay * to_mirrored);
      const double fluence = (real_decay / to_real - mirrored_decay / to_mirrored) / diffusion;
      const auto flux = [&](double z, double way, double decayed) {
        return z * (1 + decay * way) * decayed / (way * way * way);
      };
      const double normal_flux = flux(real, to_real, real_decay) - flux(mirrored, to_mirrored, mirrored_decay);
      // Habel et al.'s correction of the diffusion near the beam.
      const double correction = 1 - std::exp(-2 * sigma_t * (to_real + real));
      sum += correction * (fluence * of_fluence + normal_flux * of_flux);
    }
    const double share = reduced / sigma_t;
    return share * share * sum / (4 * kPiD * kDepths);
  }
};

}  // namespace

double fresnel_moment(double eta, int power) {
  constexpr int kSteps = 4096;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    sum += double(fresnel_dielectric(float(cosine), float(eta))) * std::pow(cosine, power);
  }
  return sum / kSteps;
}

/// Radii grow by a fifth from step to step, albedos approach 1: nodes of pbrt-v4.
BeamDiffusion::BeamDiffusion(double g, double eta, const ThreadPool& pool)
    : radii_{0, 2.5e-3f}, reflectance_(kAlbedos), farthest_(kAlbedos), density_(kAlbedos * kRadii), within_(density_) {
  while (radii_.size() < kRadii) radii_.push_back(radii_.back() * 1.2f);
  for (size_t i = 0; i < kAlbedos; ++i)
    albedos_.push_back(float(std::expm1(-8. * double(i) / (kAlbedos - 1)) / std::expm1(-8.)));
  const double inside = fresnel_moment(1 / eta, 1), inside2 = fresnel_moment(1 / eta, 2);
  pool.for_each(int64_t{kAlbedos}, [&](int64_t row, int) {
    const BeamMedium medium{double(albedos_[size_t(row)]), g, eta, inside, inside2};
    const std::span density(&density_[size_t(row) * kRadii], kRadii), within(&within_[size_t(row) * kRadii], kRadii);
    for (size_t i = 0; i < kRadii; ++i) {
      const double r = double(radii_[i]);
      density[i] = float(2 * kPiD * r * (medium.single_scattering(r) + medium.multiple_scattering(r)));
    }
    for (size_t i = 0; i + 1 < kRadii; ++i)
      within[i + 1] = within[i] + (radii_[i + 1] - radii_[i]) *
                                      catmull_rom(radii_, i, [&](size_t k) { return density[k]; }).integral(1);
    reflectance_[size_t(row)] = within.back();
    size_t last = 1;
    while (last + 1 < kRadii && within[last] < 0.999f * within.back()) ++last;
    farthest_[size_t(row)] = radii_[last];
  });
  for (size_t i = 0; i <= kSteps; ++i) {
    const float part = float(i) / kSteps;
    steps_.push_back(float(i));
    inverse_.push_back(find_albedo(reflectance_.back() * part * part));
  }
}

float BeamDiffusion::reflectance(float albedo) const { return BeamProfile(*this, albedo).reflectance(); }

float BeamDiffusion::find_albedo(float reflectance) const {
  if (!(reflectance > reflectance_.front())) return albedos_.front();
  if (!(reflectance < reflectance_.back())) return albedos_.back();
  const auto value = [&](size_t k) { return reflectance_[k]; };
  const size_t i = segment_of(kAlbedos, reflectance, value);
  const CubicSegment segment = catmull_rom(albedos_, i, value);
  const float t =
      increasing_root([&](float x) { return segment.at(x) - reflectance; }, [&](float x) { return segment.slope(x); });
  return albedos_[i] + t * (albedos_[i + 1] - albedos_[i]);
}

/// Looked up: to find the root at each hit took a quarter of the time of a render of berries. The albedo grows steeply
/// with small reflectances, if scattering is forward: the steps are those of the square root.
float BeamDiffusion::albedo(float reflectance) const {
  const float place = std::sqrt(reflectance / reflectance_.back()) * kSteps;
  if (!(place > 0)) return inverse_.front();
  if (!(place < kSteps)) return inverse_.back();
  const auto i = size_t(place);
  const CubicSegment segment = catmull_rom(steps_, i, [&](size_t k) { return inverse_[k]; });
  return std::min(segment.at(place - float(i)), inverse_.back());
}

/// The spline is linear in its values: its weights are splines of values that are 1 at one node.
BeamProfile::BeamProfile(const BeamDiffusion& table, float albedo) : table_(&table) {
  const std::vector<float>& nodes = table.albedos_;
  const size_t i = segment_of(nodes.size(), albedo, [&](size_t k) { return nodes[k]; });
  const float t = std::clamp((albedo - nodes[i]) / (nodes[i + 1] - nodes[i]), 0.f, 1.f);
  first_ = std::clamp<size_t>(i, 1, nodes.size() - 3) - 1;
  for (size_t j = 0; j < weights_.size(); ++j) {
    weights_[j] = catmull_rom(nodes, i, [&](size_t k) { return k == first_ + j ? 1.f : 0.f; }).at(t);
    reflectance_ += weights_[j] * table.reflectance_[first_ + j];
    if (weights_[j] != 0) farthest_ = std::max(farthest_, table.farthest_[first_ + j]);
  }
  if (!(reflectance_ > 1)) return;
  for (float& weight : weights_) weight /= reflectance_;
  reflectance_ = 1;
}

float BeamProfile::row(const std::vector<float>& values, size_t radius) const {
  float sum = 0;
  for (size_t j = 0; j < weights_.size(); ++j)
    sum += weights_[j] * values[(first_ + j) * BeamDiffusion::kRadii + radius];
  return sum;
}

float BeamProfile::at(float radius) const {
  const std::vector<float>& nodes = table_->radii_;
  if (!(radius > 0 && radius < nodes.back())) return 0;
  const size_t i = segment_of(nodes.size(), radius, [&](size_t k) { return nodes[k]; });
  const CubicSegment segment = catmull_rom(nodes, i, [&](size_t k) { return row(table_->density_, k); });
  return std::max(0.f, segment.at((radius - nodes[i]) / (nodes[i + 1] - nodes[i]))) / (2 * kPi * radius);
}

float BeamProfile::radius(float u) const {
  const std::vector<float>& nodes = table_->radii_;
  const float within = u * reflectance_;
  const auto integral = [&](size_t k) { return row(table_->within_, k); };
  const size_t i = segment_of(nodes.size(), within, integral);
  const float width = nodes[i + 1] - nodes[i], rest = (within - integral(i)) / width;
  const CubicSegment segment = catmull_rom(nodes, i, [&](size_t k) { return row(table_->density_, k); });
  const float t =
      increasing_root([&](float x) { return segment.integral(x) - rest; }, [&](float x) { return segment.at(x); });
  return nodes[i] + t * width;
}

}  // namespace frond
