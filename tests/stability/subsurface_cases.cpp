#include <fmt/format.h>

#include "materials/lobes/beam_diffusion.h"
#include "materials/lobes/fresnel.h"
#include "tests/stability/cases.h"
#include "tests/stability/comparison.h"
#include "tests/support/render_text.h"

namespace frond::stability {
namespace {

constexpr int kSubsurfaceSamples = 256;

/// A plane under a sky of radiance 1, seen from above.
std::string plane(std::string_view integrator, const std::string& params) {
  return fmt::format(
      "LookAt 0 0 3  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1e-3 1e-3 -1e-3 1e-3]\n"
      "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nSampler \"independent\"\nPixelFilter \"box\"\n"
      "Integrator \"{}\"\nWorldBegin\nLightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"\n"
      "Material \"subsurface\" {}\nShape \"trianglemesh\" \"point3 P\" [-1e7 -1e7 0  1e7 -1e7 0  1e7 1e7 0  -1e7 1e7 "
      "0] "
      "\"integer indices\" [0 1 2  0 2 3]\n",
      integrator, params);
}

/// A medium of the same coefficients at all wavelengths.
struct Grey {
  double sigma_a, sigma_s, g, eta;
  std::string params() const {
    return fmt::format(
        "\"spectrum sigma_a\" [300 {0} 900 {0}] \"spectrum sigma_s\" [300 {1} 900 {1}] \"float g\" {2} "
        "\"float eta\" {3}",
        sigma_a, sigma_s, g, eta);
  }
  double radiance() const {
    const double reflected = double(fresnel_dielectric(1, float(eta))), sigma_t = sigma_a + sigma_s;
    if (sigma_t == 0) return reflected;
    const BeamDiffusion table(g, eta, ThreadPool(1));
    return reflected + (1 - reflected) * double(table.reflectance(float(sigma_s / sigma_t)));
  }
};

Cell radiance(std::string_view integrator, const std::string& params, double truth) {
  const Film film = test::render_text(plane(integrator, params), {.samples = kSubsurfaceSamples});
  Comparison comparison(2e-3);
  comparison.require(film.not_finite() == 0, "a sample is no number");
  for (size_t c = 0; c < 3; ++c) {
    const auto [mean, error] = test::channel_mean(film, c);
    comparison.add("radiance", Estimate{mean, error * error}, truth, int64_t{64} * kSubsurfaceSamples);
  }
  return comparison.cell();
}

}  // namespace

Theme subsurface() {
  Theme theme{
      "Subsurface scattering",
      "Radiance of a plane of material `subsurface` under a sky of radiance 1, against the interface's reflectance "
      "and that of the table of photon beam diffusion. Points are sought within the radius of 99.9 % of the light."};
  const auto add = [&theme](const std::string& name, const std::string& expected, const std::string& params,
                            double truth) {
    theme.add(name, expected)
        .add(Method::path_subsurface, radiance("path", params, truth))
        .add(Method::volpath_subsurface, radiance("volpath", params, truth));
  };
  for (const Grey& grey : {Grey{0, 0, 0, 1.33}, Grey{1, 0, 0, 1.33}, Grey{1, 1e-9, 0, 1.33}})
    add(fmt::format("sigma_a {:g}, sigma_s {:g}", grey.sigma_a, grey.sigma_s), "the interface alone", grey.params(),
        grey.radiance());
  for (const Grey& grey :
       {Grey{0, 1, 0, 1.33}, Grey{0, 1, -0.99, 1}, Grey{1e-4, 1, 0.99, 1.33}, Grey{0.1, 1, 0, 3}, Grey{0.1, 1, 0, 1},
        Grey{1e-4, 1e-3, 0, 1.33}, Grey{1e5, 1e6, 0, 1.33}, Grey{1e29, 1e30, 0, 1.33}})
    add(fmt::format("sigma_a {:g}, sigma_s {:g}, g {:g}, eta {:g}", grey.sigma_a, grey.sigma_s, grey.g, grey.eta),
        "the table's reflectance", grey.params(), grey.radiance());
  const Grey near{1, 9, 0, 1.33};
  add("mean free paths of 0.1 and 1000 at the wavelengths of one path", "the table's reflectance",
      "\"spectrum sigma_a\" [500 1 501 1e-4] \"spectrum sigma_s\" [500 9 501 9e-4]", near.radiance());
  for (const auto& [params, part] :
       {std::pair<std::string, std::string>{"\"float g\" 1", "outside its range -0.99 to 0.99"},
        {"\"float eta\" .9", "outside its range 1 to 3"},
        {"\"rgb sigma_a\" [1 1 1]", "is given without \"sigma_s\""}}) {
    const auto act = [&params] { (void)test::render_text(plane("path", params), {.samples = 1}); };
    theme.add(params, expect_refusal(part)).add(Method::path_subsurface, refusal(part, act));
  }
  return theme;
}

}  // namespace frond::stability
