#pragma once

#include <vector>

#include "instruments/errors/convergence.h"
#include "study/choose/open_choice.h"

namespace frond::choose {

/// What changing one answer alone does: open_choices before options.
template <class T>
using ByOption = std::vector<std::vector<T>>;

/// What any answers would do to the image, to first order: biases of single answers, as images, add up, and so do
/// changes of the noise's variance. That is a guess, to be measured before it is believed.
class Screening {
 public:
  /// What one answer changes, as factors to the base's price of a sample and variance of noise after as many samples.
  struct Single {
    double price = 1, noise = 1;
    size_t place = 0;  ///< in `products`
    bool is_base = false;
  };

  /// `singles` holds options from the cheapest to the base of every open_choice. `products[i][j]`: mean product of the
  /// biases of two singles. `base`: how its noise falls; seconds are of no concern.
  Screening(ByOption<Single> singles, std::vector<std::vector<double>> products, Convergence base)
      : singles_(std::move(singles)), products_(std::move(products)), base_(std::move(base)) {}

  /// Mean square, not negative.
  double bias(const Configuration& answers) const;
  /// As factors, like those of a Single.
  double noise(const Configuration& answers) const;
  double price(const Configuration& answers) const;
  /// What a render costs until its bias and noise together are down to `rms`, in the base's samples; infinite where
  /// bias alone is too large.
  double cost(const Configuration& answers, double rms) const;

  Configuration base() const;
  /// No answers below `floor`. Found by changing one answer at a time from the base as long as that helps.
  Configuration cheapest(const Configuration& floor, double rms) const;
  /// The open_choice, of those whose answer is not the base's, whose answer adds most to the bias.
  size_t worst(const Configuration& answers) const;

 private:
  ByOption<Single> singles_;
  std::vector<std::vector<double>> products_;
  Convergence base_;
};

}  // namespace frond::choose
