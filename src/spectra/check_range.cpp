#include "spectra/check_range.h"

namespace frond {

void check_range(Interval data_nm, const WavelengthStrategy& wavelengths, const Location& where,
                 std::string_view what) {
  const Interval needed_nm = wavelengths.range_nm();
  if (data_nm.contains(needed_nm.min) && data_nm.contains(needed_nm.max)) return;
  if (needed_nm.min == needed_nm.max)
    fail(where, "\"{}\" is known from {} to {} nm, {} nm was asked for", what, data_nm.min, data_nm.max, needed_nm.min);
  fail(where, "\"{}\" is known from {} to {} nm, the render needs {} to {} nm", what, data_nm.min, data_nm.max,
       needed_nm.min, needed_nm.max);
}

}  // namespace frond
