#include <cmath>
#include <limits>
#include <new>
#include <numbers>

#include "core/plugin_module.h"

/// Materials, textures, a light, a shape and a wavelength strategy that fail in the way that their "fault" names, in a
/// shared object. With the fault "none" they work.
namespace hostile {
namespace {

using namespace frond;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
constexpr float kInvPi = std::numbers::inv_pi_v<float>;

/// An exception that derives from nothing.
struct NoStandardException {};

/// The faults that every kind has: exceptions.
void throw_if_asked(std::string_view fault) {
  if (fault == "runtime_error") throw std::runtime_error("thrown by the hostile plug-in");
  if (fault == "bad_alloc") throw std::bad_alloc();
  if (fault == "object") throw NoStandardException();
}

/// The value of a fault that is a number.
float number_of(std::string_view fault, float otherwise) {
  if (fault == "nan") return kNan;
  if (fault == "infinite") return kInfinity;
  if (fault == "negative") return -1;
  return otherwise;
}

// Material "hostile_material".
constexpr std::string_view kMaterialFaults[] = {"none",
                                                "make_runtime_error",
                                                "make_bad_alloc",
                                                "make_object",
                                                "prepare_runtime_error",
                                                "runtime_error",
                                                "bad_alloc",
                                                "object",
                                                "null",
                                                "f_throws",
                                                "sample_throws",
                                                "pdf_throws",
                                                "f_nan",
                                                "f_infinite",
                                                "f_negative",
                                                "pdf_nan",
                                                "pdf_infinite",
                                                "pdf_negative",
                                                "pdf_zero",
                                                "sample_f_nan",
                                                "sample_f_infinite",
                                                "sample_pdf_nan",
                                                "sample_pdf_negative",
                                                "sample_pdf_zero",
                                                "zero_direction",
                                                "nan_direction",
                                                "long_direction"};
constexpr Param kMaterialParams[] = {{.name = "fault",
                                      .kind = ParamKind::string,
                                      .default_value = std::string_view("none"),
                                      .doc = "What fails.",
                                      .choices = kMaterialFaults}};

/// Scatters evenly to both sides, but for the fault.
class HostileBsdf final : public Bsdf {
 public:
  HostileBsdf(std::string_view fault, const SampledWavelengths& lambda) : fault_(fault), lambda_(lambda) {}

  Lobes flags() const override { return Lobes::reflection | Lobes::transmission | Lobes::diffuse; }
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    if (fault_ == "f_throws") throw std::runtime_error("thrown by f of the hostile plug-in");
    if (wo.z == 0 || wi.z == 0) return {};
    return level(fault_.starts_with("f_") ? number_of(fault_.substr(2), kLevel) : kLevel);
  }
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream&) const override {
    if (fault_ == "sample_throws") throw std::runtime_error("thrown by sample of the hostile plug-in");
    if (wo.z == 0) return {};
    const float radius = std::sqrt(u.x), phi = 2 * std::numbers::pi_v<float> * u.y;
    Vec3 wi{radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(0.f, 1 - u.x))};
    if ((uc < 0.5f) != (wo.z > 0)) wi.z = -wi.z;
    if (wi.z == 0) return {};
    const Lobes side = wi.z * wo.z > 0 ? Lobes::reflection : Lobes::transmission;
    BsdfSample s{.f = level(kLevel), .wi = wi, .pdf = std::abs(wi.z) * kInvPi / 2, .flags = side | Lobes::diffuse};
    if (fault_ == "sample_f_nan") s.f = level(kNan);
    if (fault_ == "sample_f_infinite") s.f = level(kInfinity);
    if (fault_ == "sample_pdf_nan") s.pdf = kNan;
    if (fault_ == "sample_pdf_negative") s.pdf = -1;
    if (fault_ == "sample_pdf_zero") s.pdf = 0;
    if (fault_ == "zero_direction") s.wi = {0, 0, 0};
    if (fault_ == "nan_direction") s.wi = {kNan, kNan, kNan};
    if (fault_ == "long_direction") s.wi = wi * 1e30f;
    return s;
  }
  float pdf(const Vec3& wo, const Vec3& wi) const override {
    if (fault_ == "pdf_throws") throw std::runtime_error("thrown by pdf of the hostile plug-in");
    if (fault_ == "pdf_zero" || wo.z == 0) return 0;
    const float density = std::abs(wi.z) * kInvPi / 2;
    return fault_.starts_with("pdf_") ? number_of(fault_.substr(4), density) : density;
  }

 private:
  static constexpr float kLevel = 0.4f * kInvPi;
  SampledSpectrum level(float x) const {
    SampledSpectrum s;
    for (int i = 0; i < lambda_.count; ++i)
      if (lambda_.is_active(i)) s[i] = x;
    return s;
  }

  std::string_view fault_;
  SampledWavelengths lambda_;
};

