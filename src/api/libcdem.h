/* libcdem: the library of cdem, for programs of others. One header, installed as <libcdem.h>.
 *
 * Springs of a dense block or of a mesh, runs of case files, scaled cases, packings of grains:
 * what the program `cdem` does, without its command line. docs/reference/library.md explains each
 * function and says what may change when; examples/cube.c and examples/strength.c are whole
 * programs.
 *
 * Handles are made by ..._create (or _read, _box), given back by ..._destroy, which sets the
 * variable to NULL and may be called with NULL in it. Functions that can fail return a status and
 * write one message into a fault that the caller owns (NULL: nobody reads it); outputs are then as
 * they were before.
 *
 * Everything is SI. Arrays are row-major. Results do not depend on the number of threads.
 *
 * Nothing is printed, no file is written but those that are named, and no signal is touched.
 * Functions that read files, start runs or scale cases are for one thread at a time in a process:
 * gmsh and UDUNITS-2, which they use, know no threads. They use many threads themselves
 * (OMP_NUM_THREADS). They also switch GSL's error handler off, which would end the process.
 */
#ifndef LIBCDEM_H
#define LIBCDEM_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- what happened ---- */

/* The values are the exit codes of the program. */
typedef enum {
  LIBCDEM_OK = 0,
  LIBCDEM_USAGE = 2,        /* the function was called wrongly */
  LIBCDEM_INPUT = 3,        /* a file or a number cannot be */
  LIBCDEM_NUMERIC = 4,      /* no solution, no rest, jammed */
  LIBCDEM_MEMORY = 5,       /* there is not enough */
  LIBCDEM_FILE = 6,         /* cannot be read or written */
  LIBCDEM_INTERRUPTED = 130 /* a listener or a visitor answered false */
} libcdem_status;

/* `libcdem_fault fault = {0};` (C++: `= {}`). */
typedef struct {
  libcdem_status status;
  char message[1024]; /* one line, or several of which the first is the error */
} libcdem_fault;

/* "bad input". */
const char *libcdem_status_text(libcdem_status status);

/* Whoever listens to long work; NULL in place of a listener or of a function: nobody does. */
typedef struct {
  void *context;
  /* what: the work in a few words; done of total units (total 0: unknown). Called from one thread
   * at a time, not always the caller's; answers true to go on, false to stop cleanly. */
  bool (*progress)(void *context, const char *what, int64_t done, int64_t total);
  /* Anything worth knowing that is no failure. */
  void (*warn)(void *context, const char *message);
} libcdem_listener;

/* ---- which library this is ---- */

/* "1.0.0". */
const char *libcdem_version(void);
/* "22d8d69", with "-dirty" behind it where files differed from the commit, or "unknown". */
const char *libcdem_commit(void);
/* Compiler and what was chosen at the build, in one line. */
const char *libcdem_build(void);

/* ---- the springs of one block ---- */

/* The spring tensor S of a pair of nodes (force on i is S (u_j - u_i), so S = -K_ij) as springs:
 *
 *     S = sum over terms of dir (x) (stiffness * dual + coupling * dual[couples_to])
 */
typedef enum {
  LIBCDEM_DIAGONAL, /* two or three springs, no coupling */
  LIBCDEM_JORDAN2,  /* two of them coupled one way */
  LIBCDEM_JORDAN3,  /* all three coupled one way */
  LIBCDEM_COMPLEX,  /* two of them coupled both ways */
  LIBCDEM_FRAME     /* four springs that need no duals: one along a line, three around it */
} libcdem_form;

typedef struct {
  double stiffness, coupling; /* N/m */
  double dir[3], dual[3];     /* 2 x 2: the third is 0 */
  int32_t spring;             /* which spring, from 1 */
  int32_t couples_to;         /* which other, from 1; 0: none */
} libcdem_term;

typedef struct {
  libcdem_form form;
  int32_t size;  /* 2 or 3 */
  int32_t terms; /* 2 to 4 */
  double cond;   /* condition number of the directions; NaN for frames */
  libcdem_term term[4];
} libcdem_springs;

/* "diagonal", "jordan2", ...; "" for a value that is none. */
const char *libcdem_form_name(libcdem_form form);
/* block: S [size][size]. frame: may a transversely isotropic block become a frame? */
libcdem_status libcdem_springs_of_block(int size, const double *block, bool frame,
                                        libcdem_springs *springs, libcdem_fault *fault);
/* The sum above: block [size][size], the same to 1e-12 of its norm. */
void libcdem_springs_rebuild(const libcdem_springs *springs, double *block);

/* ---- meshes ---- */

typedef struct libcdem_mesh libcdem_mesh;

/* .msh .geo .step .stp .stl .inp, by file ending. */
libcdem_status libcdem_mesh_read(const char *path, const libcdem_listener *listener,
                                 libcdem_mesh **mesh, libcdem_fault *fault);
