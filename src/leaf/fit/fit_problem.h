#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "leaf/fit/fit.h"
#include "leaf/fit/leaf_space.h"
#include "leaf/fit/optics_surface.h"

/// Least squares of a fit. Included by .cpp files of this folder alone, which keeps Eigen out of other modules.
namespace frond::leaf {

/// Huber's loss: returns the residual whose square is quadratic up to `kFar` and linear beyond it.
struct Huber {
  static constexpr double kFar = 0.06;
  static double value(double x) {
    const double a = std::abs(x);
    return a <= kFar ? x : std::copysign(std::sqrt(2 * kFar * a - kFar * kFar), x);
  }
  static double slope(double x) {
    const double a = std::abs(x);
    return a <= kFar ? 1 : kFar / std::sqrt(2 * kFar * a - kFar * kFar);
  }
};

/// One measurement with all that does not change during a fit.
struct FitRow {
  size_t angle;  ///< index in FitRows::theta_deg
  double lambda_nm;
  OpticsSurface::Weights weights;
  Constituents specific;
  std::optional<double> r, t;
};

/// The measurements of a request.
struct FitRows {
  explicit FitRows(const FitRequest& request);

  /// Returns every n-th row, `most` at most, with the same angles: enough for the beginning of a search.
  FitRows thinned(size_t most) const;
  /// Returns indices of rows, ascending by angle and then wavelength: all, or `most` of them and the last ones of each
  /// angle.
  std::vector<size_t> spread(size_t most) const;
  /// Returns R and T of all rows: the surface's, plus their differences from `solved`, the values at the rows `chosen`
  /// by `spread`. Between these rows the differences are linear in the wavelength. `amounts`: of the leaf.
  std::vector<OpticsSurface::Pair> filled(const std::vector<size_t>& chosen,
                                          const std::vector<OpticsSurface::Pair>& solved, const OpticsSurface& surface,
                                          const Constituents& amounts) const;
  /// Number of measured values.
  Eigen::Index values() const;
  /// Mean distance between the wavelengths of one angle.
  double step_nm() const;

  std::vector<double> theta_deg;
  std::vector<FitRow> rows;
};

/// R and T of leaves about one structure, to first order in the logarithms of the structure's numbers.
struct SurfaceExpansion {
  Eigen::VectorXd at;  ///< logarithms of all free parameters, of which only the structure's count
  OpticsSurface base;
  std::vector<OpticsSurface> slopes;  ///< by free structural parameter, in the order of the space; empty: base alone
  /// Differences of R and T that are added at each row; empty: none.
  std::vector<OpticsSurface::Pair> corrections = {};
};

/// The residuals of some rows for the leaves of a space, followed by the prior's residuals.
class FitProblem {
 public:
  /// All arguments must outlive the problem.
  FitProblem(const FitRequest& request, const LeafSpace& space, const FitRows& rows);

  /// Free structural parameters, as indices of the space.
  const std::vector<Eigen::Index>& structural() const { return structural_; }

  /// Returns the expansion's surface at these logarithms.
  OpticsSurface surface(const SurfaceExpansion& expansion, const Eigen::VectorXd& logs) const;
  /// Returns the expansion's R and T of each row, without its corrections.
  std::vector<OpticsSurface::Pair> values(const SurfaceExpansion& expansion, const Eigen::VectorXd& logs) const;

  /// Returns the sum of squares, with the prior's, for given R and T of each row.
  double cost(const std::vector<OpticsSurface::Pair>& values, const Eigen::VectorXd& logs) const;
  double cost(const SurfaceExpansion& expansion, const Eigen::VectorXd& logs) const;

  /// Derivatives of the measured values, R before T in each row, by the logarithms of the free parameters.
  Eigen::MatrixXd jacobian(const SurfaceExpansion& expansion, const Eigen::VectorXd& logs) const;

  /// Limits of `minimise`.
  struct Effort {
    bool structure_is_free;
    double radius = 0;  ///< greatest change of a structural logarithm from the expansion's place
    int most_steps;
    double done;  ///< relative change of the sum of squares at which the search ends
  };
  /// Improves `logs` by the method of Levenberg and Marquardt within the ranges; returns the sum of squares there.
  double minimise(const SurfaceExpansion& expansion, const Effort& effort, Eigen::VectorXd& logs) const;

  /// Returns the information about the logarithms that the structure prior adds; 0 without one.
  Eigen::MatrixXd prior_information(const Eigen::VectorXd& logs) const;
  /// Variance of measurements, against which the structure prior is weighed; 0 without one.
  double prior_variance() const { return prior_variance_; }

  /// Weight of a logarithm's distance from the prior, in units of reflectance.
  double expectation() const { return request_.has_prior ? 0.03 : 3e-4; }

 private:
  /// Normal equations: the sum of squares, half its gradient, and the product of the Jacobian with itself.
  struct Normal {
    double cost = 0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd product;
  };
  /// Calls visit(row, values, derivatives of R, derivatives of T) for each row.
  template <class Visit>
  void for_each_row(const SurfaceExpansion& expansion, const Eigen::VectorXd& logs, const Visit& visit) const;
  Normal normal(const SurfaceExpansion& expansion, const Eigen::VectorXd& logs) const;
  double prior(Eigen::Index i, const Eigen::VectorXd& logs) const {
    return expectation() * (logs[i] - std::log(space_.variable(i).value(space_.origin())));
  }

  /// Residuals of the structure prior in standard deviations, and their derivatives by the logarithms.
  Eigen::VectorXd structure_residuals(const Eigen::VectorXd& logs) const;
  Eigen::MatrixXd structure_slopes(const Eigen::VectorXd& logs) const;

  const FitRequest& request_;
  const LeafSpace& space_;
  const FitRows& rows_;
  std::vector<Eigen::Index> structural_;
  const StructurePrior* prior_;
  double prior_variance_ = 0;
  double weight_ = 1;  ///< of a row's squares: the number of measurements that it stands for
};

}  // namespace frond::leaf
