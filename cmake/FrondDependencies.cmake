# Packages, each with the care that Debian's need. Imported here and, for static linking, by the installed package.

find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(fmt REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenImageIO REQUIRED)
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()

# OpenImageIO's target names include directories that Debian does not have, and CMake stops at those.
get_target_property(frond_oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
if(frond_oiio_includes)
  set(frond_oiio_existing "")
  foreach(dir IN LISTS frond_oiio_includes)
    if(EXISTS "${dir}")
      list(APPEND frond_oiio_existing "${dir}")
    endif()
  endforeach()
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${frond_oiio_existing}")
endif()

# OpenColorIO's CMake config is broken in Debian 12 and 13: its pkg-config file is not.
pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO)

if(NOT TARGET frond_fmt)
  add_library(frond_fmt INTERFACE IMPORTED GLOBAL)
  target_link_libraries(frond_fmt INTERFACE fmt::fmt)
  # OpenImageIO's headers switch fmt's exceptions off for the whole program unless this is set everywhere.
  target_compile_definitions(frond_fmt INTERFACE FMT_EXCEPTIONS=1)
  # Programs that never read an image must not load OpenImageIO: it costs 150 ms and 124 MB at start.
  target_link_options(frond_fmt INTERFACE "LINKER:--as-needed")

  add_library(frond_oiio INTERFACE IMPORTED GLOBAL)
  target_link_libraries(frond_oiio INTERFACE OpenImageIO::OpenImageIO)
  add_library(frond_ocio INTERFACE IMPORTED GLOBAL)
  target_link_libraries(frond_ocio INTERFACE PkgConfig::OCIO)
  add_library(frond_embree INTERFACE IMPORTED GLOBAL)
  target_link_libraries(frond_embree INTERFACE embree)
  target_compile_definitions(frond_embree INTERFACE FROND_EMBREE_MAJOR=${embree_VERSION_MAJOR})
endif()
