include(CMakePackageConfigHelpers)

set(frond_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/frond")

install(TARGETS frond RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
install(TARGETS libfrond frond_plugin EXPORT frond LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}")
# One of an earlier installation would be loaded in place of this one.
install(CODE "file(REMOVE_RECURSE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/${frond_hwcaps_dir}\")")
if(FROND_X86_64_V3)
  install(TARGETS libfrond_v3 LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/${frond_hwcaps_dir}" NAMELINK_SKIP)
endif()
install(TARGETS frond_image_codec LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(EXPORT frond NAMESPACE frond:: DESTINATION "${frond_package_dir}")
foreach(layer IN LISTS frond_layers)
  install(DIRECTORY "src/${layer}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/frond" FILES_MATCHING PATTERN "*.h")
endforeach()
install(FILES LICENSE NOTICE DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(FILES "${frond_generated}/core/build_identity.h" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/frond/core")
configure_package_config_file(cmake/frondConfig.cmake.in "${CMAKE_CURRENT_BINARY_DIR}/frondConfig.cmake"
                              INSTALL_DESTINATION "${frond_package_dir}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/frondConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/frondConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/frondConfigVersion.cmake"
              cmake/FrondFmt.cmake DESTINATION "${frond_package_dir}")
