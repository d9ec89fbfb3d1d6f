// Headers that most sources of the library include: compiled once (FROND_PRECOMPILED_HEADERS). Sources include what
// they need themselves: builds without it (preset debug) find out where one does not.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>
#include <ranges>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <unordered_map>
#include <variant>
#include <vector>

#include "core/camera.h"
#include "core/integrator.h"
#include "core/light.h"
#include "core/material.h"
#include "core/world.h"
