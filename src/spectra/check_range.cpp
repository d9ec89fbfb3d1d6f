#include "spectra/check_range.h"

namespace frond {
namespace {

bool reaches(Interval data_nm, Interval needed_nm) {
  return data_nm.contains(needed_nm.min) && data_nm.contains(needed_nm.max);
}

/// Throws the error; `advice` is the end of its message.
[[noreturn]] void reject(Interval data_nm, Interval needed_nm, const Location& where, std::string_view what,
                         std::string_view advice) {
  if (needed_nm.min == needed_nm.max)
    fail(where, "\"{}\" is known from {:g} to {:g} nm, {} nm was asked for{}", what, data_nm.min, data_nm.max,
         needed_nm.min, advice);
  fail(where, "\"{}\" is known from {:g} to {:g} nm, the render needs {} to {} nm{}", what, data_nm.min, data_nm.max,
       needed_nm.min, needed_nm.max, advice);
}

}  // namespace

void check_range(Interval data_nm, const WavelengthStrategy& wavelengths, const Location& where,
                 std::string_view what) {
  const Interval needed_nm = wavelengths.range_nm();
  if (!reaches(data_nm, needed_nm)) reject(data_nm, needed_nm, where, what, "");
}

void check_light_range(const Spectrum& emission, const WavelengthStrategy& wavelengths, const Location& where,
                       std::string_view what) {
  const Interval needed_nm = wavelengths.range_nm();
  if (reaches(emission.range_nm(), needed_nm)) return;
  reject(emission.range_nm(), needed_nm, where, what,
         fmt::format("; what reaches further: \"blackbody {0}\" 5800, \"spectrum {0}\" \"stdillum-E\" or an .spd file",
                     what));
}

}  // namespace frond
