#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exports/exported_bsdf.h"

namespace frond {

/// Contents of an export. Empty lists select the format's defaults.
struct ExportRequest {
  std::vector<double> wavelengths_nm;
  std::vector<double> theta_i_deg, theta_o_deg, phi_o_deg;
  int64_t rays = 0;  ///< 0: the format's default
};

/// Optional parts of a request. A format uses a subset of them.
enum class ExportOption : uint8_t { angles, views, rays };

/// A file format for other programs.
struct ExportFormat {
  std::string_view name, doc;
  bool is_text;                           ///< may be written to standard output
  std::span<const ExportOption> options;  ///< used by the format, in addition to the wavelengths
  void (*check)(const ExportRequest&);    ///< throws InputError for an invalid request, before any work
  std::string (*write)(const ExportMaterial&, const ExportRequest&);  ///< returns the whole file; throws InputError
};

/// Throws InputError unless the numbers ascend. `what` names them in the message.
void check_ascending(std::string_view what, const std::vector<double>& numbers);

/// Returns all formats. A new format is one file and two lines in format.cpp.
std::span<const ExportFormat* const> export_formats();

}  // namespace frond
