# Debian packages only; nothing is downloaded. ./check and ./demo install what is missing (cmake/packages.txt).
find_package(PkgConfig REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS C)
find_package(Threads REQUIRED)
pkg_check_modules(LAPACKE REQUIRED IMPORTED_TARGET lapacke)
pkg_check_modules(OPENBLAS REQUIRED IMPORTED_TARGET openblas)
pkg_check_modules(GSL REQUIRED IMPORTED_TARGET gsl)
pkg_check_modules(YAML REQUIRED IMPORTED_TARGET yaml-0.1)
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5-serial)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib)
pkg_check_modules(ARPACK REQUIRED IMPORTED_TARGET arpack)

# These three ship no pkg-config file on Debian 12.
function(cdem_find_library target header library)
  find_path(${target}_INCLUDE ${header} PATH_SUFFIXES suitesparse udunits2 REQUIRED)
  find_library(${target}_LIBRARY ${library} REQUIRED)
  add_library(cdem_dep::${target} INTERFACE IMPORTED GLOBAL)
  set_target_properties(cdem_dep::${target} PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${${target}_INCLUDE}" INTERFACE_LINK_LIBRARIES "${${target}_LIBRARY}")
endfunction()
cdem_find_library(gmsh gmshc.h gmsh)
cdem_find_library(cholmod cholmod.h cholmod)
cdem_find_library(udunits2 udunits2.h udunits2)

set(CDEM_LINK_LIBRARIES PkgConfig::LAPACKE PkgConfig::OPENBLAS PkgConfig::GSL PkgConfig::YAML PkgConfig::HDF5
    PkgConfig::ZLIB PkgConfig::ARPACK cdem_dep::gmsh cdem_dep::cholmod cdem_dep::udunits2
    OpenMP::OpenMP_C Threads::Threads m)
