#include "render/measured_material.h"

#include "core/math/random.h"
#include "scene/resolver.h"

namespace frond {
namespace {

/// Log of the warnings alone: a material that is prepared for each wavelength would report as many tables.
class WarningLog final : public Log {
 public:
  explicit WarningLog(const Log& log) : log_(log) {}
  void info(std::string_view) const override {}
  void warn(const Location& where, std::string_view message) const override { log_.warn(where, message); }

 private:
  const Log& log_;
};

}  // namespace

MaterialWords parse_material(const std::string& text, const Registry& registry) {
  const PluginText parsed = parse_plugin_text(text, {});
  MaterialWords material{registry.materials.get(parsed.name, {}), {parsed.name, {}, {}}};
  set_params(parsed, material.info, {}, material.plugin);
  return material;
}

std::string parameter_text(const PluginText& material) {
  std::string words;
  for (const auto& [name, value] : material.params) words += (words.empty() ? "" : " ") + name + '=' + value;
  return words;
}

uint64_t material_seed(const std::string& text) {
  const PluginText material = parse_plugin_text(text, {});
  return hash_bytes(material.params.empty() ? material.name : material.name + ' ' + parameter_text(material));
}

SceneDescription scene_of_materials(const Registry& registry) {
  SceneDescription description;
  for (const std::string_view name : registry.materials.names())
    description.materials.push_back({std::string(name), {std::string(name), {}, {}}});
  return description;
}

std::shared_ptr<Material> prepared_material(const std::string& text, const Registry& registry,
                                            const WavelengthStrategy& wavelengths, ThreadPool& pool, const Log& log,
                                            const std::filesystem::path& cache_dir, const AdjustMaterials& adjust) {
  SceneDescription description = scene_of_materials(registry);
  description.materials.push_back({"", parse_material(text, registry).plugin});
  if (adjust) adjust(description, registry);
  const RefusingLog refusing;
  SceneResolver resolver(description, registry, wavelengths, refusing);
  auto material = resolver.material(description.materials.size() - 1);
  material->prepare({wavelengths, pool, log, cache_dir});
  return material;
}

MeasuredMaterial::MeasuredMaterial(const std::string& text, const Registry& registry,
                                   const std::vector<double>& wavelengths_nm, ThreadPool& pool, const Log& log,
                                   const std::filesystem::path& cache_dir)
    : MeasuredMaterial(
          text, registry,
          [&] {
            std::vector<Beam> beams;
            for (const double nm : wavelengths_nm) beams.push_back({0, nm});
            return beams;
          }(),
          pool, log, cache_dir) {}

MeasuredMaterial::MeasuredMaterial(const std::string& text, const Registry& registry, const std::vector<Beam>& beams,
                                   ThreadPool& pool, const Log& log, const std::filesystem::path& cache_dir)
    : label_(text), seed_(material_seed(text)) {
  const WarningLog warnings(log);
  for (const Beam& beam : beams)
    materials_.push_back(
        beam.band ? prepared_material(text, registry, OneBand(*beam.band), pool, warnings, cache_dir)
                  : prepared_material(text, registry, OneWavelength(beam.lambda_nm), pool, warnings, cache_dir));
}

}  // namespace frond
