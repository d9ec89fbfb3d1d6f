#include "spectra/color/film_sensor.h"

#include <charconv>
#include <string>

#include "spectra/cie.h"
#include "spectra/color/color_space.h"
#include "spectra/daylight.h"

namespace frond {
namespace {

constexpr int kFirstCie_nm = int(kCieRange_nm.min), kLastCie_nm = int(kCieRange_nm.max);
constexpr double kTableFirst_nm = 380, kTableStep_nm = 10;

/// Values of one line of a table, from 380 nm in steps of 10 nm.
using CsvRow = std::vector<double>;

/// Value at a wavelength by linear interpolation; 0 outside the table.
double linear_at(const CsvRow& row, double nm) {
  const double x = (nm - kTableFirst_nm) / kTableStep_nm;
  if (x < 0 || x > double(row.size() - 1)) return 0;
  const auto i = std::min(size_t(x), row.size() - 2);
  return std::lerp(row[i], row[i + 1], x - double(i));
}

/// Returns the values of all lines that begin with `beginning`; comment lines are skipped.
std::vector<CsvRow> rows_of(std::string_view csv, std::string_view beginning) {
  std::vector<CsvRow> rows;
  for (size_t begin = 0; begin < csv.size();) {
    const size_t end = std::min(csv.find('\n', begin), csv.size());
    std::string_view line = csv.substr(begin, end - begin);
    begin = end + 1;
    if (line.empty() || line.front() == '#' || !line.starts_with(beginning)) continue;
    line.remove_prefix(beginning.size());
    const char* const last = line.data() + line.size();
    CsvRow row;
    for (const char* at = line.data(); at < last; ++at) {
      row.push_back(0);
      at = std::from_chars(at, last, row.back()).ptr;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<Triple> observer() {
  std::vector<Triple> curves;
  for (int nm = kFirstCie_nm; nm <= kLastCie_nm; ++nm) curves.push_back(cie_xyz(nm));
  return curves;
}

std::vector<Triple> camera(std::string_view name) {
  const std::vector<CsvRow> rows = rows_of(sensors_csv, std::string(name) + ',');
  std::vector<Triple> curves;
  for (int nm = kFirstCie_nm; nm <= kLastCie_nm; ++nm)
    curves.push_back({linear_at(rows.at(0), nm), linear_at(rows.at(1), nm), linear_at(rows.at(2), nm)});
  return curves;
}

/// Returns the sensor's response to light that a surface reflects; without `reflectance` it is white.
Triple responses(const std::vector<Triple>& curves, const Spectrum& illuminant, const CsvRow* reflectance = nullptr) {
  Triple sum{};
  for (size_t i = 0; i < curves.size(); ++i) {
    const int nm = kFirstCie_nm + int(i);
    const double light = double(illuminant.at(float(nm))) * (reflectance ? linear_at(*reflectance, nm) : 1);
    for (size_t c = 0; c < 3; ++c) sum[c] += curves[i][c] * light;
  }
  return sum;
}

/// Returns the matrix from a camera's response to XYZ that best maps (least squares) the training patches under the
/// camera's white to their XYZ under D65.
Matrix3 xyz_from_camera(const std::vector<Triple>& curves, const Spectrum& white) {
  const std::vector<Triple> eye = observer();
  const SpectrumPtr d65 = unit_d65();
  const double luminance = responses(eye, white)[1] / responses(eye, *d65)[1];
  Matrix3 squares, products;
  for (const CsvRow& patch : rows_of(training_patches_csv, "")) {
    const Triple seen = responses(curves, white, &patch), wanted = responses(eye, *d65, &patch);
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j) {
        squares.row[i][j] += seen[i] * seen[j];
        products.row[i][j] += wanted[i] * luminance * seen[j];
      }
  }
  return products * inverse(squares);
}

/// Returns the chromatic adaptation of the observer's XYZ from a white to D65.
Matrix3 xyz_from_observer(const Spectrum& white) {
  const Triple xyz = to_xyz(white);
  return bradford({xyz[0] / xyz[1], 1, xyz[2] / xyz[1]}, kD65White.xyz());
}

}  // namespace

FilmSensor::FilmSensor(std::string_view name, double white_kelvin) {
  constexpr double kOfCameras_kelvin = 6500;
  const bool is_observer = name == kFilmSensors[0];
  curves_ = is_observer ? observer() : camera(name);
  if (is_observer && white_kelvin == 0) return;
  const SpectrumPtr white = daylight(white_kelvin == 0 ? kOfCameras_kelvin : white_kelvin);
  const Matrix3 to_xyz = is_observer ? xyz_from_observer(*white) : xyz_from_camera(curves_, *white);
  for (Triple& c : curves_) c = to_xyz * c;
}

Triple FilmSensor::at(double lambda_nm) const {
  const double x = lambda_nm - kFirstCie_nm;
  if (!(x >= 0 && x <= double(curves_.size() - 1))) return {};
  const auto i = std::min(size_t(x), curves_.size() - 2);
  const double t = x - double(i);
  Triple result;
  for (size_t c = 0; c < 3; ++c) result[c] = std::lerp(curves_[i][c], curves_[i + 1][c], t);
  return result;
}

}  // namespace frond
