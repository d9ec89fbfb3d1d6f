#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "exports/klems.h"
#include "exports/sheet_colors.h"
#include "exports/xml_text.h"
#include "spectra/color/color_space.h"

namespace frond {
namespace {

/// A block of the file, with the weight of each wavelength.
struct Block {
  const char *wavelength, *detector;
  std::vector<double> weights;  ///< sum to 1
};

/// Returns the blocks of the file: visible, and the CIE channels.
std::vector<Block> blocks_of(const std::vector<double>& nm) {
  std::vector<Block> blocks{{"Visible", "ASTM E308 1931 Y.dsp", d65_weights(1, nm)}};
  if (nm.size() == 1) return blocks;
  blocks.push_back({"CIE-X", "ASTM E308 1931 X.dsp", d65_weights(0, nm)});
  blocks.push_back({"CIE-Z", "ASTM E308 1931 Z.dsp", d65_weights(2, nm)});
  return blocks;
}

std::string basis_text() {
  std::string text = "\t\t<AngleBasis>\n\t\t\t<AngleBasisName>LBNL/Klems Full</AngleBasisName>\n";
  for (const KlemsBasis::Ring& ring : KlemsBasis::kRings) {
    const double theta = ring.phis == 1 ? 0 : (ring.theta_min_deg + ring.theta_max_deg) / 2;
    text += fmt::format(
        "\t\t\t<AngleBasisBlock>\n\t\t\t\t<Theta>{:g}</Theta>\n\t\t\t\t<nPhis>{}</nPhis>\n\t\t\t\t<ThetaBounds>\n"
        "\t\t\t\t\t<LowerTheta>{:g}</LowerTheta>\n\t\t\t\t\t<UpperTheta>{:g}</UpperTheta>\n\t\t\t\t</ThetaBounds>\n"
        "\t\t\t</AngleBasisBlock>\n",
        theta, ring.phis, ring.theta_min_deg, ring.theta_max_deg);
  }
  return text + "\t\t</AngleBasis>\n";
}

/// A pair of sides. WINDOW 6 calls "front" the back (-z) of a Radiance surface (bsdf_m.c, load_bsdf_data).
struct Direction {
  const char* name;
  LitSide lit;
  bool reflected;
};
constexpr Direction kDirections[]{{"Transmission Front", LitSide::back, false},
                                  {"Transmission Back", LitSide::front, false},
                                  {"Reflection Front", LitSide::back, true},
                                  {"Reflection Back", LitSide::front, true}};

/// Appends one matrix: outgoing patches as rows, incident patches as columns.
void append_matrix(const KlemsMatrices& matrices, const Block& block, const Direction& d, std::string& text) {
  constexpr const char* kHead =
      "\t<WavelengthData>\n\t\t<LayerNumber>System</LayerNumber>\n\t\t<Wavelength unit=\"Integral\">{}</Wavelength>\n"
      "\t\t<SourceSpectrum>CIE Illuminant D65 1nm.ssp</SourceSpectrum>\n"
      "\t\t<DetectorSpectrum>{}</DetectorSpectrum>\n\t\t<WavelengthDataBlock>\n"
      "\t\t\t<WavelengthDataDirection>{}</WavelengthDataDirection>\n"
      "\t\t\t<ColumnAngleBasis>LBNL/Klems Full</ColumnAngleBasis>\n"
      "\t\t\t<RowAngleBasis>LBNL/Klems Full</RowAngleBasis>\n"
      "\t\t\t<ScatteringDataType>{}</ScatteringDataType>\n\t\t\t<ScatteringData>\n";
  text += fmt::format(kHead, block.wavelength, block.detector, d.name, d.reflected ? "BRDF" : "BTDF");
  for (size_t out = 0; out < KlemsBasis::kPatches; ++out) {
    for (size_t in = 0; in < KlemsBasis::kPatches; ++in) {
      double f = 0;
      for (size_t i = 0; i < block.weights.size(); ++i)
        f += block.weights[i] * matrices.f(i, d.lit, d.reflected, in, out);
      fmt::format_to(std::back_inserter(text), "{:.6g},", f);
    }
    text += '\n';
  }
  text += "\t\t\t</ScatteringData>\n\t\t</WavelengthDataBlock>\n\t</WavelengthData>\n";
}

/// Returns Radiance's own material for a translucent sheet: R and T of the front at normal incidence (the first patch),
/// in Radiance's linear colours relative to white. It transmits one share of R + T in all channels, here the mean one,
/// and has no sides. Logs what is lost.
std::string trans_primitive(const KlemsMatrices& matrices, const std::vector<Block>& blocks, const Log& log) {
  // color.h of Radiance; white is that of equal energies.
  constexpr Chromaticities kRadiance{{0.640, 0.330}, {0.290, 0.600}, {0.150, 0.060}, {1.0 / 3, 1.0 / 3}};
  static const Matrix3 rgb_from_xyz = inverse(xyz_from_rgb(kRadiance));
  const auto color_of = [&](bool reflected) {
    Triple yxz{};
    for (size_t b = 0; b < blocks.size(); ++b)
      for (size_t w = 0; w < blocks[b].weights.size(); ++w)
        for (size_t out = 0; out < KlemsBasis::kPatches; ++out)
          yxz[b] += blocks[b].weights[w] * KlemsBasis::projected_solid_angle(out) *
                    matrices.f(w, LitSide::front, reflected, 0, out);
    if (blocks.size() == 1) return Triple{yxz[0], yxz[0], yxz[0]};
    Triple rgb = rgb_from_xyz * Triple{yxz[1], yxz[0], yxz[2]};
    for (double& c : rgb) c = std::clamp(c, 0.0, 1.0);
    return rgb;
  };
  const Triple r = color_of(true), t = color_of(false);
  Triple total{};
  double sum = 0, transmitted = 0, lost = 0;
  for (size_t c = 0; c < 3; ++c) sum += total[c] = std::min(r[c] + t[c], 1.0), transmitted += t[c];
  const double share = sum > 0 ? std::min(transmitted / sum, 1.0) : 0;
  for (size_t c = 0; c < 3; ++c) lost = std::max(lost, std::abs(t[c] - share * total[c]));
  log.info(
      fmt::format("the material trans, in a comment of the file, loses gloss, angles and the back; R and T of the "
                  "front are off by up to {:.2g}",
                  lost));
  return fmt::format("void trans leaf 0 0 7 {:.4f} 0 0 {:.4f} 0", fmt::join(total, " "), share);
}

/// Returns the largest directional albedo of a patch; above 1 the file would create energy.
double largest_share(const KlemsMatrices& matrices, size_t wavelengths) {
  double largest = 0;
  for (size_t w = 0; w < wavelengths; ++w)
    for (const LitSide lit : {LitSide::front, LitSide::back})
      for (size_t in = 0; in < KlemsBasis::kPatches; ++in) {
        double share = 0;
        for (size_t out = 0; out < KlemsBasis::kPatches; ++out)
          share += KlemsBasis::projected_solid_angle(out) *
                   double(matrices.f(w, lit, true, in, out) + matrices.f(w, lit, false, in, out));
        largest = std::max(largest, share);
      }
  return largest;
}

void check_radiance(const ExportRequest& request) { check_ascending("wavelengths", request.wavelengths_nm); }

std::string radiance_file(const ExportMaterial& material, const ExportRequest& request) {
  const auto nm = request.wavelengths_nm.empty() ? visible_wavelengths() : request.wavelengths_nm;
  const KlemsMatrices matrices(material, nm);
  if (matrices.unconverged() > 0)
    material.log.warn(
        {},
        fmt::format("{} of {} pairs of patches contain a lobe too narrow for the requested accuracy: pi f "
                    "is uncertain by up to {:.2g}",
                    matrices.unconverged(),
                    split_into_lanes(nm).size() * 4 * KlemsBasis::kPatches * KlemsBasis::kPatches, matrices.error()));
  const double share = largest_share(matrices, nm.size());
  material.log.info(fmt::format(
      "{} wavelengths, 4 x 145 x 145 patches: the last two rules of integration differ by up to {:.2g} in pi f; {:.4f} "
      "of the light leaves at most",
      nm.size(), matrices.error(), share));
  const std::string of_light =
      nm.size() == 1 ? fmt::format("Visible is f at {:g} nm.", nm[0])
                     : fmt::format(
                           "Visible, CIE-X and CIE-Z: f at {} wavelengths from {:g} to {:g} nm, weighed by D65 "
                           "and the CIE 1931 functions, each by itself, so that grey stays grey.",
                           nm.size(), nm.front(), nm.back());
  const std::vector<Block> blocks = blocks_of(nm);
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += xml_comment("frond " FROND_VERSION " export, " + material.label);
  text += xml_comment("f in 1/sr, mean over pairs of patches by projected solid angle. " + of_light);
  text +=
      xml_comment(fmt::format("The last two rules of integration differ by up to {:.2g} in pi f.", matrices.error()));
  text += xml_comment("The front (adaxial side) is the front, +z, of a Radiance surface, which WINDOW calls back.");
  text += xml_comment("Without this file, R and T of the front near the normal: " +
                      trans_primitive(matrices, blocks, material.log));
  text +=
      "<WindowElement xmlns=\"http://windows.lbl.gov\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:schemaLocation=\"http://windows.lbl.gov/BSDF-v1.4.xsd\">\n<WindowElementType>System</WindowElementType>\n"
      "<FileType>BSDF</FileType>\n<Optical>\n<Layer>\n";
  text += fmt::format(
      "\t<Material>\n\t\t<Name>{}</Name>\n\t\t<Manufacturer>frond {}</Manufacturer>\n\t\t<DeviceType>Other"
      "</DeviceType>\n\t</Material>\n",
      xml_escaped(material.label), FROND_VERSION);
  text += "\t<DataDefinition>\n\t\t<IncidentDataStructure>Columns</IncidentDataStructure>\n" + basis_text() +
          "\t</DataDefinition>\n";
  for (const Block& block : blocks)
    for (const Direction& d : kDirections) append_matrix(matrices, block, d, text);
  return text + "</Layer>\n</Optical>\n</WindowElement>\n";
}

}  // namespace

extern const ExportFormat radiance_format{
    "radiance",   "BSDF of 145 x 145 Klems patches in XML, for Radiance and WINDOW", true, {}, check_radiance,
    radiance_file};

}  // namespace frond
