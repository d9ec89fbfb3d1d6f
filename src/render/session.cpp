#include "render/session.h"

#include <fmt/ranges.h>

#include <map>

#include "core/projection.h"
#include "image/spectral_layout.h"
#include "image/white_balance.h"
#include "render/film/adaptive.h"
#include "render/parts/inputs.h"
#include "render/plugins.h"
#include "spectra/cie.h"
#include "spectra/color/color_management.h"
#include "spectra/color/color_space.h"

namespace frond {
namespace {

/// Matrix of the conversion between two linear colour spaces, from the conversion of the unit vectors.
Matrix3 matrix_of(std::string_view from, std::string_view to) {
  if (from == to) return Matrix3::diagonal({1, 1, 1});
  std::array<float, 9> unit{1, 0, 0, 0, 1, 0, 0, 0, 1};
  ColorManager().convert(unit, from, to);
  Matrix3 m;
  for (size_t column = 0; column < 3; ++column)
    for (size_t row = 0; row < 3; ++row) m.row[row][column] = double(unit[3 * column + row]);
  return m;
}

/// Mean film colour of paths with radiance 1 at all wavelengths.
Triple white_of(const WavelengthStrategy& wavelengths, const Matrix3& color) {
  constexpr int kPaths = 1024;
  Triple sum{};
  for (int i = 0; i < kPaths; ++i) {
    const SampledWavelengths lambda = wavelengths.sample_for_index(uint64_t(i), (float(i) + 0.5f) / float(kPaths));
    const Triple one = color * wavelengths.sensor(SampledSpectrum(1), lambda).color();
    for (size_t c = 0; c < 3; ++c) sum[c] += one[c] / kPaths;
  }
  return sum;
}

/// Returns the chromaticity of the light of a scene: the sum of its lights' spectra, weighted by their photometric
/// power. Empty if there is no visible light. Triangles of an emitting mesh are lights of one spectrum, whose integral
/// is computed once.
std::optional<Chromaticity> light_white(const World& world) {
  std::map<const Spectrum*, double> powers;
  for (const Light* light : world.lights()) powers[&light->emission()] += light->power(world.radius());
  double x = 0, y = 0, all = 0;
  for (const Light* light : world.lights()) {  // in the order of the scene: sums have the same bits each time
    const auto found = powers.find(&light->emission());
    if (found == powers.end()) continue;
    const Triple xyz = to_xyz(*found->first);
    if (xyz[1] > 0) {
      const double weight = found->second / xyz[1];
      x += weight * xyz[0], y += weight * xyz[1], all += weight * (xyz[0] + xyz[1] + xyz[2]);
    }
    powers.erase(found);
  }
  if (!(y > 0) || !(all > 0)) return {};
  return Chromaticity{x / all, y / all};
}

/// Colour space of the image's R, G and B: the scene's ColorSpace directive, else the request's colour space, else the
/// film's.
std::string space_of(const SceneSettings& description, const ImageRequest& request, std::string_view film_space) {
  if (film_space.empty()) return {};
  std::string space = request.color_space;
  if (description.color_space_where.file)
    space = color_space(description.color_space, description.color_space_where).linear_name;
  if (space.empty()) space = film_space;
  return space == kXyzName ? "linear sRGB" : space;
}

std::array<std::array<double, 4>, 3> to_double_rows(const Transform& t) {
  std::array<std::array<double, 4>, 3> rows{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j) rows[i][j] = double(t.rows()[i][j]);
  return rows;
}

/// Adds the matrices of pbrt-v4's EXR files, for column vectors: world to camera space, of a moving camera at the start
/// of its motion, and to normalized device coordinates, if the camera projects to a plane. There x and y are 0 to 1
/// along the shorter axis of the film.
void add_matrices(const SceneSettings& description, const Scene& scene, ImageFormat& image) {
  const auto set = [&image](const char* name, const Projection::Matrix& m) {
    for (size_t i = 0; i < 16; ++i) image.matrices[name][i] = float(m[i / 4][i % 4]);
  };
  Projection::Matrix view{}, ndc{};
  std::ranges::copy(description.camera_from_world.start.precise.rows(), view.begin());
  view[3] = {0, 0, 0, 1};
  set("worldToCamera", view);
  const auto* projection = dynamic_cast<const Projection*>(&scene.camera());
  if (!projection) return;
  const Projection::Matrix screen = projection->screen_from_camera();
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j)
      for (size_t k = 0; k < 4; ++k) ndc[i][j] += screen[i][k] * view[k][j];
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j) ndc[i][j] = (ndc[i][j] + ndc[3][j]) / 2;
  set("worldToNDC", ndc);
}

