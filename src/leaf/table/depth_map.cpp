#include "leaf/table/depth_map.h"

#include "leaf/tissue/absorption.h"

namespace frond::leaf {
namespace {

double interpolate(const std::vector<double>& curve, const WavelengthGrid::Cell& cell) {
  return (1 - cell.t) * curve[cell.below] + cell.t * curve[cell.below + 1];
}

}  // namespace

DepthMap::DepthMap(const TissueParams& constant, const std::vector<Varying>& varying)
    : thickness_{constant.thickness_m, nullptr}, fraction_{constant.mesophyll_fraction, nullptr} {
  // Absorption is a sum over concentrations: each one's curve is its increment to a leaf without the varying ones.
  TissueParams base = constant;
  std::vector<const Varying*> concentrations;
  for (const Varying& v : varying) {
    double& number = v.number(base);
    if (&number == &base.thickness_m) {
      thickness_.texture = v.texture;
    } else if (&number == &base.mesophyll_fraction) {
      fraction_.texture = v.texture;
    } else {
      number = 0;
      concentrations.push_back(&v);
    }
  }
  base_ = absorption_coefficients(base);
  for (const Varying* v : concentrations) {
    TissueParams more = base;
    v->number(more) = 1;
    std::vector<double> curve = absorption_coefficients(more);
    for (size_t i = 0; i < curve.size(); ++i) curve[i] -= base_[i];
    curves_.push_back({v->texture, std::move(curve)});
  }
}

std::array<double, kLanes> DepthMap::at(const TexturePoint& point, const SampledWavelengths& lambda) const {
  std::array<WavelengthGrid::Cell, kLanes> cells;
  std::array<double, kLanes> depth{};
  const auto lanes = static_cast<size_t>(lambda.count);
  for (size_t i = 0; i < lanes; ++i) {
    cells[i] = kAbsorptionGrid.cell(double(lambda.nm[i]));
    depth[i] = interpolate(base_, cells[i]);
  }
  for (const Curve& curve : curves_) {
    const auto concentration = double(curve.concentration->evaluate(point));
    for (size_t i = 0; i < lanes; ++i) depth[i] += concentration * interpolate(curve.absorption, cells[i]);
  }
  const double way = thickness_.at(point) * fraction_.at(point);
  for (double& d : depth) d *= way;
  return depth;
}

Interval DepthMap::range(double lambda_nm) const {
  const WavelengthGrid::Cell cell = kAbsorptionGrid.cell(lambda_nm);
  double least = interpolate(base_, cell), most = least;
  for (const Curve& curve : curves_) {
    const Interval concentration = curve.concentration->range();
    least += concentration.min * interpolate(curve.absorption, cell);
    most += concentration.max * interpolate(curve.absorption, cell);
  }
  const Interval thickness = thickness_.range(), fraction = fraction_.range();
  return {least * thickness.min * fraction.min, most * thickness.max * fraction.max};
}

}  // namespace frond::leaf
