#include "models/model_files.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "imports/file_in.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMegabyte = 1'000'000, kGigabyte = 1'000'000'000, kLargestFile = 4 * kGigabyte;

/// Returns the size of the machine's memory, bytes.
uint64_t machine_memory() { return uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE)); }

/// The soft limit, which this process may raise again; never above the limit that it was started with.
void set_limit(decltype(RLIMIT_AS) what, uint64_t value) {
  rlimit limit{};
  getrlimit(what, &limit);
  limit.rlim_cur = std::min<rlim_t>(value, limit.rlim_max);
  setrlimit(what, &limit);
}

}  // namespace

/// No core dump, and few open files.
ProcessLimits::ProcessLimits() : memory_(kGigabyte), most_memory_(machine_memory()) {
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_NOFILE, 64);
  apply();
}

/// A text of n bytes becomes at most some 100 n bytes of vertices, faces and their copies while they are prepared.
void ProcessLimits::allow_file(uint64_t bytes) {
  memory_ += 128 * bytes;
  seconds_ += 2 * bytes / kMegabyte;
  apply();
}

/// Applies to this process from now on; memory beyond the limit is std::bad_alloc, time beyond it SIGXCPU.
void ProcessLimits::apply() const {
  const uint64_t memory = std::min(memory_, most_memory_);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which reserve terabytes of addresses
  set_limit(RLIMIT_AS, memory);
#endif
  set_limit(RLIMIT_FSIZE, 4 * memory);  // standard output, a file
  set_limit(RLIMIT_CPU, seconds_);
}

ModelFiles::ModelFiles(const fs::path& model, ProcessLimits& limits)
    : folder_(fs::canonical(model).parent_path()), limits_(limits) {}

/// No message: a reader tries several names.
bool ModelFiles::has(const std::string& name) const {
  try {
    return !file_in(folder_, name).empty();
  } catch (const std::runtime_error&) {
    return false;
  }
}

/// The limits grow with each file before it is read.
std::string ModelFiles::content(const std::string& name) {
  const fs::path path = file_in(folder_, name);
  const uint64_t size = fs::file_size(path);
  if (size > kLargestFile) throw std::runtime_error("it is larger than 4 GB");
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw std::runtime_error("\"" + path.filename().string() + "\" cannot be opened");
  if (allowed_.insert(path).second) limits_.allow_file(size);
  std::string bytes(size, '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  return bytes;
}

}  // namespace frond
