# cpack: one Debian package with program, library, header, data and docs (docs/how-to/package.md says why one).
set(CDEM_MAINTAINER "cdem maintainers <maintainers@users.noreply.h-seed-7ce9458a.example>" CACHE STRING "maintainer of the package")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cdem)
set(CPACK_PACKAGE_CONTACT "${CDEM_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "finite-element stiffness as springs, and models of rock and soil that break")
set(CPACK_PACKAGE_DESCRIPTION
"Turns the stiffness of any finite-element mesh into the equivalent springs of
every pair of nodes and proves that they are the same body; runs continuum-
discontinuum models (CDEM) of blocks that deform, interfaces that crack and
pieces that touch and slide; runs granular models (DEM) of discs, spheres and
grains that deform, alone or inside a continuum (bridging scale); and scales
cases exactly.
.
The program is cdem, the library libcdem (C and C++).")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "paraview")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# What Debian wants beside it, and a plain installation does not: the component `debian`.
set(debian ${CMAKE_BINARY_DIR}/debian)
string(TIMESTAMP CDEM_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(cmake/debian/changelog.in ${debian}/changelog.Debian @ONLY)
configure_file(cmake/debian/copyright ${debian}/copyright COPYONLY)
configure_file(cmake/debian/lintian-overrides ${debian}/overrides/cdem COPYONLY)
file(WRITE ${debian}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${debian}/triggers)
add_custom_command(OUTPUT ${debian}/changelog.gz ${debian}/changelog.Debian.gz
  COMMAND sh -c "gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md >changelog.gz && gzip -9nc changelog.Debian >changelog.Debian.gz"
  WORKING_DIRECTORY ${debian} DEPENDS CHANGELOG.md ${debian}/changelog.Debian VERBATIM)
add_custom_target(debian_files ALL DEPENDS ${debian}/changelog.gz)
install(FILES ${debian}/copyright ${debian}/changelog.gz ${debian}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES ${debian}/overrides/cdem DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT plain)
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};cdem;Unspecified;/;${CMAKE_BINARY_DIR};cdem;debian;/")
include(CPack)
