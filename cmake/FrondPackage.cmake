# Debian packages: frond, which runs, and libfrond-dev, which programs and plug-ins are built with. `cpack -G DEB` after a
# build of the preset deb; scripts/package does both and tries them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME frond)
set(CPACK_PACKAGE_VENDOR "The frond developers")
set(CPACK_PACKAGE_CONTACT "The frond developers <developers@frond.invalid>")
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGING_INSTALL_PREFIX "${CMAKE_INSTALL_PREFIX}")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME frond)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_CURRENT_BINARY_DIR}")  # libfrond itself
# What dpkg knows of the libraries; CPack's own list would have the library for AVX2 as a second one of the same name.
set(soname_version "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/shlibs" "libfrond ${soname_version} frond (= ${PROJECT_VERSION})
libfrond_image ${soname_version} frond (= ${PROJECT_VERSION})\n")
file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/triggers" "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_BINARY_DIR}/shlibs;${CMAKE_CURRENT_BINARY_DIR}/triggers")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "librsvg2-2, fonts-dejavu-core")  # charts as .png
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "Renders scenes of pbrt-v4's format, and leaves in them by models of their
tissue: a random walk of light, its solution, and simpler ones. Measures
spectra, BRDF and BTDF of materials, BRF and absorbed light of canopies.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libfrond-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# Its headers show fmt's.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "frond (= ${PROJECT_VERSION}), libfmt-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "What programs that render with frond, and plug-ins for it, are built with.")

# Debian's own: what may be done with a package.
install(FILES cmake/debian/copyright DESTINATION share/doc/frond COMPONENT runtime EXCLUDE_FROM_ALL)
install(FILES cmake/debian/copyright DESTINATION share/doc/libfrond-dev COMPONENT development EXCLUDE_FROM_ALL)

include(CPack)
