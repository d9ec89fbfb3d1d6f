#include "leaf/solve/lobe_mean.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "leaf/solve/azimuth.h"

namespace frond::leaf {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

LobeMean::LobeMean(double exponent) : exponent_(exponent) {
  const AzimuthModes lobe(exponent);
  constexpr auto kCount = static_cast<double>(kTerms);
  Series angle, uncut, cut;
  for (size_t i = 0; i < kTerms; ++i) {
    const auto row = static_cast<Index>(i);
    angle[row] = (static_cast<double>(i) + 0.5) * std::numbers::pi / kCount;
    const double x = 0.5 + 0.5 * std::cos(angle[row]);
    // Axis and direction of equal cosine c have a = c^2, b = 1 - c^2: a + b = 1.
    const auto at = [&lobe](double difference) {
      const double c = std::sqrt((1 + difference) / 2);
      return lobe.mean(c, c);
    };
    uncut[row] = at(x * x), cut[row] = at(-x * x);
  }
  for (size_t k = 0; k < kTerms; ++k) {
    const Series wave = (static_cast<double>(k) * angle).cos() * ((k == 0 ? 1 : 2) / kCount);
    uncut_[static_cast<Index>(k)] = (wave * uncut).sum(), cut_[static_cast<Index>(k)] = (wave * cut).sum();
  }
}

/// Clenshaw's recurrence.
ArrayXd LobeMean::sum(const Series& series, const ArrayXd& x) {
  const ArrayXd twice = 4 * x - 2;
  ArrayXd next = ArrayXd::Zero(x.size()), after = next;
  for (Index k = kTerms - 1; k > 0; --k) {
    after = twice * next - after + series[k];
    next.swap(after);
  }
  return 0.5 * twice * next - after + series[0];
}

MatrixXd LobeMean::matrix(const VectorXd& mu) const {
  const Index count = mu.size(), pairs = count * (count + 1) / 2;
  const ArrayXd sine = (1 - mu.array().square()).max(0).sqrt();
  // The pairs whose lobe the wall does not cut come first.
  ArrayXd a(pairs), b(pairs);
  std::vector<std::pair<Index, Index>> place(static_cast<size_t>(pairs));
  Index first = 0, last = pairs;
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j <= i; ++j) {
      const double product = mu[i] * mu[j], sines = sine[i] * sine[j];
      const Index at = product >= sines ? first++ : --last;
      a[at] = product, b[at] = sines, place[static_cast<size_t>(at)] = {i, j};
    }
  const ArrayXd peak = a + b, x = ((a - b).abs() / peak).sqrt();
  ArrayXd mean(pairs);
  mean.head(first) = sum(uncut_, x.head(first));
  mean.tail(pairs - first) = sum(cut_, x.tail(pairs - first));
  mean = mean.max(0) * (exponent_ * peak.log()).exp();
  MatrixXd result(count, count);
  for (Index k = 0; k < pairs; ++k) {
    const auto [i, j] = place[static_cast<size_t>(k)];
    result(i, j) = result(j, i) = mean[k];
  }
  return result;
}

Eigen::RowVectorXd LobeMean::row(double mu_axis, const VectorXd& mu) const {
  const double sine = std::sqrt(std::max(0.0, 1 - mu_axis * mu_axis));
  const ArrayXd a = mu_axis * mu.array(), b = sine * (1 - mu.array().square()).max(0).sqrt();
  const ArrayXd peak = a + b, x = ((a - b).abs() / peak).sqrt();
  const ArrayXd mean = (a >= b).select(sum(uncut_, x), sum(cut_, x));
  return (mean.max(0) * (exponent_ * peak.log()).exp()).matrix().transpose();
}

}  // namespace frond::leaf
