#pragma once

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/parallel.h"
#include "core/params.h"

namespace frond {

/// Record of a plug-in. The record of each kind (MaterialInfo, LightInfo, ...) adds a function `make`.
struct PluginInfo {
  std::string_view kind;    ///< "material", "light", ...
  std::string_view name;    ///< name in scene files
  std::string_view doc;     ///< one line of documentation
  std::string_view source;  ///< publication or program that the model comes from
  std::span<const Param> params;
};

/// Returns the parameter of this name, or nullptr.
inline const Param* find_param(const PluginInfo& info, std::string_view name) {
  const auto found = std::ranges::find(info.params, name, &Param::name);
  return found == info.params.end() ? nullptr : &*found;
}
inline const ParsedParam* find_param(std::span<const ParsedParam> params, std::string_view name) {
  const auto found = std::ranges::find(params, name, &ParsedParam::name);
  return found == params.end() ? nullptr : &*found;
}

/// For a handler: returns the message of the current exception if it is a defect of a plug-in. Rethrows InputError,
/// Stopped and std::bad_alloc.
inline std::string plugin_defect() {
  try {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const Stopped&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "it threw an object that is no std::exception";
  }
}

/// Returns the result of `make()`. InputError and Stopped pass through; any other exception, and a null pointer as
/// result, become an InputError at `where` that names the plug-in.
template <class Make>
auto make_checked(const PluginInfo& info, const Location& where, const Make& make) {
  const auto attempt = [&] {
    try {
      return make();
    } catch (const std::bad_alloc&) {
      fail(where, "{} \"{}\" needs more memory than there is", info.kind, info.name);
    } catch (...) {
      fail(where, "{} \"{}\" has a defect: {}", info.kind, info.name, plugin_defect());
    }
  };
  auto made = attempt();
  if constexpr (std::is_constructible_v<bool, decltype(made)>)
    if (!made) fail(where, "{} \"{}\" has a defect: make() returned nothing", info.kind, info.name);
  return made;
}

/// Table of the plug-ins of one kind. Their records must outlive it.
template <class Info>
class PluginTable {
 public:
  PluginTable(std::string_view kind, std::span<const Info* const> infos)
      : kind_(kind), infos_(infos.begin(), infos.end()) {}

  void add(const Info& info) { infos_.push_back(&info); }
  /// Replaces the plug-in of the same name, if there is one.
  void replace(const Info& info) {
    for (const Info*& known : infos_)
      if (known->name == info.name) known = &info;
  }
  const std::vector<const Info*>& all() const { return infos_; }
  std::string_view kind() const { return kind_; }

  std::vector<std::string_view> names() const {
    std::vector<std::string_view> names;
    for (const Info* info : infos_) names.push_back(info->name);
    return names;
  }
  /// Plug-in of this name, or nullptr.
  const Info* find(std::string_view name) const {
    for (const Info* info : infos_)
      if (info->name == name) return info;
    return nullptr;
  }
  /// Plug-in of this name. Throws an InputError that suggests the nearest name.
  const Info& get(std::string_view name, const Location& where) const {
    if (const Info* info = find(name)) return *info;
    fail(where, "unknown {} \"{}\"{}", kind_, name, suggestion(name, names()));
  }

 private:
  std::string_view kind_;
  std::vector<const Info*> infos_;
};

}  // namespace frond
