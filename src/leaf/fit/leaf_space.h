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

/// Amounts per leaf area of all absorbers, or the optical depth that one unit of each adds at one wavelength. The first
/// is the absorption that all leaves have in common (water), the others are `absorbers`.
using Constituents = Eigen::Array<double, Eigen::Dynamic, 1, 0, kMostLeafNumbers, 1>;

inline Constituents amounts_of(const TissueParams& p) {
  Constituents amounts(static_cast<Eigen::Index>(absorbers().size()));
  amounts[0] = 1;
  Eigen::Index i = 1;
  for (const Absorber& a : absorbers())
    if (a.first().is_parameter()) amounts[i++] = a.amount(p);
  return amounts * (p.thickness_m * p.mesophyll_fraction);
}

inline Constituents specific_depths(AbsorptionTables tables, double lambda_nm) {
  TissueParams of;
  of.absorption_tables = tables;
  Constituents depths(static_cast<Eigen::Index>(absorbers().size()));
  depths[0] = absorption_coefficient(of, lambda_nm);
  Eigen::Index i = 1;
  for (const Absorber& a : absorbers()) {
    if (!a.first().is_parameter()) continue;
    TissueParams one = of;
    a.first().value(one) = 1;
    depths[i++] = absorption_coefficient(one, lambda_nm) - depths[0];
  }
  return depths;
}

/// Optical depth: the scalar product. The first eight terms are added as vectors.
inline double depth_of(const Constituents& amounts, const Constituents& specific) {
  constexpr Eigen::Index kVectors = 8;
  double sum = (amounts.head<kVectors>() * specific.head<kVectors>()).sum();
  for (Eigen::Index i = kVectors; i < amounts.size(); ++i) sum += amounts[i] * specific[i];
  return sum;
}

/// One kind of leaf (structure, sieve), and its free parameters. A search varies their logarithms.
class LeafSpace {
 public:
  LeafSpace(const FitRequest& request, Structure structure, bool sieve)
      : specimen_(request.like && request.like->params.structure == structure ? *request.like : specimen_of(structure)),
        origin_(specimen_.params) {
    origin_.sieve_and_detour = sieve;
    origin_.absorption_tables = request.absorption_tables;
    take_tables();
    fix(request, *find_leaf_number("mesophyllfraction"));
    for (const FitRequest::Fixed& fixed : request.fixed) fix_content(fixed);
    for (const LeafNumber& n : fit_variables()) {
      const bool is_fixed = std::ranges::find(given_, &n) != given_.end() || fix(request, n);
      const bool is_of_leaf = has_number(structure, n) && (!n.only_with || *n.only_with == request.absorption_tables);
      if (is_fixed || is_of_leaf) numbers_.push_back(&n);
      if (is_fixed || !is_of_leaf) continue;
      free_.push_back(&n);
      if (n.value(origin_) == 0) n.value(origin_) = n.little;  // none has no logarithm
    }
    for (const LeafNumber& n : leaf_parameters()) {
      if (n.follows.empty() || std::ranges::find(given_, &n) != given_.end() || fix(request, n)) continue;
      const LeafNumber* leader = find_leaf_number(n.follows);
      const double of_leader = leader->value(specimen_.params);
      followers_.push_back({&n, leader, of_leader > 0 ? n.value(specimen_.params) / of_leader : 0});
    }
    settle(origin_);
  }

  const Specimen& specimen() const { return specimen_; }
  const TissueParams& origin() const { return origin_; }
  const std::vector<const LeafNumber*>& free() const { return free_; }
  /// The variables that the leaf has, free or fixed.
  const std::vector<const LeafNumber*>& numbers() const { return numbers_; }
  Eigen::Index count() const { return static_cast<Eigen::Index>(free_.size()); }

  TissueParams with(TissueParams p, const LeafNumber& v, double value) const {
    v.value(p) = value;
    settle(p);
    return p;
  }

