/* One run of the program: mesh, materials and options, and the same body for the reference. */
#ifndef CDEM_TESTS_CLI_REBUILD_CASE_H
#define CDEM_TESTS_CLI_REBUILD_CASE_H

#include "rebuild_mesh.h"

typedef enum rebuild_material {
  MATERIAL_ISOTROPIC,   /* -E, --nu */
  MATERIAL_ORTHOTROPIC, /* a file, with axes */
  MATERIAL_ANISOTROPIC, /* a file, with axes */
  MATERIAL_COSSERAT,    /* options */
  MATERIAL_COSSERAT_FILE,
  MATERIAL_COSSERAT_CUBIC,
  MATERIAL_RATIOS,  /* a file, isotropic, each box its own Poisson's ratio */
  MATERIAL_BY_GROUP /* a file with three materials */
} rebuild_material;

typedef struct rebuild_case {
  char name[64];
  const char *kinds; /* one for each box, between blanks */
  rebuild_material material;
  bool plane_stress;
  double poisson, couple_factor;
  double length;       /* value of --length; 0: not given */
  const double *ratio; /* Poisson's ratio of each box */
  double amount;       /* of distortion; 0: squares or cubes */
  const char *frame;   /* value of --frame; NULL: not given */
  const char *group;   /* value of --group; NULL: all cells */
  int frames_per_cell; /* pairs of form frame that theory expects */
} rebuild_case;

enum { REBUILD_MAX_OPTIONS = 24 };

/* The body of a case: what the program is told, and what the reference takes. */
typedef struct rebuild_body {
  rebuild_mesh mesh;
  reference_material material[REBUILD_MAX_GROUPS + 1]; /* by a cell's group */
  const char *option[REBUILD_MAX_OPTIONS];
  int options;
  char text[8][64]; /* numbers of the options */
  char material_file[512];
} rebuild_body;

/* Writes FOLDER/NAME.msh, and FOLDER/NAME.yaml where the material is a file. */
void rebuild_body_make(const rebuild_case *c, const char *folder, rebuild_body *body);

bool rebuild_cell_is_taken(const rebuild_case *c, const rebuild_mesh *mesh, int cell);

#endif
