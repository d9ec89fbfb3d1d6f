#pragma once

#include <string>
#include <vector>

#include "scene/geometry/random_canopy.h"

/// Descriptions of canopies by text and by tables (docs/file_formats.md), for the job canopy.
namespace frond {

/// Returns the distribution of an option: a name, `ellipsoidal,mean=57.3`, `ellipsoidal,chi=1`, `beta,mu=2.77,nu=1.17`,
/// or a file of angles (degrees) and frequencies. `option` is its spelling. Throws InputError.
LeafAngles leaf_angles_of(const std::string& text, const std::string& option);

/// Reads a table of height and leaf area density. Throws InputError.
DensityTable read_profile(const std::string& path);
/// Reads a table of crowns. Throws InputError.
std::vector<Crown> read_crowns(const std::string& path);

}  // namespace frond