/// Adds an attribute with the name of each material; its number is the value in the channel `material`.
void name_materials(const SceneSettings& description, ImageFormat& image) {
  for (size_t i = 0; i < description.materials.size(); ++i) {
    const MaterialDescription& m = description.materials[i];
    image.attributes[fmt::format("frond:material:{}", i + 1)] = m.shown_name();
  }
}

/// Material without a name: its plug-in and its index, as in the channel `material`.
std::vector<std::string> material_names(const SceneSettings& description) {
  std::vector<std::string> names;
  for (const MaterialDescription& m : description.materials)
    names.push_back(m.name.empty() ? fmt::format("{}.{}", m.plugin.name, names.size() + 1) : m.name);
  return names;
}

ImageFormat image_format_of(const SceneSettings& description, const ImageRequest& request, const Scene& scene,
                            const FilmSettings& film, const ChannelList& channels) {
  const auto bands = scene.wavelengths().bands();
  ImageFormat image{.space = space_of(description, request, scene.wavelengths().film_space()),
                    .bands = {bands.begin(), bands.end()},
                    .attributes = request.attributes};
  if (film.buckets > 0) image.bands = bucket_bands(film.buckets, film.buckets_nm);
  add_matrices(description, scene, image);
  const Vec3d& origin = scene.origin();
  if (film.features_in_camera_space) {
    const SceneTransform& view = description.camera_from_world.start;
    image.from_world = origin == Vec3d{} ? to_double_rows(view) : view.relative_to(origin).precise.rows();
  }
  if (channels.has("material")) name_materials(description, image);
  if (channels.has("CryptoObject")) image.names.objects = scene.geometry().instance_names();
  if (channels.has("CryptoObject") || channels.has("CryptoMaterial"))
    image.names.materials = material_names(description);
  image.attributes["frond:version"] = FROND_VERSION;
  image.attributes["frond:seed"] = std::to_string(scene.seed());
  image.attributes["frond:wavelengths"] = scene.wavelengths_name();
  if (const auto white = light_white(scene)) image.attributes[kLightWhiteKey] = chromaticity_text(*white);
  if (origin != Vec3d{})
    image.attributes["frond:origin"] = fmt::format("{:.17g} {:.17g} {:.17g}", origin.x, origin.y, origin.z);
  image.attributes["frond:scene_hash"] = fmt::format("{:016x}", description.content_hash);
  return image;
}

/// Empty if each sample counts in one pixel only.
std::optional<Splatting> splatting_of(const Scene& scene, const Crop& whole, const Crop& pixels, bool is_part) {
  if (scene.camera().pixels_are_apart() || !scene.has_pixel_jitter() || !splats(scene.filter())) return {};
  Splatting splatting = SplatKernel(scene.filter()).splatting();
  splatting.sampled = widened(pixels, splatting.reach_x(), splatting.reach_y());
  if (is_part) {  // other parts take the samples next to this one, except outside the whole image
    Crop& sampled = splatting.sampled;
    if (pixels.x0 > whole.x0) sampled.x0 = pixels.x0;
    if (pixels.y0 > whole.y0) sampled.y0 = pixels.y0;
    if (pixels.x1 < whole.x1) sampled.x1 = pixels.x1;
    if (pixels.y1 < whole.y1) sampled.y1 = pixels.y1;
  }
  return splatting;
}

uint64_t paths_of(const Film& film) {
  uint64_t paths = 0;
  for (size_t i = 0; i < film.tiles(); ++i) paths += film.tile(i).paths();
  return paths;
}

bool has_all(const Film& film, const std::vector<uint64_t>& tile_ends) {
  for (size_t i = 0; i < film.tiles(); ++i)
    if (!film.tile(i).coverage().missing({film.tile_pixels(i), {0, tile_ends[i]}}).empty()) return false;
  return true;
}

/// Reports the fraction of the whole adaptive render instead of that of one plan.
class WholeProgress final : public Progress {
 public:
  explicit WholeProgress(Progress* next) : next_(next) {}
  void plan(uint64_t paths_before, uint64_t predicted_paths) { before_ = paths_before, predicted_ = predicted_paths; }
  void update(double, const RenderStatistics& so_far) override {
    if (next_)
      next_->update(std::min(double(before_ + so_far.paths) / double(std::max<uint64_t>(predicted_, 1)), 1.0), so_far);
  }
  void finish() override {
    if (next_) next_->finish();
  }

 private:
  Progress* next_;
  uint64_t before_ = 0, predicted_ = 0;
};

}  // namespace

