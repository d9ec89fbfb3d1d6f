#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exports/format.h"
#include "exports/klems.h"
#include "spectra/cie.h"

namespace frond {
namespace {

/// Returns the visible range in steps of 10 nm.
std::vector<double> default_wavelengths() {
  constexpr int kFirst = 380, kLast = 780, kStep = 10;
  std::vector<double> nm;
  for (int w = kFirst; w <= kLast; w += kStep) nm.push_back(w);
  return nm;
}

/// A block of the file, with the weight of each wavelength.
struct Block {
  const char *wavelength, *detector;
  std::vector<double> weights;  ///< sum to 1
};

/// Weights of one of X, Y and Z under D65, normalized, for values that are linear between the wavelengths and constant
/// beyond.
Block color_block(const char* wavelength, const char* detector, size_t which, const std::vector<double>& nm) {
  Block block{wavelength, detector, std::vector<double>(nm.size())};
  double sum = 0;
  for (double x = kCieRange_nm.min; x <= kCieRange_nm.max; ++x) {
    const double w = cie_xyz(x)[which] * double(d65()->at(float(x)));
    const size_t above = size_t(std::ranges::lower_bound(nm, x) - nm.begin());
    if (above == 0)
      block.weights.front() += w;
    else if (above == nm.size())
      block.weights.back() += w;
    else {
      const double t = (x - nm[above - 1]) / (nm[above] - nm[above - 1]);
      block.weights[above - 1] += (1 - t) * w, block.weights[above] += t * w;
    }
    sum += w;
  }
  for (double& w : block.weights) w /= sum;
  return block;
}

/// Returns the blocks of the file: visible, and the CIE channels.
std::vector<Block> blocks_of(const std::vector<double>& nm) {
  std::vector<Block> blocks{color_block("Visible", "ASTM E308 1931 Y.dsp", 1, nm)};
  if (nm.size() == 1) return blocks;
  blocks.push_back(color_block("CIE-X", "ASTM E308 1931 X.dsp", 0, nm));
  blocks.push_back(color_block("CIE-Z", "ASTM E308 1931 Z.dsp", 2, nm));
  return blocks;
}

/// Escapes text for XML.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  return result;
}

/// Returns the text without double hyphens, which XML comments must not contain.
std::string comment(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '-' && result.ends_with('-') ? std::string(" -") : std::string(1, c);
  return fmt::format("<!-- {} -->\n", result);
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
  const auto nm = request.wavelengths_nm.empty() ? default_wavelengths() : request.wavelengths_nm;
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
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += comment("frond " FROND_VERSION " export, " + escaped(material.label));
  text += comment("f in 1/sr, mean over pairs of patches by projected solid angle. " + of_light);
  text += comment(fmt::format("The last two rules of integration differ by up to {:.2g} in pi f.", matrices.error()));
  text += comment("The front (adaxial side) is the front, +z, of a Radiance surface, which WINDOW calls back.");
  text +=
      "<WindowElement xmlns=\"http://windows.lbl.gov\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:schemaLocation=\"http://windows.lbl.gov/BSDF-v1.4.xsd\">\n<WindowElementType>System</WindowElementType>\n"
      "<FileType>BSDF</FileType>\n<Optical>\n<Layer>\n";
  text += fmt::format(
      "\t<Material>\n\t\t<Name>{}</Name>\n\t\t<Manufacturer>frond {}</Manufacturer>\n\t\t<DeviceType>Other"
      "</DeviceType>\n\t</Material>\n",
      escaped(material.label), FROND_VERSION);
  text += "\t<DataDefinition>\n\t\t<IncidentDataStructure>Columns</IncidentDataStructure>\n" + basis_text() +
          "\t</DataDefinition>\n";
  for (const Block& block : blocks_of(nm))
    for (const Direction& d : kDirections) append_matrix(matrices, block, d, text);
  return text + "</Layer>\n</Optical>\n</WindowElement>\n";
}

}  // namespace

extern const ExportFormat radiance_format{
    "radiance",   "BSDF of 145 x 145 Klems patches in XML, for Radiance and WINDOW", true, {}, check_radiance,
    radiance_file};

}  // namespace frond
