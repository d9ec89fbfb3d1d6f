#include "study/compare/report/machine.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <fstream>
#include <thread>

namespace frond::compare {
namespace {

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (const size_t colon = line.find(": "); line.starts_with("model name") && colon != std::string::npos)
      return line.substr(colon + 2);
  return "unknown processor";
}

}  // namespace

std::string machine_description() {
  utsname system{};
  uname(&system);
  return fmt::format("{}, {} threads, {} {} {}", processor(), std::thread::hardware_concurrency(), system.sysname,
                     system.release, system.machine);
}

}  // namespace frond::compare
