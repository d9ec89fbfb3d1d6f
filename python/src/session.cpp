#include <mutex>

#include "common.h"
#include "core/problems.h"
#include "image/image_file.h"
#include "render/image_output.h"
#include "render/part_file.h"
#include "study/choose/choice.h"
#include "study/choose/choice_report.h"

namespace frond::python {
namespace {

using namespace nb::literals;

struct SceneHandle {
  std::shared_ptr<SessionHandle> owner;
  LoadedScene scene;
  std::string choice;  ///< what was chosen for an open leaf, as JSON
  bool is_adaptive = false;
};

/// What has been rendered of a scene so far. One thread at a time.
struct PictureHandle {
  std::shared_ptr<SceneHandle> scene;
  RenderPart part;
};

/// What is said over what the scene says.
struct LoadArguments {
  std::string wavelengths, integrator, filter, color_space;
  std::vector<std::pair<std::string, std::string>> swaps;
  std::vector<std::string> channels;
  std::optional<uint64_t> seed;
  std::optional<std::array<int, 4>> pixels;
  uint64_t samples = 0;
  bool quick = false, adaptive = false;
};

std::shared_ptr<SceneHandle> load(const std::shared_ptr<SessionHandle>& owner, SceneDescription description,
                                  const LoadArguments& a) {
  const nb::gil_scoped_release release;
  Session& session = owner->session;
  SceneOverrides overrides;
  for (const auto& [from, to] : a.swaps) overrides.swaps.push_back({from, parse_plugin_text(to, {})});
  overrides.wavelengths = a.wavelengths, overrides.seed = a.seed, overrides.quick = a.quick;
  if (!a.integrator.empty()) overrides.integrator = parse_plugin_text(a.integrator, {});
  if (!a.filter.empty()) overrides.filter = parse_plugin_text(a.filter, {});
  apply_overrides(overrides, description, session.registry(), session.log());
  PictureRequest request{
      .channels = a.channels, .color_space = a.color_space, .adaptive = a.adaptive, .command = "python"};
  if (a.pixels) {
    const auto [x0, x1, y0, y1] = *a.pixels;
    const FilmSettings film = session.film(description);
    if (!(0 <= x0 && x0 < x1 && x1 <= film.width && 0 <= y0 && y0 < y1 && y1 <= film.height))
      fail({}, "pixels: ({}, {}, {}, {}) is no part of a film of {} x {}: (x0, x1, y0, y1) is needed", x0, x1, y0, y1,
           film.width, film.height);
    request.pixels = Crop{x0, y0, x1, y1};
  }
  auto handle = std::make_shared<SceneHandle>(owner, LoadedScene{}, "", a.adaptive);
  std::shared_ptr<const Scene> pilot;
  if (auto chosen = choose::choose_for(session, description, a.samples, request)) {
    handle->choice = choose::choice_json(chosen->choice);
    pilot = std::move(chosen->scene);
  }
  handle->scene = session.load(std::move(description), request, pilot.get());
  return handle;
}

/// Adds samples until each pixel has `samples`, or the noise is below `max_rms`, or the time is over.
void render_more(PictureHandle& picture, uint64_t samples, double max_rms, double time_limit_seconds,
                 const nb::object& progress) {
  Session& session = picture.scene->owner->session;
  const LoadedScene& scene = picture.scene->scene;
  if (samples == 0) samples = scene.samples();
  if (max_rms == 0) scene.check_samples(samples);
  run(
      [&](RenderControl control) {
        if (time_limit_seconds > 0)
          control.deadline =
              std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                                     std::chrono::duration<double>(time_limit_seconds));
        if (max_rms > 0)
          session.render_to(scene, {.max_rms = max_rms}, picture.part, control);
        else
          session.render(scene, {0, samples}, picture.part, control);
      },
      progress);
}

nb::dict statistics_of(const RenderStatistics& s) {
  nb::dict d;
  d["paths"] = s.paths, d["rays"] = s.rays;
  d["wall_seconds"] = s.wall_seconds, d["cpu_seconds"] = s.cpu_seconds;
  return d;
}

}  // namespace

