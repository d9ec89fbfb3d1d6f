#include "exports/sheet_colors.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exports/klems.h"
#include "spectra/cie.h"
#include "spectra/color/color_space.h"

namespace frond {
namespace {

constexpr double kNearNormal_deg = 8, kGrazing_deg = 75;

/// R and T of a direction of the light, one lane for each wavelength.
struct Shares {
  std::array<double, kLanes> reflected{}, transmitted{};
};

/// Returns the nodes of a hemisphere, with weights that sum to pi.
std::vector<KlemsBasis::Node> hemisphere(int order) {
  std::vector<KlemsBasis::Node> all;
  for (size_t patch = 0; patch < KlemsBasis::kPatches; ++patch)
    for (const KlemsBasis::Node& node : KlemsBasis::nodes(patch, order))
      all.push_back({node.w, node.weight * KlemsBasis::projected_solid_angle(patch)});
  return all;
}

/// Integrates f over both hemispheres, for light at an angle from the normal of a side.
Shares integrate(const ExportedBsdf::At& f, double theta_deg, bool front, const std::vector<KlemsBasis::Node>& nodes) {
  const double theta = theta_deg * std::numbers::pi / 180;
  const float side = front ? 1 : -1;
  const Vec3 light{float(std::sin(theta)), 0, side * float(std::cos(theta))};
  Shares shares;
  for (const KlemsBasis::Node& node : nodes) {
    const SampledSpectrum r = f(light, {node.w.x, node.w.y, side * node.w.z}),
                          t = f(light, {node.w.x, node.w.y, -side * node.w.z});
    for (int i = 0; i < kLanes; ++i) {
      shares.reflected[size_t(i)] += node.weight * double(r[i]);
      shares.transmitted[size_t(i)] += node.weight * double(t[i]);
    }
  }
  return shares;
}

/// Wavelengths of an export, and the weight of each in each channel.
struct Channels {
  std::vector<double> nm;
  std::array<std::vector<double>, 3> weights;
  bool are_xyz;

