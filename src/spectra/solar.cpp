#include "spectra/solar.h"

#include <array>
#include <charconv>
#include <vector>

#include "spectra/data_files.h"
#include "spectra/tabulated.h"

namespace frond {
namespace {

constexpr size_t kColumns = 4;  // wavelength_nm, extraterrestrial, global, direct

/// Returns a column of solar.csv as a spectrum over the wavelengths in column 0.
SpectrumPtr column(size_t index) {
  std::vector<SpectrumPoint> points;
  for (size_t begin = 0; begin < solar_csv.size();) {
    const size_t end = solar_csv.find('\n', begin);
    const std::string_view line = solar_csv.substr(begin, end - begin);
    begin = end == std::string_view::npos ? solar_csv.size() : end + 1;
    if (line.empty() || line.front() == '#') continue;
    std::array<double, kColumns> values{};
    const char* at = line.data();
    for (double& value : values) at = std::from_chars(at, line.data() + line.size(), value).ptr + 1;
    points.push_back({values[0], values[index]});
  }
  return make_tabulated(points);
}

}  // namespace

SpectrumPtr solar_am0() {
  static const SpectrumPtr spectrum = column(1);
  return spectrum;
}

SpectrumPtr solar_am15_global() {
  static const SpectrumPtr spectrum = column(2);
  return spectrum;
}

SpectrumPtr solar_am15_direct() {
  static const SpectrumPtr spectrum = column(3);
  return spectrum;
}

}  // namespace frond
