#include "core/plugin_module.h"

/// A film, shapes, a light and an area light, correct and faulty ones, in a shared object.
namespace frond::test {
namespace {

// Film "square".
constexpr Param kSquare[] = {
    {.name = "pixels", .kind = ParamKind::integer, .default_value = 8, .range = {0, 1e6}, .doc = "Along each side."}};
FilmSettings make_square(const Params& p) {
  const int n = p.integer("pixels");
  FilmSettings film{.width = n, .height = n};
  film.crop = {0, 0, n, n};
  film.channels = {"depth"};
  return film;
}
const FilmInfo kSquareFilm{{"film", "square", "As wide as high.", "", kSquare}, make_square};

/// Shape "tile": a square in the plane z = 0, found by its own routine.
class Tile final : public AnalyticShape {
 public:
  explicit Tile(const ShapePlacement& placement)
      : corner_(placement.to_scene.point({-1, -1, 0})),
        x_(placement.to_scene.vector({2, 0, 0})),
        y_(placement.to_scene.vector({0, 2, 0})),
        n_(normalize_any(cross(x_, y_))) {}
  Bounds bounds(unsigned) const override {
    Bounds b;
    for (const float u : {0.f, 1.f})
      for (const float v : {0.f, 1.f}) b.add(corner_ + x_ * u + y_ * v);
    return b;
  }
  std::optional<ShapePoint> intersect(unsigned, const Ray& ray, float t_min) const override {
    const float t = dot(corner_ - ray.o, n_) / dot(ray.d, n_);
    if (!(t > t_min && t < ray.t_max)) return {};
    const Vec3 at = ray.o + ray.d * t - corner_;
    const Vec2 uv{dot(at, x_) / dot(x_, x_), dot(at, y_) / dot(y_, y_)};
    if (uv.x < 0 || uv.x > 1 || uv.y < 0 || uv.y > 1) return {};
    return ShapePoint{.p = at + corner_, .ng = n_, .at = uv, .t = t};
  }
  SurfaceDerivatives derivatives(const ShapePoint&) const override { return {.dpdu = x_, .dpdv = y_}; }
  ShapePoint sample(unsigned, Vec2 u) const override {
    return {.p = corner_ + x_ * u.x + y_ * u.y, .ng = n_, .at = u, .area = area(0)};
  }
  double area(unsigned) const override { return double(length(cross(x_, y_))); }

 private:
  Vec3 corner_, x_, y_, n_;
};
MadeShape make_tile(const Params&, const ShapePlacement& placement) {
  return std::vector<ShapeGeometry>{AnalyticShapePtr(std::make_shared<Tile>(placement))};
}
const ShapeInfo kTile{{"shape", "tile", "A square.", "", {}}, make_tile};

constexpr std::string_view kHow[] = {"corner", "odd", "normals", "null", "endless"};
constexpr Param kTornParams[] = {{.name = "how",
                                  .kind = ParamKind::string,
                                  .default_value = std::string_view("corner"),
                                  .doc = "What is wrong; corner: the third one is not there.",
                                  .choices = kHow}};
MadeShape make_torn(const Params& p, const ShapePlacement&) {
  const std::string how = p.string("how");
  if (how == "null") return std::vector<ShapeGeometry>{AnalyticShapePtr()};
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->p = {{0, 0, 0}, {1, 0, 0}};
  if (how != "corner") mesh->p.push_back({0, how == "endless" ? NAN : 1, 0});
  if (how == "normals") mesh->n = {{0, 0, 1}};
  if (how == "odd") mesh->halves_from = 0;
  mesh->triangles = {{0, 1, 2}};
  return std::vector<ShapeGeometry>{MeshPtr(mesh)};
}
const ShapeInfo kTorn{{"shape", "torn", "A mesh that is none.", "", kTornParams}, make_torn};

/// AreaLightSource "glow": the radiance L on the front.
class Glow final : public AreaLight {
 public:
  Glow(SpectrumPtr spectrum, std::unique_ptr<const EmittingSurface> surface)
      : spectrum_(std::move(spectrum)), surface_(std::move(surface)) {}
  std::optional<LightSample> sample(const Vec3& p, Vec2 u, const SampledWavelengths& lambda) const override {
    const auto [point, uv, weight] = surface_->sample(u);
    const Vec3 d = point.p - p;
    const EmittingPoint at{point.p, point.ng, uv};
    if (dot(point.ng, d) >= 0) return {};
    return LightSample{radiance(at, -d, lambda) * weight, normalize_any(d), length(d), pdf(p, at)};
  }
  SampledSpectrum radiance(const EmittingPoint& at, const Vec3& w, const SampledWavelengths& lambda) const override {
    return dot(at.ng, w) > 0 ? spectrum_->sample(lambda) * surface_->opacity(at) : SampledSpectrum{};
  }
  float pdf(const Vec3& from, const EmittingPoint& at) const override {
    const Vec3 d = at.p - from;
    return dot(d, d) * length(d) / (std::abs(dot(at.ng, d)) * float(surface_->area()));
  }
  bool is_delta() const override { return !surface_->is_intersectable(); }
  double power(float) const override { return surface_->area(); }
  const Spectrum& emission() const override { return *spectrum_; }

 private:
  SpectrumPtr spectrum_;
  std::unique_ptr<const EmittingSurface> surface_;
};
class GlowEmission final : public AreaEmission {
 public:
  explicit GlowEmission(const Params& p) : spectrum_(p.spectrum("L")), makes_nothing_(p.boolean("nothing")) {}
  bool is_by_face() const override { return false; }
  std::unique_ptr<AreaLight> make_area_light(std::unique_ptr<const EmittingSurface> surface) const override {
    if (makes_nothing_) return nullptr;
    return std::make_unique<Glow>(spectrum_, std::move(surface));
  }

 private:
  SpectrumPtr spectrum_;
  bool makes_nothing_;
};
constexpr Param kGlowParams[] = {
    {.name = "L", .kind = ParamKind::illuminant, .default_value = std::array<double, 3>{1, 1, 1}, .doc = "Radiance."},
    {.name = "nothing", .kind = ParamKind::boolean, .default_value = false, .doc = "Make no light."}};
std::unique_ptr<AreaEmission> make_glow(const Params& p) { return std::make_unique<GlowEmission>(p); }
const AreaLightInfo kGlow{{"area light", "glow", "The same in every direction.", "", kGlowParams}, make_glow};

constexpr Param kThrows[] = {
    {.name = "throws", .kind = ParamKind::boolean, .default_value = false, .doc = "Throw what is no InputError."}};
std::unique_ptr<Light> make_nothing(const Params& p, const Transform&) {
  if (p.boolean("throws")) throw std::runtime_error("thrown on purpose");
  return nullptr;
}
const LightInfo kNothing{{"light", "nothing", "Not made.", "", kThrows}, make_nothing};

const FilmInfo* const kFilms[] = {&kSquareFilm};
const ShapeInfo* const kShapes[] = {&kTile, &kTorn};
const LightInfo* const kLights[] = {&kNothing};
const AreaLightInfo* const kAreaLights[] = {&kGlow};

}  // namespace
}  // namespace frond::test

const frond::PluginModule* frond_plugin() {
  using namespace frond::test;
  static const frond::PluginModule module{
      .films = kFilms, .shapes = kShapes, .lights = kLights, .area_lights = kAreaLights};
  return &module;
}