class HostileMaterial final : public Material {
 public:
  explicit HostileMaterial(const Params& p) : fault_(p.string("fault")) {
    if (fault_.starts_with("make_")) throw_if_asked(std::string_view(fault_).substr(5));
  }
  void prepare(const Preparation&) override {
    if (fault_ == "prepare_runtime_error") throw_if_asked("runtime_error");
  }
  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    throw_if_asked(fault_);
    if (fault_ == "null") return nullptr;
    return arena.make<HostileBsdf>(fault_, lambda);
  }

 private:
  std::string fault_;
};
const MaterialInfo kMaterial{{"material", "hostile_material", "Fails on purpose.", "", kMaterialParams},
                             make_material<HostileMaterial>};

// Textures "hostile_float" and "hostile_spectrum".
constexpr std::string_view kFaults[] = {
    "none", "make_runtime_error", "make_bad_alloc", "make_object", "runtime_error", "bad_alloc", "object",
    "nan",  "infinite",           "negative"};
constexpr Param kParams[] = {{.name = "fault",
                              .kind = ParamKind::string,
                              .default_value = std::string_view("none"),
                              .doc = "What fails.",
                              .choices = kFaults}};

std::string fault_of(const Params& p) {
  const std::string fault = p.string("fault");
  if (fault.starts_with("make_")) throw_if_asked(std::string_view(fault).substr(5));
  return fault;
}

/// Says that it lies in [0, 1], whatever it returns.
class HostileFloat final : public FloatTexture {
 public:
  explicit HostileFloat(std::string fault) : fault_(std::move(fault)) {}
  float evaluate(const TexturePoint&) const override {
    throw_if_asked(fault_);
    return number_of(fault_, 0.5f);
  }
  Interval range() const override { return {0, 1}; }

 private:
  std::string fault_;
};
std::unique_ptr<FloatTexture> make_float(const Params& p, const TexturePlacement&) {
  return std::make_unique<HostileFloat>(fault_of(p));
}
const FloatTextureInfo kFloat{{"float texture", "hostile_float", "Fails on purpose.", "", kParams}, make_float};

class HostileSpectrum final : public SpectrumTexture {
 public:
  explicit HostileSpectrum(std::string fault) : fault_(std::move(fault)) {}
  SampledSpectrum evaluate(const TexturePoint&, const SampledWavelengths&) const override {
    throw_if_asked(fault_);
    return SampledSpectrum(number_of(fault_, 0.5f));
  }
  Interval range_nm() const override { return {300, 2500}; }
  float max_value() const override { return 1; }

 private:
  std::string fault_;
};
std::unique_ptr<SpectrumTexture> make_spectrum(const Params& p, const TexturePlacement&) {
  return std::make_unique<HostileSpectrum>(fault_of(p));
}
const SpectrumTextureInfo kSpectrum{{"spectrum texture", "hostile_spectrum", "Fails on purpose.", "", kParams},
                                    make_spectrum};

// Light "hostile_light".
class HostileLight final : public Light {
 public:
  HostileLight(const Params& p, SpectrumPtr emission) : fault_(fault_of(p)), emission_(std::move(emission)) {}
  std::optional<LightSample> sample(const Vec3&, Vec2, const SampledWavelengths&) const override {
    throw_if_asked(fault_);
    LightSample sample{SampledSpectrum(number_of(fault_, 1)), {0, 0, -1}, kInfinity, 1};
    if (fault_ == "distance_nan") sample.distance = NAN;
    if (fault_ == "distance_zero") sample.distance = 0;
    if (fault_ == "pdf_negative") sample.pdf = -1;
    if (fault_ == "nan_direction") sample.wi.x = NAN;
    if (fault_ == "long_direction") sample.wi = {0, 0, -2};
    return sample;
  }
  bool is_delta() const override { return true; }
  bool is_distant() const override { return true; }
  double power(float) const override { return 1; }
  const Spectrum& emission() const override { return *emission_; }

 private:
  std::string fault_;
  SpectrumPtr emission_;
};
constexpr std::string_view kLightFaults[] = {"none",          "make_runtime_error", "make_bad_alloc", "make_object",
                                             "runtime_error", "bad_alloc",          "object",         "nan",
                                             "infinite",      "negative",           "distance_nan",   "distance_zero",
                                             "pdf_negative",  "nan_direction",      "long_direction"};
constexpr Param kLightParams[] = {
    {.name = "fault",
     .kind = ParamKind::string,
     .default_value = std::string_view("none"),
     .doc = "What fails.",
     .choices = kLightFaults},
    {.name = "L", .kind = ParamKind::illuminant, .default_value = std::array<double, 3>{1, 1, 1}, .doc = "Emission."}};
