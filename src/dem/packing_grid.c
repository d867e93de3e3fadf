#include "dem/packing_grid.h"

#include <stdlib.h>

/* Cells of one class may be this many times the grains that are expected: more costs memory and
 * saves nothing. */
enum { CELLS_PER_GRAIN = 4, LEAST_CELLS = 4096 };

static bool set_level(cdem_packing_grid *grid, cdem_packing_level *level, double radius,
                      double most_cells) {
  double cells = 1.0;
  level->radius = radius;
  for (int c = 0; c < 3; c++) {
    double count = c < grid->grains->dim ? fmax(1.0, floor(grid->length[c] / (2.0 * radius))) : 1.0;
    cells *= count;
    if (cells > most_cells)
      return false;
    level->cell[c] = (int64_t)count;
    level->edge[c] = grid->length[c] / count;
  }
  return true;
}

cdem_status cdem_packing_grid_init(cdem_packing_grid *grid, const cdem_grains *grains,
                                   const double low[3], const double high[3],
                                   const bool periodic[3], const double sizes[2], int64_t expected,
                                   cdem_fault *fault) {
  double most_cells = fmax((double)(CELLS_PER_GRAIN * expected), LEAST_CELLS), radius = sizes[1];
  *grid = (cdem_packing_grid){.grains = grains};
  for (int c = 0; c < 3; c++) {
    grid->low[c] = low[c];
    grid->length[c] = high[c] - low[c];
    grid->periodic[c] = c < grains->dim && periodic[c];
  }
  /* The first class always gets cells, larger ones where the room is empty but for a few grains. */
  while (!set_level(grid, &grid->level[0], radius, most_cells))
    radius *= 2.0;
  radius = sizes[1];
  grid->level[0].radius = radius;
  for (grid->levels = 1; grid->levels < CDEM_GRID_LEVELS && 0.5 * radius > sizes[0];
       grid->levels++) {
    radius *= 0.5;
    if (!set_level(grid, &grid->level[grid->levels], radius, most_cells))
      break;
  }
  for (int l = 0; l < grid->levels; l++) {
    cdem_packing_level *level = &grid->level[l];
    int64_t cells = level->cell[0] * level->cell[1] * level->cell[2];
    level->first = cdem_allocate(cells, sizeof *level->first, fault);
    if (level->first == NULL) {
      cdem_packing_grid_release(grid);
      return CDEM_MEMORY;
    }
    for (int64_t i = 0; i < cells; i++)
      level->first[i] = -1;
  }
  return CDEM_OK;
}

void cdem_packing_grid_release(cdem_packing_grid *grid) {
  for (int l = 0; l < CDEM_GRID_LEVELS; l++)
    free(grid->level[l].first);
  free(grid->next);
  *grid = (cdem_packing_grid){0};
}

static int64_t cell_along(const cdem_packing_grid *grid, const cdem_packing_level *level, int c,
                          double x) {
  double at = floor((x - grid->low[c]) / level->edge[c]);
  double last = (double)(level->cell[c] - 1);
  /* Beyond a free face the outermost cell; the same for questions, so nobody is missed. */
  return (int64_t)(grid->periodic[c] ? at : fmin(fmax(at, 0.0), last));
}

/* Cell number and shift of the image, for indices that may lie beyond periodic faces. */
static inline int64_t cell_number(const cdem_packing_grid *grid, const cdem_packing_level *level,
                                  const int64_t index[3], double shift[3]) {
  int64_t in[3];
  for (int c = 0; c < 3; c++) {
    int64_t n = level->cell[c], turns = 0;
    if (index[c] < 0)
      turns = -((n - 1 - index[c]) / n);
    else if (index[c] >= n)
      turns = index[c] / n;
    in[c] = index[c] - turns * n;
    shift[c] = (double)turns * grid->length[c];
  }
  return in[0] + level->cell[0] * (in[1] + level->cell[1] * in[2]);
}

