#pragma once

#include <gtest/gtest.h>

#include "core/stop.h"

namespace frond::test {

/// Expects `act`, called after a stop has been requested, to end with Stopped.
template <class Act>
void expect_stopped(const Act& act) {
  std::stop_source source;
  source.request_stop();
  const StopScope stop(source.get_token());
  EXPECT_THROW(act(), Stopped);
}

}  // namespace frond::test
