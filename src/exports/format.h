#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exports/exported_bsdf.h"

namespace frond {

/// What an export is to hold. Lists that are empty are the format's own.
struct ExportRequest {
  std::vector<double> wavelengths_nm;
  std::vector<double> theta_i_deg, theta_o_deg, phi_o_deg;
  int64_t rays = 0;  ///< 0: as many as the format says
};

/// What a request can say, for formats that do not look at all of it.
enum class ExportOption : uint8_t { angles, views, rays };

/// A file format for programs that are not frond.
struct ExportFormat {
  std::string_view name, doc;
  bool is_text;                           ///< can go to standard output
  std::span<const ExportOption> options;  ///< that it looks at, beside the wavelengths
  void (*check)(const ExportRequest&);    ///< throws InputError for what is asked for in vain, before anything is done
  std::string (*write)(const ExportMaterial&, const ExportRequest&);  ///< the whole file; throws InputError
};

/// Throws InputError for numbers that do not ascend; `what` they are.
void check_ascending(std::string_view what, const std::vector<double>& numbers);

/// All of them. A new format is one file and its name in two lines of format.cpp.
std::span<const ExportFormat* const> export_formats();

}  // namespace frond
