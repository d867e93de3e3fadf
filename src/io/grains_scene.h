/* Grains for other programs.
 *
 * A scene is what stands where, and, where a solver is at hand, how grains push each other. One
 * format = one file grains_NAME.c with a cdem_grain_format + one line in grains_formats.c.
 *
 * Laws of contact go where the other program has the same law (docs/formats.md). What has none
 * there, and walls, bonds, confinements and the memory of contacts, is not in the file; `lost` says
 * so in one line.
 */
#ifndef CDEM_IO_GRAINS_SCENE_H
#define CDEM_IO_GRAINS_SCENE_H

#include "dem/dem.h"

#include <stdio.h>

typedef struct {
  cdem_grains grains; /* places and motion now; all arrays. Borrowed, as everything here */
  int materials;
  const cdem_grain_material *material; /* [materials] names and densities */
  double thickness;                    /* of discs, m */
  const cdem_dem *dem;                 /* where laws and the step come from; NULL: not known */
} cdem_scene;

typedef struct {
  const char *name;    /* "lammps" */
  const char *endings; /* parted by spaces */
  const char *help;
  bool masses; /* grains need a density there */
  cdem_status (*write)(const char *path, const cdem_scene *scene, const char *lost,
                       cdem_fault *fault);
  /* What of a scene's laws the program has: NULL, or what is missing ("its dashpots"). */
  const char *(*lacks)(const cdem_scene *scene);
} cdem_grain_format;

const cdem_grain_format *cdem_grain_format_at(int index);        /* NULL past the last */
const cdem_grain_format *cdem_grain_format_of(const char *path); /* by its ending; NULL: none */

/* Writes by the ending of the path. lost [256]: what the file lacks, "" for nothing. CDEM_INPUT: an
 * ending of no format, grains that cannot be, a cell that the program cannot have. */
cdem_status cdem_write_scene(const char *path, const cdem_scene *scene, char lost[256],
                             cdem_fault *fault);

/* ---- private to the formats ---- */

extern const cdem_grain_format cdem_grain_format_lammps, cdem_grain_format_yade;

/* Numbers of the contact of materials a and b. Dashpots c + z sqrt(m k) of the normal and the shear
 * motion, m the reduced mass, k the normal stiffness (hertz: 2 E* sqrt(R d)). */
typedef struct {
  double normal, shear; /* linear: N/m; hertz: 2 E* and 8 G*, Pa */
  double friction, constant[2], critical[2];
  bool rescaled; /* hertz: the shear force shrinks with the area */
} cdem_scene_contact;
void cdem_scene_contact_of(const cdem_scene *scene, int a, int b, cdem_scene_contact *contact);

/* Is the law of the scene the one of this name? */
bool cdem_scene_has_law(const cdem_scene *scene, const char *name);
/* Any dashpot between grains? */
bool cdem_scene_has_dashpots(const cdem_scene *scene);
static inline bool cdem_scene_is_driven(const cdem_scene *scene, int64_t grain) {
  return scene->grains.motion[grain] == CDEM_GRAIN_DRIVEN;
}
/* kg */
double cdem_scene_mass(const cdem_scene *scene, int64_t grain);
/* A name between two `quote` (0: none), with a backslash before these; control characters are '?'.
 */
void cdem_scene_put_name(FILE *stream, const char *name, char quote);
/* "# grains for PROGRAM ..." and what the file lacks. */
void cdem_scene_put_head(const cdem_scene *scene, const char *program, const char *lost,
                         FILE *stream);

#endif
