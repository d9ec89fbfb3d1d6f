#include "tests/planted/planted.h"

#include "core/plugin_module.h"
#include "core/texture.h"

/// The materials that are wrong on purpose, in a shared object.
namespace frond::test {
namespace {

constexpr Param kLevel[] = {
    {.name = "level", .kind = ParamKind::real, .default_value = 0.5, .range = {0, 1}, .doc = "Below 0.9."}};

constexpr Param kTooHigh[] = {
    {.name = "level", .kind = ParamKind::real, .default_value = 0.95, .range = {0, 1}, .doc = "Too high by default."}};

/// Finds out by itself that a parameter is wrong.
struct Picky final : Material {
  explicit Picky(const Params& p) {
    if (const double level = p.real("level"); level >= 0.9)
      fail(p.where("level"), "\"level\" is {}, and picky wants less than 0.9", level);
  }
  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    return arena.make<GoodLambertian>(lambda);
  }
};

struct NotThere final : Material {
  explicit NotThere(const Params&) {}
  const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena&) const override { return nullptr; }
};

constexpr Param kReflectance[] = {{.name = "reflectance",
                                   .kind = ParamKind::spectrum_texture,
                                   .default_value = 0.5,
                                   .range = {0, 1},
                                   .doc = "Reflects 5 % more than this."}};
constexpr Param kScale[] = {
    {.name = "scale", .kind = ParamKind::real, .default_value = 0.5, .range = kAtLeastZero, .doc = "Any factor."},
    {.name = "note", .kind = ParamKind::string, .default_value = std::string_view("none"), .doc = "Free text."}};

/// A Lambertian reflector times 1.05.
struct TooBright final : Material {
  explicit TooBright(const Params& p) : reflectance(p.spectrum_texture("reflectance")) {}
  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    return arena.make<Honest>(lambda, 1.05f * reflectance->evaluate(hit.at, lambda)[0], 0.f);
  }
  std::shared_ptr<const SpectrumTexture> reflectance;
};

/// Lawful up to a scale of 1, and its range has no end.
struct Unbounded final : Material {
  explicit Unbounded(const Params& p) : scale(static_cast<float>(p.real("scale"))) { p.string("note"); }
  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    return arena.make<Honest>(lambda, scale, 0.f);
  }
  float scale;
};

const MaterialInfo kTable[] = {
    {{"material", "picky", "Refuses what it dislikes.", "", kLevel}, make_material<Picky>},
    {{"material", "picky_with_itself", "Refuses its own default.", "", kTooHigh}, make_material<Picky>},
    {{"material", "not_there", "A surface that is none.", "", {}}, make_material<NotThere>},
    planted<GoodLambertian>("good"),
    planted<GoodStochastic>("good_stochastic"),
    planted<WrongWarp>("wrong_warp"),
    planted<LostEnergy>("lost_energy"),
    planted<SampleOfAnotherF>("wrong_weight"),
    planted<PdfWithoutProbability>("wrong_pdf"),
    planted<OneWay>("one_way"),
    planted<NegativeF>("negative"),
    planted<StochasticMissesAWayOut>("misses_a_way_out"),
    planted<StochasticWrongByLittle>("wrong_cone"),
    {{"material", "too_bright", "Reflects 5 % too much.", "", kReflectance}, make_material<TooBright>},
    {{"material", "unbounded", "Brighter than white at a scale above 1.", "", kScale}, make_material<Unbounded>},
};

constexpr auto pointers() {
  std::array<const MaterialInfo*, std::size(kTable)> result{};
  for (size_t i = 0; i < result.size(); ++i) result[i] = &kTable[i];
  return result;
}
constexpr auto kMaterials = pointers();

}  // namespace
}  // namespace frond::test

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module{.materials = frond::test::kMaterials};
  return &module;
}
