#pragma once

#include <cstdio>
#include <string>

#include "image/display_image.h"
#include "render/live_view.h"

namespace frond {

/// Returns standard error if it is a terminal, else standard output if it is one, else nullptr.
std::FILE* output_terminal();

/// Draws an image on a terminal, repeatedly in the same place.
class TerminalViewer final : public Viewer {
 public:
  /// R, G and B of the image are linear in the colour space `space`; `display` maps them to the terminal's sRGB.
  TerminalViewer(std::FILE* terminal, std::string space, DisplayChoice display);

  void show(const Image& image) override;
  void end(bool) override {}

 private:
  std::FILE* terminal_;
  std::string space_;
  DisplayChoice display_;
  ColorManager colors_;
  int columns_ = 0, rows_ = 0;  ///< size of the terminal when last drawn
  int lines_ = 0;               ///< number of lines last drawn
};

}  // namespace frond
