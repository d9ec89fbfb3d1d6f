#pragma once

#include <string>
#include <vector>

#include "instruments/goniophotometer.h"

namespace frond {

/// A goniophotometer's reading and the material it is of.
struct LabelledPatches {
  std::string material;
  GoniophotometerReading reading;
};

/// Comment lines, a line of names, a line for each patch of each reading.
std::string patches_csv(const std::vector<std::string>& notes, const std::vector<LabelledPatches>& readings);

/// The same, by reading, and the notes as a list.
std::string patches_json(const std::vector<std::string>& notes, const std::vector<LabelledPatches>& readings);

/// For people: R and T, and where f is largest on either side.
std::string patches_text(const std::vector<LabelledPatches>& readings);

}  // namespace frond
