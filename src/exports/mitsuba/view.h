#pragma once

#include "core/film.h"
#include "exports/mitsuba/context.h"

namespace frond::mitsuba {

/// Writes the integrator, and the sensor with film, filter and sampler. `samples`: per pixel. Throws InputError for
/// what Mitsuba has no equivalent of.
void write_view(Context& context, Xml& xml, const FilmSettings& film, int samples);

}  // namespace frond::mitsuba
