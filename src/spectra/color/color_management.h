#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace frond {

/// Colour conversions by OpenColorIO. Spaces are those of the configuration; linear spaces of color_space.h and XYZ are
/// known with any configuration that says what ACES2065-1 is (role aces_interchange, or a space of that name).
/// Every function throws InputError that names what there is.
class ColorManager {
 public:
  /// `config` is a file; empty: the one that the environment variable OCIO names, or else the built-in one.
  explicit ColorManager(const std::filesystem::path& config = {});
  ~ColorManager();
  ColorManager(ColorManager&&) noexcept;
  ColorManager& operator=(ColorManager&&) noexcept;

  /// In place, pixels of three channels. No clamping.
  void convert(std::span<float> rgb, std::string_view from, std::string_view to) const;

  /// In place: from a colour space to what a display's view shows. Empty names: the configuration's defaults.
  void display(std::span<float> rgb, std::string_view from, std::string_view display, std::string_view view) const;

  /// Throws what `display` would throw, before there are pixels.
  void check_display(std::string_view from, std::string_view display, std::string_view view) const;

  /// Throws what `display` would throw for a display or a view that is not there.
  void check_names(std::string_view display, std::string_view view) const;

  std::vector<std::string> spaces() const;
  std::vector<std::string> displays() const;
  std::vector<std::string> views(std::string_view display) const;

  /// The configuration's file, or "built-in".
  const std::string& source() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace frond
