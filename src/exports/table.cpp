#include "exports/table.h"

#include <cmath>

#include "core/math/vec.h"
#include "instruments/goniophotometer.h"

namespace frond {
namespace {

/// Returns multiples of `step` below `end`.
std::vector<double> steps(double step, double end) {
  std::vector<double> numbers;
  for (int i = 0; i * step < end; ++i) numbers.push_back(i * step);
  return numbers;
}

/// Returns the axes of a request, with defaults for empty lists.
BsdfTable axes_of(const ExportRequest& request) {
  constexpr double kStep_deg = 5, kAzimuthStep_deg = 15;
  const auto or_else = [](const std::vector<double>& given, const std::vector<double>& own) {
    return given.empty() ? own : given;
  };
  BsdfTable table;
  table.wavelengths_nm = request.wavelengths_nm;
  table.theta_i_deg = or_else(request.theta_i_deg, steps(kStep_deg, 90));
  table.theta_o_deg = or_else(request.theta_o_deg, steps(kStep_deg, 90));
  table.phi_o_deg = or_else(request.phi_o_deg, steps(kAzimuthStep_deg, 360));
  return table;
}

/// Returns the unit vector of angles in degrees, on the front or the back.
Vec3 direction(double theta_deg, double phi_deg, bool front) {
  const double s = std::sin(theta_deg * kDegree), c = std::cos(theta_deg * kDegree);
  return {float(s * std::cos(phi_deg * kDegree)), float(s * std::sin(phi_deg * kDegree)), float(front ? c : -c)};
}

/// Fills f and integrates R and T, one direction of the light at a time.
void fill(const ExportedBsdf& bsdf, const ExportMaterial& material, size_t wavelength, BsdfTable& table) {
  constexpr int kThetas = 4, kPhis = 6;  // initial patches, which are subdivided where necessary
  const size_t angles = table.theta_i_deg.size(), views = table.theta_o_deg.size() * table.phi_o_deg.size() * 2;
  const ThreadPool alone(1);
  material.pool.for_each(int64_t(angles * 2), [&](int64_t index, int) {
    const bool front = size_t(index) < angles;
    const double theta_i = table.theta_i_deg[size_t(index) % angles];
    const size_t row = wavelength * angles * 2 + size_t(index);
    const LitMaterial lit{.material = bsdf.material(),
                          .beam = {front ? theta_i : 180 - theta_i, bsdf.wavelengths_nm()[0]},
                          .as_rendered = true};
    const GoniophotometerMeasurement measurement = integrate_f(lit, DetectorSphere(kThetas, kPhis), alone);
    table.reflectance[row] = measurement.share(true).mean;
    table.transmittance[row] = measurement.share(false).mean;
    const ExportedBsdf::At f(bsdf);
    const Vec3 light = direction(theta_i, 0, front);
    size_t i = row * views;
    for (const double theta_o : table.theta_o_deg)
      for (const double phi_o : table.phi_o_deg)
        for (const bool reflected : {true, false})
          table.f[i++] = f(light, direction(theta_o, phi_o, front == reflected))[0];
  });
}

}  // namespace

void check_table(const ExportRequest& request) {
  constexpr double kMost = 1 << 28;
  if (request.wavelengths_nm.empty()) fail({}, "a table needs wavelengths, as in 400:700:10");
  check_ascending("wavelengths", request.wavelengths_nm);
  check_ascending("angles", request.theta_i_deg);
  check_ascending("view angles", request.theta_o_deg);
  check_ascending("view azimuths", request.phi_o_deg);
  const BsdfTable axes = axes_of(request);
  const double numbers = double(axes.wavelengths_nm.size()) * 4 * double(axes.theta_i_deg.size()) *
                         double(axes.theta_o_deg.size()) * double(axes.phi_o_deg.size());
  if (numbers > kMost) fail({}, "a table of {:.3g} numbers was asked for; {:.3g} are the most", numbers, kMost);
}

BsdfTable make_table(const ExportMaterial& material, const ExportRequest& request) {
  BsdfTable table = axes_of(request);
  const size_t rows = table.wavelengths_nm.size() * 2 * table.theta_i_deg.size();
  table.reflectance.resize(rows), table.transmittance.resize(rows);
  table.f.resize(rows * table.theta_o_deg.size() * table.phi_o_deg.size() * 2);
  for (size_t w = 0; w < table.wavelengths_nm.size(); ++w)
    fill(ExportedBsdf(material, {table.wavelengths_nm[w]}), material, w, table);
  return table;
}

}  // namespace frond
