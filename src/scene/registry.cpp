#include "scene/registry.h"

#include <array>

#include "spectra/wavelengths/registry.h"

namespace frond {

extern const CameraInfo perspective_camera, orthographic_camera, spherical_camera, distant_camera;
extern const FilmInfo rgb_film, gbuffer_film, spectral_film;
extern const SamplerInfo independent_sampler, lattice_sampler;
extern const FilterInfo box_filter, triangle_filter, gaussian_filter, mitchell_filter, sinc_filter;
extern const ShapeInfo triangle_mesh_shape, ply_mesh_shape, sphere_shape, disk_shape, cylinder_shape,
    bilinear_mesh_shape, curve_shape, loop_subdivision_shape, instances_shape;
extern const LightInfo infinite_light, distant_light, point_light, spot_light, projection_light, goniometric_light,
    sky_light;
extern const AreaLightInfo diffuse_area_light;
extern const FloatTextureInfo constant_float_texture, scale_float_texture, mix_float_texture, image_float_texture,
    instance_float_texture, bilerp_float_texture, checkerboard_float_texture, direction_mix_float_texture,
    dots_float_texture, fbm_float_texture, windy_float_texture, wrinkled_float_texture;
extern const SpectrumTextureInfo constant_spectrum_texture, scale_spectrum_texture, mix_spectrum_texture,
    image_spectrum_texture, bilerp_spectrum_texture, checkerboard_spectrum_texture, direction_mix_spectrum_texture,
    dots_spectrum_texture, marble_spectrum_texture, soil_spectrum_texture;
extern const MediumInfo homogeneous_medium, uniform_grid_medium, rgb_grid_medium, cloud_medium, nanovdb_medium,
    turbid_medium;

namespace {

constexpr std::array kCameras{&perspective_camera, &orthographic_camera, &spherical_camera, &distant_camera};
constexpr std::array kFilms{&rgb_film, &gbuffer_film, &spectral_film};
constexpr std::array kSamplers{&lattice_sampler, &independent_sampler};
constexpr std::array kFilters{&box_filter, &triangle_filter, &gaussian_filter, &mitchell_filter, &sinc_filter};
constexpr std::array kShapes{&triangle_mesh_shape, &ply_mesh_shape,         &sphere_shape,
                             &disk_shape,          &cylinder_shape,         &bilinear_mesh_shape,
                             &curve_shape,         &loop_subdivision_shape, &instances_shape};
constexpr std::array kLights{&infinite_light,   &distant_light,     &point_light, &spot_light,
                             &projection_light, &goniometric_light, &sky_light};
constexpr std::array kAreaLights{&diffuse_area_light};
constexpr std::array kFloatTextures{&constant_float_texture,      &scale_float_texture, &mix_float_texture,
                                    &direction_mix_float_texture, &image_float_texture, &bilerp_float_texture,
                                    &checkerboard_float_texture,  &dots_float_texture,  &fbm_float_texture,
                                    &wrinkled_float_texture,      &windy_float_texture, &instance_float_texture};
constexpr std::array kSpectrumTextures{&constant_spectrum_texture,     &scale_spectrum_texture,
                                       &mix_spectrum_texture,          &direction_mix_spectrum_texture,
                                       &image_spectrum_texture,        &bilerp_spectrum_texture,
                                       &checkerboard_spectrum_texture, &dots_spectrum_texture,
                                       &marble_spectrum_texture,       &soil_spectrum_texture};
constexpr std::array kMedia{&homogeneous_medium, &uniform_grid_medium, &rgb_grid_medium,
                            &cloud_medium,       &nanovdb_medium,      &turbid_medium};

}  // namespace

Registry make_registry(std::span<const MaterialInfo* const> materials,
                       std::span<const IntegratorInfo* const> integrators) {
  return {.materials{"material", materials},
          .integrators{"integrator", integrators},
          .wavelengths{"wavelengths", builtin_wavelengths()},
          .cameras{"camera", kCameras},
          .films{"film", kFilms},
          .samplers{"sampler", kSamplers},
          .filters{"pixel filter", kFilters},
          .shapes{"shape", kShapes},
          .lights{"light", kLights},
          .area_lights{"area light", kAreaLights},
          .float_textures{"float texture", kFloatTextures},
          .spectrum_textures{"spectrum texture", kSpectrumTextures},
          .media{"medium", kMedia}};
}

/// The order is the order of `frond list`.
std::vector<const PluginInfo*> all_plugins(const Registry& r) {
  std::vector<const PluginInfo*> all;
  const auto add = [&all](const auto& table) { all.insert(all.end(), table.all().begin(), table.all().end()); };
  add(r.materials), add(r.integrators), add(r.wavelengths), add(r.cameras), add(r.films), add(r.samplers);
  add(r.filters), add(r.shapes), add(r.lights), add(r.area_lights), add(r.float_textures), add(r.spectrum_textures);
  add(r.media);
  return all;
}

}  // namespace frond
