#pragma once

#include <string>
#include <string_view>

namespace frond {

/// Text of spectra as an instrument or a library exports it, as TextTable reads it.
struct SpectraText {
  /// The table with a line that names its columns: "wavelength", and "R" or "T" for what the layout states. Lines
  /// before it are empty, so that lines keep their numbers.
  std::string text;
  std::string_view layout;  ///< name of the layout, for messages; empty: `text` is what was given
};

/// Recognises files of Spectra Vista (.sig), Spectral Evolution (.sed), the libraries ECOSTRESS and ASTER, ASCII plots
/// of ENVI, and tables whose line of names follows other lines (ASD's ViewSpec and others): the names of their columns
/// begin with that of wavelengths, and numbers follow.
SpectraText spectra_text(std::string_view text);

}  // namespace frond
