#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/params.h"

namespace frond {

/// What every plugin says of itself. Each kind adds how it is made.
struct PluginInfo {
  std::string_view kind;    ///< "material", "light", ...
  std::string_view name;    ///< as scene files call it
  std::string_view doc;     ///< one line
  std::string_view source;  ///< where the model comes from
  std::span<const Param> params;
};

/// What a plugin made, by a pointer. Throws InputError where that is nothing.
template <class Pointer>
Pointer made_by(const PluginInfo& info, const Location& where, Pointer made) {
  if (!made) fail(where, "{} \"{}\" has made nothing: this is a defect of the plug-in", info.kind, info.name);
  return made;
}

/// The plugins of one kind.
template <class Info>
class PluginTable {
 public:
  PluginTable(std::string_view kind, std::span<const Info* const> infos)
      : kind_(kind), infos_(infos.begin(), infos.end()) {}

  void add(const Info& info) { infos_.push_back(&info); }
  const std::vector<const Info*>& all() const { return infos_; }
  std::string_view kind() const { return kind_; }

  std::vector<std::string_view> names() const {
    std::vector<std::string_view> names;
    for (const Info* info : infos_) names.push_back(info->name);
    return names;
  }
  const Info* find(std::string_view name) const {
    for (const Info* info : infos_)
      if (info->name == name) return info;
    return nullptr;
  }
  /// Throws InputError that names the nearest one.
  const Info& get(std::string_view name, const Location& where) const {
    if (const Info* info = find(name)) return *info;
    fail(where, "unknown {} \"{}\"{}", kind_, name, suggestion(name, names()));
  }

 private:
  std::string_view kind_;
  std::vector<const Info*> infos_;
};

}  // namespace frond