void LoadedScene::check_samples(uint64_t samples) const {
  constexpr uint64_t kMost = uint64_t{1} << 30;
  if (samples > kMost) fail({}, "{} samples per pixel are requested: {} are the most", samples, kMost);
  const size_t bands = facts_.format.bands, needed = (bands + kLanes - 1) / kLanes;
  if (samples < needed)
    fail({}, "{} bands need {} samples per pixel or more, as each sample carries {} of them: {} are requested", bands,
         needed, kLanes, samples);
}

RenderInputs LoadedScene::job() const { return job_of(*scene_); }

RenderPart LoadedScene::empty_part() const {
  Film film(facts_.format, description_.film.where);
  PartHeader header;
  header.identity = identity();
  header.image = image_format_;
  header.command = facts_.command;
  header.scene_crop = scene_crop_;
  header.pixel_scale = description_.is_quick ? 2 : 1;
  return {std::move(header), std::move(film)};
}

Session::Session(const Log& log, SessionOptions options)
    : log_(log), options_(std::move(options)), registry_(load_registry(options_.plugins)), pool_(options_.threads) {}

std::vector<std::filesystem::path> Session::plugins() const { return plugin_files(options_.plugins); }

void Session::add_material(const MaterialInfo& info) {
  if (registry_.materials.find(info.name)) fail({}, "material \"{}\" already exists", info.name);
  registry_.materials.add(info);
}

SceneDescription Session::read_text(const std::string& text, const std::string& name,
                                    const Unsupported& unsupported) const {
  return read_scene_text(text, name, registry_, log_, unsupported);
}

SceneDescription Session::read(const std::filesystem::path& path, const Unsupported& unsupported) const {
  return read_scene(path, registry_, log_, unsupported);
}

SceneDescription Session::read(const std::vector<std::filesystem::path>& paths, const Unsupported& unsupported,
                               Problems& problems) const {
  return read_scene(paths, registry_, log_, unsupported, problems);
}

void Session::check(const SceneDescription& description) { Scene::check(description, registry_, pool_, log_); }

FilmSettings Session::film(const SceneSettings& description) const {
  return Scene::film_settings(description, registry_);
}

std::string name_in_messages(const MaterialDescription& material) {
  return material.name.empty() ? fmt::format("material \"{}\"", material.plugin.name)
                               : fmt::format("material \"{}\" ({})", material.name, material.plugin.name);
}

void Session::rethrow_naming_material(const std::vector<MaterialDescription>& materials) const {
  try {
    try {
      throw;
    } catch (const SurfaceError& error) {
      const MaterialDescription& material = materials.at(error.material_id);
      fail(material.plugin.where, "{}, or a light or texture at its surface, has a defect: {}{}",
           name_in_messages(material), error.what(), loaded_from(options_.plugins));
    }
  } catch (...) {
    rethrow_naming_plugins(options_.plugins);
  }
}

LoadedScene Session::load(SceneDescription description, const ImageRequest& request, const Scene* other) {
  const std::vector<MaterialDescription> materials = description.materials;
  try {
    return load_scene(std::move(description), request, other);
  } catch (...) {
    rethrow_naming_material(materials);
  }
}

LoadedScene Session::load_scene(SceneDescription description, const ImageRequest& request, const Scene* other) {
  LoadedScene loaded;
  loaded.scene_ = std::make_unique<Scene>(description, registry_, pool_, log_, cache(), other);
  FilmSettings film = loaded.scene_->film();
  loaded.scene_crop_ = film.crop;
  if (request.pixels) film.crop = *request.pixels;
  loaded.facts_ = {.plugins = plugins(),
                   .seed = loaded.scene_->seed(),
                   .wavelengths = wavelengths_plugin(description, registry_),
                   .format = {},
                   .color_space = {},
                   .command = request.command};
  FilmFormat& format = loaded.facts_.format;
  format.settings = film;
  format.splatting = splatting_of(*loaded.scene_, loaded.scene_crop_, film.crop, request.is_part);
  std::vector<std::string> channels = film.channels;
  if (!loaded.scene_->wavelengths().bands().empty())
    std::erase_if(channels, [](const std::string& name) { return !ChannelList({name}).color().empty(); });
  channels.insert(channels.end(), request.channels.begin(), request.channels.end());
  format.channels = ChannelList(channels);
  loaded.image_format_ = image_format_of(description, request, *loaded.scene_, film, format.channels);
  loaded.facts_.color_space = loaded.image_format_.space;
  if (format.splatting)
    loaded.image_format_.attributes["frond:correlated_pixels"] =
        fmt::format("{:.3f}", format.splatting->correlated_pixels);
  loaded.description_ = std::move(description);
  const WavelengthStrategy& wavelengths = loaded.scene_->wavelengths();
  format.bands = loaded.image_format_.bands.size();
  format.halves = request.adaptive;
  if (const std::string_view color = format.channels.color(); !format.has_colors() && !color.empty())
    fail({}, "channel \"{}\" is a colour: with wavelengths \"{}\" the film has bands, not colours", color,
         loaded.scene_->wavelengths_name());
  if (request.adaptive && !format.has_colors())
    fail({}, "a noise target needs a film of colours: with wavelengths \"{}\" the film has bands",
         loaded.scene_->wavelengths_name());
  if (format.has_colors()) {
    format.color = matrix_of(wavelengths.film_space(), loaded.image_format_.space);
    format.white = white_of(wavelengths, format.color);
  }
  format.exponent = film_exponent(loaded.job(), film.exposure);
  return loaded;
}

