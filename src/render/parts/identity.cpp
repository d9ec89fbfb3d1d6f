#include "render/parts/identity.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "core/math/random.h"
#include "render/parts/inputs.h"
#include "scene/scene_options.h"

namespace frond {
namespace {

std::string text_of(const ParsedPlugin& plugin) {
  std::string text = plugin.name;
  for (const ParsedParam& p : plugin.params)
    std::visit([&](const auto& values) { text += fmt::format(",{}={}", p.name, fmt::join(values, " ")); }, p.values);
  return text;
}

uint64_t hash_materials(const SceneSettings& description) {
  uint64_t hash = 0;
  for (const MaterialDescription& m : description.materials) hash = hash_bytes(m.name + '\n' + text_of(m.plugin), hash);
  return hash;
}

/// Instruction set that Embree uses; its intersections differ in the last bits between instruction sets.
const char* instruction_set() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return "avx2";
  if (__builtin_cpu_supports("avx")) return "avx";
  return "sse";
#else
  return "generic";
#endif
}

std::string hexadecimal(uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace

uint64_t Identity::hash() const {
  uint64_t hash = 0;
  for (const Field& field : fields_) hash = hash_bytes(field.name + '\n' + field.value, hash);
  return hash;
}

std::string Identity::difference(const Identity& other, const std::string& here, const std::string& there) const {
  for (const Field& field : fields_) {
    const auto same = std::ranges::find(other.fields_, field.name, &Field::name);
    if (same == other.fields_.end())
      return fmt::format("{}: {} in {}, nothing in {}", field.name, field.value, here, there);
    if (same->value != field.value)
      return fmt::format("{}: {} in {}, {} in {}", field.name, field.value, here, same->value, there);
  }
  for (const Field& field : other.fields_)
    if (std::ranges::find(fields_, field.name, &Field::name) == fields_.end())
      return fmt::format("{}: nothing in {}, {} in {}", field.name, here, field.value, there);
  return {};
}

Identity identity_of(const SceneDescription& description, const IdentityInputs& facts) {
  Identity id;
  const FilmSettings& film = facts.format.settings;
  id.add("frond", fmt::format("{} (build {})", FROND_VERSION, hexadecimal(hash_program(0))));
  id.add("instruction set", instruction_set());
  for (const auto& plugin : facts.plugins)
    id.add("plug-in " + plugin.filename().string(), hexadecimal(hash_file(plugin, 0)));
  id.add("seed", std::to_string(facts.seed));
  id.add("wavelengths", read_options(description).wavelengths);
  id.add("integrator", text_of(description.integrator));
  id.add("filter", fmt::format("{}, {}", text_of(description.filter),
                               facts.format.splatting ? "splatting" : "importance sampling"));
  id.add("resolution", fmt::format("{} x {}", film.width, film.height));
  id.add("film", fmt::format("exposure {}, maxcomponentvalue {}", film.exposure, film.max_component));
  id.add("channels", fmt::format("{}", fmt::join(facts.format.channels.names(), ",")));
  id.add("color space", facts.color_space);
  id.add("command", facts.command);
  id.add("scene", hexadecimal(description.content_hash));
  id.add("materials", hexadecimal(hash_materials(description)));
  for (const auto& file : input_files(description, facts.wavelengths))
    id.add("file " + file.filename().string(), hexadecimal(hash_file(file, 0)));
  return id;
}

}  // namespace frond
