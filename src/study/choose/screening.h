#pragma once

#include <vector>

#include "instruments/errors/convergence.h"
#include "study/choose/open_choice.h"

namespace frond::choose {

/// Values by open choice, then by option.
template <class T>
using ByOption = std::vector<std::vector<T>>;

/// Predicts the effect of a configuration to first order: biases of single options, as images, are added, and so are
/// changes of the noise's variance. Predictions are verified by measurement.
class Screening {
 public:
  /// Effect of one option: factors on the reference's price of a sample and on its variance at equal samples.
  struct Single {
    double price = 1, noise = 1;
    size_t place = 0;  ///< index in `products`
    bool is_reference = false;
  };

  /// `singles`: options of every open choice, from the cheapest to the reference. `products[i][j]`: mean product of the
  /// biases of two singles. `reference`: convergence of the reference; its seconds are not used.
  Screening(ByOption<Single> singles, std::vector<std::vector<double>> products, Convergence reference)
      : singles_(std::move(singles)), products_(std::move(products)), reference_(std::move(reference)) {}

  /// Returns the mean square bias, >= 0.
  double bias(const Configuration& answers) const;
  /// Returns the factor on the reference's variance; price: on its time.
  double noise(const Configuration& answers) const;
  double price(const Configuration& answers) const;
  /// Returns the cost until bias and noise together reach `rms`, in samples of the reference; infinite if the bias
  /// alone is larger.
  double cost(const Configuration& answers, double rms) const;

  Configuration reference() const;
  /// Returns the cheapest configuration found, with no option below `floor`. Greedy: changes one option at a time,
  /// starting from the reference.
  Configuration cheapest(const Configuration& floor, double rms) const;
  /// Returns the open choice whose option contributes most to the bias, among those that differ from the reference.
  size_t worst(const Configuration& answers) const;

 private:
  ByOption<Single> singles_;
  std::vector<std::vector<double>> products_;
  Convergence reference_;
};

}  // namespace frond::choose
