#pragma once

#include "tests/stability/page.h"

namespace frond::stability {

/// Light from the normal to grazing and across it.
Theme incidence();
/// Aspect ratios, thickness, pigments and mesophyll fraction at the ends of their ranges.
Theme ends_of_ranges();
/// The same numbers outside them.
Theme outside_ranges();
/// Nothing absorbs, or all does.
Theme absorption();
/// Refractive indices that no leaf has.
Theme indices();
/// Four wavelengths on one walk.
Theme dispersion();
/// f, pdf and sample in and near the surface's plane.
Theme directions();
/// Files with tables, good and bad.
Theme table_files();
/// Requests to the instruments.
Theme instruments();
/// Weights of samples: whether noise settles.
Theme tails();
/// Scenes: normals that disagree, places far from the origin.
Theme scenes();

}  // namespace frond::stability
