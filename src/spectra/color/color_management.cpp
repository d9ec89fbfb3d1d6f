#include "spectra/color/color_management.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <sstream>

#include "core/error.h"
#include "spectra/color/builtin_config.h"

namespace OCIO = OCIO_NAMESPACE;

namespace frond {
namespace {

OCIO::ConstConfigRcPtr make_builtin() {
  std::istringstream text(builtin_ocio_config());
  return OCIO::Config::CreateFromStream(text);
}

std::filesystem::path config_in_use(const std::filesystem::path& config) {
  if (!config.empty()) return config;
  const char* environment = std::getenv("OCIO");
  return environment ? environment : "";
}

/// OpenColorIO reads its own configurations (ocio://default) since 2.2; older versions look for a file of that name.
void check_uri(const std::filesystem::path& path) {
  constexpr int kFirstWithConfigurations = 0x02020000;
  if (!path.string().starts_with("ocio://") || OCIO::GetVersionHex() >= kFirstWithConfigurations) return;
  fail({},
       "OCIO=\"{}\": OpenColorIO {} of this machine has no configurations of its own; 2.2 and later have. Set OCIO to "
       "a file, such as cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio from "
       "https://github.com/AcademySoftwareFoundation/OpenColorIO-Config-ACES/releases, or unset it: frond's own "
       "configuration has the view \"ACES 1.0 - SDR Video\" of the display sRGB",
       path.string(), OCIO::GetVersion());
}

OCIO::ConstConfigRcPtr read_config(const std::filesystem::path& path) try {
  check_uri(path);
  return OCIO::Config::CreateFromFile(path.c_str());
} catch (const OCIO::Exception& e) {
  fail({}, "cannot read the OpenColorIO configuration \"{}\" (environment variable OCIO): {}", path.string(), e.what());
}

/// Conversions that are applied one after the other.
using Chain = std::vector<OCIO::ConstProcessorRcPtr>;

void apply_chain(const Chain& chain, std::span<float> rgb) {
  assert(rgb.size() % 3 == 0);
  if (rgb.empty()) return;
  for (const auto& processor : chain) {
    OCIO::PackedImageDesc image(rgb.data(), static_cast<long>(rgb.size() / 3), 1, 3);
    processor->getDefaultCPUProcessor()->apply(image);
  }
}

/// Returns the names for the indices 0 to count - 1, which OpenColorIO returns one at a time.
template <class Get>
std::vector<std::string> collect_names(int count, const Get& get) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.emplace_back(get(i));
  return names;
}

[[noreturn]] void fail_unknown(std::string_view what, std::string_view name, const std::vector<std::string>& known) {
  fail({}, "unknown {} \"{}\"{}", what, name, suggestion(name, {known.begin(), known.end()}));
}

void check_known(std::string_view what, std::string_view name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end()) fail_unknown(what, name, known);
}

/// Colour space of one of the two configurations, built-in and user's.
struct Place {
  OCIO::ConstConfigRcPtr config;
  std::string space;
};

}  // namespace

class ColorManager::Impl {
 public:
  explicit Impl(const std::filesystem::path& path)
      : source_(path.empty() ? "built-in" : path.string()),
        builtin_(make_builtin()),
        config_(path.empty() ? builtin_ : read_config(path)) {}

  const std::string& source() const { return source_; }

  /// Conversion between two spaces; between two configurations it goes through ACES2065-1.
  Chain conversion(std::string_view from, std::string_view to) const {
    Place a = find(from), b = find(to);
    if (a.config == b.config) return {a.config->getProcessor(a.space.c_str(), b.space.c_str())};
    return {a.config->getProcessor(a.space.c_str(), aces(a.config).c_str()),
            b.config->getProcessor(aces(b.config).c_str(), b.space.c_str())};
  }

  /// Returns the names of a display and one of its views; the configuration's defaults for empty names.
  std::pair<std::string, std::string> names(std::string_view display_or_empty, std::string_view view_or_empty) const {
    const std::string display(display_or_empty.empty() ? config_->getDefaultDisplay() : display_or_empty);
    const std::vector<std::string> known_views = views(display);
    const std::string view(view_or_empty.empty() ? config_->getDefaultView(display.c_str()) : view_or_empty);
    check_known(fmt::format("view of display {}", display), view, known_views);
    return {display, view};
  }

