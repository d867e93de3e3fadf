/* Bonds of a case: all pairs closer than the gap at the start, found by a sweep along x over the
 * grains and their images. */
#include "base/memory.h"
#include "base/sort.h"
#include "run/grains.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A grain, or an image of one, as the sweep meets it. */
typedef struct {
  double low, xyz[3], reach; /* where it begins along x; radius and half of the largest gap */
  int32_t grain;
  bool image;
} passer;

static int by_low(const void *a, const void *b) {
  const passer *p = a, *q = b;
  if (p->low != q->low)
    return p->low < q->low ? -1 : 1;
  return p->grain != q->grain ? (p->grain < q->grain ? -1 : 1) : (int)p->image - (int)q->image;
}

static int by_grains(const void *a, const void *b) {
  const cdem_bond *p = a, *q = b;
  int first = (p->grain[0] > q->grain[0]) - (p->grain[0] < q->grain[0]);
  return first != 0 ? first : (p->grain[1] > q->grain[1]) - (p->grain[1] < q->grain[1]);
}

/* ---- the law of a pair ---- */

/* The first entry that fits both materials; -1: none. */
static int entry_of(const cdem_run_grains *g, int32_t i, int32_t j) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  const char *a = v->grains.materials.item[g->case_material[i]].name,
             *b = v->grains.materials.item[g->case_material[j]].name;
  for (int64_t e = 0; e < v->bonds.count; e++) {
    const cdem_case_texts *between = &v->bonds.item[e].between;
    if (between->count == 0 ||
        (strcmp(between->item[0], a) == 0 && strcmp(between->item[1], b) == 0) ||
        (strcmp(between->item[0], b) == 0 && strcmp(between->item[1], a) == 0))
      return (int)e;
  }
  return -1;
}

static cdem_status try_pair(cdem_run_grains *g, const passer *p, const passer *q,
                            cdem_fault *fault) {
  const double *radius = g->grains.radius;
  int32_t i = p->grain, j = q->grain;
  if (i == j || (p->image && q->image) || entry_of(g, i, j) < 0)
    return CDEM_OK;
  int entry = entry_of(g, i, j);
  double d[3] = {q->xyz[0] - p->xyz[0], q->xyz[1] - p->xyz[1], q->xyz[2] - p->xyz[2]};
  double gap = cdem_run_grains_values(g)->bonds.item[entry].gap * 0.5 * (radius[i] + radius[j]);
  if (cdem_norm3(d) - radius[i] - radius[j] > gap)
    return CDEM_OK;
  CDEM_TRY(cdem_grow(&g->bond, &g->bond_room, g->bonds + 1, sizeof *g->bond, fault));
  g->bond[g->bonds++] = (cdem_bond){{i < j ? i : j, i < j ? j : i}, entry};
  return CDEM_OK;
}

/* ---- grains and images ---- */

static bool is_near(const double low[3], const double high[3], const double at[3], double reach,
                    int dim) {
  for (int k = 0; k < dim; k++)
    if (at[k] + reach < low[k] || at[k] - reach > high[k])
      return false;
  return true;
}

static cdem_status add_passer(const cdem_run_grains *g, int64_t i, const double shift[3],
                              double gap, bool image, passer **list, int64_t count[2],
                              cdem_fault *fault) {
  CDEM_TRY(cdem_grow(list, &count[1], count[0] + 1, sizeof **list, fault));
  passer *p = &(*list)[count[0]++];
  p->reach = (1.0 + 0.5 * gap) * g->grains.radius[i];
  for (int k = 0; k < 3; k++)
    p->xyz[k] = g->grains.xyz[3 * i + k] + shift[k];
  p->low = p->xyz[0] - p->reach;
  p->grain = (int32_t)i;
  p->image = image;
  return CDEM_OK;
}

/* The box of the grains, with their reach. */
static cdem_status list_passers(const cdem_run_grains *g, double gap, passer **list,
                                int64_t count[2], cdem_fault *fault) {
  double shift[27][3] = {{0}}, low[3], high[3], most = 0.0;
  cdem_grains_box(&g->grains, low, high);
  for (int64_t i = 0; i < g->grains.grains; i++)
    most = fmax(most, g->grains.radius[i]);
  if (g->has_cell)
    cdem_cell_images(&g->cell, shift);
  for (int code = 0; code < 27; code++) {
    bool own = code == CDEM_IMAGE_SELF, moved = cdem_norm3(shift[code]) > 0.0;
    for (int64_t i = 0; (own || moved) && i < g->grains.grains; i++) {
      double at[3];
      for (int k = 0; k < 3; k++)
        at[k] = g->grains.xyz[3 * i + k] + shift[code][k];
      if (own || is_near(low, high, at, (1.0 + gap) * (g->grains.radius[i] + most), g->dim))
        CDEM_TRY(add_passer(g, i, shift[code], gap, !own, list, count, fault));
    }
  }
  return CDEM_OK;
}

static cdem_status sweep(cdem_run_grains *g, const passer *list, int64_t count, cdem_fault *fault) {
  for (int64_t a = 0; a < count; a++)
    for (int64_t b = a + 1; b < count && list[b].low <= list[a].xyz[0] + list[a].reach; b++)
      CDEM_TRY(try_pair(g, &list[a], &list[b], fault));
  return CDEM_OK;
}

/* Each pair once, in the order of ids. */
static void sort_bonds(cdem_run_grains *g) {
  int64_t kept = 0;
  if (g->bonds == 0)
    return;
  cdem_sort(g->bond, g->bonds, sizeof *g->bond, by_grains);
  for (int64_t i = 0; i < g->bonds; i++)
    if (kept == 0 || by_grains(&g->bond[kept - 1], &g->bond[i]) != 0)
      g->bond[kept++] = g->bond[i];
  g->bonds = kept;
}

static void fill_law(const cdem_case_bond *from, cdem_bond_law *law) {
  *law = (cdem_bond_law){.normal_stiffness = from->normal_stiffness,
                         .shear_stiffness = from->shear_stiffness,
                         .rolling_stiffness = from->rolling_stiffness,
                         .twisting_stiffness = from->twisting_stiffness,
                         .damping_ratio = from->damping_ratio,
                         .tension = from->tension,
                         .cohesion = from->cohesion,
                         .friction = from->friction,
                         .moment = from->moment};
}

cdem_status cdem_run_grains_bonds(cdem_run_grains *g, cdem_fault *fault) {
  const cdem_case_values *v = cdem_run_grains_values(g);
  passer *list = NULL;
  int64_t count[2] = {0, 0};
  double gap = 0.0;
  if (v->bonds.count == 0)
    return CDEM_OK;
  CDEM_NEW(g->bond_law, v->bonds.count, fault);
  for (int64_t e = 0; e < v->bonds.count; e++) {
    fill_law(&v->bonds.item[e], &g->bond_law[e]);
    gap = fmax(gap, v->bonds.item[e].gap);
  }
  cdem_status status = list_passers(g, gap, &list, count, fault);
  if (status == CDEM_OK) {
    cdem_sort(list, count[0], sizeof *list, by_low);
    status = sweep(g, list, count[0], fault);
  }
  free(list);
  CDEM_TRY(status);
  sort_bonds(g);
  if (g->bonds == 0)
    return cdem_case_fail(&g->run->cases, "bonds", CDEM_INPUT, fault,
                          "no two grains are close enough for a bond: the largest gap is %g of the "
                          "mean radius of a pair",
                          gap);
  return CDEM_OK;
}
