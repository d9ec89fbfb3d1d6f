#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace frond::leaf {

/// What the values of a file of matrices are.
struct MatrixUnit {
  bool is_energy = false;  ///< energy per nm and incident energy; else photons per nm and incident photon
  double scale = 1;        ///< factor of all values
};

/// Excitation-emission matrices of a leaf from a file (docs/file_formats.md): photons per nm of emission that leave a
/// side, in all directions, per incident photon. Bilinear between the file's wavelengths, 0 beyond them.
class EmissionMatrices {
 public:
  /// Values at a pair of wavelengths, 1/nm.
  struct Sides {
    double lit = 0;       ///< Mb, of the side of the light
    double opposite = 0;  ///< Mf
  };

  /// Parses a file's text; `name` is the file's for messages. Throws InputError with line and column.
  EmissionMatrices(std::string_view text, const std::string& name, const MatrixUnit& unit);

  /// Name of the file, for results.
  const std::string& name() const { return name_; }
  Sides at(double emission_nm, double excitation_nm, bool abaxial) const;
  /// Returns the photons of all wavelengths that leave both sides, the mean of light on one side and on the other.
  double emitted(double excitation_nm) const;

 private:
  struct Row;
  /// Matrices for light on one side of the leaf.
  struct Matrix {
    std::vector<double> excitation_nm, emission_nm;
    std::vector<Sides> values;    ///< [excitation][emission]
    std::vector<double> emitted;  ///< [excitation], over both sides and all emission
  };

  static Matrix matrix_of(std::vector<Row> rows);

  std::string name_;
  /// By the lit side: adaxial, abaxial; without values, the latter equals the former.
  std::array<Matrix, 2> sides_;
};

/// Reads such a file. Throws InputError, at `where` if the file cannot be read.
EmissionMatrices read_emission_matrices(const std::filesystem::path& path, const MatrixUnit& unit,
                                        const Location& where);

}  // namespace frond::leaf
