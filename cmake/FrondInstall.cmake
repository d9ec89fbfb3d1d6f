include(CMakePackageConfigHelpers)

# Two components: what runs, and what other programs and plug-ins are built with (cmake/FrondPackage.cmake). A wheel has one of
# its own (python/CMakeLists.txt), and the files of share.
set(frond_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/frond")

install(TARGETS frond RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT runtime)
install(TARGETS libfrond frond_plugin EXPORT frond
        LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT runtime NAMELINK_COMPONENT development)
# One of an earlier installation would be loaded in place of this one.
install(CODE "file(REMOVE_RECURSE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/${frond_hwcaps_dir}\")"
        COMPONENT runtime)
if(FROND_INSTRUCTIONS STREQUAL both)
  install(TARGETS libfrond_v3 LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/${frond_hwcaps_dir}" COMPONENT runtime
          NAMELINK_SKIP)
endif()
install(TARGETS frond_image_codec LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT runtime)
install(TARGETS frond_model_reader RUNTIME DESTINATION "${CMAKE_INSTALL_LIBDIR}/frond" COMPONENT runtime)

set(frond_share_component runtime)
if(SKBUILD)
  set(frond_share_component python)
endif()
install(FILES LICENSE NOTICE CHANGELOG.md DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT ${frond_share_component})
# Licences of figures that the libraries and scenes contain.
install(FILES LICENSES/BSD-3-Clause.txt LICENSES/MIT.txt LICENSES/LicenseRef-EC-reuse.txt
        DESTINATION "${CMAKE_INSTALL_DOCDIR}/LICENSES" COMPONENT ${frond_share_component})
install(DIRECTORY "${frond_manual_dir}/man1" DESTINATION "${CMAKE_INSTALL_MANDIR}" COMPONENT ${frond_share_component})
install(FILES "${frond_manual_dir}/frond" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions"
        COMPONENT ${frond_share_component})
install(FILES "${frond_manual_dir}/frond.fish" DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d"
        COMPONENT ${frond_share_component})
set(frond_zsh_folder site-functions)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(frond_zsh_folder vendor-completions)  # Debian's, for packages
endif()
install(FILES "${frond_manual_dir}/_frond" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/${frond_zsh_folder}"
        COMPONENT ${frond_share_component})
# The scenes of the repository; canopy/make generates the tables of leaves that the canopy scenes name.
install(DIRECTORY scenes DESTINATION "${CMAKE_INSTALL_DATADIR}/frond" COMPONENT ${frond_share_component}
        USE_SOURCE_PERMISSIONS PATTERN ".gitignore" EXCLUDE PATTERN "*.md" EXCLUDE PATTERN "image.*" EXCLUDE PATTERN "generator" EXCLUDE
        REGEX "scenes/canopy/[^/]*[.]npy$" EXCLUDE)

install(EXPORT frond NAMESPACE frond:: DESTINATION "${frond_package_dir}" COMPONENT development)
# Removes headers of an earlier installation, which the compiler would find.
install(CODE "file(REMOVE_RECURSE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/frond\")"
        COMPONENT development)
install(DIRECTORY "${frond_headers}/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/frond" COMPONENT development
        FILES_MATCHING PATTERN "*.h")
configure_package_config_file(cmake/frondConfig.cmake.in "${CMAKE_CURRENT_BINARY_DIR}/frondConfig.cmake"
                              INSTALL_DESTINATION "${frond_package_dir}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/frondConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/frondConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/frondConfigVersion.cmake"
              cmake/FrondFmt.cmake DESTINATION "${frond_package_dir}" COMPONENT development)
# find_package on the build folder (-Dfrond_DIR=...) finds the library there.
export(EXPORT frond NAMESPACE frond:: FILE "${CMAKE_CURRENT_BINARY_DIR}/frond.cmake")
file(COPY cmake/FrondFmt.cmake DESTINATION "${CMAKE_CURRENT_BINARY_DIR}")
