#pragma once

#include "exports/mitsuba/context.h"

namespace frond::mitsuba {

/// Writes the lights that are not area lights: distant, point, spot and infinite ones. Throws InputError for others.
void write_lights(Context& context, Xml& xml);

}  // namespace frond::mitsuba