  /// Logarithms of the free parameters, within their ranges.
  Eigen::VectorXd logs_of(const TissueParams& p) const {
    Eigen::VectorXd logs(count());
    for (Eigen::Index i = 0; i < count(); ++i) logs[i] = std::clamp(std::log(variable(i).value(p)), low(i), high(i));
    return logs;
  }
  TissueParams at(const Eigen::VectorXd& logs) const {
    TissueParams p = origin_;
    for (Eigen::Index i = 0; i < count(); ++i) {
      const Interval& range = variable(i).fit_range;  // the exponential of its ends may lie beyond them
      variable(i).value(p) = std::clamp(std::exp(logs[i]), range.min, range.max);
    }
    settle(p);
    return p;
  }
  /// Ends of a parameter's range, as logarithms.
  double low(Eigen::Index i) const { return std::log(variable(i).fit_range.min); }
  double high(Eigen::Index i) const { return std::log(variable(i).fit_range.max); }
  const LeafNumber& variable(Eigen::Index i) const { return *free_[static_cast<size_t>(i)]; }

 private:
  struct Follower {
    const LeafNumber *number, *leader;
    double ratio;
  };

  /// Removes the constituents of other absorption tables. A content as a whole replaces its parts.
  void take_tables() {
    const TissueParams& p = specimen_.params;
    for (const LeafNumber& n : leaf_parameters()) {
      if (!n.only_with) continue;
      if (*n.only_with != origin_.absorption_tables) {
        n.value(origin_) = 0;
      } else if (n.value(origin_) == 0 && n.name == n.content.name) {
        for (const LeafNumber* part : parts_of(n.content)) n.value(origin_) += part->value(p);
      }
    }
  }

  /// Sets what follows other parameters.
  void settle(TissueParams& p) const {
    for (const auto& [number, content] : per_area_) number->value(p) = content / area_content(p, 1);
    for (const Follower& f : followers_) f.number->value(p) = f.ratio * f.leader->value(p);
  }

  /// Returns whether the request gives the parameter, and sets it.
  bool fix(const FitRequest& request, const LeafNumber& number) {
    const auto found = std::ranges::find(request.fixed, number.name, &FitRequest::Fixed::name);
    if (found == request.fixed.end()) return false;
    if (found->per_area)
      per_area_.push_back({&number, found->value});
    else
      number.value(origin_) = found->value;
    return true;
  }
  /// Applies a content per area that is not a parameter: sets its parts in the specimen's ratio, or the thickness if it
  /// has no parts.
  void fix_content(const FitRequest::Fixed& fixed) {
    const auto content = std::ranges::find(area_contents(), fixed.name, &AreaContent::name);
    const LeafNumber* same = find_leaf_number(fixed.name);
    if (content == area_contents().end() || (same && same->is_parameter())) return;
    const std::vector<const LeafNumber*> parts = parts_of(*content);
    if (parts.empty()) {
      origin_.thickness_m = fixed.value / (content->kg_per_m3 * origin_.mesophyll_fraction);
      given_.push_back(find_leaf_number("thickness"));
      return;
    }
    double sum = 0, rest = 1;
    for (const LeafNumber* part : parts) sum += part->value(specimen_.params);
    for (const LeafNumber* part : parts) {
      const double share = part == parts.back() ? rest : part->value(specimen_.params) / sum;
      per_area_.push_back({part, share * fixed.value});
      rest -= share;
    }
    given_.insert(given_.end(), parts.begin(), parts.end());
  }

  const Specimen& specimen_;
  TissueParams origin_;
  std::vector<const LeafNumber*> free_, numbers_;
  std::vector<const LeafNumber*> given_;  ///< by a content per area
  /// Concentrations that follow the thickness, because their contents per area are given, kg/m^2.
  std::vector<std::pair<const LeafNumber*, double>> per_area_;
  std::vector<Follower> followers_;
};

}  // namespace frond::leaf
