#pragma once

#if !defined(_GLIBCXX_RELEASE)
#define FROND_STANDARD_LIBRARY "another standard library than libstdc++"
#elif defined(_GLIBCXX_DEBUG)
#define FROND_STANDARD_LIBRARY "libstdc++ in debug mode"
#elif !_GLIBCXX_USE_CXX11_ABI
#define FROND_STANDARD_LIBRARY "libstdc++ with the strings of C++03"
#else
#define FROND_STANDARD_LIBRARY "libstdc++"
#endif

/// Begin and end of the section `frond_headers` of this shared object, defined by the linker; null if it is empty.
extern "C" {
[[gnu::weak, gnu::visibility("hidden")]] extern const char __start_frond_headers[];
[[gnu::weak, gnu::visibility("hidden")]] extern const char __stop_frond_headers[];
}

namespace frond {

/// Headers and standard library that a shared object was compiled with. Interfaces are C++ classes: a plug-in is binary
/// compatible only with a frond compiled with the same headers and the same standard library. Each header of
/// `frond::plugin`, and each installed header, adds its path and a hash of its code to the section `frond_headers` of a
/// shared object that includes it (cmake/FrondHeaders.cmake).
struct BuildRecord {
  const char* standard_library = FROND_STANDARD_LIBRARY;
  const char* headers = __start_frond_headers;
  const char* headers_end = __stop_frond_headers;
};

}  // namespace frond
