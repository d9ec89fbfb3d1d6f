#include "instruments/errors/render_error.h"

namespace frond {
namespace {

/// Mean of the values added, and an upper bound of its standard error.
class BoundedMean {
 public:
  void add(double x) {
    ++count_;
    sum_ += x;
    squares_ += x * x;
  }
  MeanSquare result() const {
    if (count_ == 0) return {};
    return {sum_ / count_, std::sqrt(squares_) / count_};
  }

 private:
  double count_ = 0, sum_ = 0, squares_ = 0;
};

/// Mean square of one render's difference from the reference's mean, minus the reference's own noise.
double excess(double a1, double a2, double r1, double r2) {
  const double r = (r1 + r2) / 2;
  return (square(a1 - r) + square(a2 - r)) / 2 - square(r1 - r2) / 4;
}

double clip(double x) { return std::clamp(x, 0.0, 1.0); }

constexpr MeanSquare RenderError::*kParts[] = {&RenderError::total, &RenderError::clipped, &RenderError::noise,
                                               &RenderError::bias, &RenderError::reference_noise};

void scale(RenderError& e, double factor) {
  for (const auto part : kParts) {
    (e.*part).value *= factor;
    (e.*part).standard_error *= factor;
  }
}

}  // namespace

RenderError& RenderError::operator+=(const RenderError& other) {
  for (const auto part : kParts) {
    (this->*part).value += (other.*part).value;
    (this->*part).standard_error += (other.*part).standard_error;
  }
  return *this;
}

RenderError render_error(const RenderPair& renders, const RenderPair& reference, std::span<const float> use) {
  BoundedMean total, clipped, noise, reference_noise;
  for (size_t i = 0; i < renders.first.size(); ++i) {
    if (!use.empty() && !(use[i] > 0.5f)) continue;
    const double a1 = static_cast<double>(renders.first[i]), a2 = static_cast<double>(renders.second[i]),
                 r1 = static_cast<double>(reference.first[i]), r2 = static_cast<double>(reference.second[i]);
    total.add(excess(a1, a2, r1, r2));
    clipped.add(excess(clip(a1), clip(a2), clip(r1), clip(r2)));
    noise.add(square(a1 - a2) / 2);
    reference_noise.add(square(r1 - r2) / 4);
  }
  const MeanSquare bias =
      image_error(renders.first, renders.second, reference.first, reference.second, use).bias_squared;
  return {total.result(), clipped.result(), noise.result(), bias, reference_noise.result()};
}

double mean_of(const RenderPair& renders, std::span<const float> use) {
  BoundedMean mean;
  for (size_t i = 0; i < renders.first.size(); ++i)
    if (use.empty() || use[i] > 0.5f)
      mean.add((static_cast<double>(renders.first[i]) + static_cast<double>(renders.second[i])) / 2);
  return mean.result().value;
}

RenderError in_unit(double unit, RenderError error) {
  scale(error, 1 / square(unit));
  return error;
}

RenderError mean_of(std::span<const RenderError> channels) {
  RenderError sum;
  for (const RenderError& e : channels) sum += e;
  if (!channels.empty()) scale(sum, 1 / static_cast<double>(channels.size()));
  return sum;
}

RenderError mean_of_independent(std::span<const RenderError> repeats) {
  RenderError mean = mean_of(repeats);
  for (const auto part : kParts) {
    double squares = 0;
    for (const RenderError& e : repeats) squares += square((e.*part).standard_error);
    if (!repeats.empty()) (mean.*part).standard_error = std::sqrt(squares) / static_cast<double>(repeats.size());
  }
  return mean;
}

}  // namespace frond
