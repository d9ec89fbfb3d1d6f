#include <algorithm>
#include <filesystem>
#include <vector>

#include "exports/mitsuba/materials.h"
#include "spectra/check_range.h"
#include "system/file_bytes.h"
#include "system/tensor_file.h"

namespace frond::mitsuba {
namespace {

using Field = TensorFile::Field;

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Returns the spectra, [slice][wavelength][texel], at other wavelengths, [slice][color][texel], as frond interpolates
/// them.
std::vector<float> at_wavelengths(const std::vector<float>& spectra, const std::vector<float>& known_nm,
                                  const std::vector<double>& nm, size_t texels) {
  std::vector<float> values;
  const size_t slices = spectra.size() / known_nm.size() / texels;
  values.reserve(slices * nm.size() * texels);
  for (size_t slice = 0; slice < slices; ++slice)
    for (const double at : nm) {
      size_t below = 0;
      while (below + 2 < known_nm.size() && double(known_nm[below + 1]) <= at) ++below;
      const size_t above = std::min(below + 1, known_nm.size() - 1);
      const double step = double(known_nm[above]) - double(known_nm[below]);
      const auto t = float(step > 0 ? (at - double(known_nm[below])) / step : 0);
      const float* a = &spectra[(slice * known_nm.size() + below) * texels];
      const float* b = &spectra[(slice * known_nm.size() + above) * texels];
      for (size_t i = 0; i < texels; ++i) values.push_back((1 - t) * a[i] + t * b[i]);
    }
  return values;
}

}  // namespace

/// Rgb variants read a field "rgb" instead of "spectra", and require a description and a flag, which frond does not
/// read. Mitsuba's BSDF is black from behind; "twosided" makes it the same on both sides, as frond's is.
bool write_measured(Context& context, Xml& xml, const Materials::Source& source) {
  const Params& p = source.p;
  const std::filesystem::path path = p.file("filename");
  const Location where = p.where("filename");
  std::string content = read_file_bytes(path, where, "measured BSDF");
  const auto stand_in = [&](const std::string& why) {
    return context.report_unsupported("materials", where, why, kStandIn) && write_stand_in(context, xml, source);
  };
  if (!is_tensor_file(content))
    return stand_in(
        "a table of a goniometer has no equivalent in Mitsuba, tensor files have; --swap replaces the material");
  const bool is_rgb = context.spectra.variants() == Variants::rgb;
  if (context.spectra.variants() == Variants::mono)
    return stand_in("Mitsuba's measured BSDF is not for mono variants: give three wavelengths or more, or none");
  const TensorFile file(std::move(content), path.string(), where);
  const Field &phi = file.floats("phi_i", 1), &spectra = file.floats("spectra", 5);
  if (phi.count > 2)
    return stand_in("an anisotropic measurement is not exported: Mitsuba turns its back around the normal differently");
  const std::vector<float> nm = file.numbers(file.floats("wavelengths", 1));
  check_range({double(nm.front()), double(nm.back())}, context.spectra.strategy(), where, "filename");

  const Field& luminance = file.floats("luminance", 4);
  const size_t side = spectra.shape[4];
  if (spectra.shape[3] != side || luminance.shape[2] != side || luminance.shape[3] != side)
    return stand_in("Mitsuba needs square grids of one size for \"luminance\" and \"spectra\" of a measured file");
  const std::vector<uint8_t> one{1};
  std::vector<Field> fields{{"description", TensorFile::kUint8, {1}, 1, bytes_of(one)},
                            {"jacobian", TensorFile::kUint8, {1}, 1, bytes_of(one)},
                            phi,
                            file.floats("theta_i", 1),
                            file.floats("ndf", 2),
                            file.floats("sigma", 2),
                            file.floats("vndf", 4),
                            luminance};
  std::vector<float> rgb;
  if (is_rgb) {
    const std::vector<double>& wanted_nm = context.spectra.wavelengths_nm();
    rgb = at_wavelengths(file.numbers(spectra), nm, wanted_nm, side * side);
    fields.push_back({"rgb",
                      TensorFile::kFloat32,
                      {spectra.shape[0], spectra.shape[1], wanted_nm.size(), side, side},
                      rgb.size(),
                      bytes_of(rgb)});
  } else {
    fields.push_back(file.floats("wavelengths", 1));
    fields.push_back(spectra);
  }
  const std::string out = tensor_file_of(fields);
  const Element both(xml, "bsdf", {{"type", "twosided"}, {"id", source.id}});
  const Element bsdf(xml, "bsdf", {{"type", "measured"}});
  xml.text("filename", context.folder.add("measured", path.stem().string(), "bsdf",
                                          {reinterpret_cast<const unsigned char*>(out.data()), out.size()}));
  return false;
}

}  // namespace frond::mitsuba
