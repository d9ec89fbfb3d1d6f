#pragma once

#include <cstdio>
#include <string>

#include "image/display_image.h"
#include "render/live_view.h"

namespace frond {

/// Standard error where it is a terminal, or else standard output; nullptr where neither is.
std::FILE* output_terminal();

/// An image on a terminal, drawn over and over in the same place.
class TerminalViewer final : public Viewer {
 public:
  /// The image's R, G and B, linear in `space`, go through this display.
  TerminalViewer(std::FILE* terminal, std::string space, DisplayChoice display);

  void show(const Image& image) override;
  void end(bool) override {}

 private:
  std::FILE* terminal_;
  std::string space_;
  DisplayChoice display_;
  ColorManager colors_;
  int columns_ = 0, rows_ = 0;  ///< of the terminal when it was drawn on last
  int lines_ = 0;               ///< of what was drawn
};

}  // namespace frond
