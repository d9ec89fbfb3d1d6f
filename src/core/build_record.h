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

/// Of this shared object's own section, which the linker bounds. Null where no header has left anything in it.
extern "C" {
[[gnu::weak, gnu::visibility("hidden")]] extern const char __start_frond_headers[];
[[gnu::weak, gnu::visibility("hidden")]] extern const char __stop_frond_headers[];
}

namespace frond {

/// What a shared object was compiled from. The contracts are C++: two sides understand each other if they were compiled
/// from the same headers and with the same standard library. Each header of `frond::plugin`, and each that is
/// installed, leaves "PATH HASH" in the section `frond_headers` of what includes it (cmake/FrondHeaders.cmake).
struct BuildRecord {
  const char* standard_library = FROND_STANDARD_LIBRARY;
  const char* headers = __start_frond_headers;
  const char* headers_end = __stop_frond_headers;
};

}  // namespace frond
