#include "core/error.h"
#include "report/chart.h"
#include "system/atomic_file.h"
#ifdef FROND_RSVG_FILE
#include <librsvg/rsvg.h>

#include <memory>

#include "system/shared_object.h"
#endif

namespace frond {

#ifdef FROND_RSVG_FILE
namespace {

/// Returns a function of librsvg, which is loaded on first use, or of its dependencies Cairo and GLib.
template <class Function>
Function* librsvg_function(const char* name) {
  static const SharedObject library(FROND_RSVG_FILE, "librsvg", SharedObject::Binding::lazy);
  if (Function* function = library.find<Function>(name)) return function;
  fail({}, "librsvg \"{}\" has no function {}", FROND_RSVG_FILE, name);
}
#define LATE(name) librsvg_function<decltype(::name)>(#name)

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

std::string png_of(const std::string& svg) {
  const auto bytes = reinterpret_cast<const guint8*>(svg.data());
  const std::shared_ptr<RsvgHandle> handle(LATE(rsvg_handle_new_from_data)(bytes, svg.size(), nullptr),
                                           LATE(g_object_unref));
  RsvgRectangle size{};
  LATE(rsvg_handle_get_intrinsic_size_in_pixels)(handle.get(), &size.width, &size.height);
  const std::shared_ptr<cairo_surface_t> surface(
      LATE(cairo_image_surface_create)(CAIRO_FORMAT_RGB24, int(size.width), int(size.height)),
      LATE(cairo_surface_destroy));
  const std::shared_ptr<cairo_t> cairo(LATE(cairo_create)(surface.get()), LATE(cairo_destroy));
  std::string png;
  if (!LATE(rsvg_handle_render_document)(handle.get(), cairo.get(), &size, nullptr) ||
      LATE(cairo_surface_write_to_png_stream)(surface.get(), append, &png) != CAIRO_STATUS_SUCCESS)
    fail({}, "librsvg cannot draw the chart");
  return png;
}

}  // namespace

std::string png_refusal() try {
  LATE(rsvg_handle_render_document);
  return "";
} catch (const InputError& error) {
  return fmt::format("{}: charts as .png need it (Debian: librsvg2-2), charts as .svg do not", error.what());
}
#else
static std::string png_of(const std::string&) { fail({}, "{}", png_refusal()); }

std::string png_refusal() {
  return "this frond was built without librsvg (Debian: librsvg2-dev): charts as .png need it, charts as .svg do not";
}
#endif

void check_chart(const std::string& path) {
  if (!path.ends_with(".svg") && !path.ends_with(".png")) fail({}, "{}: a chart is an .svg or a .png file", path);
  check_replaceable(path);
  if (path.ends_with(".svg")) return;
  if (const std::string why = png_refusal(); !why.empty()) fail({}, "{}", why);
}

std::string chart_png(const Chart& chart) { return png_of(chart_svg(chart)); }

void write_chart(const std::string& path, const Chart& chart) {
  const std::string bytes = path.ends_with(".png") ? chart_png(chart) : chart_svg(chart);
  replace_file(path, {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
}

}  // namespace frond
