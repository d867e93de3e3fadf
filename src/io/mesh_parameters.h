/* Private to io: numbers of a .geo file that a caller sets.
 *
 * gmsh lets DefineConstant leave alone what has a value already. So a small .geo file that gives
 * the values and merges the geometry is opened in its place. The other ways of gmsh 4.8 are not
 * good enough: ONELAB (gmshOnelabSetNumber) reaches only constants that have the attribute Name,
 * and -setnumber lasts for all later sessions of the process. */
#ifndef CDEM_IO_MESH_PARAMETERS_H
#define CDEM_IO_MESH_PARAMETERS_H

#include "base/base.h"
#include "io/mesh_build.h"

typedef struct {
  int count;
  const char *const *name; /* [count] */
  const double *value;     /* [count] */
} cdem_mesh_parameters;

/* CDEM_INPUT: a name that no DefineConstant of the text declares; the message lists those there
 * are. Files that the text includes are not looked at. */
cdem_status cdem_mesh_parameters_check(const cdem_mesh_parameters *parameters,
                                       const cdem_text *text, cdem_fault *fault);

enum { CDEM_WRAPPER_PATH = 32 };
/* Writes the small file; remove it when it has been read. */
cdem_status cdem_mesh_parameters_wrap(const cdem_mesh_parameters *parameters, const char *path,
                                      char wrapper[CDEM_WRAPPER_PATH], cdem_fault *fault);

#endif
