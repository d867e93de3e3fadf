/* Files of grains.
 *
 * Table (.csv): one row a grain, in the order of ids, under a header `name [unit]`. Columns: x, y
 * and radius; z for spheres (a table without z is of discs); and where they are wanted material (a
 * name), vx, vy, vz, wx, wy, wz (discs: vx, vy, wz) and motion (free, driven). Numbers have 17
 * digits: what is read back has the same bits. In a table that is read columns may come in any
 * order, units may be others of the same kind (`radius [mm]`; none: SI), lines that begin with #
 * are passed over.
 *
 * VTP (.vtp): the same as points with one vertex each, for ParaView (Glyph by `radius`, or Point
 * Gaussian).
 */
#ifndef CDEM_IO_GRAINS_FILE_H
#define CDEM_IO_GRAINS_FILE_H

#include "dem/grains.h"

/* Materials by name: grains->material counts in name [names]. */
typedef struct {
  cdem_grains grains;
  int64_t names;
  char **name; /* in the order of first appearance; none without a column material */
} cdem_grain_table;
void cdem_grain_table_release(cdem_grain_table *table);

/* By the ending of the path: .csv or .vtp ("-": the table to standard output). Arrays that are NULL
 * have no columns; name [names] may be NULL where grains->material is. CDEM_INPUT: another ending,
 * grains that cannot be (cdem_grains_check), a material without a name. */
cdem_status cdem_write_grains(const char *path, const cdem_grains *grains, int64_t names,
                              const char *const *name, cdem_fault *fault);

/* Reads a table. dim: 2 or 3 where it is known (3 needs z; 2 takes a z that is 0), 0: by its
 * columns. CDEM_INPUT names file and line: a column that is missing, double or unknown (with the
 * nearest name), a unit of another kind, a field that is no number, a radius that is not positive,
 * rows of another length, no rows. */
cdem_status cdem_read_grains(const char *path, int dim, cdem_grain_table *table, cdem_fault *fault);

/* Reads classes of sizes: columns radius (a length) and fraction (of the solid), in the form of a
 * table of grains. radius, fraction [classes]: free() both. CDEM_INPUT names file and line. */
cdem_status cdem_read_sizes(const char *path, int *classes, double **radius, double **fraction,
                            cdem_fault *fault);

#endif
