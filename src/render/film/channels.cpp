#include "render/film/channels.h"

#include <algorithm>

namespace frond {
namespace {

Triple triple(const Vec3& v) { return {double(v.x), double(v.y), double(v.z)}; }
Triple single(double value) { return {value, 0, 0}; }

using Kind = ChannelInfo::Kind;
using Space = ChannelInfo::Space;

/// The names are those that Blender, Nuke and Open Image Denoise expect.
constexpr ChannelInfo kChannels[] = {
    {"albedo",
     {"albedo.R", "albedo.G", "albedo.B"},
     Kind::mean,
     Space::none,
     "share of light that the surface reflects or transmits",
     [](const CameraHit& hit) { return hit.albedo; }},
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
};

constexpr size_t count(ChannelInfo::Kind kind) {
  size_t values = 0;
  for (const ChannelInfo& c : kChannels) values += c.kind == kind ? c.size() : 0;
  return values;
}
static_assert(std::ranges::all_of(kChannels,
                                  [](const ChannelInfo& c) { return c.space == Space::none || c.size() == 3; }));
static_assert(count(Kind::mean) <= kMostMeans && count(Kind::nearest) <= kMostIds);

}  // namespace

std::span<const ChannelInfo> all_channels() { return kChannels; }

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

}  // namespace frond
