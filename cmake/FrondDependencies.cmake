# Packages, each with the care that Debian's need.

find_package(PkgConfig REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(ZLIB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(benchmark QUIET)
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()

# In Debian 12 and 13 OpenColorIO's CMake config is broken, and OpenImageIO's wants its tools and Qt: not so pkg-config's.
pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO)
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)
pkg_check_modules(EXR REQUIRED IMPORTED_TARGET OpenEXR)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)

include("${CMAKE_CURRENT_LIST_DIR}/FrondFmt.cmake")
foreach(library oiio ocio exr zstd embree)
  add_library(frond_${library} INTERFACE IMPORTED GLOBAL)
endforeach()
target_link_libraries(frond_oiio INTERFACE PkgConfig::OIIO)
target_link_libraries(frond_ocio INTERFACE PkgConfig::OCIO)
target_link_libraries(frond_exr INTERFACE PkgConfig::EXR)
target_link_libraries(frond_zstd INTERFACE PkgConfig::ZSTD)
target_link_libraries(frond_embree INTERFACE embree)
target_compile_definitions(frond_embree INTERFACE FROND_EMBREE_MAJOR=${embree_VERSION_MAJOR})
