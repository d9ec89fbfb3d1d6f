#include "exports/format.h"

#include <algorithm>
#include <functional>
#include <iterator>

namespace frond {

extern const ExportFormat radiance_format, csv_format, npz_format, netcdf_format, osl_format, gltf_format,
    materialx_format;

void check_ascending(std::string_view what, const std::vector<double>& numbers) {
  const auto wrong = std::ranges::adjacent_find(numbers, std::greater_equal());
  if (wrong != numbers.end()) fail({}, "{} must ascend: {:g} follows {:g}", what, *std::next(wrong), *wrong);
}

std::span<const ExportFormat* const> export_formats() {
  static const ExportFormat* const kFormats[] = {&radiance_format, &csv_format,  &npz_format,      &netcdf_format,
                                                 &osl_format,      &gltf_format, &materialx_format};
  return kFormats;
}

}  // namespace frond
