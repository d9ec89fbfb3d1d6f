#include "core/math/affine_map.h"
#include "core/parallel.h"
#include "media/medium_params.h"
#include "media/nanovdb_grid.h"
#include "media/null_collisions.h"
#include "system/file_bytes.h"

namespace frond {
namespace {

constexpr int kNanoVdbMajorantCells = 64;  // along each axis, as in pbrt-v4

/// Coefficients are in 1/unit at density 1.
constexpr Param kNanoVdb[] = {
    {.name = "filename", .kind = ParamKind::string, .doc = "NanoVDB file.", .required = true},
    {.name = "gridname",
     .kind = ParamKind::string,
     .default_value = std::string_view("density"),
     .doc = "Grid of densities."},
    {.name = "temperaturename",
     .kind = ParamKind::string,
     .default_value = std::string_view("temperature"),
     .doc = "Grid of temperatures (K), for emission as a blackbody whose largest value is 1; it may be missing."},
    {.name = "Lescale",
     .kind = ParamKind::real,
     .default_value = 1.0,
     .range = kAtLeastZero,
     .doc = "Factor of the emission."},
    kTemperatureOffset,
    kTemperatureScale,
    kTemperatureCutoff,
    kSigmaA,
    kSigmaS,
    kMediumScale,
    kMeanCosine};

/// Grids of a file.
struct Grids {
  std::unique_ptr<NanoVdbGrid> density, temperature;  ///< temperature may be null
  Bounds bounds;                                      ///< of both grids, medium space
};

/// Throws InputError for an unreadable file or a grid that is missing; warns if floats do not resolve its position.
Grids read_grids(const Params& p) {
  const std::filesystem::path path = p.file("filename");
  const std::string bytes = read_file_bytes(path, p.where("filename"), "NanoVDB file");
  const auto read = [&](const std::string& name) {
    return NanoVdbGrid::read(bytes, path.string(), name, p.where("filename"));
  };
  Grids grids{read(p.string("gridname")), read(p.string("temperaturename")), {}};
  if (!grids.density)
    fail(p.where("filename"), "NanoVDB file \"{}\": it has no grid \"{}\"; \"gridname\" names another", path.string(),
         p.string("gridname"));
  if (p.given("temperaturename") && !grids.temperature)
    fail(p.where("temperaturename"), "NanoVDB file \"{}\": it has no grid \"{}\"", path.string(),
         p.string("temperaturename"));
  for (const NanoVdbGrid* grid : {grids.density.get(), grids.temperature.get()}) {
    if (!grid) continue;
    grids.bounds.add(grid->bounds().min);
    grids.bounds.add(grid->bounds().max);
  }
  const Vec3 size = grids.bounds.max - grids.bounds.min;
  const double reach = double(std::max(largest_coordinate(grids.bounds.min), largest_coordinate(grids.bounds.max)));
  // Warns if the spacing of floats exceeds 1/4096 of the grid's size.
  if (constexpr double kVisible = 1. / 4096;
      reach > kFar && float_spacing(reach) > kVisible * double(largest_coordinate(size)))
    p.warn("filename",
           fmt::format("its grid lies up to {:.3g} units from the origin, where coordinates in 32-bit floats "
                       "have steps of {:g}: write it near the origin, and place it by Translate",
                       reach, float_spacing(reach)));
  return grids;
}

/// Density and temperature of a NanoVDB file.
class NanoVdb final : public Medium {
 public:
  NanoVdb(const Params& p, const Transform& world_from_medium)
      : grids_(read_grids(p)),
        box_(grids_.bounds, world_from_medium),
        null_collisions_(grids_.bounds, world_from_medium, p.where()),
        coefficients_(p),
        phase_(Phase::henyey_greenstein(float(p.real("g")))),
        temperature_(p),
        emission_scale_(float(p.real("Lescale"))) {
    grids_.density->for_each([this](const Vec3& low, const Vec3& high, float density) {
      check_stop();  // a large tile raises all cells
      majorants_.raise_bound(box_.local_to_unit(low), box_.local_to_unit(high), density);
    });
  }

  /// Looks up both grids in medium space, where the file's own map applies.
  MediumPoint properties(const Vec3& p, const SampledWavelengths& lambda) const override {
    const Vec3 local = box_.world_to_local(p);
    const float density = grids_.density->at(local);
    MediumPoint point{coefficients_.sigma_a(lambda) * density, coefficients_.sigma_s(lambda) * density, {}, phase_};
    if (is_emissive())
      point.emission = point.sigma_a * temperature_.emission(grids_.temperature->at(local), lambda) * emission_scale_;
    return point;
  }
  /// Majorants of a 64^3 grid over the box of both grids.
  MajorantSteps majorants(const Ray& ray, const SampledWavelengths& lambda) const override {
    return box_.steps(ray, &majorants_, coefficients_.sigma_t(lambda));
  }
  bool is_emissive() const override { return grids_.temperature && emission_scale_ > 0; }
  void check(const WavelengthStrategy& wavelengths) const override { null_collisions_.check(*this, wavelengths); }

 private:
  Grids grids_;
  MediumBox box_;
  NullCollisionCheck null_collisions_;
  Coefficients coefficients_;
  Phase phase_;
  Temperature temperature_;
  float emission_scale_;
  MajorantGrid majorants_{kNanoVdbMajorantCells};
};

}  // namespace

extern const MediumInfo nanovdb_medium{{"medium", "nanovdb", "Medium of a NanoVDB file.", "pbrt-v4", kNanoVdb},
                                       make_medium<NanoVdb>};

}  // namespace frond
