#include "core/material.h"
#include "materials/measured/measured_data.h"
#include "spectra/check_range.h"
#include "system/file_bytes.h"
#include "system/tensor_file.h"

namespace frond {
namespace {

constexpr Param kMeasured[] = {
    {.name = "filename",
     .kind = ParamKind::string,
     .doc =
         "Tensor file with spectra (RGL, EPFL), or a table of BRDF and BTDF as frond goniophotometer writes it (CSV).",
     .required = true},
};

std::unique_ptr<MeasuredData> read(const std::filesystem::path& path, const Location& where) {
  std::string bytes = read_file_bytes(path, where, "measured BSDF");
  if (!is_tensor_file(bytes)) return read_goniometer_table(bytes, path.string());
  return read_tensor_brdf(std::move(bytes), path.string(), where);
}

// Material "measured": a BSDF by measured values. Measurements are reciprocal within their errors only, so the material
// does not claim reciprocity.
class Measured final : public Material {
 public:
  explicit Measured(const Params& p) : where_(p.where("filename")), data_(read(p.file("filename"), where_)) {}

  void prepare(const Preparation& preparation) override {
    check_range(data_->range_nm(), preparation.wavelengths, where_, "filename");
    data_->prepare(preparation.wavelengths.range_nm());
    if (const std::string warning = data_->warning(); !warning.empty()) preparation.log.warn(where_, warning);
  }
  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    return data_->bsdf(lambda, arena);
  }
  bool needs_details() const override { return !data_->is_isotropic(); }

 private:
  Location where_;
  std::unique_ptr<MeasuredData> data_;
};

}  // namespace

extern const MaterialInfo measured_material{
    {"material", "measured", "Measured BSDF.", "Dupuy and Jakob 2018; pbrt-v4", kMeasured}, make_material<Measured>};

}  // namespace frond
