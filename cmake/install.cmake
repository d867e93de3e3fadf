# cmake --install: program, library with its one header, pkg-config and CMake package files, man pages, completion, data,
# docs and examples. All of it can be moved: nothing knows the prefix.
include(CMakePackageConfigHelpers)
install(TARGETS cdem EXPORT cdemTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS cdem_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES src/api/libcdem.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT cdemTargets NAMESPACE cdem:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cdem)
configure_package_config_file(cmake/cdemConfig.cmake.in ${CMAKE_BINARY_DIR}/cdemConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cdem)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/cdemConfigVersion.cmake COMPATIBILITY SameMajorVersion)
file(RELATIVE_PATH CDEM_PC_UP /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" CDEM_PC_UP ${CDEM_PC_UP})
configure_file(cmake/cdem.pc.in ${CMAKE_BINARY_DIR}/cdem.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/cdemConfig.cmake ${CMAKE_BINARY_DIR}/cdemConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cdem)
install(FILES ${CMAKE_BINARY_DIR}/cdem.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/cdem)
install(FILES cmake/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME cdem)
include(cmake/man.cmake)
include(cmake/package.cmake)
