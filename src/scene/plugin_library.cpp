#include "scene/plugin_library.h"

#include <algorithm>
#include <cmath>

#include "core/plugin_module.h"
#include "system/build_check.h"
#include "system/shared_object.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

/// Returns the shared object's table of plug-ins. Throws InputError if it was built for another interface version.
const PluginModule& module_of(const SharedObject& library, const fs::path& file) {
  const auto function = library.find<decltype(frond_plugin)>("frond_plugin");
  if (!function) fail({}, "plug-in \"{}\" has no function frond_plugin (core/plugin_module.h)", file.string());
  const PluginModule* module = function();
  if (!module) fail({}, "plug-in \"{}\": frond_plugin returned nothing", file.string());
  if (module->interface_version != kPluginInterface)
    fail({}, "plug-in \"{}\" has version {} of the plug-in interface, this frond has version {}: build it again",
         file.string(), module->interface_version, kPluginInterface);
  if (const std::string problem = build_mismatch(module->build); !problem.empty())
    fail({}, "plug-in \"{}\" {}: build it again", file.string(), problem);
  return *module;
}

template <class Info>
void add_all(std::span<const Info* const> infos, const fs::path& file, PluginTable<Info>& table) {
  for (const Info* info : infos) {
    if (!info) fail({}, "plug-in \"{}\" has a null pointer among its {}s", file.string(), table.kind());
    if (info->name.empty() || info->name.find_first_of(" \t\n\",=@;:") != std::string_view::npos)
      fail({}, "plug-in \"{}\": a {} is called \"{}\"; a name is one word without quotes, commas and the like",
           file.string(), table.kind(), info->name);
    const Info* known = table.find(info->name);
    if (known == info) continue;
    if (known) fail({}, "plug-in \"{}\": {} \"{}\" already exists", file.string(), table.kind(), info->name);
    if (info->kind != table.kind())
      fail({}, "plug-in \"{}\" offers \"{}\" as a {}, but calls it a {}", file.string(), info->name, table.kind(),
           info->kind);
    if (!info->make) fail({}, "plug-in \"{}\": {} \"{}\" has no `make`", file.string(), info->kind, info->name);
    if (const std::string problem = declaration_problem(*info); !problem.empty())
      fail({}, "plug-in \"{}\": {} \"{}\": {}", file.string(), info->kind, info->name, problem);
    table.add(*info);
  }
}

}  // namespace

/// Throws InputError for leaf models with invalid statements.
void check_leaves(std::span<const MaterialInfo* const> infos, const fs::path& file, const Registry& registry) {
  for (const MaterialInfo* info : infos) {
    if (!info->leaf || info->leaf->is_open) continue;
    const auto reject = [&](const std::string& what) {
      fail({}, "plug-in \"{}\": the leaf model \"{}\" {}", file.string(), info->name, what);
    };
    if (!(info->leaf->cost > 0 && std::isfinite(info->leaf->cost)))
      reject(fmt::format("has a cost of {:g}: the CPU time of a path relative to a Lambertian leaf is needed",
                         info->leaf->cost));
    const MaterialInfo* reference = registry.materials.find(info->leaf->reference);
    if (!reference || !reference->leaf || reference->leaf->reference != reference->name)
      reject(fmt::format("names \"{}\" as its reference, which is none", info->leaf->reference));
  }
}

/// All symbols are bound at load time, so that a missing one is an error here and not during a render.
void load_plugin(const fs::path& file, Registry& registry) {
  const PluginModule& module = module_of(SharedObject(file, "plug-in", SharedObject::Binding::now), file);
  add_all(module.materials, file, registry.materials);
  check_leaves(module.materials, file, registry);
  add_all(module.integrators, file, registry.integrators);
  add_all(module.wavelengths, file, registry.wavelengths);
  add_all(module.cameras, file, registry.cameras);
  add_all(module.samplers, file, registry.samplers);
  add_all(module.filters, file, registry.filters);
  add_all(module.films, file, registry.films);
  add_all(module.shapes, file, registry.shapes);
  add_all(module.lights, file, registry.lights);
  add_all(module.area_lights, file, registry.area_lights);
  add_all(module.float_textures, file, registry.float_textures);
  add_all(module.spectrum_textures, file, registry.spectrum_textures);
  add_all(module.media, file, registry.media);
}

/// Empty entries of the path are ignored.
std::vector<fs::path> plugins_in(std::string_view folders) {
  std::vector<fs::path> files;
  while (!folders.empty()) {
    const fs::path folder = folders.substr(0, folders.find(':'));
    folders.remove_prefix(std::min(folders.size(), folder.native().size() + 1));
    if (folder.empty()) continue;
    if (!fs::is_directory(folder)) fail({}, "plug-ins: there is no folder \"{}\"", folder.string());
    const auto first = static_cast<ptrdiff_t>(files.size());
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".so") files.push_back(entry.path());
    std::sort(files.begin() + first, files.end());
  }
  return files;
}

}  // namespace frond