/* A box from the origin to size [3] (m) of count [3] bricks (count[2] = 0: a plane one) of cells of
 * this shape: "tri3" "quad4" "tri6" "quad8" "tet4" "tet10" "pyr5" "wedge6" "hex8" "hex20". */
libcdem_status libcdem_mesh_box(const char *shape, const int32_t *count, const double *size,
                                libcdem_mesh **mesh, libcdem_fault *fault);
/* An empty mesh, to be filled by the three below. */
libcdem_status libcdem_mesh_create(libcdem_mesh **mesh, libcdem_fault *fault);
/* xyz [nodes][3], m. Nodes are counted from 0 in the order of adding; their tags begin with 1. */
libcdem_status libcdem_mesh_add_nodes(libcdem_mesh *mesh, int64_t nodes, const double *xyz,
                                      libcdem_fault *fault);
/* node [cells][nodes of the shape], corners first and then mid nodes, in gmsh's order. Cells are
 * counted and get tags as nodes do. */
libcdem_status libcdem_mesh_add_cells(libcdem_mesh *mesh, const char *shape, int64_t cells,
                                      const int32_t *node, libcdem_fault *fault);
/* A named group of cells of one dimension, for material files. */
libcdem_status libcdem_mesh_add_group(libcdem_mesh *mesh, const char *name, int64_t cells,
                                      const int32_t *cell, libcdem_fault *fault);
int64_t libcdem_mesh_nodes(const libcdem_mesh *mesh);
int64_t libcdem_mesh_cells(const libcdem_mesh *mesh);
void libcdem_mesh_destroy(libcdem_mesh **mesh);

/* ---- the springs of a mesh ---- */

typedef struct libcdem_model libcdem_model;

typedef enum {
  LIBCDEM_EDGE, /* the smallest thing of the element that holds both nodes is an edge */
  LIBCDEM_FACE, /* ... a face */
  LIBCDEM_BODY  /* ... the element itself */
} libcdem_class;

/* One pair of nodes of one element. The library hands it out by pointer; later releases may add
 * members at the end. */
typedef struct {
  int64_t element, node[2]; /* tags of the mesh */
  int32_t place[2];         /* of the nodes in the element, from 0 */
  libcdem_class kind;
  double block[9]; /* S [size][size], N/m */
  libcdem_springs springs;
} libcdem_pair;

/* Largest errors of the network against the finite-element body, relative; NaN: does not apply.
 * Handed out like a pair. */
typedef struct {
  bool holds; /* are all within their bounds? */
  int64_t elements, pairs, springs;
  double rebuild;                  /* blocks from springs */
  double translation;              /* a moved body stays at rest */
  double rotation;                 /* a turned body stays at rest */
  double assembled;                /* the whole matrix against B^T D B */
  double patch;                    /* uniform strain leaves inner nodes at rest */
  int64_t rigid_modes, zero_modes; /* expected and counted; -1: too large to be counted */
} libcdem_certificate;

/* "edge", "face", "body"; "" for a value that is none. */
const char *libcdem_class_name(libcdem_class kind);
/* All cells of the highest dimension of a mesh, which is kept by the caller for as long as the
 * model lives and not changed. */
libcdem_status libcdem_model_create(const libcdem_mesh *mesh, libcdem_model **model,
                                    libcdem_fault *fault);
/* One material everywhere: kind and order of parameters as `cdem list materials` shows them,
 * "isotropic" {young, poisson}; optional ones at the end may be left out. */
libcdem_status libcdem_model_material(libcdem_model *model, const char *kind, int parameters,
                                      const double *parameter, libcdem_fault *fault);
/* Materials of groups, from a material file. */
libcdem_status libcdem_model_read_materials(libcdem_model *model, const char *path,
                                            libcdem_fault *fault);
/* Of a 2-D body; else it is 1 m thick and in plane strain. */
libcdem_status libcdem_model_plane(libcdem_model *model, bool stress, double thickness,
                                   libcdem_fault *fault);
/* Calls visit for every pair, in the order of the cells, from one thread at a time; it answers true
 * to go on. */
libcdem_status libcdem_model_visit(libcdem_model *model,
                                   bool (*visit)(void *context, const libcdem_pair *pair),
                                   void *context, const libcdem_listener *listener,
                                   libcdem_fault *fault);
/* .csv .h5 .vtp .vtu .mtx .inp, by file ending. */
libcdem_status libcdem_model_write(libcdem_model *model, const char *path,
                                   const libcdem_listener *listener, libcdem_fault *fault);
/* *certificate is good until the model is used again. LIBCDEM_OK also when it does not hold. */
libcdem_status libcdem_model_certify(libcdem_model *model, const libcdem_listener *listener,
                                     const libcdem_certificate **certificate, libcdem_fault *fault);
