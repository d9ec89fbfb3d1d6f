#include "exports/mitsuba/spectra.h"

#include <fmt/ranges.h>

#include "core/error.h"
#include "exports/format.h"
#include "instruments/given_wavelengths.h"
#include "spectra/cie.h"

namespace frond::mitsuba {
namespace {

constexpr double kSmpte_nm[] = {608, 551, 455};
constexpr double kYbarIntegral_nm = 106.7502594;  // of ybar, by which Mitsuba's film divides (MI_CIE_Y_NORMALIZATION)

/// Strategy of spectral variants: any wavelength of the list's range.
class AnyWavelength final : public WavelengthStrategy {
 public:
  explicit AnyWavelength(Interval range) : range_(range) {}
  SampledWavelengths sample(float u) const override {
    SampledWavelengths lambda;
    lambda.nm[0] = float(range_.min + double(u) * (range_.max - range_.min));
    lambda.pdf[0] = 1, lambda.active[0] = true, lambda.count = 1;
    return lambda;
  }
  Interval range_nm() const override { return range_; }
  std::span<const float> fixed_nm() const override { return {}; }
  SensorResponse sensor(const SampledSpectrum&, const SampledWavelengths&) const override { return {}; }
  std::string_view film_space() const override { return "XYZ"; }

 private:
  Interval range_;
};

}  // namespace

/// The number of wavelengths decides the variants.
Spectra::Spectra(std::vector<double> wavelengths_nm) : nm_(std::move(wavelengths_nm)) {
  if (nm_.empty()) nm_.assign(std::begin(kSmpte_nm), std::end(kSmpte_nm));
  for (const double nm : nm_)
    if (!kCieRange_nm.contains(nm))
      fail({}, "wavelengths for mitsuba lie within {} to {} nm, {} was given", kCieRange_nm.min, kCieRange_nm.max, nm);
  if (nm_.size() == 2)
    fail({}, "mitsuba takes one wavelength (mono variants), three (rgb) or more (spectral), two were given");
  variants_ = nm_.size() == 1 ? Variants::mono : nm_.size() == 3 ? Variants::rgb : Variants::spectral;
  if (variants_ == Variants::spectral) {
    check_ascending("the wavelengths of a spectral export", nm_);
    strategy_ = std::make_unique<AnyWavelength>(Interval{nm_.front(), nm_.back()});
  } else {
    strategy_ = std::make_unique<GivenWavelengths>(std::vector<float>(nm_.begin(), nm_.end()));
  }
}

/// A number of wavelengths as Mitsuba takes them has no equal strategy in frond: `hero` is the nearest.
std::string Spectra::frond_wavelengths() const {
  switch (variants_) {
    case Variants::mono:
      return fmt::format("bands,wavelengths={:g}", nm_[0]);
    case Variants::rgb:
      if (std::equal(nm_.begin(), nm_.end(), std::begin(kSmpte_nm))) return "smpte";
      return fmt::format("smpte,red={:g},green={:g},blue={:g}", nm_[0], nm_[1], nm_[2]);
    case Variants::spectral:
      break;
  }
  return "hero";
}

/// Evaluates up to four wavelengths at a time, the number that a path carries.
std::vector<double> Spectra::values(const AtWavelengths& at) const {
  std::vector<double> result;
  for (size_t first = 0; first < nm_.size(); first += kLanes) {
    SampledWavelengths lambda;
    lambda.count = int(std::min(nm_.size() - first, size_t(kLanes)));
    for (size_t i = 0; i < size_t(lambda.count); ++i)
      lambda.nm[i] = float(nm_[first + i]), lambda.pdf[i] = 1, lambda.active[i] = true;
    const SampledSpectrum s = at(lambda);
    for (int i = 0; i < lambda.count; ++i) result.push_back(double(s[i]));
  }
  return result;
}

/// See the class for the units.
std::vector<double> Spectra::emission(std::vector<double> values, double scale) const {
  for (size_t i = 0; i < values.size(); ++i) {
    values[i] *= scale;
    if (variants_ == Variants::rgb) values[i] /= double(unit_d65()->at(float(nm_[i])));
    if (variants_ == Variants::spectral) values[i] *= kYbarIntegral_nm;
  }
  return values;
}

/// Mitsuba interpolates between the pairs of a spectrum linearly.
void Spectra::write(Xml& xml, std::string_view name, const std::vector<double>& values) const {
  if (variants_ == Variants::rgb) {
    xml.element("rgb", {{"name", std::string(name)}, {"value", joined(values)}});
    return;
  }
  std::string text = joined(values);
  if (variants_ == Variants::spectral) {
    text.clear();
    for (size_t i = 0; i < values.size(); ++i)
      text += fmt::format("{}{:g}:{:.9g}", i == 0 ? "" : ", ", nm_[i], values[i]);
  }
  xml.element("spectrum", {{"name", std::string(name)}, {"value", text}});
}

/// Mitsuba's rgb reflectances end at 1.
void Spectra::write_unbounded(Xml& xml, std::string_view name, const std::vector<double>& values) const {
  if (variants_ != Variants::rgb) return write(xml, name, values);
  const Element texture(xml, "texture", {{"name", std::string(name)}, {"type", "rawconstant"}});
  xml.element("vector", {{"name", "value"}, {"value", joined(values)}});
}

}  // namespace frond::mitsuba
