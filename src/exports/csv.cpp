#include <fmt/format.h>

#include <iterator>

#include "exports/table.h"

namespace frond {
namespace {

/// Returns a comment line that documents a column.
std::string note(const Quantity& q) {
  return fmt::format("# {}{}{}: {}\n", q.name, q.unit.empty() || q.unit == "1" ? "" : ", ", q.unit == "1" ? "" : q.unit,
                     q.doc);
}

/// Returns one row for each number, so that readers need no knowledge of the shape.
std::string csv_file(const ExportMaterial& material, const ExportRequest& request) {
  const BsdfTable t = make_table(material, request);
  std::string text = "# frond " FROND_VERSION " export\n# material: " + material.label + '\n';
  for (const Quantity& q : {kWavelength, kSide, kThetaI, kThetaO, kPhiO}) text += note(q);
  text +=
      "# quantity: R, T: directional-hemispherical reflectance and transmittance, 0 to 1, without a viewer; f_r, f_t: "
      "BRDF and BTDF, sr-1\n";
  text += "quantity,wavelength_nm,side,theta_i_deg,theta_o_deg,phi_o_deg,value\n";
  const auto out = std::back_inserter(text);
  size_t row = 0, i = 0;
  for (const double nm : t.wavelengths_nm)
    for (const std::string_view side : BsdfTable::kSides)
      for (const double theta_i : t.theta_i_deg) {
        fmt::format_to(out, "R,{:.10g},{},{:.10g},,,{:.6g}\n", nm, side, theta_i, t.reflectance[row]);
        fmt::format_to(out, "T,{:.10g},{},{:.10g},,,{:.6g}\n", nm, side, theta_i, t.transmittance[row++]);
        for (const double theta_o : t.theta_o_deg)
          for (const double phi_o : t.phi_o_deg)
            for (const char* quantity : {"f_r", "f_t"})
              fmt::format_to(out, "{},{:.10g},{},{:.10g},{:.10g},{:.10g},{:.6g}\n", quantity, nm, side, theta_i,
                             theta_o, phi_o, t.f[i++]);
      }
  return text;
}

}  // namespace

extern const ExportFormat csv_format{
    "csv", "R, T and f as a table, a line for each number", true, kTableOptions, check_table, csv_file};

}  // namespace frond
