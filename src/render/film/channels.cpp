#include "render/film/channels.h"

#include <algorithm>

#include "render/film/cryptomatte.h"

namespace frond {
namespace {

Triple triple(const Vec3& v) { return {double(v.x), double(v.y), double(v.z)}; }
Triple single(double value) { return {value, 0, 0}; }

using Kind = ChannelInfo::Kind;
using Space = ChannelInfo::Space;

Triple albedo(const CameraHit& hit) { return hit.albedo; }
double material_key(const CameraHit& hit) { return -1 - double(hit.first.material); }
/// A normal on the side of the camera, as in pbrt-v4.
Triple facing(const Vec3& n, const CameraHit& hit) { return triple(dot(n, hit.ray.d) > 0 ? -n : n); }

/// The names are those that Blender, Nuke and Open Image Denoise expect; the last rows are for pbrt-v4's film gbuffer
/// and have its names.
constexpr ChannelInfo kChannels[] = {
    {"albedo",
     {"albedo.R", "albedo.G", "albedo.B"},
     Kind::mean,
     Space::none,
     "share of light that the surface reflects or transmits",
     albedo,
     true,
     true},
    {"normal",
     {"normal.X", "normal.Y", "normal.Z"},
     Kind::mean,
     Space::vector,
     "shading normal, on the surface's front",
     [](const CameraHit& hit) { return triple(hit.first.n); }},
    {"depth",
     {"Z", "", ""},
     Kind::mean,
     Space::none,
     "distance from the camera along its axis",
     [](const CameraHit& hit) { return single(double(dot(hit.first.p - hit.ray.o, hit.axis))); }},
    {"position",
     {"P.X", "P.Y", "P.Z"},
     Kind::mean,
     Space::point,
     "position of the surface",
     [](const CameraHit& hit) { return triple(hit.first.p); }},
    {"material",
     {"materialId", "", ""},
     Kind::nearest,
     Space::none,
     "index of the material in the scene file, from 1; names are in the header",
     [](const CameraHit& hit) { return single(hit.first.material + 1.0); }},
    {"instance",
     {"instanceId", "", ""},
     Kind::nearest,
     Space::none,
     "index of the instance in the scene file, from 1",
     [](const CameraHit& hit) { return single(double(hit.first.instance)); }},
    {"samples", {"samples", "", ""}, Kind::sample_count, Space::none, "samples of the pixel", nullptr},
    {"Albedo",
     {"Albedo.R", "Albedo.G", "Albedo.B"},
     Kind::mean,
     Space::none,
     "as albedo, with the name of pbrt-v4",
     albedo,
     true,
     true},
    {"N",
     {"N.X", "N.Y", "N.Z"},
     Kind::mean,
     Space::vector,
     "geometric normal, on the side of the camera",
     [](const CameraHit& hit) { return facing(hit.first.ng, hit); }},
    {"Ns",
     {"Ns.X", "Ns.Y", "Ns.Z"},
     Kind::mean,
     Space::vector,
     "shading normal, on the side of the camera",
     [](const CameraHit& hit) { return facing(hit.first.n, hit); }},
    {"uv",
     {"u", "v", ""},
     Kind::mean,
     Space::none,
     "texture coordinates",
     [](const CameraHit& hit) {
       return Triple{double(hit.first.uv.x), double(hit.first.uv.y), 0};
     }},
    {"Variance",
     {"Variance.R", "Variance.G", "Variance.B"},
     Kind::sample_variance,
     Space::none,
     "variance of the pixel's samples, which is that of their mean times their number",
     nullptr,
     true},
    {"RelativeVariance",
     {"RelativeVariance.R", "RelativeVariance.G", "RelativeVariance.B"},
     Kind::relative_variance,
     Space::none,
     "Variance over the mean, as in pbrt-v4",
     nullptr,
     true},
    {"alpha",
     {"A", "", ""},
     Kind::coverage,
     Space::none,
     "share of the pixel that surfaces cover, weighted by the pixel filter",
     [](const CameraHit&) { return single(1); }},
    {"CryptoObject",
     {"CryptoObject", "", ""},
     Kind::cryptomatte,
     Space::none,
     "Cryptomatte of instances, and of the materials of shapes outside objects",
     [](const CameraHit& hit) {
       return single(hit.first.instance > 0 ? double(hit.first.instance) : material_key(hit));
     }},
    {"CryptoMaterial",
     {"CryptoMaterial", "", ""},
     Kind::cryptomatte,
     Space::none,
     "Cryptomatte of materials",
     [](const CameraHit& hit) { return single(material_key(hit)); }},
};

constexpr size_t count(ChannelInfo::Kind kind) {
  size_t values = 0;
  for (const ChannelInfo& c : kChannels) values += c.kind == kind ? c.size() : 0;
  return values;
}
static_assert(count(Kind::coverage) + count(Kind::cryptomatte) == kMostMattes);
static_assert(std::ranges::all_of(kChannels,
                                  [](const ChannelInfo& c) { return c.space == Space::none || c.size() == 3; }));
static_assert(count(Kind::mean) <= kMostMeans && count(Kind::nearest) <= kMostIds);

}  // namespace

std::span<const ChannelInfo> all_channels() { return kChannels; }

std::vector<std::string> ChannelInfo::exr_names() const {
  if (kind == Kind::cryptomatte) return matte_channels(exr[0]);
  return {exr.begin(), exr.begin() + size()};
}

std::array<MatteKey, kMostMattes> ChannelList::matte_keys(const CameraHit& hit) const {
  std::array<MatteKey, kMostMattes> keys{};
  size_t count = 0;
  for (const ChannelInfo* info : infos_)
    if (info->is_matte()) keys[count++] = MatteKey(info->value(hit)[0]);
  return keys;
}

ChannelList::ChannelList(const std::vector<std::string>& names, const Location& where) {
  std::vector<std::string_view> known;
  for (const ChannelInfo& info : kChannels) known.push_back(info.name);
  for (const std::string& name : names)
    if (std::ranges::find(known, name) == known.end())
      fail(where, "there is no channel \"{}\"{}", name, suggestion(name, known));
  for (const ChannelInfo& info : kChannels) {
    if (std::ranges::find(names, info.name) == names.end()) continue;
    infos_.push_back(&info);
    if (info.kind == Kind::mean) means_ += info.size();
    if (info.kind == Kind::nearest) ids_ += info.size();
    if (info.is_matte()) ++mattes_;
  }
}

std::vector<std::string> ChannelList::names() const {
  std::vector<std::string> names;
  for (const ChannelInfo* info : infos_) names.emplace_back(info->name);
  return names;
}

bool ChannelList::has(std::string_view name) const {
  return std::ranges::any_of(infos_, [&](const ChannelInfo* info) { return info->name == name; });
}

std::string_view ChannelList::color() const {
  const auto found = std::ranges::find_if(infos_, &ChannelInfo::is_color);
  return found == infos_.end() ? std::string_view() : (*found)->name;
}

}  // namespace frond