void libcdem_model_destroy(libcdem_model **model);

/* ---- runs ---- */

typedef struct libcdem_run libcdem_run;

typedef enum {
  LIBCDEM_RUN_THREADS, /* 0: as many as the size of the problem is worth (the default) */
  LIBCDEM_RUN_FRAMES,  /* 1: write frames (the default); 0: do not */
  LIBCDEM_RUN_FIGURES  /* 1: draw figures, by gnuplot (the default); 0: do not */
} libcdem_run_choice;

/* A key result of the case. Handed out like a pair. */
typedef struct {
  const char *name, *unit;
  double value;      /* NaN: there is none */
  double reference;  /* NaN: none was given */
  double difference; /* relative; from a reference of 0 absolute */
} libcdem_result;

/* path: of the case (.yaml); NULL where only libcdem_run_resume is called. */
libcdem_status libcdem_run_create(const char *path, libcdem_run **run, libcdem_fault *fault);
/* Replaces a value of the case, as --set does: "interfaces[0].tension=2 MPa". */
libcdem_status libcdem_run_set(libcdem_run *run, const char *assignment, libcdem_fault *fault);
libcdem_status libcdem_run_choose(libcdem_run *run, libcdem_run_choice choice, int value,
                                  libcdem_fault *fault);
/* Reads and builds everything, runs nothing. */
libcdem_status libcdem_run_check(libcdem_run *run, const libcdem_listener *listener,
                                 libcdem_fault *fault);
/* Runs the case into a folder, as `cdem run CASE -o FOLDER` does. Stopped by the listener it leaves
 * a checkpoint. */
libcdem_status libcdem_run_start(libcdem_run *run, const char *folder,
                                 const libcdem_listener *listener, libcdem_fault *fault);
/* Goes on from the checkpoint of a folder, to the same bits; the case is that of the folder. */
libcdem_status libcdem_run_resume(libcdem_run *run, const char *folder,
                                  const libcdem_listener *listener, libcdem_fault *fault);
/* Key results of the last run that ended well; 0 where none did. */
int64_t libcdem_run_results(const libcdem_run *run);
/* Those that are off by more than the case's tolerance. */
int64_t libcdem_run_failed(const libcdem_run *run);
/* By number from 0, or by name; NULL: there is none. Good until the run starts again. */
const libcdem_result *libcdem_run_result(const libcdem_run *run, int64_t index);
const libcdem_result *libcdem_run_find(const libcdem_run *run, const char *name);
void libcdem_run_destroy(libcdem_run **run);

/* ---- scaled cases ---- */

/* Writes the case exactly scaled by these ratios of length, time and mass; (h, h, h^3) keeps
 * density and stress. */
libcdem_status libcdem_case_scale(const char *path, const double *ratio, const char *output,
                                  const libcdem_listener *listener, libcdem_fault *fault);
/* Writes the case with grains h times as large, and the parameters that belong to them, in the same
 * domain. */
libcdem_status libcdem_case_coarsen(const char *path, double h, const char *output,
                                    const libcdem_listener *listener, libcdem_fault *fault);

/* ---- packings ---- */

typedef struct libcdem_packing libcdem_packing;

/* kind: "square", "hexagonal", "cubic", "inward", "loose"; in the box from low to high
 * [dimension], m; dimension 2 or 3. */
libcdem_status libcdem_packing_create(const char *kind, int dimension, const double *low,
                                      const double *high, libcdem_packing **packing,
                                      libcdem_fault *fault);
/* One of the numbers listed in docs/reference/library.md: ("radius", 0.01). */
libcdem_status libcdem_packing_set(libcdem_packing *packing, const char *name, double value,
                                   libcdem_fault *fault);
/* Puts the grains in place; what was there goes. */
libcdem_status libcdem_packing_make(libcdem_packing *packing, const libcdem_listener *listener,
                                    libcdem_fault *fault);
/* How many there are; 0 before they are made. */
int64_t libcdem_packing_grains(const libcdem_packing *packing);
/* [grains][3] and [grains], m; good until the packing is made again. NULL before. */
const double *libcdem_packing_centres(const libcdem_packing *packing);
const double *libcdem_packing_radii(const libcdem_packing *packing);
/* The box, which is smaller after pressing: low, high [3]. */
void libcdem_packing_box(const libcdem_packing *packing, double *low, double *high);
/* .csv (what a case's grains.file reads) or .vtp. */
libcdem_status libcdem_packing_write(const libcdem_packing *packing, const char *path,
                                     libcdem_fault *fault);
void libcdem_packing_destroy(libcdem_packing **packing);

#ifdef __cplusplus
}
#endif

#endif
