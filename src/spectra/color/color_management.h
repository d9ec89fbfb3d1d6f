#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace frond {

/// Colour conversions by OpenColorIO. The spaces are the configuration's, and in addition the linear spaces of
/// color_space.h and XYZ if the configuration defines ACES2065-1 (role aces_interchange, or a space of that name), by
/// which the two are connected. Every function throws InputError for an unknown name, with a suggestion.
class ColorManager {
 public:
  /// `config` is a configuration file, or with OpenColorIO 2.2 one of its own (ocio://default); empty: the one named by
  /// the environment variable OCIO, else frond's. Throws InputError if it cannot be read.
  explicit ColorManager(const std::filesystem::path& config = {});
  ~ColorManager();
  ColorManager(ColorManager&&) noexcept;
  ColorManager& operator=(ColorManager&&) noexcept;

  /// Converts pixels of three interleaved channels in place, from one space to another. Values are not clamped.
  void convert(std::span<float> rgb, std::string_view from, std::string_view to) const;

  /// Converts pixels of three interleaved channels in place, from a colour space to the encoded values of a display's
  /// view. Empty names select the configuration's default display and view.
  void display(std::span<float> rgb, std::string_view from, std::string_view display, std::string_view view) const;

  /// Throws what `display` would throw, so that a wrong choice is reported before an image is rendered.
  void check_display(std::string_view from, std::string_view display, std::string_view view) const;

  /// Throws InputError if the display or the view does not exist; the colour space is not checked.
  void check_names(std::string_view display, std::string_view view) const;

  /// Names of all colour spaces: the configuration's, then the spaces of color_space.h that it lacks.
  std::vector<std::string> spaces() const;
  /// Names of the configuration's displays.
  std::vector<std::string> displays() const;
  /// Names of a display's views.
  std::vector<std::string> views(std::string_view display) const;

  /// Path of the configuration, or "built-in".
  const std::string& source() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace frond
