#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cstring>

#include "exports/stored_zip.h"
#include "exports/table.h"

namespace frond {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Returns a file as numpy.save writes it, format version 1.0 (NumPy documentation, numpy.lib.format).
std::string npy(const std::string& type, const std::vector<size_t>& shape, std::string_view data) {
  constexpr size_t kStart = 10, kAlignment = 64;
  const std::string tuple = fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  std::string dict = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, tuple);
  dict += std::string(kAlignment - (kStart + dict.size() + 1) % kAlignment, ' ') + '\n';
  std::string file("\x93NUMPY\x01\x00", 8);
  file += char(dict.size() & 0xff);
  file += char(dict.size() >> 8);
  return file.append(dict).append(data);
}

template <class T>
std::string number_array(const std::vector<size_t>& shape, const std::vector<T>& values) {
  return npy(fmt::format("<f{}", sizeof(T)), shape,
             {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

/// Returns an array of words in UTF-32, padded to the longest, as NumPy stores strings. Bytes above 127 are taken as
/// Latin-1.
std::string string_array(const std::vector<size_t>& shape, std::span<const std::string_view> values) {
  size_t longest = 1;
  for (const std::string_view v : values) longest = std::max(longest, v.size());
  std::string data;
  for (const std::string_view v : values)
    for (size_t i = 0; i < longest; ++i) {
      data += i < v.size() ? v[i] : '\0';
      data.append(3, '\0');
    }
  return npy(fmt::format("<U{}", longest), shape, data);
}

/// Arrays are named as in the CSV columns.
std::string npz_file(const ExportMaterial& material, const ExportRequest& request) {
  const BsdfTable t = make_table(material, request);
  const size_t w = t.wavelengths_nm.size(), i = t.theta_i_deg.size(), o = t.theta_o_deg.size(), p = t.phi_o_deg.size();
  StoredZip zip;
  zip.add("wavelength_nm.npy", number_array({w}, t.wavelengths_nm));
  zip.add("side.npy", string_array({2}, BsdfTable::kSides));
  zip.add("theta_i_deg.npy", number_array({i}, t.theta_i_deg));
  zip.add("theta_o_deg.npy", number_array({o}, t.theta_o_deg));
  zip.add("phi_o_deg.npy", number_array({p}, t.phi_o_deg));
  zip.add("kind.npy", string_array({2}, BsdfTable::kKinds));
  zip.add("R.npy", number_array({w, 2, i}, t.reflectance));
  zip.add("T.npy", number_array({w, 2, i}, t.transmittance));
  zip.add("f_per_sr.npy", number_array({w, 2, i, o, p, 2}, t.f));
  const std::string_view axes[] = {"wavelength_nm", "side", "theta_i_deg", "theta_o_deg", "phi_o_deg", "kind"};
  zip.add("axes.npy", string_array({6}, axes));
  const std::string_view label = material.label, version = "frond " FROND_VERSION;
  zip.add("material.npy", string_array({}, {&label, 1}));
  zip.add("source.npy", string_array({}, {&version, 1}));
  return std::move(zip).finish();
}

}  // namespace

extern const ExportFormat npz_format{"npz",   "the same table for numpy.load", false, kTableOptions, check_table,
                                     npz_file};

}  // namespace frond
