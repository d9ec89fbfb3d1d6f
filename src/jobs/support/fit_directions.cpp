#include "jobs/support/fit_directions.h"

#include <map>
#include <set>

#include "core/math/vec.h"
#include "instruments/beam.h"
#include "materials/measured/goniometer_rows.h"
#include "render/measured_material.h"
#include "system/file_bytes.h"

namespace frond {
namespace {

/// Sums over the rows of one kind, incidence and wavelength.
struct Sums {
  double weight = 0, measured = 0, fitted = 0, squares = 0, noise = 0;
  size_t rows = 0;
};

/// Unit vector at an angle from the normal and an azimuth from x, in the frame of a flat leaf.
Vec3 direction(double theta_deg, double phi_deg) {
  const double sine = std::sin(theta_deg * kDegree);
  return to_float(
      Vec3d{sine * std::cos(phi_deg * kDegree), sine * std::sin(phi_deg * kDegree), std::cos(theta_deg * kDegree)});
}

}  // namespace

Table compare_directions(const JobRun& run, const std::string& path, const std::string& material) {
  const std::vector<GoniometerRow> rows = parse_goniometer_rows(read_file_bytes(path, {}, "goniometer table"), path);
  std::set<double> nm;
  for (const GoniometerRow& row : rows) nm.insert(row.wavelength_nm);
  const std::vector<double> wavelengths(nm.begin(), nm.end());
  const MeasuredMaterial leaf(material, run.session().registry(), wavelengths, run.session().pool(), silent_log(), {});
  std::map<std::tuple<bool, double, double>, Sums> sums;
  Arena arena;
  RandomStream unused(1);
  for (const GoniometerRow& row : rows) {
    run.check_stop();
    const auto wavelength = size_t(std::distance(nm.begin(), nm.find(row.wavelength_nm)));
    const Beam beam{row.incidence_deg, row.wavelength_nm};
    arena.reset();
    // The incident direction of a leaf's model is wo (docs/conventions.md).
    const Bsdf& bsdf = bsdf_of(leaf.at(wavelength), beam, arena);
    const double f = double(bsdf.f(toward_light(beam), direction(row.theta_deg, row.phi_deg), unused)[0]);
    const double weight = row.projected_solid_angle > 0 ? row.projected_solid_angle : 1;
    Sums& s = sums[{!row.is_reflected(), row.incidence_deg, row.wavelength_nm}];
    s.weight += weight, s.measured += weight * row.f, s.fitted += weight * f, ++s.rows;
    s.squares += weight * (f - row.f) * (f - row.f), s.noise += weight * row.error * row.error;
  }
  Table table{"directions"};
  for (const auto& [key, s] : sums) {
    const auto& [transmitted, incidence, lambda] = key;
    table.add("kind", std::string(transmitted ? "BTDF" : "BRDF"));
    table.add("incidence_deg", incidence);
    table.add("wavelength_nm", lambda);
    table.add("rows", double(s.rows));
    table.add("measured_per_sr", s.measured / s.weight);
    table.add("fitted_per_sr", s.fitted / s.weight);
    table.add("rms_per_sr", std::sqrt(s.squares / s.weight));
    table.add("noise_per_sr", std::sqrt(s.noise / s.weight));
  }
  table.document("measured_per_sr", "mean f of the goniometer table, 1/sr");
  table.document("fitted_per_sr", "mean f of the fitted leaf, 1/sr");
  table.document("rms_per_sr", "RMS difference of the two, 1/sr");
  table.document("noise_per_sr", "RMS of the standard errors of the goniometer table, 1/sr");
  return table;
}

std::string directions_text(const Table& directions) {
  const auto numbers = [&directions](const char* name) -> const std::vector<double>& {
    return std::get<std::vector<double>>(directions.find(name)->values);
  };
  const auto& kinds = std::get<std::vector<std::string>>(directions.find("kind")->values);
  std::string text = "by direction, the fitted leaf against the goniometer table\n";
  for (const char* kind : {"BRDF", "BTDF"}) {
    double squares = 0, noise = 0, measured = 0, fitted = 0, count = 0;
    for (size_t i = 0; i < kinds.size(); ++i) {
      if (kinds[i] != kind) continue;
      squares += numbers("rms_per_sr")[i] * numbers("rms_per_sr")[i];
      noise += numbers("noise_per_sr")[i] * numbers("noise_per_sr")[i];
      measured += numbers("measured_per_sr")[i], fitted += numbers("fitted_per_sr")[i], ++count;
    }
    if (count > 0)
      text += fmt::format("  {}   RMS {:.4f} 1/sr, of which noise {:.4f}   mean {:.4f}, fitted {:.4f}\n", kind,
                          std::sqrt(squares / count), std::sqrt(noise / count), measured / count, fitted / count);
  }
  return text;
}

}  // namespace frond
