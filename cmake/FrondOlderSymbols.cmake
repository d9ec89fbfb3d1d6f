# frond_older_symbols(TARGET): links a library of the wheel so that it needs glibc 2.34 and libstdc++ of GCC 11, those of RHEL 9, where it
# would need those of Debian 12 for a few symbols (older_symbols.cpp).
function(frond_older_symbols target)
  if(CMAKE_LIBRARY_ARCHITECTURE STREQUAL "x86_64-linux-gnu")
    target_sources(${target} PRIVATE "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/older_symbols.cpp")
    target_link_options(${target} PRIVATE LINKER:--wrap=hypot,--wrap=hypotf
                        LINKER:--wrap=_ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE)
  endif()
endfunction()