  Chain display(std::string_view from, std::string_view display_or_empty, std::string_view view_or_empty) const {
    const auto [display, view] = names(display_or_empty, view_or_empty);
    Place source = find(from);
    Chain chain;
    if (source.config != config_ && !has_aces(config_) && config_->getColorSpace(source.space.c_str())) {
      source.config = config_;  // without ACES2065-1, use the configuration's own space of that name
    } else if (source.config != config_) {
      const std::string common = aces(config_);
      chain = conversion(from, common);
      source.space = common;
    }
    chain.push_back(
        config_->getProcessor(source.space.c_str(), display.c_str(), view.c_str(), OCIO::TRANSFORM_DIR_FORWARD));
    return chain;
  }

  std::vector<std::string> spaces() const {
    auto names =
        collect_names(config_->getNumColorSpaces(), [this](int i) { return config_->getColorSpaceNameByIndex(i); });
    if (config_ == builtin_) return names;
    for (int i = 0; i < builtin_->getNumColorSpaces(); ++i)
      if (const char* ours = builtin_->getColorSpaceNameByIndex(i); !config_->getColorSpace(ours))
        names.emplace_back(ours);
    return names;
  }

  std::vector<std::string> displays() const {
    return collect_names(config_->getNumDisplays(), [this](int i) { return config_->getDisplay(i); });
  }

  std::vector<std::string> views(const std::string& display) const {
    check_known("display", display, displays());
    return collect_names(config_->getNumViews(display.c_str()),
                         [&](int i) { return config_->getView(display.c_str(), i); });
  }

 private:
  /// Built-in names have priority over equal names of the user's configuration, so that the pixels of an EXR do not
  /// depend on the configuration.
  Place find(std::string_view name) const {
    const std::string space(name);
    for (const auto& config : {builtin_, config_})
      if (config->getColorSpace(space.c_str())) return {config, space};
    fail_unknown("color space", name, spaces());
  }

  static constexpr std::array kAcesNames{"aces_interchange", "ACES2065-1", "ACES - ACES2065-1"};
  static bool has_aces(const OCIO::ConstConfigRcPtr& config) {
    return std::any_of(kAcesNames.begin(), kAcesNames.end(), [&](auto name) { return config->getColorSpace(name); });
  }

  /// Returns a configuration's name of ACES2065-1, the space by which two configurations are connected.
  std::string aces(const OCIO::ConstConfigRcPtr& config) const {
    for (const char* name : kAcesNames)
      if (config->getColorSpace(name)) return name;
    fail({},
         "the OpenColorIO configuration \"{}\" does not say what ACES2065-1 is (role aces_interchange), so that other "
         "color spaces than its own cannot be converted; its own are {}",
         source_, fmt::join(spaces(), ", "));
  }

  std::string source_;
  OCIO::ConstConfigRcPtr builtin_, config_;
};

namespace {

/// Converts exceptions of OpenColorIO to InputError.
template <class Make>
Chain build(const Make& make) try {
  return make();
} catch (const OCIO::Exception& e) {
  fail({}, "OpenColorIO: {}", e.what());
}

}  // namespace

ColorManager::ColorManager(const std::filesystem::path& config)
    : impl_(std::make_unique<Impl>(config_in_use(config))) {}
ColorManager::~ColorManager() = default;
ColorManager::ColorManager(ColorManager&&) noexcept = default;
ColorManager& ColorManager::operator=(ColorManager&&) noexcept = default;

void ColorManager::convert(std::span<float> rgb, std::string_view from, std::string_view to) const {
  apply_chain(build([&] { return impl_->conversion(from, to); }), rgb);
}

void ColorManager::display(std::span<float> rgb, std::string_view from, std::string_view display,
                           std::string_view view) const {
  apply_chain(build([&] { return impl_->display(from, display, view); }), rgb);
}

void ColorManager::check_display(std::string_view from, std::string_view display, std::string_view view) const {
  build([&] { return impl_->display(from, display, view); });
}

void ColorManager::check_names(std::string_view display, std::string_view view) const { impl_->names(display, view); }

std::vector<std::string> ColorManager::spaces() const { return impl_->spaces(); }
std::vector<std::string> ColorManager::displays() const { return impl_->displays(); }
std::vector<std::string> ColorManager::views(std::string_view display) const {
  return impl_->views(std::string(display));
}
const std::string& ColorManager::source() const { return impl_->source(); }

}  // namespace frond
