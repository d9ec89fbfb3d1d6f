#include "report/patch_tables.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/text_output.h"

namespace frond {
namespace {

constexpr const char* kNotes[] = {
    "incidence_deg: from the front's normal to the light, degrees; above 90 the back (abaxial side) is lit.",
    ("Detectors: patches equal in theta (from the front's normal) and in phi (from the light's azimuth), degrees; the "
     "first is centred on phi = 0, and the mirror direction lies at phi = 180."),
    ("f_per_sr: BRDF (on the lit side) or BTDF, 1/sr: weight sum / (rays * projected solid angle); f_se: its standard "
     "error; solid angles in sr; caught: rays that reached the patch; rays: rays of light shot, 0 where f was "
     "integrated over the patches, without noise.")};

std::string_view kind_of(const GoniophotometerReading& r, const Patch& p) {
  return r.is_reflected(p) ? "BRDF" : "BTDF";
}

/// Where f is largest among the patches of one kind.
size_t brightest(const GoniophotometerReading& r, bool reflected) {
  size_t patch = 0;
  double largest = -1;
  for (size_t i = 0; i < r.sphere.size(); ++i)
    if (const double f = r.f(i).mean; r.is_reflected(r.sphere.patch(i)) == reflected && f > largest)
      largest = f, patch = i;
  return patch;
}

std::string side_text(const GoniophotometerReading& r, bool reflected) {
  const Estimate share = r.share(reflected);
  const size_t patch = brightest(r, reflected);
  const Estimate f = r.f(patch);
  const Patch p = r.sphere.patch(patch);
  return fmt::format("  {} {:.5f} +- {:.5f}; {} up to {:.5f} +- {:.5f} per sr, at theta {:g}, phi {:g} degrees\n",
                     reflected ? "R" : "T", share.mean, share.standard_error(), reflected ? "BRDF" : "BTDF", f.mean,
                     f.standard_error(), p.theta_deg(), p.phi_deg());
}

}  // namespace

std::string patches_csv(const std::vector<std::string>& notes, const std::vector<LabelledPatches>& readings) {
  std::string csv;
  for (const std::string& note : notes) csv += "# " + note + '\n';
  for (const char* note : kNotes) csv += fmt::format("# {}\n", note);
  csv +=
      "incidence_deg,wavelength_nm,theta_min_deg,theta_max_deg,theta_deg,phi_min_deg,phi_max_deg,phi_deg,solid_angle_"
      "sr,"
      "projected_solid_angle_sr,kind,f_per_sr,f_se,caught,rays,material\n";
  for (const auto& [material, r] : readings) {
    const std::string label = csv_field(material);
    for (size_t i = 0; i < r.sphere.size(); ++i) {
      const Patch p = r.sphere.patch(i);
      const Estimate f = r.f(i);
      fmt::format_to(
          std::back_inserter(csv),
          "{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.9g},{:.9g},{},{:.9g},{:.4g},{},{},{}\n",
          r.beam.theta_deg, r.beam.lambda_nm, p.theta_min_deg, p.theta_max_deg, p.theta_deg(), p.phi_min_deg,
          p.phi_max_deg, p.phi_deg(), p.solid_angle, p.projected_solid_angle, kind_of(r, p), f.mean, f.standard_error(),
          r.count(i), r.rays, label);
    }
  }
  return csv;
}

std::string patches_json(const std::vector<std::string>& notes, const std::vector<LabelledPatches>& readings) {
  nlohmann::ordered_json json{{"notes", notes}, {"readings", nlohmann::ordered_json::array()}};
  for (const char* note : kNotes) json["notes"].push_back(note);
  for (const auto& [material, r] : readings) {
    auto patches = nlohmann::ordered_json::array();
    for (size_t i = 0; i < r.sphere.size(); ++i) {
      const Patch p = r.sphere.patch(i);
      const Estimate f = r.f(i);
      patches.push_back({{"theta_min_deg", p.theta_min_deg},
                         {"theta_max_deg", p.theta_max_deg},
                         {"theta_deg", p.theta_deg()},
                         {"phi_min_deg", p.phi_min_deg},
                         {"phi_max_deg", p.phi_max_deg},
                         {"phi_deg", p.phi_deg()},
                         {"solid_angle_sr", p.solid_angle},
                         {"projected_solid_angle_sr", p.projected_solid_angle},
                         {"kind", kind_of(r, p)},
                         {"f_per_sr", f.mean},
                         {"f_se", f.standard_error()},
                         {"caught", r.count(i)}});
    }
    json["readings"].push_back({{"material", material},
                                {"incidence_deg", r.beam.theta_deg},
                                {"wavelength_nm", r.beam.lambda_nm},
                                {"rays", r.rays},
                                {"patches_in_theta", r.sphere.thetas()},
                                {"patches_in_phi", r.sphere.phis()},
                                {"patches", std::move(patches)}});
  }
  return json.dump(2) + '\n';
}

std::string patches_text(const std::vector<LabelledPatches>& readings) {
  std::string text;
  for (const auto& [material, r] : readings) {
    const std::string how = r.is_integrated() ? "integrated" : fmt::format("{} rays", r.rays);
    text += fmt::format("{}, {:g} degrees, {:g} nm, {}, {} x {} patches\n", material, r.beam.theta_deg,
                        r.beam.lambda_nm, how, r.sphere.thetas(), r.sphere.phis());
    text += side_text(r, true) + side_text(r, false);
  }
  return text;
}

}  // namespace frond
