#include "spectra/soil.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "spectra/data_files.h"
#include "spectra/named_tables.h"

namespace frond {
namespace {

constexpr float kSoilFirst_nm = 400, kSoilStep_nm = 10;  // of soil.csv

// BSM's constants.
constexpr double kSoilIndex = 2;       // refractive index of the soil's grains
constexpr double kFilm_m = 0.00015;    // thickness of a film of water
constexpr double kCapacity = 25;       // percent of the volume that raises the mean number of films by 1
constexpr int kMostFilms = 6;          // on one point
constexpr double kIncidence_deg = 40;  // light from the air falls on the water within this cone

/// Refractive index of water at 20 degrees Celsius: Daimon and Masumura 2007, Applied Optics 46:3811-3820. The fit ends
/// at 1129 nm; at 2500 nm it exceeds Hale and Querry's table (1973) by 0.006.
double water_index(double lambda_nm) {
  constexpr double kStrength[] = {5.684027565e-1, 1.726177391e-1, 2.086189578e-2, 1.130748688e-1};
  constexpr double kResonance_um2[] = {5.101829712e-3, 1.821153936e-2, 2.620722293e-2, 1.069792721e1};
  const double square_um2 = lambda_nm * lambda_nm * 1e-6;
  double squared_index = 1;
  for (size_t i = 0; i < std::size(kStrength); ++i)
    squared_index += kStrength[i] * square_um2 / (square_um2 - kResonance_um2[i]);
  return std::sqrt(squared_index);
}

/// Transmittance of an interface for unpolarised light (Fresnel) from the side of the smaller index; `index` >= 1 is
/// the ratio of the indices, `sin2` the squared sine of the angle of incidence.
double transmittance(double sin2, double index) {
  const double cos_in = std::sqrt(1 - sin2), cos_out = std::sqrt(1 - sin2 / (index * index));
  const double s = (cos_in - index * cos_out) / (cos_in + index * cos_out);
  const double p = (index * cos_in - cos_out) / (index * cos_in + cos_out);
  return 1 - (s * s + p * p) / 2;
}

/// Returns the mean transmittance of an interface for isotropic radiance within a cone: "tav" of Stern 1964 (Applied
/// Optics 3:111-113). By the midpoint rule over the squared sine, whose error is below 1e-4 for 90 degrees.
double mean_transmittance(double cone_deg, double index) {
  constexpr int kSteps = 500;
  const double most = std::pow(std::sin(cone_deg * std::numbers::pi / 180), 2);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += transmittance((i + 0.5) / kSteps * most, index);
  return sum / kSteps;
}

}  // namespace

Soil::Soil(const Coefficients& coefficients) {
  constexpr std::string_view kVectors[] = {"dry1", "dry2", "dry3", "wet"};
  std::vector<double> dry;
  for (size_t i = 0; i < coefficients.size(); ++i) {
    const auto vector = table_column(soil_csv, kVectors[i]);
    dry.resize(vector.size());
    for (size_t j = 0; j < vector.size(); ++j) dry[j] += coefficients[i] * vector[j].value;
  }
  prepare(dry);
}

Soil::Soil(const Spectrum& dry) {
  std::vector<double> values;
  for (const auto& point : table_column(soil_csv, "water-k")) values.push_back(dry.at(float(point.lambda_nm)));
  prepare(values);
}

void Soil::prepare(const std::vector<double>& dry) {
  const auto absorption = table_column(soil_csv, "water-k");  // 1/m
  const double grains = mean_transmittance(90, kSoilIndex);
  for (size_t j = 0; j < dry.size(); ++j) {
    const double r = std::clamp(dry[j], 0., 1.), n = water_index(absorption[j].lambda_nm);
    // Lekner and Dorf 1988: light leaves the grains more easily into water, whose index is closer to theirs.
    const double submerged = 1 - (1 - r) * (r * mean_transmittance(90, kSoilIndex / n) / grains + 1 - r);
    optics_.push_back({float(r), float(submerged), float(1 - mean_transmittance(kIncidence_deg, n)),
                       float(1 - mean_transmittance(90, n) / (n * n)),
                       float(std::exp(-2 * absorption[j].value * kFilm_m))});
    max_ = std::max({max_, optics_.back().dry, optics_.back().below_films(1)});
  }
}

float Soil::reflectance(float lambda_nm, float moisture) const {
  const float x = std::clamp((lambda_nm - kSoilFirst_nm) / kSoilStep_nm, 0.f, float(optics_.size() - 1));
  const size_t i = std::min(size_t(x), optics_.size() - 2);
  const float t = x - float(i);
  const Optics &a = optics_[i], &b = optics_[i + 1];
  const auto mix = [t](float from, float to) { return from + t * (to - from); };
  const float dry = mix(a.dry, b.dry);
  const float films = (std::min(moisture, float(kMoisture.max)) - float(kMoisture.min)) / float(kCapacity);
  if (films <= 0) return dry;
  const Optics here{dry, mix(a.submerged, b.submerged), mix(a.surface, b.surface), mix(a.enclosed, b.enclosed),
                    mix(a.film, b.film)};
  // The number of films on a point has a Poisson distribution.
  float probability = std::exp(-films), attenuation = 1, sum = probability * dry;
  for (int k = 1; k <= kMostFilms; ++k) {
    probability *= films / float(k);
    attenuation *= here.film;
    sum += probability * here.below_films(attenuation);
  }
  return sum;
}

}  // namespace frond
