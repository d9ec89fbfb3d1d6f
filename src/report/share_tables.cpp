#include "report/share_tables.h"

#include <fmt/ranges.h>

#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "report/text_output.h"

namespace frond {
namespace {

struct Column {
  const char* name;
  Estimate SpectrophotometerReading::*value;
  bool only_if_told;  ///< by the material's flags
};

constexpr std::array<Column, 5> kColumns{{{"Rs", &SpectrophotometerReading::surface, true},
                                          {"Rd", &SpectrophotometerReading::subsurface, true},
                                          {"R", &SpectrophotometerReading::reflectance, false},
                                          {"T", &SpectrophotometerReading::transmittance, false},
                                          {"A", &SpectrophotometerReading::absorptance, false}}};

std::optional<Estimate> value_of(const SpectrophotometerReading& r, const Column& column) {
  if (column.only_if_told && !r.tells_surface) return {};
  return r.*column.value;
}

constexpr const char* kColumnNotes[] = {
    "theta_deg: from the front's normal to the light, degrees; above 90 the back (abaxial side) is lit.",
    ("Shares of the light, 0 to 1: R = Rs + Rd comes back on the lit side (Rs: at the first event, off the surface; "
     "Rd: out of the body), T leaves by the other side, A = 1 - R - T is absorbed."),
    "Rs and Rd are blank where the material does not tell them apart. _se: standard error; rays: rays of light shot."};

/// 0.04514 and 0.00021.
std::string text_of(const std::optional<Estimate>& e) {
  return e ? fmt::format("{:.5f} +- {:.5f}", e->mean, e->standard_error()) : "";
}

}  // namespace

std::string shares_csv(const std::vector<std::string>& notes, const std::vector<LabelledReading>& readings) {
  std::string csv;
  for (const std::string& note : notes) csv += "# " + note + '\n';
  for (const char* note : kColumnNotes) csv += fmt::format("# {}\n", note);
  csv += "theta_deg,wavelength_nm";
  for (const Column& c : kColumns) csv += fmt::format(",{}", c.name);
  for (const Column& c : kColumns) csv += fmt::format(",{}_se", c.name);
  csv += ",rays,material\n";
  for (const auto& [material, r] : readings) {
    csv += fmt::format("{:.10g},{:.10g}", r.beam.theta_deg, r.beam.lambda_nm);
    for (const Column& c : kColumns)
      if (const auto value = value_of(r, c))
        csv += fmt::format(",{:.9g}", value->mean);
      else
        csv += ',';
    for (const Column& c : kColumns)
      if (const auto value = value_of(r, c))
        csv += fmt::format(",{:.4g}", value->standard_error());
      else
        csv += ',';
    csv += fmt::format(",{},{}\n", r.rays, csv_field(material));
  }
  return csv;
}

std::string shares_json(const std::vector<std::string>& notes, const std::vector<LabelledReading>& readings) {
  nlohmann::ordered_json json{{"notes", notes}, {"readings", nlohmann::ordered_json::array()}};
  for (const char* note : kColumnNotes) json["notes"].push_back(note);
  for (const auto& [material, r] : readings) {
    nlohmann::ordered_json row{
        {"material", material}, {"theta_deg", r.beam.theta_deg}, {"wavelength_nm", r.beam.lambda_nm}, {"rays", r.rays}};
    for (const Column& c : kColumns) {
      const auto value = value_of(r, c);
      row[c.name] = value ? nlohmann::ordered_json(value->mean) : nlohmann::ordered_json();
      row[fmt::format("{}_se", c.name)] =
          value ? nlohmann::ordered_json(value->standard_error()) : nlohmann::ordered_json();
    }
    json["readings"].push_back(std::move(row));
  }
  return json.dump(2) + '\n';
}

std::string shares_text(const std::vector<LabelledReading>& readings) {
  std::string text;
  const std::string* material = nullptr;
  for (const auto& [label, r] : readings) {
    if (!material || *material != label) {
      text += fmt::format("{}{}\n  theta      nm", material ? "\n" : "", label);
      for (const Column& c : kColumns) text += fmt::format("  {:^18}", c.name);
      text += "  rays\n";
      material = &label;
    }
    text += fmt::format("{:7.6g} {:7.6g}", r.beam.theta_deg, r.beam.lambda_nm);
    for (const Column& c : kColumns) text += fmt::format("  {:>18}", text_of(value_of(r, c)));
    text += fmt::format("  {}\n", r.rays);
  }
  return text;
}

}  // namespace frond