namespace {

/// Warns of impossible values, and names the plug-in that returned them.
void warn_about_fault(const PlugInFault& fault, uint64_t count, const LoadedScene& loaded, const Log& log) {
  constexpr const char* kWhat =
      "{} returned values that are negative, infinite or not a number on {} path{}: they count as black";
  const char* plural = count == 1 ? "" : "s";
  if (fault.kind == PlugInFault::Kind::material) {
    const MaterialDescription& material = loaded.description().materials[fault.index];
    log.warn(material.plugin.where, fmt::format(kWhat, name_in_messages(material), count, plural));
  } else {
    log.warn(loaded.scene().light_where(fault.index), fmt::format(kWhat, "this light", count, plural));
  }
}

}  // namespace

RenderStatistics Session::render(const LoadedScene& scene, SampleRange samples, RenderPart& part,
                                 const RenderControl& control) {
  return render_plan(scene, plan_of(part.film, samples), part, control);
}

RenderStatistics Session::render_plan(const LoadedScene& scene, const WorkPlan& plan, RenderPart& part,
                                      const RenderControl& control) {
  RenderStatistics statistics;
  try {
    statistics = frond::render(scene.job(), plan, part.film, pool_, control);
  } catch (...) {
    rethrow_naming_material(scene.description().materials);
  }
  for (const auto& [fault, count] : statistics.faults) warn_about_fault(fault, count, scene, log_);
  part.header.statistics += statistics;
  return statistics;
}

RenderStatistics Session::render_to(const LoadedScene& scene, const NoiseRequest& request, RenderPart& part,
                                    const RenderControl& control) {
  if (request.most_samples < kLeastAdaptive)
    fail({}, "at least {} samples per pixel are needed to estimate the noise, {} are allowed", kLeastAdaptive,
         request.most_samples);
  WholeProgress progress(control.progress);
  RenderControl each = control;
  each.progress = &progress;
  RenderStatistics statistics;
  PartHeader& header = part.header;
  Film& film = part.film;
  const auto change = [&](const std::function<void()>& to_next) {
    if (request.on_change)
      request.on_change(to_next, header);
    else
      to_next();
  };
  SamplePlan plan = first_plan(film);
  change([&] {
    header.adaptive = true;
    if (header.tile_ends.empty()) header.tile_ends = plan.tile_ends;
  });
  for (;;) {
    progress.plan(paths_of(film), plan.predicted_paths);
    statistics += render_plan(scene, {film.sampled(), {}, header.tile_ends}, part, each);
    if (!has_all(film, header.tile_ends)) return statistics;  // ended early
    const auto second_half = second_half_plan(film, request.most_samples);
    if (second_half) {
      plan = *second_half;
    } else {
      const NoiseUnit unit = noise_unit(film, request.is_relative);
      const NoiseEstimate noise = image_noise(film, noise_z(header.round + 1), unit);
      if (noise.upper_rms() <= request.max_rms) return statistics;
      plan = next_plan(film, request.max_rms, request.most_samples, unit, noise);
    }
    if (plan.tile_ends == header.tile_ends) return statistics;  // all tiles have the largest number of samples
    if (control.is_over()) return statistics;                   // new halves without samples would tell less
    change([&] {
      for (size_t i = 0; i < film.tiles(); ++i)
        if (plan.tile_ends[i] > samples_of(film.tile(i)).most) film.begin_second_half(i);
      header.tile_ends = plan.tile_ends;
      if (!second_half) ++header.round;
    });
  }
}

}  // namespace frond
