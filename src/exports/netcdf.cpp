#include "exports/table.h"

#ifdef FROND_NETCDF_FILE
#include <netcdf.h>
#include <netcdf_mem.h>

#include <cstdlib>
#include <memory>

#include "system/shared_object.h"
#endif

namespace frond {
namespace {

#ifdef FROND_NETCDF_FILE

/// The NetCDF library, loaded on first use, because it loads further libraries that no other command needs.
struct NetCdf {
  SharedObject library{FROND_NETCDF_FILE, "the NetCDF library", SharedObject::Binding::lazy};

  template <class Function>
  Function* find(const char* name) const {
    Function* function = library.find<Function>(name);
    if (!function) fail({}, "the NetCDF library \"{}\" has no function {}", FROND_NETCDF_FILE, name);
    return function;
  }
  decltype(::nc_strerror)* strerror = find<decltype(::nc_strerror)>("nc_strerror");
  decltype(::nc_create_mem)* create_mem = find<decltype(::nc_create_mem)>("nc_create_mem");
  decltype(::nc_def_dim)* def_dim = find<decltype(::nc_def_dim)>("nc_def_dim");
  decltype(::nc_def_var)* def_var = find<decltype(::nc_def_var)>("nc_def_var");
  decltype(::nc_put_att_text)* put_att_text = find<decltype(::nc_put_att_text)>("nc_put_att_text");
  decltype(::nc_put_att_schar)* put_att_schar = find<decltype(::nc_put_att_schar)>("nc_put_att_schar");
  decltype(::nc_enddef)* enddef = find<decltype(::nc_enddef)>("nc_enddef");
  decltype(::nc_put_var_double)* put_var_double = find<decltype(::nc_put_var_double)>("nc_put_var_double");
  decltype(::nc_put_var_float)* put_var_float = find<decltype(::nc_put_var_float)>("nc_put_var_float");
  decltype(::nc_put_var_schar)* put_var_schar = find<decltype(::nc_put_var_schar)>("nc_put_var_schar");
  decltype(::nc_close_memio)* close_memio = find<decltype(::nc_close_memio)>("nc_close_memio");
  decltype(::nc_abort)* abort = find<decltype(::nc_abort)>("nc_abort");
};

/// A classic NetCDF file, created in memory.
class NetCdfFile {
 public:
  NetCdfFile() { check(nc_.create_mem("frond", NC_CLOBBER, kFirstBytes, &id_)); }
  ~NetCdfFile() {
    if (id_ >= 0) nc_.abort(id_);
  }
  NetCdfFile(const NetCdfFile&) = delete;
  NetCdfFile& operator=(const NetCdfFile&) = delete;

  /// Defines a dimension.
  int dimension(const Quantity& q, size_t length) {
    int id;
    check(nc_.def_dim(id_, name(q).c_str(), length, &id));
    return id;
  }
  /// Defines a variable with its unit and documentation.
  int variable(const Quantity& q, nc_type type, const std::vector<int>& dimensions) {
    int id;
    check(nc_.def_var(id_, name(q).c_str(), type, int(dimensions.size()), dimensions.data(), &id));
    attribute(id, "long_name", q.doc);
    if (!q.unit.empty()) attribute(id, "units", q.unit);
    return id;
  }
  void attribute(int variable, const char* key, std::string_view text) {
    check(nc_.put_att_text(id_, variable, key, text.size(), text.data()));
  }
  /// Defines a variable of words by the CF conventions: flag_values and flag_meanings.
  void flags(int variable, std::span<const std::string_view> words) {
    std::string meanings;
    for (const std::string_view word : words) (meanings += meanings.empty() ? "" : " ") += word;
    const auto values = index_values(words.size());
    check(nc_.put_att_schar(id_, variable, "flag_values", NC_BYTE, values.size(), values.data()));
    attribute(variable, "flag_meanings", meanings);
  }
  void end_of_header() { check(nc_.enddef(id_)); }
  void put(int variable, const std::vector<double>& v) { check(nc_.put_var_double(id_, variable, v.data())); }
  void put(int variable, const std::vector<float>& v) { check(nc_.put_var_float(id_, variable, v.data())); }
  void put_index_values(int variable, size_t count) {
    check(nc_.put_var_schar(id_, variable, index_values(count).data()));
  }

