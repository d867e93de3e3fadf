/* Room io: the only room that opens files.
 *
 * Output is atomic: every writer works on a temporary file beside the target and renames it at the
 * end, so that a full disk, an error or Ctrl-C leaves no partial file under the final name (targets
 * that are not regular files, such as /dev/full or a pipe, are written straight). Numbers are
 * written with 17 significant digits in the C locale whatever the process's locale is.
 */
#ifndef CDEM_IO_IO_H
#define CDEM_IO_IO_H

#include "base/base.h"
#include "elements/elements.h"
#include "mesh/mesh.h"
#include "network/network.h"
#include "results/results.h"

#include <stdio.h>

/* ---- meshes in (mesh_gmsh.c, mesh_inp.c) ---- */

/* Anything the program prints about what it read: a callback, because the library never prints. */
typedef struct {
  void *context;
  void (*warn)(void *context, const char *message);
} cdem_warnings;

/* Reads .msh (2.2 and 4.1, text and binary; 4.0 through gmsh), .geo .step .stp (gmsh meshes them in
 * their highest dimension), .stl (text and binary; through gmsh, equal corners become one node) and
 * .inp (Abaqus, CalculiX), by file ending. The mesh has passed
 * cdem_mesh_check. CDEM_FILE: cannot be opened. CDEM_INPUT: cannot be understood. */
cdem_status cdem_read_mesh(const char *path, cdem_mesh *mesh, const cdem_warnings *warnings,
                           cdem_fault *fault);

/* The same with numbers for a .geo file: name [parameters] are declared there by
 * `DefineConstant[ h = 0.1 ];` (with or without attributes), and value [parameters] replace the
 * declared ones. CDEM_INPUT: a name that the file does not declare (the message lists those it
 * does), parameters for any other format. */
cdem_status cdem_read_mesh_with(const char *path, int parameters, const char *const *name,
                                const double *value, cdem_mesh *mesh, const cdem_warnings *warnings,
                                cdem_fault *fault);

/* ---- material files in (material_file.c) ---- */

/* A material file: one material at top level, or `materials:` by name, `groups:` group -> material,
 * `default:`. */
typedef struct {
  int materials;
  cdem_material *material; /* [materials] */
  int assignments;
  char **group;         /* [assignments] */
  int *material_of;     /* [assignments] */
  int default_material; /* -1: none */
} cdem_material_file;

/* Errors carry file:line:column, a caret line and "did you mean". */
cdem_status cdem_read_materials(const char *path, cdem_material_file *file, cdem_fault *fault);
void cdem_material_file_release(cdem_material_file *file);

/* "40 GPa" -> 4e10 by UDUNITS-2; a plain number is SI. CDEM_INPUT for a wrong dimension or unit. */
cdem_status cdem_parse_quantity(const char *text, cdem_dimension dimension, double *value,
                                cdem_fault *fault);

/* ---- atomic output (output.c) ---- */

typedef struct cdem_output cdem_output;
/* "-" is standard output. */
cdem_status cdem_output_open(const char *path, cdem_output **output, cdem_fault *fault);
/* The stream to write to. */
FILE *cdem_output_stream(cdem_output *output);
/* Path of the temporary file, for libraries that open files themselves (HDF5). */
const char *cdem_output_path(const cdem_output *output);
cdem_status cdem_output_write(cdem_output *output, const void *data, size_t bytes,
                              cdem_fault *fault);
/* Flushes, closes, renames; on failure the temporary file is gone. *output is NULL afterwards. */
cdem_status cdem_output_commit(cdem_output **output, cdem_fault *fault);
/* Drops everything written; safe on NULL and after commit. */
void cdem_output_discard(cdem_output **output);
/* A whole text as a file: all of it or nothing. */
cdem_status cdem_write_text(const char *path, const char *text, int64_t length, cdem_fault *fault);

/* ---- springs out: one writer a format (springs_csv.c, springs_hdf5.c, springs_vtk.c,
 * springs_mtx.c, springs_inp.c, springs_lammps.c, springs_yade.c) ---- */

typedef struct cdem_springs_writer cdem_springs_writer;
typedef struct {
  const char *name;    /* "csv" */
  const char *endings; /* ".csv" or several parted by spaces */
  const char *help;
  cdem_status (*open)(const char *path, const cdem_model *model, cdem_springs_writer **writer,
                      cdem_fault *fault);
  bool assembled; /* holds the sum over all elements: what is filtered out is missing in it */
} cdem_springs_format;

/* By name or by the ending of a path; NULL when there is none. */
const cdem_springs_format *cdem_springs_format_find(const char *name);
const cdem_springs_format *cdem_springs_format_of(const char *path);
const cdem_springs_format *cdem_springs_format_at(int index); /* NULL past the last */

/* Programs of particles know forces along and across the line of a pair; the tensor of a pair may
 * hold more. */
typedef enum {
  CDEM_CARRY_ALL,    /* as much of each pair as the program can */
  CDEM_CARRY_EXACT,  /* CDEM_INPUT when that is not everything */
  CDEM_CARRY_CENTRAL /* only the springs along the lines */
} cdem_carry;

/* What became of the pairs of the network, each summed over all elements. */
typedef struct {
  int64_t pairs;                /* 0: the format holds whatever there is */
  int64_t along, across, other; /* nothing but a spring along the line; that and one stiffness
                                 * across it; more than these */
  int64_t looped;               /* of the others: carried by a loop in the file */
  int64_t cut;                  /* pairs of which a part is not in the file */
  double lost;                  /* Frobenius norm of what is not in the file, over that of all */
  double worst;                 /* the same of the pair that loses most of its own norm ... */
  int64_t worst_node[2];        /* ... with these tags */
} cdem_carried;

struct cdem_springs_writer {
  cdem_carry carry;     /* set it before commit; formats that hold everything do not look at it */
  cdem_carried carried; /* after commit */
  cdem_pair_sink sink;  /* feed it to cdem_network_convert */
  cdem_status (*commit)(cdem_springs_writer *writer, cdem_fault *fault);
  void (*destroy)(cdem_springs_writer *writer); /* discards what was not committed */
};
/* Destroys and nulls; safe on NULL. */
void cdem_springs_writer_destroy(cdem_springs_writer **writer);

/* ---- tables and checks out (table_file.c) ---- */

cdem_status cdem_write_table_csv(const char *path, const cdem_table *table, cdem_fault *fault);
/* An array of objects, one a row. */
cdem_status cdem_write_table_json(const char *path, const cdem_table *table, cdem_fault *fault);
cdem_status cdem_write_checks_json(FILE *stream, const cdem_check_list *list, cdem_fault *fault);
/* One JSON string with its quotes; one JSON number (null when not finite). */
void cdem_json_text(FILE *stream, const char *text);
void cdem_json_number(FILE *stream, double value);

/* ---- figures out (figure.c) ---- */

/* Draws FOLDER/NAME.png and .svg (the folder is made where it is missing) with gnuplot (child
 * process) and keeps NAME.gp and NAME.dat beside them. CDEM_FILE with the remedy when gnuplot is
 * missing. */
cdem_status cdem_write_figure(const char *folder, const char *name, const cdem_figure *figure,
                              cdem_fault *fault);

#endif
