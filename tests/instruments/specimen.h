#pragma once

#include "core/log.h"
#include "instruments/rays.h"
#include "instruments/sweep.h"
#include "materials/registry.h"
#include "tests/support/parsed_params.h"

namespace frond::test {

/// A material made ready for one wavelength.
class Prepared {
 public:
  Prepared(const MaterialInfo& info, std::vector<ParsedParam> params, double lambda_nm) : lambda_nm_(lambda_nm) {
    PlainResolver nothing([](const std::string&) { return nullptr; });
    material_ = info.make(Params(info, {std::string(info.name), {}, std::move(params)}, nothing));
    const Log& quiet = silent_log();
    ThreadPool pool(1);
    material_->prepare({OneWavelength(lambda_nm), pool, quiet, {}});
  }
  Prepared(std::string_view name, std::vector<ParsedParam> params, double lambda_nm)
      : Prepared(PluginTable<MaterialInfo>("material", builtin_materials()).get(name, {}), std::move(params),
                 lambda_nm) {}

  LitMaterial under(double theta_deg, uint64_t seed = 0) const { return {*material_, {theta_deg, lambda_nm_}, seed}; }

 private:
  double lambda_nm_;
  std::unique_ptr<Material> material_;
};

}  // namespace frond::test
