#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "leaf/fit/fit.h"
#include "leaf/tissue/absorption.h"
#include "leaf/tissue/area_content.h"

/// Parameters of a fit. Included by .cpp files of this folder alone, which keeps Eigen out of other modules.
namespace frond::leaf {

/// A parameter that follows a fitted one in a constant ratio.
struct Companion {
  std::string_view name;
  double TissueParams::*number;
  double TissueParams::*leader;
};
inline constexpr Companion kCompanions[] = {
    {"chlorophyllb", &TissueParams::chlorophyll_b, &TissueParams::chlorophyll_a},
    {"lignin", &TissueParams::lignin, &TissueParams::cellulose},
};

inline const Specimen& specimen_of(Structure structure) {
  return *std::ranges::find(kSpecimens, structure, [](const Specimen& s) { return s.params.structure; });
}

/// Amounts per leaf area of all that absorbs, and what one unit of each adds to the optical depth at one wavelength:
/// the depth is their scalar product. The first is the water.
using Constituents = Eigen::Array<double, 9, 1>;
inline constexpr double TissueParams::*kConcentrations[] = {
    &TissueParams::chlorophyll_a, &TissueParams::carotenoids,     &TissueParams::protein,
    &TissueParams::cellulose,     &TissueParams::anthocyanins,    &TissueParams::brown_pigments,
    &TissueParams::dry_matter,    &TissueParams::other_absorption};

inline Constituents amounts_of(const TissueParams& p) {
  Constituents amounts;
  amounts << 1, p.chlorophyll_a + p.chlorophyll_b, p.carotenoids, p.protein, p.cellulose + p.lignin, p.anthocyanins,
      p.brown_pigments, p.dry_matter, p.other_absorption;
  return amounts * (p.thickness_m * p.mesophyll_fraction);
}

inline Constituents specific_depths(AbsorptionTables tables, double lambda_nm) {
  TissueParams of;
  of.absorption_tables = tables;
  Constituents depths;
  depths[0] = absorption_coefficient(of, lambda_nm);
  Eigen::Index i = 1;
  for (const auto concentration : kConcentrations) {
    TissueParams one = of;
    one.*concentration = 1;
    depths[i++] = absorption_coefficient(one, lambda_nm) - depths[0];
  }
  return depths;
}

/// One kind of leaf (structure, sieve), and its free parameters. A search varies their logarithms.
class LeafSpace {
 public:
  LeafSpace(const FitRequest& request, Structure structure, bool sieve)
      : specimen_(request.like && request.like->params.structure == structure ? *request.like : specimen_of(structure)),
        origin_(specimen_.params) {
    origin_.sieve_and_detour = sieve;
    origin_.absorption_tables = request.absorption_tables;
    if (request.absorption_tables == AbsorptionTables::prospect) {
      if (origin_.dry_matter == 0) origin_.dry_matter = origin_.protein + origin_.cellulose + origin_.lignin;
      origin_.protein = origin_.cellulose = origin_.lignin = 0;
    } else {
      origin_.anthocyanins = origin_.brown_pigments = origin_.dry_matter = 0;
    }
    fix(request, "mesophyllfraction", &TissueParams::mesophyll_fraction);
    const bool has_water = fix_water(request);
    const bool has_chlorophyll = fix_chlorophyll(request);
    for (const FitVariable& v : kFitVariables) {
      const bool is_given = (v.number == &TissueParams::thickness_m && has_water) ||
                            (v.number == &TissueParams::chlorophyll_a && has_chlorophyll);
      if (is_given || fix(request, v.name, v.number)) {
        fixed_.push_back(&v);
        continue;
      }
      if (!has_variable(structure, v) || (v.only_with && *v.only_with != request.absorption_tables)) continue;
      free_.push_back(&v);
      if (origin_.*v.number == 0) origin_.*v.number = v.little;  // none has no logarithm
    }
    for (const Companion& c : kCompanions) {
      if ((c.number == &TissueParams::chlorophyll_b && has_chlorophyll) || fix(request, c.name, c.number)) continue;
      const double leader = specimen_.params.*c.leader;
      followers_.push_back({c.number, c.leader, leader > 0 ? specimen_.params.*c.number / leader : 0});
    }
    settle(origin_);
  }

