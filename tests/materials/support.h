#pragma once

#include <gtest/gtest.h>

#include "core/log.h"
#include "core/material.h"
#include "materials/registry.h"
#include "spectra/tabulated.h"
#include "spectra/wavelengths/registry.h"
#include "tests/support/bind.h"
#include "tests/support/parsed_params.h"
#include "tests/support/ramp.h"

namespace frond::test {

/// Spectra are the numbers given; the name of a material stands for a built-in material with its defaults; a float
/// texture "0.5:2" is the ramp between these numbers.
class Resolver final : public ParamResolver {
 public:
  std::shared_ptr<const FloatTexture> float_texture(const std::string& name, const Location&) override {
    return std::make_shared<Ramp>(std::stof(name), std::stof(name.substr(name.find(':') + 1)));
  }
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string&, const Location& w) override { none(w); }
  std::filesystem::path file(const std::string& name, const Location&) override { return name; }
  SpectrumPtr spectrum(const ParsedParam& p, SpectrumUse) override {
    return make_tabulated(std::get<std::vector<double>>(p.values), p.where);
  }
  std::shared_ptr<Material> material(const std::string& name, const Location& where) override;

 private:
  [[noreturn]] static void none(const Location& where) { fail(where, "this test has no textures"); }
};

inline const MaterialInfo& material_info(std::string_view name) {
  return PluginTable<MaterialInfo>("material", builtin_materials()).get(name, {});
}

inline std::shared_ptr<Material> Resolver::material(const std::string& name, const Location& where) {
  const MaterialInfo& info = material_info(name);
  return info.make(Params(info, {name, where, {}}, *this));
}

/// A material made ready for a render, and its BSDF at a flat hit.
class Ready {
 public:
  Ready(std::string_view material, std::vector<ParsedParam> params, std::string_view wavelengths = "smpte") {
    Resolver resolver;
    const MaterialInfo& info = material_info(material);
    material_ = info.make(Params(info, {std::string(material), {}, std::move(params)}, resolver));
    strategy_ =
        test::make_plugin(PluginTable<WavelengthsInfo>("wavelengths", builtin_wavelengths()).get(wavelengths, {}), {});
    material_->prepare({*strategy_, pool_, log_, {}});
    lambda_ = strategy_->sample(0.3f);
  }

  const Material& material() const { return *material_; }
  const SampledWavelengths& lambda() const { return lambda_; }
  void sample_wavelengths(float u) { lambda_ = strategy_->sample(u); }
  /// Deactivates the lanes before `first`, as if they carried no light.
  void retire_lanes(int first) {
    for (int lane = 0; lane < first; ++lane) lambda_.active[static_cast<size_t>(lane)] = false;
  }
  const Bsdf& bsdf(Vec2 uv = {}) {
    arena_.reset();
    return *material_->evaluate({{}, {0, 0, 1}, Frame::around(Vec3{0, 0, 1}), uv}, lambda_, arena_);
  }

 private:
  ThreadPool pool_{2};
  const Log& log_ = silent_log();
  Arena arena_;
  std::unique_ptr<Material> material_;
  std::unique_ptr<WavelengthStrategy> strategy_;
  SampledWavelengths lambda_;
};

/// Prepared for one strategy after another, with shared data, a material must equal one that is prepared alone.
inline void expect_sharing_changes_nothing(std::string_view material, const std::vector<ParsedParam>& params) {
  Resolver resolver;
  const MaterialInfo& info = material_info(material);
  const auto make = [&] { return info.make(Params(info, {std::string(material), {}, params}, resolver)); };
  const auto together = make(), holds_the_last = make();
  SharedWork shared;
  ThreadPool pool(1);
  Arena arena;
  const Log& quiet = silent_log();
  for (const char* name : {"smpte", "hero", "meyer", "smpte"}) {
    const auto strategy =
        test::make_plugin(PluginTable<WavelengthsInfo>("wavelengths", builtin_wavelengths()).get(name, {}), {});
    const auto alone = make();
    alone->prepare({*strategy, pool, quiet, {}});
    together->prepare({*strategy, pool, quiet, {}, &shared});
    const SampledWavelengths lambda = strategy->sample(0.3f);
    const auto f = [&](const Material& m) {
      RandomStream rng(1);
      return m.evaluate({{}, {0, 0, 1}, Frame::around(Vec3{0, 0, 1}), {}}, lambda, arena)
          ->f({0, 0, 1}, {0, 0, -1}, rng);
    };
    EXPECT_EQ(f(*together), f(*alone)) << name;
    holds_the_last->prepare({*strategy, pool, quiet, {}, &shared});
  }
}

}  // namespace frond::test