void bind_session(nb::module_& m) {
  m.def(
      "read_image",
      [](const std::string& path) {
        Image image;
        {
          const nb::gil_scoped_release release;
          image = read_image(path, {}).image;
        }
        const std::vector<size_t> shape{size_t(image.height), size_t(image.width), image.channels.size()};
        return std::pair(image.channels, to_array(std::move(image.pixels), shape));
      },
      "path"_a);

  nb::class_<SceneDescription>(m, "SceneDescription", "A scene as data: nothing is loaded yet.")
      .def_prop_ro("files", [](const SceneDescription& d) { return d.files; });

  nb::class_<PictureHandle>(m, "Picture")
      .def("image",
           [](const PictureHandle& p) {
             Image image;
             {
               const nb::gil_scoped_release release;
               image = film_image(p.part.film, finished_picture(p.part));
             }
             const std::vector<size_t> shape{size_t(image.height), size_t(image.width), image.channels.size()};
             return std::pair(image.channels, to_array(std::move(image.pixels), shape));
           })
      .def("render_more", &render_more, "samples"_a, "max_rms"_a, "time_limit"_a, "progress"_a.none())
      .def("samples",
           [](const PictureHandle& p) {
             const SampleCount count = sample_count(p.part.film);
             return std::pair(count.least, count.most);
           })
      .def("statistics", [](const PictureHandle& p) { return statistics_of(p.part.header.statistics); })
      .def("attributes", [](const PictureHandle& p) { return finished_picture(p.part).attributes; })
      .def_prop_ro("color_space", [](const PictureHandle& p) { return p.part.header.picture.space; })
      .def(
          "save",
          [](const PictureHandle& p, const std::string& path) {
            const nb::gil_scoped_release release;
            const ImageOutput output(path, {});
            output.check(p.scene->scene.picture());
            output.write(p.part.film, finished_picture(p.part));
          },
          "path"_a)
      .def(
          "save_part",
          [](const PictureHandle& p, const std::string& path) {
            const nb::gil_scoped_release release;
            write_part(path, p.part.header, p.part.film);
          },
          "path"_a);

  nb::class_<SceneHandle>(m, "Scene")
      .def_prop_ro("width", [](const SceneHandle& s) { return s.scene.film_format().settings.width; })
      .def_prop_ro("height", [](const SceneHandle& s) { return s.scene.film_format().settings.height; })
      .def_prop_ro("samples", [](const SceneHandle& s) { return s.scene.samples(); })
      .def_prop_ro("color_space", [](const SceneHandle& s) { return s.scene.picture().space; })
      .def_prop_ro("is_adaptive", [](const SceneHandle& s) { return s.is_adaptive; })
      .def_prop_ro("choice", [](const SceneHandle& s) { return s.choice; })
      .def_prop_ro("materials",
                   [](const SceneHandle& s) {
                     std::vector<std::pair<std::string, std::string>> names;
                     for (const auto& d : s.scene.description().materials) names.emplace_back(d.name, d.plugin.name);
                     return names;
                   })
      .def("picture", [](const std::shared_ptr<SceneHandle>& s) {
        return std::make_unique<PictureHandle>(s, s->scene.empty_part());
      });

  nb::class_<SessionHandle>(m, "Session")
      .def(
          "__init__",
          [](SessionHandle* self, int threads, const std::string& cache, const std::vector<std::string>& plugins) {
            new (self) SessionHandle({threads, cache, plugins});
          },
          "threads"_a = 0, "cache"_a = "", "plugins"_a = std::vector<std::string>())
      .def_prop_ro("threads", [](SessionHandle& s) { return s.session.pool().size(); })
      .def(
          "names",
          [](const SessionHandle& s, const std::string& kind) {
            std::vector<std::pair<std::string, std::string>> names;
            for (const PluginInfo* info : all_plugins(s.session.registry()))
              if (info->kind == kind) names.emplace_back(info->name, info->doc);
            return names;
          },
          "kind"_a)
      .def(
          "read",
          [](const SessionHandle& s, const std::string& path, const std::optional<std::string>& text) {
            const nb::gil_scoped_release release;
            return text ? s.session.read_text(*text, path) : s.session.read(path);
          },
          "path"_a, "text"_a.none() = nb::none())
      .def(
          "load",
          [](const std::shared_ptr<SessionHandle>& self, const SceneDescription& description,
             const std::string& wavelengths, const std::vector<std::pair<std::string, std::string>>& swaps,
             const std::string& integrator, const std::string& filter, const std::vector<std::string>& channels,
             const std::string& color_space, std::optional<uint64_t> seed, std::optional<std::array<int, 4>> pixels,
             uint64_t samples, bool quick, bool adaptive) {
            return load(self, description,
                        {wavelengths, integrator, filter, color_space, swaps, channels, seed, pixels, samples, quick,
                         adaptive});
          },
          "description"_a, nb::kw_only(), "wavelengths"_a = "",
          "swaps"_a = std::vector<std::pair<std::string, std::string>>(), "integrator"_a = "", "filter"_a = "",
          "channels"_a = std::vector<std::string>(), "color_space"_a = "", "seed"_a.none() = nb::none(),
          "pixels"_a.none() = nb::none(), "samples"_a = 0, "quick"_a = false, "adaptive"_a = false);
}

}  // namespace frond::python
