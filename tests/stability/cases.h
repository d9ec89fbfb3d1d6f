#pragma once

#include "tests/stability/page.h"

namespace frond::stability {

/// Light from the normal to the horizon and beyond.
Theme incidence();
/// Aspect ratios, thickness, pigments and mesophyll fraction at the ends of their ranges.
Theme ends_of_ranges();
/// The same parameters outside their ranges.
Theme outside_ranges();
/// No absorption and complete absorption.
Theme absorption();
/// Refractive indices outside the range of leaves.
Theme indices();
/// Four wavelengths on one walk.
Theme dispersion();
/// f, pdf and sample in and near the surface's plane.
Theme directions();
/// Valid and invalid table files.
Theme table_files();
/// Requests to the instruments.
Theme instruments();
/// Sample weights: whether their variance is finite.
Theme tails();
/// Scenes: tilted shading normals, objects far from the origin.
Theme scenes();
/// The light "sky": positions of the sun, ends of the ranges of its atmosphere.
Theme skies();
/// Participating media: no absorption, no scattering, ends of ranges.
Theme media();
/// Material "measured": valid and invalid goniometer tables, and a tensor file to the horizon.
Theme measured();
/// Material "hair": ends of its ranges, light along the fibre.
Theme hair();
/// Material "subsurface": no absorption, no scattering, ends of ranges.
Theme subsurface();
/// Fluorescence: no and much chlorophyll, yields 0 and 1, grazing light, excitation within the emission.
Theme fluorescence();

}  // namespace frond::stability
