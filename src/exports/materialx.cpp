#include <fmt/format.h>

#include "exports/sheet_colors.h"
#include "exports/xml_text.h"

namespace frond {
namespace {

/// The shaders of a side. OpenPBR 1.1: a thin-walled subsurface transmits the share (1 + anisotropy) / 2 and reflects
/// the rest in the same colour; with an anisotropy of 1 it only transmits, and the diffuse base reflects. The sum of
/// two BSDFs, unlike a mix, needs no common share.
constexpr const char* kSideSurface = R"(  <open_pbr_surface name="openpbr_{0}" type="surfaceshader">
    <input name="base_color" type="color3" value="{1}" />
    <input name="specular_weight" type="float" value="0" />
    <input name="subsurface_weight" type="float" value="{2:.6g}" />
    <input name="subsurface_color" type="color3" value="{3}" />
    <input name="subsurface_scatter_anisotropy" type="float" value="1" />
    <input name="geometry_thin_walled" type="boolean" value="true" />
  </open_pbr_surface>
  <oren_nayar_diffuse_bsdf name="reflected_{0}" type="BSDF">
    <input name="color" type="color3" value="{4}" />
  </oren_nayar_diffuse_bsdf>
  <translucent_bsdf name="transmitted_{0}" type="BSDF">
    <input name="color" type="color3" value="{5}" />
  </translucent_bsdf>
  <add name="sum_{0}" type="BSDF">
    <input name="in1" type="BSDF" nodename="reflected_{0}" />
    <input name="in2" type="BSDF" nodename="transmitted_{0}" />
  </add>
  <surface name="lambertian_{0}" type="surfaceshader">
    <input name="bsdf" type="BSDF" nodename="sum_{0}" />
    <input name="thin_walled" type="boolean" value="true" />
  </surface>
)";

/// Programs that do not read the shader of the back show the front's on both sides.
constexpr const char* kMaterial = R"(  <surfacematerial name="leaf_{0}" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="{0}_front" />
    <input name="backsurfaceshader" type="surfaceshader" nodename="{0}_back" />
  </surfacematerial>
)";

std::string side_text(const char* name, const SideColors& side, const Log& log) {
  const auto value = [](const Triple& c) { return fmt::format("{:.6g}, {:.6g}, {:.6g}", c[0], c[1], c[2]); };
  const SharedColors shared = shared_colors(side, log);
  return fmt::format(kSideSurface, name, value(shared.reflected), shared.share, value(shared.transmitted),
                     value(side.reflected), value(side.transmitted));
}

std::string materialx_file(const ExportMaterial& material, const ExportRequest& request) {
  const SheetColors colors = sheet_colors(material, request, true);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" +
         xml_comment("frond " FROND_VERSION " export, " + material.label + ". R and T as colours: " + colors.light) +
         "<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n" +
         side_text("front", colors.near_normal[0], material.log) +
         side_text("back", colors.near_normal[1], material.log) + fmt::format(kMaterial, "openpbr") +
         fmt::format(kMaterial, "lambertian") + "</materialx>\n";
}

}  // namespace

extern const ExportFormat materialx_format{
    "materialx", "R and T as colours of MaterialX surfaces", true, {}, check_sheet_colors, materialx_file};

}  // namespace frond
