# cmake --install: program, library, headers by room, pkg-config and CMake package files.
include(CMakePackageConfigHelpers)
install(TARGETS cdem EXPORT cdemTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS cdem_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cdem FILES_MATCHING PATTERN "*.h" PATTERN "*.def")
install(EXPORT cdemTargets NAMESPACE cdem:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cdem)
configure_package_config_file(cmake/cdemConfig.cmake.in ${CMAKE_BINARY_DIR}/cdemConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cdem)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/cdemConfigVersion.cmake COMPATIBILITY SameMinorVersion)
configure_file(cmake/cdem.pc.in ${CMAKE_BINARY_DIR}/cdem.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/cdemConfig.cmake ${CMAKE_BINARY_DIR}/cdemConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cdem)
install(FILES ${CMAKE_BINARY_DIR}/cdem.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY data DESTINATION ${CMAKE_INSTALL_DATADIR}/cdem)
