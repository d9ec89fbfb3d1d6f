# Debian's, without its version: OpenImageIO asks for 2.2, Debian 12 has 2.1 (scripts/wheel adapts the four calls).
find_package(PkgConfig REQUIRED)
pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET GLOBAL OpenColorIO)
if(NOT TARGET OpenColorIO::OpenColorIO)
  find_path(OCIO_INCLUDE_DIR OpenColorIO/OpenColorIO.h REQUIRED)
  add_library(OpenColorIO::OpenColorIO INTERFACE IMPORTED GLOBAL)
  set_target_properties(OpenColorIO::OpenColorIO PROPERTIES INTERFACE_LINK_LIBRARIES PkgConfig::OCIO
                        INTERFACE_INCLUDE_DIRECTORIES "${OCIO_INCLUDE_DIR}")
endif()
set(OpenColorIO_FOUND TRUE)
