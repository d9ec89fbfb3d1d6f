#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/spectrum.h"
#include "leaf/fit/structure_prior.h"
#include "leaf/tissue/specimens.h"

namespace frond::leaf {

/// Measured directional-hemispherical reflectance and transmittance of a leaf at one wavelength and angle.
struct LeafMeasurement {
  double lambda_nm;            ///< within kConstantsRange_nm
  double theta_deg;            ///< in [0, 180]; above 90 the abaxial side is lit
  std::optional<double> r, t;  ///< shares of 1; at least one of the two
};

/// Parameters that `fit_leaf` can estimate. A constituent that follows another one is fitted with it, by the specimen's
/// ratio, since both absorb alike.
inline auto fit_variables() { return kLeafNumbers | std::views::filter(&LeafNumber::is_fitted); }

/// Whether leaves of this structure have the number.
inline bool has_number(Structure structure, const LeafNumber& n) {
  return structure == Structure::bifacial || !n.only_bifacial;
}

/// Input of `fit_leaf`.
struct FitRequest {
  std::vector<LeafMeasurement> measurements;
  std::optional<Structure> structure = {};  ///< none: both are fitted, the better one is returned
  std::optional<bool> sieve = {};           ///< sieve and detour effects; none: likewise
  /// Start of the search, and the values that the measurements do not determine. nullptr: a specimen of the structure
  /// that is being fitted.
  const Specimen* like = nullptr;
  /// Use `like` as a prior with a standard deviation of about 0.3 in each parameter's logarithm; otherwise the prior is
  /// almost flat.
  bool has_prior = false;
  /// Prior over the structure where only R or only T was measured (used_prior); nullptr: none.
  const StructurePrior* structure_prior = &built_in_prior();
  /// Specific absorption of the fitted leaf. With `prospect`, dry matter takes the place of protein, cellulose and
  /// lignin.
  AbsorptionTables absorption_tables = AbsorptionTables::prospect;
  /// A parameter that is kept at a given value.
  struct Fixed {
    /// Of a parameter that changes reflectance and transmittance, or, per area, of an area content.
    std::string name;
    double value;
    bool per_area = false;  ///< `value` is the content, kg/m^2 (leaf/tissue/area_content.h)
  };
  std::vector<Fixed> fixed = {};
  /// Reflectance of a Lambertian background behind the leaf, in [0, 1), where R is that of both; 0: R is the leaf's.
  double background = 0;
  /// Lower bound of the standard error that is assumed for a measured R or T.
  double least_error = 0.002;
};

/// Estimate of one parameter.
struct FittedNumber {
  const LeafNumber* variable;
  double value;
  double relative_error = 0;  ///< standard error of its logarithm; 0 if fixed
  bool is_fixed = false;
  bool is_at_bound = false;
  bool is_of_prior = false;  ///< its error is hardly below that of the structure prior
  /// Whether the measurements determine the parameter: it is not fixed, lies within its range, and its relative error
  /// is below 0.5, not by the prior.
  bool is_identified() const { return !is_fixed && !is_at_bound && !is_of_prior && relative_error < 0.5; }
};

/// Content of a constituent per leaf area.
struct FittedContent {
  std::string_view name;
  AreaUnit unit;  ///< for reports
  double kg_per_m2;
  double relative_error = 0;  ///< standard error of its logarithm; 0 if fixed
};

/// Range of wavelengths in which the fitted leaf differs from the measurements.
struct MisfitBand {
  double theta_deg;
  Interval nm;      ///< first and last measurement
  bool is_t;        ///< T, else R
  double measured;  ///< means over the band's measurements
  double fitted;
  double lowest_r;  ///< lowest R in the band that a leaf of the fitted structure reaches with any absorption
};

/// Output of `fit_leaf`.
struct FitResult {
  TissueParams params;
  const Specimen* specimen = nullptr;  ///< the specimen that the search began with
  std::vector<FittedNumber> numbers;
  std::vector<std::vector<double>> correlations;  ///< of the parameters that are not fixed, in the order of `numbers`
  /// R and T of the fitted leaf at one measurement, R with the background.
  struct Fitted {
    double r, t;
    bool is_outlier;  ///< its residual is too large for the others' spread: it has less weight
  };
  std::vector<FittedContent> contents;    ///< per leaf area, those above 0
  std::vector<MisfitBand> misfits;        ///< see misfit_bands
  std::vector<Fitted> fitted;             ///< [measurement], solved with the fitted parameters
  double rmse = 0;                        ///< root mean square of the residuals
  std::optional<double> rmse_r, rmse_t;   ///< of R alone and of T alone; nullopt: none was measured
  double reach_nm = 0;                    ///< the correlation of two residuals is about exp(-distance / reach)
  const StructurePrior* prior = nullptr;  ///< the structure prior that was used, of the request; nullptr: none
};

/// Returns R of a leaf on a background: light is reflected between both (Stokes 1862). The leaf's lower side and
/// diffuse light are taken to have the R and T of its upper side and of the beam.
inline double on_background(double r, double t, double background) {
  return background == 0 ? r : r + t * t * background / (1 - r * background);
}

/// Root mean square of the residuals at wavelengths within `nm`, R and T together; none if there are no measurements.
std::optional<double> rmse_between(const FitRequest& request, const FitResult& result, const Interval& nm);

/// Residuals above this are a misfit; so is a band of them that is at least this wide.
inline constexpr double kMisfit = 0.01, kMisfitWidth_nm = 25;

/// Returns the bands in which R or T is off by more than kMisfit at every measurement, with one sign. Single bad points
/// are none: a band reaches halfway to the measurements beside it and is at least kMisfitWidth_nm wide.
std::vector<MisfitBand> misfit_bands(const FitRequest& request, const FitResult& result);

/// Results of `fit_leaf` that are the same for many leaves: the optics of the structures at which searches start. May
/// be used by several threads at once.
class FitCache {
 public:
  FitCache();
  ~FitCache();
  FitCache(const FitCache&) = delete;
  FitCache& operator=(const FitCache&) = delete;

  struct Content;
  Content& content() { return *content_; }

 private:
  std::unique_ptr<Content> content_;
};

/// Returns the leaf whose solved walk fits the measurements best, by the method of Levenberg and Marquardt from several
/// starts: least squares, except that outliers are weighted by their distance (Huber 1964). The search interpolates R
/// and T (OpticsSurface); its last steps solve them at the measurements, until the fit no longer changes. Standard
/// errors follow from the linearised problem, widened for residuals that are correlated along the spectrum. Requires at
/// least as many measurements as free parameters. Deterministic. `cache`, unless it is nullptr, saves a tenth of the
/// time of many fits and does not change them.
FitResult fit_leaf(const FitRequest& request, const ThreadPool& pool, FitCache* cache = nullptr);

}  // namespace frond::leaf
