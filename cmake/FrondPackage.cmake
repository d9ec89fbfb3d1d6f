# Debian packages: frond, which runs, and libfrond-dev, which programs and plug-ins are built with. `cpack -G DEB` after a
# build of the preset deb; scripts/package does both and tries them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME frond)
set(CPACK_PACKAGE_VENDOR "The frond developers")
set(CPACK_PACKAGE_CONTACT "The frond developers <developers@frond.invalid>")
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
# Revision by the Debian release of the build: 1~deb12u1.
cmake_host_system_information(RESULT distribution QUERY DISTRIB_INFO)
string(REPLACE debian deb CPACK_DEBIAN_PACKAGE_RELEASE "1~${distribution_ID}${distribution_VERSION_ID}u1")
set(frond_deb_version "${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")
set(CPACK_PACKAGING_INSTALL_PREFIX "${CMAKE_INSTALL_PREFIX}")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME frond)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_CURRENT_BINARY_DIR}")  # libfrond itself
# Shared libraries for dpkg; CPack's own list would contain the library for AVX2 as a second library of the same name.
set(soname_version "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/shlibs" "libfrond ${soname_version} frond (= ${frond_deb_version})
libfrond_image ${soname_version} frond (= ${frond_deb_version})\n")
file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/triggers" "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_BINARY_DIR}/shlibs;${CMAKE_CURRENT_BINARY_DIR}/triggers")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "librsvg2-2, fonts-dejavu-core")  # charts as .png
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "Renders scenes of pbrt-v4's format, and leaves in them by models of their
tissue: a random walk of light, its solution, and simpler ones. Measures
spectra, BRDF and BTDF of materials, BRF and absorbed light of canopies.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libfrond-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# Its headers show fmt's.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "frond (= ${frond_deb_version}), libfmt-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "What programs that render with frond, and plug-ins for it, are built with.")

# Debian's own: what may be done with a package, and its changelog, of the date in CHANGELOG.md, or of today before a release.
set(debian_files cmake/debian/copyright)
file(STRINGS CHANGELOG.md changelog_date REGEX "^## ${PROJECT_VERSION}, [0-9-]+$")
string(REGEX REPLACE ".*, " "" changelog_date "${changelog_date}")
execute_process(COMMAND date --utc --rfc-email "--date=${changelog_date}" OUTPUT_VARIABLE changelog_date OUTPUT_STRIP_TRAILING_WHITESPACE)
if(FROND_GZIP)
  set(changelog "${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian")
  file(WRITE "${changelog}" "frond (${frond_deb_version}) ${distribution_VERSION_CODENAME}; urgency=medium

  * Version ${PROJECT_VERSION}: see CHANGELOG.md in /usr/share/doc/frond.

 -- ${CPACK_PACKAGE_CONTACT}  ${changelog_date}\n")
  execute_process(COMMAND "${FROND_GZIP}" -9nf "${changelog}" COMMAND_ERROR_IS_FATAL ANY)
  list(APPEND debian_files "${changelog}.gz")
endif()
install(FILES ${debian_files} DESTINATION share/doc/frond COMPONENT runtime EXCLUDE_FROM_ALL)
install(FILES ${debian_files} DESTINATION share/doc/libfrond-dev COMPONENT development EXCLUDE_FROM_ALL)

include(CPack)
