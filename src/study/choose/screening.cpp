#include "study/choose/screening.h"

#include <algorithm>
#include <limits>

namespace frond::choose {

double Screening::bias(const Configuration& answers) const {
  double sum = 0;
  for (size_t q = 0; q < answers.size(); ++q)
    for (size_t r = 0; r < answers.size(); ++r) {
      const Single &a = singles_[q][answers[q]], &b = singles_[r][answers[r]];
      if (!a.is_reference && !b.is_reference) sum += products_[a.place][b.place];
    }
  return std::max(0.0, sum);
}

double Screening::noise(const Configuration& answers) const {
  double sum = 1;
  for (size_t q = 0; q < answers.size(); ++q) sum += singles_[q][answers[q]].noise - 1;
  return std::max(sum, 0.01);  // first-order predictions may overshoot
}

double Screening::price(const Configuration& answers) const {
  double product = 1;
  for (size_t q = 0; q < answers.size(); ++q) product *= singles_[q][answers[q]].price;
  return product;
}

double Screening::cost(const Configuration& answers, double rms) const {
  const auto effort = reference_.until_noise((rms * rms - bias(answers)) / noise(answers));
  return effort ? price(answers) * effort->samples : std::numeric_limits<double>::infinity();
}

Configuration Screening::reference() const {
  Configuration answers;
  for (const auto& options : singles_) answers.push_back(options.size() - 1);
  return answers;
}

Configuration Screening::cheapest(const Configuration& floor, double rms) const {
  constexpr double kAlike =
      1e-3;  // below the pilot's resolution, for leaves that are hardly visible, the simpler model is preferred
  Configuration best = reference();
  for (bool better = true; better;) {
    better = false;
    const Configuration from = best;
    for (size_t q = 0; q < from.size(); ++q)
      for (size_t option = floor[q]; option < singles_[q].size(); ++option) {
        Configuration other = from;
        other[q] = option;
        if (cost(other, rms) < cost(best, rms)) best = other, better = true;
      }
  }
  for (size_t q = 0; q < best.size(); ++q)
    for (size_t option = floor[q]; option < best[q]; ++option) {
      Configuration other = best;
      other[q] = option;
      if (cost(other, rms) <= cost(best, rms) * (1 + kAlike)) best = other;
    }
  return best;
}

size_t Screening::worst(const Configuration& answers) const {
  size_t result = answers.size();
  double most = -std::numeric_limits<double>::infinity();
  for (size_t q = 0; q < answers.size(); ++q) {
    if (singles_[q][answers[q]].is_reference) continue;
    Configuration without = answers;
    without[q] = singles_[q].size() - 1;
    const double adds = bias(answers) - bias(without);
    if (adds > most) most = adds, result = q;
  }
  return result;
}

}  // namespace frond::choose
