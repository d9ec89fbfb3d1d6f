#include "leaf/fluorescence/fluorescence_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/fluorescence.h"
#include "leaf/solve/fluorescence_solver.h"
#include "leaf/solve/modes.h"
#include "leaf/table/series_lookup.h"
#include "leaf/tissue/absorption.h"
#include "leaf/tissue/fresnel.h"

namespace frond::leaf {
namespace {

/// Relative errors of interpolation between the sines are below 1e-4 with this number.
constexpr int kSineCells = 10;
constexpr size_t kSines = kSineCells + 3;
/// Values of a pair of wavelengths and an incident sine: shares that leave above and below, the share that is
/// reabsorbed, and the distributions over the leaving sines above and below.
constexpr size_t kReabsorbed = 2, kToward = 3, kValues = kToward + 2 * kSines;

constexpr WavelengthGrid grid_of(const Interval& nm) {
  constexpr double kStep_nm = kAbsorptionGrid.step_nm;
  return {nm.min, kStep_nm, static_cast<size_t>((nm.max - nm.min) / kStep_nm) + 1};
}
constexpr WavelengthGrid kExcitations = grid_of(kExcitation_nm), kEmissions = grid_of(kEmission_nm);

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

SineNodes nodes_of(const Vec3d& w) { return {static_cast<float>(std::min(1.0, std::hypot(w.x, w.y))), kSineCells}; }

double entering(const Tissue& tissue, const Vec3d& w) {
  return 1 - fresnel(std::abs(w.z), 1 / tissue.n_cuticle()).reflectance;
}

}  // namespace

FluorescenceTable::FluorescenceTable(const TissueParams& params, const ThreadPool& pool)
    : model_(params), emissions_(kEmissions.size()), per_sine_(kValues), per_pair_(kSines * kValues) {
  const std::vector<double> sines = grid_sines(kSineCells);
  const int nodes = mode_nodes(model_.at(kEmission_nm.min));
  std::vector<SolvedEmission> emissions(emissions_);
  pool.for_each(static_cast<int64_t>(emissions_), [&](int64_t i, int) {
    const Tissue tissue = model_.at(kEmissions.nm(static_cast<size_t>(i)));
    emissions[static_cast<size_t>(i)] = solve_emission(tissue, sines, nodes);
  });
  values_.resize(kExcitations.size() * emissions_ * 2 * per_pair_);
  absorbed_.resize(kExcitations.size() * 2 * kSines);
  pool.for_each(static_cast<int64_t>(kExcitations.size()), [&](int64_t index, int) {
    const auto e = static_cast<size_t>(index);
    const SolvedExcitation excitation = solve_excitation(model_.at(kExcitations.nm(e)), sines, nodes);
    for (const bool below : {false, true})
      for (size_t i = 0; i < kSines; ++i) {
        const std::vector<double>& absorbed = excitation.absorbed[below][i];
        absorbed_[(e * 2 + size_t(below)) * kSines + i] =
            static_cast<float>(std::accumulate(absorbed.begin(), absorbed.end(), 0.0));
        for (size_t f = 0; f < emissions_; ++f) {
          float* to = &values_[((e * emissions_ + f) * 2 + size_t(below)) * per_pair_ + i * kValues];
          const auto add = [&](const std::vector<double>& by_depth) { *to++ = float(dot(absorbed, by_depth)); };
          add(emissions[f].left[0]), add(emissions[f].left[1]), add(emissions[f].reabsorbed);
          for (const ByDepth& toward : emissions[f].toward)
            for (const std::vector<double>& by_depth : toward) add(by_depth);
        }
      }
  });
}

template <class At>
double FluorescenceTable::between(double emission_nm, double excitation_nm, const At& at) const {
  const auto [e, te] = kExcitations.cell(excitation_nm);
  const auto [f, tf] = kEmissions.cell(emission_nm);
  return (1 - te) * ((1 - tf) * at(e, f) + tf * at(e, f + 1)) + te * ((1 - tf) * at(e + 1, f) + tf * at(e + 1, f + 1));
}

FluorescenceEnd FluorescenceTable::photons(const Vec3d& wi, double emission_nm, double excitation_nm) const {
  const bool below = wi.z < 0;
  const SineNodes nodes = nodes_of(wi);
  const double enters = entering(model_.at(excitation_nm), wi);
  const auto value = [&](size_t which) {
    return enters * between(emission_nm, excitation_nm, [&](size_t e, size_t f) {
             const float* values = pair(e, f, below) + nodes.first * kValues + which;
             double sum = 0;
             for (size_t k = 0; k < 4; ++k) sum += double(nodes.weight[k]) * double(values[k * kValues]);
             return sum;
           });
  };
  const auto [e, t] = kExcitations.cell(excitation_nm);
  double absorbed = 0;
  for (size_t k = 0; k < 4; ++k) {
    const float* values = &absorbed_[(e * 2 + size_t(below)) * kSines + nodes.first + k];
    absorbed += double(nodes.weight[k]) * std::lerp(double(values[0]), double(values[2 * kSines]), t);
  }
  return {enters * absorbed, value(kReabsorbed), {value(below ? 1 : 0), value(below ? 0 : 1)}};
}

double FluorescenceTable::f(const Vec3d& wo, const Vec3d& wi, double emission_nm, double excitation_nm) const {
  const SineNodes in = nodes_of(wi), out = nodes_of(wo);
  const size_t first = kToward + (wo.z < 0 ? kSines : 0) + out.first;
  const double toward = between(emission_nm, excitation_nm, [&](size_t e, size_t f) {
    const float* values = pair(e, f, wi.z < 0) + in.first * kValues + first;
    double sum = 0;
    for (size_t i = 0; i < 4; ++i)
      for (size_t o = 0; o < 4; ++o)
        sum += double(in.weight[i]) * double(out.weight[o]) * double(values[i * kValues + o]);
    return sum;
  });
  const Crossing exit = fresnel(std::abs(wo.z), 1 / model_.at(emission_nm).n_cuticle());
  return std::max(0.0, toward) * entering(model_.at(excitation_nm), wi) * (1 - exit.reflectance) / exit.cos_t;
}

}  // namespace frond::leaf
