#include "version.h"

#include "base/version.h"

#include <cblas.h>
#include <cholmod.h>
#include <gmshc.h>
#include <gsl/gsl_version.h>
#include <hdf5.h>
#include <stdio.h>
#include <yaml.h>
#include <zlib.h>

/* As found when the program starts; gmsh's is that of its header, as the library would have to be
 * set up to be asked. UDUNITS and ARPACK cannot be asked. */
static void print_libraries(void) {
  char openblas[64] = "OpenBLAS";
  unsigned hdf5[3] = {0};
  int cholmod[3] = {0};
  sscanf(openblas_get_config(), "OpenBLAS %63s", openblas);
  H5get_libversion(&hdf5[0], &hdf5[1], &hdf5[2]);
  cholmod_version(cholmod);
  printf("with OpenBLAS %s (%s), GSL %s, gmsh %s, CHOLMOD %d.%d.%d, HDF5 %u.%u.%u, libyaml %s, "
         "zlib %s\n",
         openblas, openblas_get_corename(), gsl_version, GMSH_API_VERSION, cholmod[0], cholmod[1],
         cholmod[2], hdf5[0], hdf5[1], hdf5[2], yaml_get_version_string(), zlibVersion());
}

void version_print(void) {
  printf("cdem %s (%s)\nbuilt by %s\n", cdem_version(), cdem_version_commit(),
         cdem_version_build());
  print_libraries();
  printf(
      "Licence GPL-3.0-or-later: you may change and share this program; there is no warranty.\n");
}