  const Specimen& specimen() const { return specimen_; }
  const TissueParams& origin() const { return origin_; }
  const std::vector<const FitVariable*>& free() const { return free_; }
  /// Whether the leaf has the variable, free or fixed.
  bool has(const FitVariable& v) const {
    return std::ranges::find(free_, &v) != free_.end() || std::ranges::find(fixed_, &v) != fixed_.end();
  }
  Eigen::Index count() const { return static_cast<Eigen::Index>(free_.size()); }

  TissueParams with(TissueParams p, const FitVariable& v, double value) const {
    p.*v.number = value;
    settle(p);
    return p;
  }

  /// Logarithms of the free parameters, within their ranges.
  Eigen::VectorXd logs_of(const TissueParams& p) const {
    Eigen::VectorXd logs(count());
    for (Eigen::Index i = 0; i < count(); ++i) logs[i] = std::clamp(std::log(p.*variable(i).number), low(i), high(i));
    return logs;
  }
  TissueParams at(const Eigen::VectorXd& logs) const {
    TissueParams p = origin_;
    for (Eigen::Index i = 0; i < count(); ++i) {
      const Interval& range = variable(i).range;  // the exponential of its ends may lie beyond them
      p.*variable(i).number = std::clamp(std::exp(logs[i]), range.min, range.max);
    }
    settle(p);
    return p;
  }
  /// Ends of a parameter's range, as logarithms.
  double low(Eigen::Index i) const { return std::log(variable(i).range.min); }
  double high(Eigen::Index i) const { return std::log(variable(i).range.max); }
  const FitVariable& variable(Eigen::Index i) const { return *free_[static_cast<size_t>(i)]; }

 private:
  struct Follower {
    double TissueParams::*number;
    double TissueParams::*leader;
    double ratio;
  };
  /// A concentration that follows the thickness, because its content per area is given.
  struct PerArea {
    double TissueParams::*number;
    double kg_per_m2;
  };

  /// Sets what follows other parameters.
  void settle(TissueParams& p) const {
    for (const PerArea& a : per_area_) p.*a.number = a.kg_per_m2 / area_content(p, 1);
    for (const Follower& f : followers_) p.*f.number = f.ratio * p.*f.leader;
  }

  /// Returns whether the request gives the parameter, and sets it.
  bool fix(const FitRequest& request, std::string_view name, double TissueParams::*number) {
    const auto found = std::ranges::find(request.fixed, name, &FitRequest::Fixed::name);
    if (found == request.fixed.end()) return false;
    if (found->per_area)
      per_area_.push_back({number, found->value});
    else
      origin_.*number = found->value;
    return true;
  }
  /// Water per area gives the thickness.
  bool fix_water(const FitRequest& request) {
    const auto found = std::ranges::find(request.fixed, "water", &FitRequest::Fixed::name);
    if (found == request.fixed.end()) return false;
    origin_.thickness_m = found->value / (kWaterConcentration * origin_.mesophyll_fraction);
    return true;
  }
  /// Chlorophyll per area is that of a and b, in the specimen's ratio.
  bool fix_chlorophyll(const FitRequest& request) {
    const auto found = std::ranges::find(request.fixed, "chlorophyll", &FitRequest::Fixed::name);
    if (found == request.fixed.end()) return false;
    const TissueParams& p = specimen_.params;
    const double a = p.chlorophyll_a / (p.chlorophyll_a + p.chlorophyll_b);
    per_area_.push_back({&TissueParams::chlorophyll_a, a * found->value});
    per_area_.push_back({&TissueParams::chlorophyll_b, (1 - a) * found->value});
    return true;
  }

  const Specimen& specimen_;
  TissueParams origin_;
  std::vector<const FitVariable*> free_, fixed_;
  std::vector<PerArea> per_area_;
  std::vector<Follower> followers_;
};

}  // namespace frond::leaf
