#pragma once

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/error.h"

/// Fuzz targets: a target passes bytes to one of frond's file readers and checks what the reader returns. Compiled with
/// FROND_FUZZ, each is a program of libFuzzer; else all are functions of the program fuzz_replay.
namespace frond::fuzz {

using Target = void (*)(std::string_view bytes);

/// Targets of this program by name.
inline std::map<std::string_view, Target>& targets() {
  static std::map<std::string_view, Target> all;
  return all;
}
struct Registered {
  Registered(std::string_view name, Target target) { targets()[name] = target; }
};

/// Throws if an invariant does not hold. Only InputError is expected from a target: libFuzzer reports all other
/// exceptions with the stack of their origin.
inline void require(bool holds, const std::string& invariant) {
  if (!holds) throw std::logic_error("violated: " + invariant);
}

/// Calls `act`. Returns false if it throws InputError, which must have a message.
template <class Act>
bool accepts(const Act& act) {
  try {
    act();
    return true;
  } catch (const InputError& error) {
    require(!std::string_view(error.what()).empty(), "an error has a message");
    return false;
  }
}

template <class Values>
void require_finite(const Values& values, const char* what) {
  for (const auto value : values) require(std::isfinite(value), std::string(what) + " is finite");
}

/// Folder in memory for the files of this process, initially empty and deleted at its end. It becomes the working
/// directory, so that no file name in an input is found elsewhere.
class Folder {
 public:
  Folder() : path_("/dev/shm/frond_fuzz_" + std::to_string(::getpid())) {
    std::filesystem::create_directories(path_);
    std::filesystem::current_path(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::current_path("/", ignored);
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path path = path_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  void clear() const {
    for (const auto& entry : std::filesystem::directory_iterator(path_)) std::filesystem::remove_all(entry.path());
  }

 private:
  std::filesystem::path path_;
};

inline const Folder& folder() {
  static const Folder the_folder;
  return the_folder;
}

/// Takes the bytes up to the first NUL, which separates parts of an input.
inline std::string_view take_part(std::string_view& bytes) {
  const std::string_view part = bytes.substr(0, bytes.find('\0'));
  bytes.remove_prefix(std::min(part.size() + 1, bytes.size()));
  return part;
}

}  // namespace frond::fuzz

// FROND_FUZZ_TARGET(name, bytes) { ... }: defines a target.
#ifdef FROND_FUZZ
#define FROND_FUZZ_ENTRY(name)                                              \
  extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) { \
    target_##name({reinterpret_cast<const char*>(data), size});             \
    return 0;                                                               \
  }
#else
#define FROND_FUZZ_ENTRY(name) static const frond::fuzz::Registered registered_##name(#name, target_##name);
#endif
#define FROND_FUZZ_TARGET(name, bytes)               \
  static void target_##name(std::string_view bytes); \
  FROND_FUZZ_ENTRY(name)                             \
  static void target_##name(std::string_view bytes)
