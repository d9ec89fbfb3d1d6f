#pragma once

#include <Eigen/Dense>
#include <array>
#include <map>

/// Shared by the solvers of the walk. Included by .cpp files alone, which keeps Eigen out of other modules.
namespace frond::leaf {

/// Mean over azimuth of the lobe max(0, cos alpha)^e of any exponent, for many pairs of directions: AzimuthModes::mean
/// by series, to 1e-5 of the lobe's peak for exponents from 0.5 to 30.
///
/// With cos alpha = a + b cos phi the mean is (a + b)^e g((a - b) / (a + b)). g depends on one variable, and is smooth
/// in the square root of its modulus on each side of 0, where the wall begins to cut the lobe.
class LobeMean {
 public:
  explicit LobeMean(double exponent);

  /// Matrix of the means: axes by directions, both with the cosines `mu` in (0, 1].
  Eigen::MatrixXd matrix(const Eigen::VectorXd& mu) const;
  /// The means from one axis toward directions.
  Eigen::RowVectorXd row(double mu_axis, const Eigen::VectorXd& mu) const;

 private:
  static constexpr size_t kTerms = 24;
  using Series = Eigen::Array<double, kTerms, 1>;  ///< coefficients of Chebyshev polynomials on [0, 1]
  static Eigen::ArrayXd sum(const Series& series, const Eigen::ArrayXd& x);

  double exponent_;
  Series uncut_, cut_;
};

/// Series by exponent, each made when it is first needed. Not for several threads at once.
class LobeMeans {
 public:
  const LobeMean& get(double exponent) { return known_.try_emplace(exponent, exponent).first->second; }

 private:
  std::map<double, LobeMean> known_;
};

}  // namespace frond::leaf