static int32_t *head_of(const cdem_packing_grid *grid, int64_t grain, int *class_) {
  int l = 0;
  while (l + 1 < grid->levels && grid->grains->radius[grain] <= grid->level[l + 1].radius)
    l++;
  const cdem_packing_level *level = &grid->level[l];
  int64_t index[3];
  double shift[3];
  for (int c = 0; c < 3; c++)
    index[c] = cell_along(grid, level, c, grid->grains->xyz[3 * grain + c]);
  *class_ = l;
  return &level->first[cell_number(grid, level, index, shift)];
}

cdem_status cdem_packing_grid_add(cdem_packing_grid *grid, int64_t grain, cdem_fault *fault) {
  int l;
  CDEM_TRY(cdem_grow(&grid->next, &grid->capacity, grain + 1, sizeof *grid->next, fault));
  int32_t *head = head_of(grid, grain, &l);
  grid->next[grain] = *head;
  *head = (int32_t)grain;
  grid->level[l].grains++;
  return CDEM_OK;
}

void cdem_packing_grid_remove(cdem_packing_grid *grid, int64_t grain) {
  int l;
  int32_t *at = head_of(grid, grain, &l);
  while (*at != (int32_t)grain)
    at = &grid->next[*at];
  *at = grid->next[grain];
  grid->level[l].grains--;
}

/* A walk through the cells of one class that a sphere of this reach meets. */
typedef struct {
  int64_t from[3], to[3], at[3];
} cell_walk;

static bool begin(const cdem_packing_grid *grid, const cdem_packing_level *level,
                  const double place[3], double reach, cell_walk *walk) {
  double all = reach + level->radius;
  for (int c = 0; c < 3; c++) {
    bool flat = c >= grid->grains->dim;
    walk->from[c] = flat ? 0 : cell_along(grid, level, c, place[c] - all);
    walk->to[c] = flat ? 0 : cell_along(grid, level, c, place[c] + all);
    walk->at[c] = walk->from[c];
  }
  return level->grains > 0;
}

static inline bool advance(cell_walk *walk) {
  for (int c = 0; c < 3; c++) {
    if (++walk->at[c] <= walk->to[c])
      return true;
    walk->at[c] = walk->from[c];
  }
  return false;
}

bool cdem_packing_grid_is_free(const cdem_packing_grid *grid, const double place[3],
                               double radius) {
  const double *xyz = grid->grains->xyz, *radii = grid->grains->radius;
  for (int l = 0; l < grid->levels; l++) {
    const cdem_packing_level *level = &grid->level[l];
    cell_walk walk;
    if (!begin(grid, level, place, radius, &walk))
      continue;
    do {
      double shift[3];
      for (int32_t j = level->first[cell_number(grid, level, walk.at, shift)]; j >= 0;
           j = grid->next[j]) {
        double x = xyz[3 * j] + shift[0] - place[0], y = xyz[3 * j + 1] + shift[1] - place[1];
        double z = xyz[3 * j + 2] + shift[2] - place[2], touch = radius + radii[j];
        if (x * x + y * y + z * z < touch * touch)
          return false;
      }
    } while (advance(&walk));
  }
  return true;
}

cdem_status cdem_packing_grid_near(const cdem_packing_grid *grid, const double place[3],
                                   double reach, cdem_packing_list *list, cdem_fault *fault) {
  const double *xyz = grid->grains->xyz, *radii = grid->grains->radius;
  list->count = 0;
  for (int l = 0; l < grid->levels; l++) {
    const cdem_packing_level *level = &grid->level[l];
    cell_walk walk;
    if (!begin(grid, level, place, reach, &walk))
      continue;
    do {
      double shift[3];
      for (int32_t j = level->first[cell_number(grid, level, walk.at, shift)]; j >= 0;
           j = grid->next[j]) {
        cdem_packing_near near = {.radius = radii[j], .grain = j};
        double square = 0.0, most = reach + radii[j];
        for (int c = 0; c < 3; c++) {
          near.place[c] = xyz[3 * j + c] + shift[c];
          square += (near.place[c] - place[c]) * (near.place[c] - place[c]);
        }
        if (!(square < most * most))
          continue;
        CDEM_TRY(cdem_grow(&list->near, &list->capacity, list->count + 1, sizeof near, fault));
        list->near[list->count++] = near;
      }
    } while (advance(&walk));
  }
  return CDEM_OK;
}
