#include "image/display_image.h"

#include <array>

#include "core/error.h"
#include "image/image_file.h"

namespace frond {

void check_display_choice(const std::string& path, const ColorManager& colors, const DisplayChoice& choice) {
  if (!is_exr(path)) return colors.check_names(choice.display, choice.view);
  if (!choice.display.empty() || !choice.view.empty())
    fail({}, "--display and --view are for .png and .jpg: {} holds linear values", path);
}

void write_display_image(const std::string& path, const Image& image, std::string_view space,
                         const ColorManager& colors, const DisplayChoice& choice,
                         const std::map<std::string, std::string>& text) {
  Image shown = image.selected(std::array<size_t, 3>{0, 1, 2}, {"R", "G", "B"});
  colors.display(shown.pixels, space, choice.display, choice.view);
  write_image(path, shown, {.color_space = "", .text = text});
}

}  // namespace frond
