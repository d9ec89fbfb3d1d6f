#include "exports/mitsuba/scene_export.h"

#include <cmath>

#include "exports/mitsuba/lights.h"
#include "exports/mitsuba/shapes.h"
#include "exports/mitsuba/view.h"
#include "scene/origin.h"
#include "scene/scene.h"
#include "scene/scene_options.h"

namespace frond {
namespace {

/// Returns a power of ten that makes the scene at least a hundred units large: see Context::units.
double units_of(const Bounds& bounds) {
  if (bounds.is_empty()) return 1;
  const double radius = double(length(bounds.max - bounds.min)) / 2;
  if (!(radius > 0)) return 1;
  return std::pow(10, std::max(0.0, std::ceil(std::log10(100 / radius))));
}

/// Reports options and media without an equivalent.
void check_options(mitsuba::Context& context) {
  const SceneDescription& description = context.description;
  const SceneOptions options = read_options(description, context.log);
  if (options.period)
    context.report_unsupported("shapes", options.period_where, "a periodic scene has no equivalent in Mitsuba",
                               "one period is exported, with nothing around it");
  if (!options.has_pixel_jitter)
    context.log.warn({},
                     "Option \"disablepixeljitter\" has no equivalent in Mitsuba: samples are spread over the pixel");
  if (description.has_media())
    context.report_unsupported("media", description.media.front().plugin.where, "participating media are not exported",
                               "they are left out");
}

}  // namespace

void export_to_mitsuba(SceneDescription description, const Registry& registry, const MitsubaExport& request,
                       ThreadPool& pool, const Log& log, const std::filesystem::path& cache) {
  using namespace mitsuba;
  const Spectra spectra(request.wavelengths_nm);
  set_wavelengths(description, spectra.frond_wavelengths());
  Scene::check(description, registry, pool, silent_log());
  const SceneOrigins origins = find_origins(description, log);
  if (origins.move_something) description = moved_to(origins, std::move(description), registry);
  SceneResolver resolver(description, registry, spectra.strategy(), log);
  const FilmSettings film = Scene::film_settings(description, registry, log);
  const ParsedPlugin& sampler = description.sampler;
  const SamplerInfo& info = registry.samplers.get(sampler.name, sampler.where);
  const int samples = make_checked(info, sampler.where, [&] {
                        return info.make(Params(info, sampler, resolver), {});
                      })->samples_per_pixel();

  Folder folder(request.folder);
  Problems problems;
  Context context{description, registry, resolver, spectra, folder, pool, log, cache, request.unsupported, problems};
  context.exposure = film.exposure;
  check_options(context);
  Materials materials(context);
  Shapes shapes(context, materials);
  context.units = units_of(shapes.bounds());

  Xml xml;
  {
    const Element scene(xml, "scene", {{"version", "3.0.0"}});
    xml.comment("Written by frond from " + request.scene);
    constexpr std::string_view kVariants[] = {"mono", "rgb", "spectral"};
    xml.comment(fmt::format("For {} variants of Mitsuba; frond renders the same with wavelengths {}",
                            kVariants[size_t(spectra.variants())], spectra.frond_wavelengths()));
    if (const Vec3d& o = origins.world; o != Vec3d{})
      xml.comment(
          fmt::format("Positions are relative to ({:.10g}, {:.10g}, {:.10g}) of the scene file, because Mitsuba's "
                      "have 32 bits",
                      o.x, o.y, o.z));
    xml.comment(fmt::format("One unit of the scene file is {:g} units here, because Mitsuba offsets rays by a length",
                            context.units));
    write_view(context, xml, film, samples);
    shapes.write_materials(xml);
    write_lights(context, xml);
    shapes.write(xml);
  }
  problems.check();
  folder.finish(xml.str());
}

}  // namespace frond
