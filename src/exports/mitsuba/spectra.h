#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/wavelengths.h"
#include "exports/mitsuba/xml.h"

namespace frond::mitsuba {

/// Kind of Mitsuba variants that an export is for: mono for one wavelength, rgb for three, spectral for more.
enum class Variants : uint8_t { mono, rgb, spectral };

/// Wavelengths of an export, and the conversion of frond's spectra to Mitsuba's.
///
/// rgb: a value at each of the three wavelengths; emission is divided by D65 of luminance 1, as by frond's wavelengths
/// "smpte", so that both programs give the same colours. mono: the value at the wavelength, as frond's "bands".
/// spectral: pairs of wavelength and value; emission is multiplied by the integral of ybar, by which Mitsuba's film
/// divides, so that luminance 1 is the value 1.
class Spectra {
 public:
  /// Empty: red, green and blue of frond's wavelengths "smpte". Throws InputError for two wavelengths, for those out of
  /// the visible range and for spectral ones that do not ascend.
  explicit Spectra(std::vector<double> wavelengths_nm);

  Variants variants() const { return variants_; }
  const std::vector<double>& wavelengths_nm() const { return nm_; }
  /// Returns the wavelengths as frond's option --wavelengths, for the same render in frond.
  std::string frond_wavelengths() const;
  /// Strategy with which materials and lights are made.
  const WavelengthStrategy& strategy() const { return *strategy_; }

  /// Function of up to four wavelengths.
  using AtWavelengths = std::function<SampledSpectrum(const SampledWavelengths&)>;
  /// Returns the function's values at all wavelengths.
  std::vector<double> values(const AtWavelengths& at) const;
  /// Converts an emission to Mitsuba's unit.
  std::vector<double> emission(std::vector<double> values, double scale) const;

  /// Writes a reflectance or an emission.
  void write(Xml& xml, std::string_view name, const std::vector<double>& values) const;
  /// Writes a spectrum whose values may exceed 1.
  void write_unbounded(Xml& xml, std::string_view name, const std::vector<double>& values) const;

 private:
  Variants variants_;
  std::vector<double> nm_;
  std::unique_ptr<const WavelengthStrategy> strategy_;
};

}  // namespace frond::mitsuba
