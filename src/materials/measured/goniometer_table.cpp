#include "materials/measured/goniometer_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/messages/counted.h"

namespace frond {
namespace {

constexpr double kRadian = double(kPi) / 180;

/// Angles that differ by less than 0.001 degrees are equal.
using Angle = int64_t;
Angle rounded(double degrees) { return std::llround(degrees * 1000); }
double degrees(Angle angle) { return double(angle) / 1000; }
constexpr Angle kTurn = 360000, kHorizon = 90000;

/// Values of one polar angle by azimuth.
using Ring = std::map<Angle, double>;
/// Rings of one incidence and wavelength by polar angle.
struct Rings {
  std::map<Angle, Ring> by_theta;
  double solid_angle = 0, share = 0;  ///< projected solid angle of all patches, sr; sum of f times that of each

  /// Whether the rows are means over patches that cover the hemisphere: then `share` is the reflectance.
  bool has_share() const { return std::abs(solid_angle - double(kPi)) < 1e-3; }
};
/// All of one lit side and one hemisphere by incidence (from the lit side's normal) and wavelength.
using Hemisphere = std::map<Angle, std::map<float, Rings>>;

/// Linear between the azimuths, around the turn.
double at(const Ring& ring, Angle phi) {
  auto above = ring.lower_bound(phi);
  if (above != ring.end() && above->first == phi) return above->second;
  const auto below = above == ring.begin() ? std::prev(ring.end()) : std::prev(above);
  if (above == ring.end()) above = ring.begin();
  const auto turned = [](Angle angle) { return double((angle + kTurn) % kTurn); };
  const double width = turned(above->first - below->first);
  if (width == 0) return below->second;
  const double t = turned(phi - below->first) / width;
  return (1 - t) * below->second + t * above->second;
}

/// Mean over the azimuth.
double mean(const Ring& ring) {
  double sum = 0;
  for (auto i = ring.begin(); i != ring.end(); ++i) {
    const auto next = std::next(i) == ring.end() ? ring.begin() : std::next(i);
    const Angle width = next->first - i->first + (next == ring.begin() ? kTurn : 0);
    sum += double(width) * (i->second + next->second) / 2;
  }
  return sum / double(kTurn);
}

/// Value at a direction; see the class.
double at(const std::map<Angle, Ring>& rings, Angle theta, Angle phi) {
  const auto above = rings.lower_bound(theta);
  if (above == rings.end()) return at(std::prev(above)->second, phi);
  const bool is_first = above == rings.begin();
  const Angle below = is_first ? 0 : std::prev(above)->first;
  const double first = is_first ? mean(above->second) : at(std::prev(above)->second, phi);
  if (above->first == below) return first;  // a ring at the pole
  const double t = double(theta - below) / double(above->first - below);
  return (1 - t) * first + t * at(above->second, phi);
}

/// Rows in hemispheres: [lit side][side that the light leaves on, the lit one first].
struct Sorted {
  std::array<std::array<Hemisphere, 2>, 2> hemispheres;
  std::set<float> nm;
  size_t negative = 0;

  explicit Sorted(const std::vector<GoniometerRow>& rows) {
    const bool one_half = std::ranges::all_of(rows, [](const auto& row) { return row.phi_deg <= 180; });
    for (const GoniometerRow& row : rows) {
      const bool front = row.is_front_lit(), above = row.theta_deg < 90;
      const Angle incidence = rounded(front ? row.incidence_deg : 180 - row.incidence_deg);
      Hemisphere& hemisphere = hemispheres[front ? 0 : 1][row.is_reflected() ? 0 : 1];
      Rings& rings = hemisphere[incidence][float(row.wavelength_nm)];
      Ring& ring = rings.by_theta[rounded(above ? row.theta_deg : 180 - row.theta_deg)];
      const Angle phi = rounded(row.phi_deg) % kTurn;
      const double value = std::max(0.0, row.f);
      negative += row.f < 0 ? 1 : 0;
      nm.insert(float(row.wavelength_nm));
      rings.solid_angle += row.projected_solid_angle, rings.share += value * row.projected_solid_angle;
      if (!ring.emplace(phi, value).second)
        fail(row.where, "there are two values for theta_deg {}, phi_deg {}, incidence_deg {} and {} nm", row.theta_deg,
             row.phi_deg, row.incidence_deg, row.wavelength_nm);
      if (one_half) ring.emplace((kTurn - phi) % kTurn, value);
    }
  }

  /// Throws InputError unless each incidence has all wavelengths, and a side's BRDF the incidences of its BTDF.
  void check(const Location& where) const {
    for (const auto& sides : hemispheres)
      for (const Hemisphere& hemisphere : sides) {
        for (const auto& [incidence, spectra] : hemisphere)
          for (const float wanted : nm)
            if (!spectra.contains(wanted))
              fail(where, "{} nm is missing at an incidence of {} degrees from the lit side's normal", wanted,
                   degrees(incidence));
        if (!sides[0].empty() && !sides[1].empty() && !std::ranges::equal(sides[0], sides[1], {}, first, first))
          fail(where, "BRDF and BTDF of one side need the same angles of incidence");
      }
  }

