# Packages, each with the care that Debian's need. Imported here and, for static linking, by the installed package.

find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(fmt REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()

# In Debian 12 and 13 OpenColorIO's CMake config is broken, and OpenImageIO's wants its tools and Qt: not so pkg-config's.
pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO)
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)

if(NOT TARGET frond_fmt)
  add_library(frond_fmt INTERFACE IMPORTED GLOBAL)
  target_link_libraries(frond_fmt INTERFACE fmt::fmt)
  # OpenImageIO's headers switch fmt's exceptions off for the whole program unless this is set everywhere.
  target_compile_definitions(frond_fmt INTERFACE FMT_EXCEPTIONS=1)
  # Programs that never read an image must not load OpenImageIO: it costs 150 ms and 124 MB at start.
  target_link_options(frond_fmt INTERFACE "LINKER:--as-needed")

  add_library(frond_oiio INTERFACE IMPORTED GLOBAL)
  target_link_libraries(frond_oiio INTERFACE PkgConfig::OIIO)
  add_library(frond_ocio INTERFACE IMPORTED GLOBAL)
  target_link_libraries(frond_ocio INTERFACE PkgConfig::OCIO)
  add_library(frond_embree INTERFACE IMPORTED GLOBAL)
  target_link_libraries(frond_embree INTERFACE embree)
  target_compile_definitions(frond_embree INTERFACE FROND_EMBREE_MAJOR=${embree_VERSION_MAJOR})
endif()
