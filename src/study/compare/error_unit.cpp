#include "study/compare/error_unit.h"

namespace frond::compare {

std::string ErrorUnit::data_unit(const ChannelList& channels) const {
  return relative_ ? "mean of the reference over the same pixels in the same channel (0.01 is 1 %)" : channels.unit;
}

std::string ErrorUnit::axis_unit(const ChannelList& channels) const {
  return relative_ ? "% of the reference’s mean" : channels.unit;
}

std::string ErrorUnit::fixed(double error, int decimals) const {
  return relative_ ? fmt::format("{:.2f} %", 100 * error) : fmt::format("{:.{}f}", error, decimals);
}

std::string ErrorUnit::rounded(double error) const {
  return relative_ ? figures(100 * error, 2) + " %" : fmt::format("{:.2g}", error);
}

std::string ErrorUnit::in_argument_unit(double error) const {
  return relative_ ? fmt::format("{:g} %", 100 * error) : fmt::format("{:g}", error);
}

std::string figures(double value, int count) {
  if (value == 0 || !std::isfinite(value)) return fmt::format("{}", value);
  const double place = std::pow(10, std::floor(std::log10(std::abs(value))) + 1 - count);
  return fmt::format("{:.{}g}", std::round(value / place) * place, std::max(count, 6));
}

}  // namespace frond::compare
