#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "spectra/tabulated.h"

namespace frond {

/// Response of one band of a sensor.
struct BandResponse {
  std::string name;                   ///< of its column, or of its rows; of the file if this has no other band
  std::vector<SpectrumPoint> points;  ///< ascending, without zeros beyond those next to the response; empty: it is 0
};

/// Reads the responses of a sensor's bands: a spectrum file, whose columns of values are a band each, or a table with
/// columns of bands, wavelengths and responses. "FILE:COLUMN" reads one band. Wavelengths may descend; cells may be
/// empty; columns of standard deviations are passed over, and noise about 0, of up to 1 % of the largest response, is
/// 0. Throws InputError as read_spd_points does.
std::vector<BandResponse> read_responses(const std::filesystem::path& path, const Location& where);

/// Reads the same from text. `column`: the band; "" for all.
std::vector<BandResponse> parse_responses(std::string_view text, const std::string& name, std::string_view column = {});

}  // namespace frond