std::unique_ptr<Light> make_hostile_light(const Params& p, const Transform&) {
  return std::make_unique<HostileLight>(p, p.spectrum("L"));
}
const LightInfo kLight{{"light", "hostile_light", "Fails on purpose.", "", kLightParams}, make_hostile_light};

// Shape "hostile_shape": a square in z = 1, which is found by its own routine.
constexpr std::string_view kShapeFaults[] = {"none",          "make_runtime_error", "make_bad_alloc", "make_object",
                                             "runtime_error", "bad_alloc",          "object",         "nan",
                                             "nan_bounds",    "nan_normal"};
constexpr Param kShapeParams[] = {{.name = "fault",
                                   .kind = ParamKind::string,
                                   .default_value = std::string_view("none"),
                                   .doc = "What fails.",
                                   .choices = kShapeFaults}};
class HostileShape final : public AnalyticShape {
 public:
  explicit HostileShape(std::string fault) : fault_(std::move(fault)) {}
  Bounds bounds(unsigned) const override {
    Bounds b;
    const float end = fault_ == "nan_bounds" ? kNan : 2;
    b.add({-end, -end, 1});
    b.add({end, end, 1});
    return b;
  }
  std::optional<ShapePoint> intersect(unsigned, const Ray& ray, float t_min) const override {
    throw_if_asked(fault_);
    const float t = fault_ == "nan" ? kNan : (1 - ray.o.z) / ray.d.z;
    if (fault_ != "nan" && !(t > t_min && t < ray.t_max)) return {};
    const Vec3 p = ray.o + ray.d * t;
    return ShapePoint{.p = p, .ng = {0, 0, fault_ == "nan_normal" ? kNan : -1}, .at = {p.x, p.y}, .t = t};
  }
  SurfaceDerivatives derivatives(const ShapePoint&) const override { return {.dpdu = {1, 0, 0}, .dpdv = {0, -1, 0}}; }
  ShapePoint sample(unsigned, Vec2 u) const override {
    return {.p = {4 * u.x - 2, 4 * u.y - 2, 1}, .ng = {0, 0, -1}, .at = u, .area = 16};
  }
  double area(unsigned) const override { return 16; }

 private:
  std::string fault_;
};
MadeShape make_hostile_shape(const Params& p, const ShapePlacement&) {
  return std::vector<ShapeGeometry>{AnalyticShapePtr(std::make_shared<HostileShape>(fault_of(p)))};
}
const ShapeInfo kShape{{"shape", "hostile_shape", "Fails on purpose.", "", kShapeParams}, make_hostile_shape};

// Wavelength strategy "hostile_wavelengths": three bands, of which one is what the fault names.
class HostileWavelengths final : public WavelengthStrategy {
 public:
  explicit HostileWavelengths(std::string fault) : fault_(std::move(fault)) {}
  SampledWavelengths sample(float) const override {
    throw_if_asked(fault_);
    SampledWavelengths lambda;
    lambda.count = 3;
    for (size_t i = 0; i < 3; ++i) lambda.nm[i] = kNm[i], lambda.pdf[i] = 1, lambda.active[i] = true;
    lambda.nm[0] = number_of(fault_, kNm[0]);
    return lambda;
  }
  Interval range_nm() const override { return {kNm[2], kNm[0]}; }
  std::span<const float> fixed_nm() const override { return kNm; }
  SensorResponse sensor(const SampledSpectrum& radiance, const SampledWavelengths&) const override {
    return std::array<double, 3>{double(radiance[0]), double(radiance[1]), double(radiance[2])};
  }
  std::string_view film_space() const override { return "linear sRGB"; }

 private:
  static constexpr float kNm[] = {608, 551, 455};
  std::string fault_;
};
std::unique_ptr<WavelengthStrategy> make_wavelengths(const Params& p) {
  return std::make_unique<HostileWavelengths>(fault_of(p));
}
const WavelengthsInfo kWavelengths{{"wavelengths", "hostile_wavelengths", "Fails on purpose.", "", kParams},
                                   make_wavelengths};

const MaterialInfo* const kMaterials[] = {&kMaterial};
const FloatTextureInfo* const kFloatTextures[] = {&kFloat};
const SpectrumTextureInfo* const kSpectrumTextures[] = {&kSpectrum};
const LightInfo* const kLights[] = {&kLight};
const ShapeInfo* const kShapes[] = {&kShape};
const WavelengthsInfo* const kStrategies[] = {&kWavelengths};

}  // namespace
}  // namespace hostile

const frond::PluginModule* frond_plugin() {
  using namespace hostile;
  static const frond::PluginModule module{.materials = kMaterials,
                                          .wavelengths = kStrategies,
                                          .shapes = kShapes,
                                          .lights = kLights,
                                          .float_textures = kFloatTextures,
                                          .spectrum_textures = kSpectrumTextures};
  return &module;
}