 private:
  static Angle first(const Hemisphere::value_type& entry) { return entry.first; }
};

/// Makes a grid of all polar angles and azimuths that occur, which represents every ring exactly.
DirectionGrid make_grid(const Hemisphere& hemisphere, size_t rows, const Location& where) {
  if (hemisphere.empty()) return {};
  std::set<Angle> thetas{0, kHorizon}, phis;
  size_t functions = 0;
  for (const auto& [incidence, spectra] : hemisphere)
    for (const auto& [nm, rings] : spectra) {
      ++functions;
      for (const auto& [theta, ring] : rings.by_theta) {
        thetas.insert(theta);
        for (const auto& [phi, value] : ring) phis.insert(phi);
      }
    }
  constexpr size_t kMostPerRow = 100, kAlways = 1000000;
  if (functions * thetas.size() * phis.size() > kMostPerRow * rows + kAlways)
    fail(where, "the directions have {} polar angles and {} azimuths; rings of equal theta_deg are needed",
         thetas.size(), phis.size());
  DirectionAxes axes;
  for (const Angle theta : thetas) axes.theta.push_back(float(degrees(theta) * kRadian));
  for (const Angle phi : phis) axes.phi.push_back(float(degrees(phi) * kRadian));
  const size_t wavelengths = hemisphere.begin()->second.size();
  std::vector<float> values(functions * thetas.size() * phis.size());
  auto value = values.begin();
  for (const auto& [incidence, spectra] : hemisphere)
    for (const Angle theta : thetas)
      for (const Angle phi : phis)
        for (const auto& [nm, rings] : spectra) *value++ = float(at(rings.by_theta, theta, phi));
  DirectionGrid grid(std::move(axes), wavelengths, std::move(values));
  size_t slice = 0;
  for (const auto& [incidence, spectra] : hemisphere) {
    size_t w = 0;
    for (const auto& [nm, rings] : spectra) {
      const double albedo = grid.albedo(slice, w);
      if (rings.has_share() && albedo > 0) grid.scale(slice, w, rings.share / albedo);
      ++w;
    }
    ++slice;
  }
  return grid;
}

}  // namespace

GoniometerTable::GoniometerTable(const std::vector<GoniometerRow>& rows) {
  const Sorted sorted(rows);
  Location where = rows.front().where;
  where.line = 0;
  sorted.check(where);
  nm_.assign(sorted.nm.begin(), sorted.nm.end());
  for (const size_t side : {0u, 1u}) {
    const auto& [reflected, transmitted] = sorted.hemispheres[side];
    for (const auto& [incidence, spectra] : reflected.empty() ? transmitted : reflected)
      faces_[side].incidence.push_back(float(degrees(incidence) * kRadian));
    faces_[side].reflected = make_grid(reflected, rows.size(), where);
    faces_[side].transmitted = make_grid(transmitted, rows.size(), where);
  }
  if (sorted.negative > 0)
    warning_ = fmt::format(
        "{} as 0", counted(sorted.negative, "value of f_per_sr below 0 counts", "values of f_per_sr below 0 count"));
  limit_energy();
  for (const size_t side : {0u, 1u})
    if (faces_[side].incidence.empty()) faces_[side] = faces_[1 - side];
}

/// The albedo is linear between incidences and wavelengths, so a limit at these is one everywhere.
void GoniometerTable::limit_energy() {
  constexpr double kRounding = 1e-5;
  double largest = 1 + kRounding;
  for (GoniometerFace& face : faces_)
    for (size_t i = 0; i < face.incidence.size(); ++i)
      for (size_t w = 0; w < nm_.size(); ++w) {
        double albedo = 0;
        for (const DirectionGrid* grid : {&face.reflected, &face.transmitted})
          if (!grid->empty()) albedo += grid->albedo(i, w);
        largest = std::max(largest, albedo);
        for (DirectionGrid* grid : {&face.reflected, &face.transmitted})
          if (!grid->empty() && albedo > 1) grid->scale(i, w, 1 / albedo);
      }
  if (largest > 1 + kRounding)
    warning_ += fmt::format(
        "{}reflectance + transmittance reaches {:.4g}; where the sum exceeds 1, both are scaled down "
        "to a sum of 1",
        warning_.empty() ? "" : "; ", largest);
}

void GoniometerTable::prepare(Interval range) {
  const size_t first = cell_of(nm_, float(range.min)).below;
  const auto last_cell = cell_of(nm_, float(range.max));
  const size_t last = last_cell.below + (last_cell.t > 0 ? 1 : 0);
  for (GoniometerFace& face : faces_)
    for (DirectionGrid* grid : {&face.reflected, &face.transmitted})
      if (!grid->empty()) grid->make_densities(first, last);
}

const Bsdf* GoniometerTable::bsdf(const SampledWavelengths& lambda, Arena& arena) const {
  return arena.make<GoniometerBsdf>(faces_, nm_, lambda);
}

std::unique_ptr<MeasuredData> read_goniometer_table(std::string_view text, const std::string& name) {
  return std::make_unique<GoniometerTable>(parse_goniometer_rows(text, name));
}

}  // namespace frond
