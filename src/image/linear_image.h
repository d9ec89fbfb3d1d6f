#pragma once

#include <string>

#include "image/image_file.h"

namespace frond {

/// Linear R, G, B and, where the file has it, the share of leaf of each pixel.
struct LinearImage {
  std::string path, space;
  Image image;              ///< R G B
  std::vector<float> leaf;  ///< empty: not in the file
  std::string seed;         ///< of the render, as its header says; empty: it does not
};

/// Throws InputError when the file is not linear or lacks a channel.
LinearImage read_linear(const std::string& path);

void check_same_size(const LinearImage& a, const LinearImage& b);

}  // namespace frond
