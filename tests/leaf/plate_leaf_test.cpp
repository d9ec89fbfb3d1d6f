#include "leaf/plates/plate_leaf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "leaf/fit/measured_spectra.h"
#include "leaf/solve/solver.h"
#include "leaf/tissue/constants.h"

namespace frond::leaf {
namespace {

struct Known {
  double nm, r, t;
};

const LeafMeasurement& at(const std::vector<LeafMeasurement>& spectra, double nm) {
  return spectra.at(nm < 400 ? 0 : static_cast<size_t>(nm - 399));
}

// Computed with prosail 2.0.5 from PyPI, run_prospect(..., prospect_version="D"), to six decimals.
TEST(PlateLeaf, HasTheSpectraOfProspectD) {
  const struct {
    PlateLeaf leaf;
    std::vector<Known> known;
  } cases[] = {
      {{{1.5, 40, 8, 0, 0, 0.01, 0.009}},
       {{400, 0.043118, 0.000331},
        {551, 0.150719, 0.149922},
        {677, 0.035826, 0.004661},
        {703, 0.158288, 0.170418},
        {1450, 0.16503, 0.209699},
        {2500, 0.03356, 0.058345}}},
      {{{1, 5, 2, 0, 0, 0.004, 0.003}},
       {{400, 0.05467, 0.086203},
        {551, 0.292351, 0.491661},
        {677, 0.112203, 0.253695},
        {703, 0.29586, 0.515966},
        {1450, 0.202455, 0.43885},
        {2500, 0.064527, 0.263901}}},
      {{{2.7, 85, 18, 4, 0.6, 0.03, 0.015}},
       {{400, 0.043086, 0},
        {551, 0.090235, 0.010312},
        {677, 0.035142, 1.7e-5},
        {703, 0.132654, 0.027706},
        {1450, 0.114613, 0.029473},
        {2500, 0.021421, 0.001303}}},
  };
  for (const auto& [leaf, known] : cases) {
    const std::vector<LeafMeasurement> spectra = plate_spectra(leaf);
    for (const Known& k : known) {
      const LeafMeasurement& m = at(spectra, k.nm);
      EXPECT_EQ(m.lambda_nm, k.nm);
      EXPECT_NEAR(*m.r, k.r, 6e-7) << k.nm;
      EXPECT_NEAR(*m.t, k.t, 6e-7) << k.nm;
    }
  }
}

TEST(PlateLeaf, HasTheNumbersOfProspectD) {
  std::vector<std::string_view> names;
  for (const PlateNumber& n : plate_numbers()) names.push_back(n.name);
  EXPECT_EQ(names, (std::vector<std::string_view>{"N", "Cab", "Car", "Cant", "Cbrown", "Cw", "Cm"}));
}

TEST(PlateLeaf, CoversTheWavelengthsOfLeaves) {
  const std::vector<LeafMeasurement> spectra = plate_spectra({{1.5, 40, 8, 0, 0, 0.01, 0.009}});
  EXPECT_EQ(spectra.front().lambda_nm, kConstantsRange_nm.min);
  EXPECT_EQ(spectra.back().lambda_nm, kConstantsRange_nm.max);
  EXPECT_EQ(spectra.front().r, at(spectra, 400).r);
}

// Where nothing absorbs, all light leaves, of any number of plates: the formula's limit.
TEST(PlateLeaf, WithoutAbsorbersLosesNoLight) {
  for (const double plates : {1.0, 1.5, 2.0, 10.0})
    for (const LeafMeasurement& m : plate_spectra({{plates, 0, 0, 0, 0, 0, 0}})) {
      ASSERT_NEAR(*m.r + *m.t, 1, 1e-9) << plates << " " << m.lambda_nm;
      ASSERT_GE(*m.t, 0);
    }
}

// The ends of all ranges.
TEST(PlateLeaf, HasSharesAtTheEndsOfItsRanges) {
  const auto numbers = plate_numbers();
  for (unsigned corner = 0; corner < 1u << numbers.size(); ++corner) {
    PlateLeaf leaf;
    for (size_t i = 0; i < numbers.size(); ++i)
      leaf.values.push_back((corner >> i & 1) ? numbers[i].range.max : numbers[i].range.min);
    for (const LeafMeasurement& m : plate_spectra(leaf))
      ASSERT_TRUE(*m.r >= 0 && *m.t >= 0 && *m.r + *m.t <= 1 + 1e-9) << corner << " " << m.lambda_nm << " " << *m.r;
  }
}

TEST(PlateLeaf, HasALeafOfTheWalkThatIsNear) {
  const PlateLeaf leaf{{1.5, 40, 8, 0, 0, 0.01, 0.009}};
  const NearestWalk& walk = nearest_walk(leaf);
  EXPECT_EQ(&walk, &nearest_walk(leaf)) << "leaves are fitted once";
  EXPECT_LT(walk.rmse, 0.02);
  EXPECT_GE(walk.largest, walk.rmse);
  // Solved again, at wavelengths beside those of the fit.
  const TissueModel model(walk.params);
  const std::vector<LeafMeasurement> spectra = plate_spectra(leaf);
  for (const double nm : {555.0, 685.0, 865.0, 1605.0}) {
    const Shares shares = solve(model.at(nm), std::vector<double>{8})[0];
    EXPECT_NEAR(shares.surface + shares.subsurface, *at(spectra, nm).r, walk.largest + 0.005) << nm;
    EXPECT_NEAR(shares.transmitted, *at(spectra, nm).t, walk.largest + 0.005) << nm;
  }
}

/// PROSPECT's own spectra give its numbers again; R alone does so for these, as PROSPECT has no further structure.
TEST(PlateLeaf, IsFittedByItsSpectra) {
  for (const PlateLeaf& leaf :
       {PlateLeaf{{1.5, 40, 8, 1, 0.1, 0.01, 0.009}}, PlateLeaf{{2.4, 70, 14, 0, 0, 0.03, 0.003}}})
    for (const bool has_t : {true, false}) {
      std::vector<LeafMeasurement> spectra;
      for (LeafMeasurement m : plate_spectra(leaf)) {
        if (std::fmod(m.lambda_nm, 20) != 0) continue;
        if (!has_t) m.t.reset();
        spectra.push_back(m);
      }
      spectra.push_back({550, 60, 0.9, {}});  // an angle that PROSPECT does not have
      const auto fitted = fit_plates(spectra);
      ASSERT_TRUE(fitted);
      EXPECT_LT(fitted->rmse, 1e-5);
      for (size_t i = 0; i < leaf.values.size(); ++i)
        EXPECT_NEAR(fitted->leaf.values[i], leaf.values[i], 0.01 * leaf.values[i] + 0.01) << plate_numbers()[i].name;
    }
  EXPECT_FALSE(fit_plates(std::vector<LeafMeasurement>{{550, 8, 0.1, 0.1}}));
}

/// By SciPy's least_squares and prosail 2.0.5 (measurements/fit.py): RMSE 0.0100, N 1.71, 34.4 ug/cm2 of chlorophyll.
TEST(PlateLeaf, IsFittedToAMeasuredLeaf) {
  const auto leaves = read_measured_leaves(FROND_SOURCE_DIR "/tests/reference/lopex93_soybean.csv", {});
  const auto fitted = fit_plates(leaves[0].spectra.measurements);
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(fitted->rmse, 0.0100, 5e-5);
  EXPECT_NEAR(fitted->leaf.plates(), 1.708, 0.002);
  EXPECT_NEAR(fitted->leaf.values[1], 34.41, 0.05);
}

}  // namespace
}  // namespace frond::leaf