  std::string finish() {
    NC_memio memory{};
    const int status = nc_.close_memio(id_, &memory);
    id_ = -1;
    const std::unique_ptr<void, decltype(&std::free)> bytes(memory.memory, &std::free);
    check(status);
    return {static_cast<const char*>(memory.memory), memory.size};
  }

 private:
  static constexpr size_t kFirstBytes = 1;  // initial size; unused bytes would remain in the file

  static std::string name(const Quantity& q) { return std::string(q.name); }
  static std::vector<signed char> index_values(size_t count) {
    std::vector<signed char> values;
    for (size_t i = 0; i < count; ++i) values.push_back(static_cast<signed char>(i));
    return values;
  }
  /// Throws InputError with the library's message.
  void check(int status) const {
    if (status != NC_NOERR) fail({}, "NetCDF: {}", nc_.strerror(status));
  }

  NetCdf nc_;
  int id_ = -1;
};

void check_netcdf(const ExportRequest& request) {
  check_table(request);
  const NetCdf library;
}

/// Variables follow the CF conventions, so that common tools label the axes.
std::string netcdf_file(const ExportMaterial& material, const ExportRequest& request) {
  const BsdfTable t = make_table(material, request);
  NetCdfFile file;
  const std::vector<int> axes{file.dimension(kWavelength, t.wavelengths_nm.size()),
                              file.dimension(kSide, BsdfTable::kSides.size()),
                              file.dimension(kThetaI, t.theta_i_deg.size()),
                              file.dimension(kThetaO, t.theta_o_deg.size()),
                              file.dimension(kPhiO, t.phi_o_deg.size()),
                              file.dimension(kKind, BsdfTable::kKinds.size())};
  const int wavelength = file.variable(kWavelength, NC_DOUBLE, {axes[0]});
  const int side = file.variable(kSide, NC_BYTE, {axes[1]});
  const int theta_i = file.variable(kThetaI, NC_DOUBLE, {axes[2]});
  const int theta_o = file.variable(kThetaO, NC_DOUBLE, {axes[3]});
  const int phi_o = file.variable(kPhiO, NC_DOUBLE, {axes[4]});
  const int kind = file.variable(kKind, NC_BYTE, {axes[5]});
  const std::vector<int> of_light(axes.begin(), axes.begin() + 3);
  const int reflectance = file.variable(kReflectance, NC_DOUBLE, of_light);
  const int transmittance = file.variable(kTransmittance, NC_DOUBLE, of_light);
  const int f = file.variable(kF, NC_FLOAT, axes);
  file.attribute(wavelength, "standard_name", "radiation_wavelength");
  file.flags(side, BsdfTable::kSides);
  file.flags(kind, BsdfTable::kKinds);
  file.attribute(NC_GLOBAL, "Conventions", "CF-1.8");
  file.attribute(NC_GLOBAL, "title", "Bidirectional scattering distribution function of " + material.label);
  file.attribute(NC_GLOBAL, "source", "frond " FROND_VERSION " export");
  file.attribute(NC_GLOBAL, "material", material.label);
  file.end_of_header();
  file.put(wavelength, t.wavelengths_nm);
  file.put(theta_i, t.theta_i_deg);
  file.put(theta_o, t.theta_o_deg);
  file.put(phi_o, t.phi_o_deg);
  file.put_index_values(side, BsdfTable::kSides.size());
  file.put_index_values(kind, BsdfTable::kKinds.size());
  file.put(reflectance, t.reflectance);
  file.put(transmittance, t.transmittance);
  file.put(f, t.f);
  return file.finish();
}

#else

void check_netcdf(const ExportRequest&) {
  fail({}, "format netcdf: this frond was built without the NetCDF library (Debian's libnetcdf-dev)");
}

std::string netcdf_file(const ExportMaterial&, const ExportRequest& request) {
  check_netcdf(request);
  return {};
}

#endif

}  // namespace

extern const ExportFormat netcdf_format{
    "netcdf", "the same table as a classic NetCDF file", false, kTableOptions, check_netcdf, netcdf_file};

}  // namespace frond
