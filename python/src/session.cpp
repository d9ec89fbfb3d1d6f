#include "image/display_image.h"
#include "image/image_file.h"
#include "image/rgb_file.h"
#include "render/image_output.h"
#include "render/parts/inputs.h"
#include "render/parts/part_file.h"
#include "render/plugins.h"
#include "scene_handle.h"
#include "study/choose/choice_report.h"

namespace frond::python {
namespace {

using namespace nb::literals;

/// Partial render of a scene. For one thread at a time.
struct ImageHandle {
  std::shared_ptr<SceneHandle> scene;
  RenderPart part;
};

std::shared_ptr<SceneHandle> load(const std::shared_ptr<SessionHandle>& owner, const std::string& path,
                                  const std::optional<std::string>& text, const GivenArguments& given, bool adaptive) {
  Arguments args = arguments_of(kRenderJob, given);
  args.set("scene", path);
  args.check();
  std::shared_ptr<SceneHandle> scene;
  run(
      [&](const RenderControl& control) {
        const StopScope stop(control.stop);
        owner->context.log().begin(args.flag("strict"));
        scene = std::make_shared<SceneHandle>(owner, std::move(args), adaptive);
        if (text)
          scene->task.read_text(*text, path);
        else
          scene->task.read({{path}});
        scene->task.choose(nullptr, {});
        scene->task.load(nullptr);
        const SceneDescription& loaded = scene->task.scene().description();
        scene->files = states_of(input_files(loaded, wavelengths_plugin(loaded, owner->session().registry())));
        owner->context.log().check();
      },
      nb::none());
  return scene;
}

/// Adds samples until each pixel has `samples`, or the noise is below `max_rms`, if that is above 0, or the time is
/// over.
void render_more(ImageHandle& image, uint64_t samples, double max_rms, double time_limit_seconds,
                 const nb::object& progress) {
  SceneHandle& handle = *image.scene;
  Session& session = handle.owner->session();
  const LoadedScene& scene = handle.task.scene();
  if (max_rms > 0 && !handle.task.is_adaptive()) fail({}, "max_rms: the scene was not loaded for an adaptive render");
  scene.check_samples(samples);
  run(
      [&](const RenderControl& control) {
        const RenderControl until =
            JobRun{handle.owner->context, handle.args, control}.control_until(time_limit_seconds);
        if (max_rms > 0)
          session.render_to(scene, {.max_rms = max_rms, .most_samples = samples}, image.part, until);
        else
          session.render(scene, {0, samples}, image.part, until);
      },
      progress);
}

nb::dict statistics_of(const RenderStatistics& s) {
  nb::dict d;
  d["paths"] = s.paths, d["rays"] = s.rays;
  d["wall_seconds"] = s.wall_seconds, d["cpu_seconds"] = s.cpu_seconds;
  return d;
}

/// Names of the channels, and float32 [row][column][channel].
auto arrays_of(Image image) {
  const std::vector<size_t> shape{size_t(image.height), size_t(image.width), image.channels.size()};
  return std::pair(image.channels, to_array(std::move(image.pixels), shape));
}

/// Float32 [row][column][3].
using Rgb = nb::ndarray<const float, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;

/// Writes linear colours. The header is copied from the file `like`, if it is not empty, without attributes that do not
/// apply to these colours. Throws InputError.
void write_rgb(const std::string& path, const Rgb& rgb, std::string space, const std::string& like) {
  check_writable(path);
  std::map<std::string, std::string> text{{"frond:version", FROND_VERSION}};
  if (!like.empty()) {
    const ImageFile file = read_image(like, {});
    for (const auto& [name, value] : file.header.text)
      if (name.starts_with("frond:") && name != "frond:correlated_pixels" && name != "frond:noise_rms")
        text[name] = value;
    if (space.empty()) space = file.header.color_space;
    if (const ColorSpace* known = color_space_of(file); space.empty() && known) space = known->linear_name;
  }
  if (space.empty()) space = "linear sRGB";
  if (space != kXyzName) space = color_space(space, {}).linear_name;
  Image image(int(rgb.shape(1)), int(rgb.shape(0)), {"R", "G", "B"});
  std::copy_n(rgb.data(), rgb.size(), image.pixels.begin());
  if (is_exr(path))
    write_image(path, image, {space, text});
  else
    write_display_image(path, image, space, ColorManager(), {}, text);
}

}  // namespace

void bind_session(nb::module_& m) {
  m.def(
      "write_image",
      [](const std::string& path, const Rgb& rgb, const std::string& space, const std::string& like) {
        const nb::gil_scoped_release release;
        write_rgb(path, rgb, space, like);
      },
      "path"_a, "rgb"_a, "color_space"_a, "like"_a);

  m.def(
      "read_image",
      [](const std::string& path) {
        ImageFile file;
        {
          const nb::gil_scoped_release release;
          file = read_image(path, {});
        }
        for (const std::string& message : file.left_out) PythonLog().warn({}, message);
        return arrays_of(std::move(file.image));
      },
      "path"_a);

  nb::class_<ImageHandle>(m, "Image")
      .def("pixels",
           [](const ImageHandle& p) {
             Image image;
             {
               const nb::gil_scoped_release release;
               image = film_image(p.part.film, finished_format(p.part));
             }
             return arrays_of(std::move(image));
           })
      .def("render_more", &render_more, "samples"_a, "max_rms"_a, "time_limit"_a, "progress"_a.none())
      .def("samples",
           [](const ImageHandle& p) {
             const SampleCount count = sample_count(p.part.film);
             return std::pair(count.least, count.most);
           })
      .def("statistics", [](const ImageHandle& p) { return statistics_of(p.part.header.statistics); })
      .def("attributes", [](const ImageHandle& p) { return finished_format(p.part).attributes; })
      .def_prop_ro("color_space", [](const ImageHandle& p) { return p.part.header.image.space; })
      .def(
          "save",
          [](const ImageHandle& p, const std::string& path) {
            const nb::gil_scoped_release release;
            const ImageOutput output(path, {});
            output.check(p.scene->task.scene().image_format());
            output.write(p.part.film, finished_format(p.part));
          },
          "path"_a)
      .def(
          "save_part",
          [](const ImageHandle& p, const std::string& path) {
            const nb::gil_scoped_release release;
            write_part(path, p.part.header, p.part.film);
          },
          "path"_a);

  nb::class_<SceneHandle>(m, "Scene")
      .def_prop_ro("path", [](const SceneHandle& s) { return s.args.words("scene").front(); })
      .def_prop_ro("width", [](const SceneHandle& s) { return s.task.scene().film_format().settings.width; })
      .def_prop_ro("height", [](const SceneHandle& s) { return s.task.scene().film_format().settings.height; })
      .def_prop_ro("samples", [](const SceneHandle& s) { return s.task.samples().end; })
      .def_prop_ro("color_space", [](const SceneHandle& s) { return s.task.scene().image_format().space; })
      .def_prop_ro("is_adaptive", [](const SceneHandle& s) { return s.task.is_adaptive(); })
      .def_prop_ro(
          "choice",
          [](const SceneHandle& s) { return s.task.choice() ? choose::choice_json(*s.task.choice()) : std::string(); })
      .def_prop_ro("materials",
                   [](const SceneHandle& s) {
                     std::vector<std::pair<std::string, std::string>> names;
                     for (const auto& d : s.task.scene().description().materials)
                       names.emplace_back(d.name, d.plugin.name);
                     return names;
                   })
      .def("image", [](const std::shared_ptr<SceneHandle>& s) {
        return std::make_unique<ImageHandle>(s, s->task.empty_part());
      });

  nb::class_<SessionHandle>(m, "Session")
      .def(
          "__init__",
          [](SessionHandle* self, int threads, const std::string& cache, const std::vector<std::string>& plugins) {
            new (self) SessionHandle({threads, cache, plugins});
          },
          "threads"_a = 0, "cache"_a = "", "plugins"_a = std::vector<std::string>())
      .def_prop_ro("threads", [](SessionHandle& s) { return s.session().pool().size(); })
      .def(
          "names",
          [](SessionHandle& s, const std::string& kind) {
            std::vector<std::pair<std::string, std::string>> names;
            for (const PluginInfo* info : all_plugins(s.session().registry()))
              if (info->kind == kind) names.emplace_back(info->name, info->doc);
            return names;
          },
          "kind"_a)
      .def("load", &load, "path"_a, "text"_a.none(), "arguments"_a, "adaptive"_a);
}

}  // namespace frond::python
