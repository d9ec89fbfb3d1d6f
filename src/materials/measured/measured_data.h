#pragma once

#include <memory>
#include <string>

#include "core/arena.h"
#include "core/bsdf.h"
#include "core/wavelengths.h"

namespace frond {

/// Content of a file of a measured BSDF. Thread-safe after `prepare`.
class MeasuredData {
 public:
  virtual ~MeasuredData() = default;
  /// Wavelengths of the data.
  virtual Interval range_nm() const = 0;
  /// Whether only the difference of the azimuths matters.
  virtual bool is_isotropic() const { return true; }
  /// Makes tables for sampling at the wavelengths of a render.
  virtual void prepare(Interval /*range_nm*/) {}
  /// Returns the BSDF, allocated in `arena`.
  virtual const Bsdf* bsdf(const SampledWavelengths& lambda, Arena& arena) const = 0;
  /// Warning about changed or assumed values; empty: none.
  virtual std::string warning() const { return {}; }
};

/// Reads a tensor file, `bytes`, of Dupuy and Jakob 2018. `name` and `where` are for messages. Throws InputError.
std::unique_ptr<MeasuredData> read_tensor_brdf(std::string bytes, const std::string& name, const Location& where);
/// Reads a goniometer table (GoniometerTable). Throws InputError with `name`, line and column.
std::unique_ptr<MeasuredData> read_goniometer_table(std::string_view text, const std::string& name);

}  // namespace frond