  explicit Channels(const ExportRequest& request)
      : nm(request.wavelengths_nm.empty() ? visible_wavelengths() : request.wavelengths_nm), are_xyz(nm.size() != 3) {
    for (size_t c = 0; c < 3; ++c) {
      weights[c] = are_xyz ? d65_weights(c, nm) : std::vector<double>(3);
      if (!are_xyz) weights[c][c] = 1;
    }
  }
  std::string light() const {
    if (!are_xyz) return fmt::format("red, green and blue are {:g}, {:g} and {:g} nm", nm[0], nm[1], nm[2]);
    return fmt::format("linear sRGB under D65 (CIE 1931), of {} wavelengths from {:g} to {:g} nm", nm.size(),
                       nm.front(), nm.back());
  }
  /// Converts the three weighted sums. Colours relative to white: a grey sheet is grey.
  Triple rgb(const Triple& channels) const {
    if (!are_xyz) return channels;
    static const ColorSpace& srgb = *find_color_space("srgb");
    return srgb.rgb_from_xyz * (Matrix3::diagonal(kD65White.xyz()) * channels);
  }
};

/// Limits colours that no material has: outside the channels' gamut, or with a sum above 1. Returns the largest change.
double limit(SideColors& side) {
  const SideColors given = side;
  double change = 0;
  for (size_t c = 0; c < 3; ++c) {
    double &r = side.reflected[c], &t = side.transmitted[c];
    r = std::max(r, 0.0), t = std::max(t, 0.0);
    const double most = std::max(r + t, 1.0);
    r /= most, t /= most;
    change = std::max({change, std::abs(r - given.reflected[c]), std::abs(t - given.transmitted[c])});
  }
  return change;
}

/// Logs the colours, and what a Lambertian material lacks.
void log_losses(const SheetColors& colors, bool keeps_sides, const Log& log) {
  const auto text = [](const std::array<SideColors, 2>& sides) {
    const auto& [front, back] = sides;
    return fmt::format("front R {:.3f}, T {:.3f}; back R {:.3f}, T {:.3f}", fmt::join(front.reflected, " "),
                       fmt::join(front.transmitted, " "), fmt::join(back.reflected, " "),
                       fmt::join(back.transmitted, " "));
  };
  log.info(fmt::format("light at {:g} degrees, {}: {}", kNearNormal_deg, colors.light, text(colors.near_normal)));
  log.info(fmt::format("lost: gloss and all other dependence on angles; at {:g} degrees: {}", kGrazing_deg,
                       text(colors.at_grazing_angle)));
  if (!keeps_sides) log.info("lost: the back, which has the front's R and T");
}

}  // namespace

std::vector<double> visible_wavelengths() {
  constexpr int kFirst = 380, kLast = 780, kStep = 10;
  std::vector<double> nm;
  for (int w = kFirst; w <= kLast; w += kStep) nm.push_back(w);
  return nm;
}

std::vector<double> d65_weights(size_t which, const std::vector<double>& nm) {
  std::vector<double> weights(nm.size());
  double sum = 0;
  for (double x = kCieRange_nm.min; x <= kCieRange_nm.max; ++x) {
    const double w = cie_xyz(x)[which] * double(d65()->at(float(x)));
    const size_t above = size_t(std::ranges::lower_bound(nm, x) - nm.begin());
    if (above == 0)
      weights.front() += w;
    else if (above == nm.size())
      weights.back() += w;
    else {
      const double t = (x - nm[above - 1]) / (nm[above] - nm[above - 1]);
      weights[above - 1] += (1 - t) * w, weights[above] += t * w;
    }
    sum += w;
  }
  for (double& w : weights) w /= sum;
  return weights;
}

void check_sheet_colors(const ExportRequest& request) {
  const size_t n = request.wavelengths_nm.size();
  if (n == 1 || n == 2)
    fail({}, "a colour takes three wavelengths, red, green and blue, or more, as in 400:700:10; {} given", n);
  if (n > 3) check_ascending("wavelengths", request.wavelengths_nm);
}

SheetColors sheet_colors(const ExportMaterial& material, const ExportRequest& request, bool keeps_sides) {
  constexpr double kTolerance = 1e-3;
  static const auto kFine = hemisphere(12), kCoarse = hemisphere(8);
  const Channels channels(request);
  std::array<SideColors, 4> sums{};  // near the normal: front and back; at the grazing angle
  double error = 0, change = 0;
  size_t w = 0;
  for (const std::vector<double>& run : split_into_lanes(channels.nm)) {
    const ExportedBsdf bsdf(material, run);
    std::array<std::array<Shares, 2>, 4> shares;
    material.pool.for_each(int64_t(shares.size()), [&](int64_t i, int) {
      const ExportedBsdf::At f(bsdf);
      const double theta_deg = i < 2 ? kNearNormal_deg : kGrazing_deg;
      shares[size_t(i)] = {integrate(f, theta_deg, i % 2 == 0, kFine), integrate(f, theta_deg, i % 2 == 0, kCoarse)};
    });
    for (size_t lane = 0; lane < run.size(); ++lane, ++w)
      for (size_t i = 0; i < shares.size(); ++i) {
        const auto& [fine, coarse] = shares[i];
        error = std::max(error, std::abs(fine.reflected[lane] - coarse.reflected[lane]));
        for (size_t c = 0; c < 3; ++c) {
          sums[i].reflected[c] += channels.weights[c][w] * fine.reflected[lane];
          sums[i].transmitted[c] += channels.weights[c][w] * fine.transmitted[lane];
        }
      }
  }
  for (SideColors& side : sums) {
    side = {channels.rgb(side.reflected), channels.rgb(side.transmitted)};
    change = std::max(change, limit(side));
  }
  if (error > kTolerance)
    material.log.warn({}, fmt::format("a lobe is too narrow to integrate: R is uncertain by {:.2g}", error));
  if (change > kTolerance)
    material.log.warn({}, fmt::format("a channel below 0, or R + T above 1, was limited: changed by {:.2g}", change));
  const SheetColors colors{channels.light(), {sums[0], sums[1]}, {sums[2], sums[3]}};
  log_losses(colors, keeps_sides, material.log);
  return colors;
}

SharedColors shared_colors(const SideColors& side, const Log& log) {
  SharedColors shared{std::ranges::max(side.transmitted), {}, {1, 1, 1}};
  double lost = 0;
  for (size_t c = 0; c < 3; ++c) {
    if (shared.share > 0) shared.transmitted[c] = side.transmitted[c] / shared.share;
    const double r = std::min(side.reflected[c], 1 - shared.share);
    lost = std::max(lost, side.reflected[c] - r);
    if (r > 0) shared.reflected[c] = r / (1 - shared.share);
  }
  if (lost > 0)
    log.warn({}, fmt::format("the material transmits the same share, {:.3f}, in all channels and reflects at most the "
                             "rest: R is lowered by up to {:.2g}",
                             shared.share, lost));
  return shared;
}

}  // namespace frond
