#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/spectrum.h"
#include "leaf/tissue/specimens.h"

namespace frond::leaf {

/// What was measured of a leaf at one wavelength and angle: directional-hemispherical reflectance and transmittance.
struct LeafMeasurement {
  double lambda_nm;            ///< within kConstantsRange_nm
  double theta_deg;            ///< in [0, 180]; above 90 the abaxial side is lit
  std::optional<double> r, t;  ///< one of them at least
};

/// A number of a leaf that measurements can tell.
struct FitVariable {
  std::string_view name;  ///< a leaf material's parameter
  double TissueParams::*number;
  Interval range;
  bool is_structure = false;
};

/// Chlorophyll a stands for both: they absorb alike here, b follows by the specimen's ratio; so does lignin cellulose.
/// `mesophyllfraction` is the specimen's: it acts by its product with the thickness alone. The cuticle shapes reflected
/// light and takes nothing from it.
inline constexpr FitVariable kFitVariables[] = {
    {"thickness", &TissueParams::thickness_m, {2e-6, 1e-2}},
    {"chlorophylla", &TissueParams::chlorophyll_a, {1e-3, 100}},
    {"carotenoids", &TissueParams::carotenoids, {1e-3, 100}},
    {"protein", &TissueParams::protein, {0.1, 1500}},
    {"cellulose", &TissueParams::cellulose, {0.1, 1500}},
    {"otherabsorption", &TissueParams::other_absorption, {1, 1e4}},
    {"epidermisaspect", &TissueParams::epidermis_aspect, {0.7, 20}, true},
    {"spongyaspect", &TissueParams::spongy_aspect, {0.7, 20}, true},
    {"palisadeaspect", &TissueParams::palisade_aspect, {0.7, 20}, true},  // of bifacial leaves
};

struct FitRequest {
  std::vector<LeafMeasurement> measurements;
  std::optional<Structure> structure = {};  ///< none: the better one
  std::optional<bool> sieve = {};           ///< likewise
  /// Where the search begins, and what is not told by the data; of the structure that is tried where it is none.
  const Specimen* like = nullptr;
  /// Expect numbers within a factor of e^0.3 or so of `like`: else hardly anything is expected.
  bool has_prior = false;
  struct Fixed {
    std::string name;  ///< of kFitVariables, or mesophyllfraction, chlorophyllb, lignin
    double value;
  };
  std::vector<Fixed> fixed = {};
  /// Least standard error that a reading is believed to have.
  double least_error = 0.002;
};

/// What the data say of one variable.
struct FittedNumber {
  const FitVariable* variable;
  double value;
  double relative_error = 0;  ///< standard error of its logarithm; 0 if fixed
  bool is_fixed = false;
  bool is_at_bound = false;
  /// Told by the data: not fixed, within its range, and to a factor of e^0.5.
  bool is_identified() const { return !is_fixed && !is_at_bound && relative_error < 0.5; }
};

struct FitResult {
  TissueParams params;
  const Specimen* specimen = nullptr;  ///< whose structure it has
  std::vector<FittedNumber> numbers;
  std::vector<std::vector<double>> correlations;  ///< of those that are not fixed, in their order
  struct Fitted {
    double r, t;
    bool is_outlier;  ///< further off than the rest can explain: it counts for less
  };
  std::vector<Fitted> fitted;  ///< [measurement], solved anew
  double rmse = 0, rmse_r = 0, rmse_t = 0;
};

/// Root mean square of what is left between the wavelengths, R and T together; none where there are no measurements.
std::optional<double> rmse_between(const FitRequest& request, const FitResult& result, const Interval& nm);

/// The leaf whose solved walk comes nearest to the measurements, by Levenberg and Marquardt's method from several
/// starts: least squares, but for measurements that are far off, which count by their distance (Huber 1964). Its
/// chemistry acts through one optical depth at each wavelength (OpticsSurface), so that derivatives are exact. Standard
/// errors are those of the linearised problem, widened for residuals that go together along the spectrum. There are as
/// many measurements as free numbers at least. Deterministic.
FitResult fit_leaf(const FitRequest& request, const ThreadPool& pool);

}  // namespace frond::leaf
