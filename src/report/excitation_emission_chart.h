#pragma once

#include <string>
#include <vector>

#include "instruments/fluorescence_matrix.h"
#include "report/chart.h"

namespace frond {

/// A fluorescence matrix, labelled with the material under test.
struct LabelledMatrix {
  std::string material;
  FluorescenceMatrix matrix;
};

/// Returns maps of what leaves both sides over excitation and emission, one row for each matrix.
Chart excitation_emission_chart(const std::vector<LabelledMatrix>& matrices);

/// Throws InputError if there is no area to draw, or too much; called before the measurement.
void check_excitation_emission_chart(size_t matrices, size_t excitations, size_t emissions);

}  // namespace frond
