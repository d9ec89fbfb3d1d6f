#include <nlohmann/json.hpp>

#include "exports/sheet_colors.h"

namespace frond {
namespace {

using Json = nlohmann::ordered_json;

/// A square of 0.1 m about the origin, front up (+z), with texture coordinates. The buffer has positions and these as
/// 32-bit floats, and six indices of 16 bits.
constexpr const char* kSquare = R"({"asset":{"version":"2.0","generator":"frond"},
"extensionsUsed":["KHR_materials_diffuse_transmission","KHR_materials_specular"],
"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"leaf","mesh":0}],"meshes":[{"name":"leaf","primitives":[
{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],"materials":[],"accessors":[
{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-0.05,-0.05,0],"max":[0.05,0.05,0]},
{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},
{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}],"bufferViews":[
{"buffer":0,"byteLength":48,"target":34962},{"buffer":0,"byteOffset":48,"byteLength":32,"target":34962},
{"buffer":0,"byteOffset":80,"byteLength":12,"target":34963}],"buffers":[{"byteLength":92,
"uri":"data:application/octet-stream;base64,zcxMvc3MTL0AAAAAzcxMPc3MTL0AAAAAzcxMPc3MTD0AAAAAzcxMvc3MTD0AAAAAAAAAAAAAgD8AAIA/AACAPwAAgD8AAAAAAAAAAAAAAAAAAAEAAgAAAAIAAwA="}]})";

/// A glTF material has one R and T, here the front's. Of the light, the extension transmits a share, in a colour of its
/// own; the base colour reflects the rest. The core specification's reflection by the surface (F0 = 0.04) would be
/// added to R: specularFactor removes it.
std::string gltf_file(const ExportMaterial& material, const ExportRequest& request) {
  const SheetColors colors = sheet_colors(material, request, false);
  const auto& [front, back] = colors.near_normal;
  const SharedColors shared = shared_colors(front, material.log);
  const auto& [r, g, b] = shared.reflected;
  const auto shares = [](const SideColors& side) { return Json{{"R", side.reflected}, {"T", side.transmitted}}; };
  Json gltf = Json::parse(kSquare);
  gltf["materials"].push_back(
      {{"name", "leaf"},
       {"doubleSided", true},
       {"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
       {"extensions",
        {{"KHR_materials_diffuse_transmission",
          {{"diffuseTransmissionFactor", shared.share}, {"diffuseTransmissionColorFactor", shared.transmitted}}},
         {"KHR_materials_specular", {{"specularFactor", 0}}}}},
       {"extras",
        {{"frond " FROND_VERSION, material.label},
         {"channels", colors.light},
         {"front", shares(front)},
         {"back", shares(back)}}}});
  return gltf.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace

extern const ExportFormat gltf_format{"gltf",   "R and T as colours of a glTF material", true, {}, check_sheet_colors,
                                      gltf_file};

}  // namespace frond
