/* Bonds: where they are, which hold, and how they go with the grains when these are sorted. */
#include "base/sort.h"
#include "dem/solver_store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static cdem_status check_law(const cdem_bond_law *law, int index, cdem_fault *fault) {
  const double value[] = {law->normal_stiffness,   law->shear_stiffness, law->rolling_stiffness,
                          law->twisting_stiffness, law->damping_ratio,   law->tension,
                          law->cohesion,           law->friction,        law->moment};
  static const char *const name[] = {"normal stiffness",   "shear stiffness", "rolling stiffness",
                                     "twisting stiffness", "damping ratio",   "tension",
                                     "cohesion",           "friction",        "moment"};
  for (size_t k = 0; k < sizeof value / sizeof value[0]; k++)
    CDEM_REQUIRE(value[k] >= 0.0 && isfinite(value[k]), fault, CDEM_INPUT,
                 "bond law %d has %s %g; it is not negative", index, name[k], value[k]);
  CDEM_REQUIRE(law->normal_stiffness > 0.0, fault, CDEM_INPUT,
               "bond law %d has no normal stiffness", index);
  return CDEM_OK;
}

static cdem_status check(const cdem_dem_options *o, cdem_fault *fault) {
  for (int k = 0; k < o->bond_laws; k++)
    CDEM_TRY(check_law(&o->bond_law[k], k, fault));
  for (int64_t b = 0; b < o->bonds; b++) {
    const cdem_bond *bond = &o->bond[b];
    bool known = bond->grain[0] >= 0 && bond->grain[0] < o->grains->grains && bond->grain[1] >= 0 &&
                 bond->grain[1] < o->grains->grains;
    CDEM_REQUIRE(known && bond->grain[0] != bond->grain[1], fault, CDEM_INPUT,
                 "bond %lld joins grains %d and %d of %lld", (long long)b, bond->grain[0],
                 bond->grain[1], (long long)o->grains->grains);
    CDEM_REQUIRE(bond->law >= 0 && bond->law < o->bond_laws, fault, CDEM_INPUT,
                 "bond %lld has law %d; there are %d", (long long)b, bond->law, o->bond_laws);
  }
  return CDEM_OK;
}

static int by_ids(const void *left, const void *right) {
  const int32_t *a = left, *b = right;
  if (a[0] != b[0])
    return a[0] < b[0] ? -1 : 1;
  return (a[1] > b[1]) - (a[1] < b[1]);
}

void cdem_bonds_update(cdem_dem *dem) {
  cdem_dem_core *core = dem->store->core;
  core->held = 0;
  for (int64_t b = 0; b < core->bonds; b++) {
    const cdem_bond_state *bond = &core->bond[b];
    if (!bond->holds)
      continue;
    int32_t *pair = core->held_by + 2 * core->held++;
    pair[0] = bond->id[0] < bond->id[1] ? bond->id[0] : bond->id[1];
    pair[1] = bond->id[0] < bond->id[1] ? bond->id[1] : bond->id[0];
  }
  cdem_sort(core->held_by, core->held, 2 * sizeof *core->held_by, by_ids);
  core->broken = core->bonds - core->held;
}

/* The nearest image; difference from A to B. Across free directions there are none. */
static uint8_t nearest_image(const cdem_dem_store *s, const double a[3], const double b[3],
                             double difference[3]) {
  double least = INFINITY;
  uint8_t best = CDEM_IMAGE_SELF;
  for (int k = 0; k < 27; k++) {
    double d[3], d2 = 0.0;
    int edges[3];
    bool there = true;
    cdem_image_edges(k, edges);
    for (int c = 0; c < 3; c++)
      there = there && (s->cell.periodic[c] || edges[c] == 0);
    for (int c = 0; c < 3; c++) {
      d[c] = b[c] - a[c] + s->image[k][c];
      d2 += d[c] * d[c];
    }
    if (there && d2 < least) {
      least = d2;
      best = (uint8_t)k;
      memcpy(difference, d, sizeof d);
    }
  }
  return best;
}

cdem_status cdem_bonds_init(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  const cdem_dem_options *o = &s->options;
  CDEM_TRY(check(o, fault));
  CDEM_NEW(core->bond, o->bonds, fault);
  CDEM_NEW(core->bond_spare, o->bonds, fault);
  CDEM_NEW(core->bond_start, (int64_t)s->grains + 1, fault);
  CDEM_NEW(core->held_by, 2 * o->bonds, fault);
  core->bonds = o->bonds;
  for (int64_t b = 0; b < o->bonds; b++) {
    cdem_bond_state *bond = &core->bond[b];
    double d[3] = {0};
    memcpy(bond->id, o->bond[b].grain, sizeof bond->id);
    bond->law = o->bond[b].law;
    bond->holds = 1;
    for (int c = 0; c < 3; c++)
      d[c] = cdem_place(s, s->slot[bond->id[1]])[c] - cdem_place(s, s->slot[bond->id[0]])[c];
    cdem_cell_nearest(&s->cell, d);
    bond->rest = cdem_norm3(d);
    CDEM_REQUIRE(bond->rest > 0.0, fault, CDEM_INPUT,
                 "bond %lld: grains %d and %d stand in one place", (long long)b, bond->id[0],
                 bond->id[1]);
  }
  cdem_bonds_update(dem);
  for (int64_t b = 1; b < core->held; b++)
    CDEM_REQUIRE(by_ids(core->held_by + 2 * b, core->held_by + 2 * b - 2) != 0, fault, CDEM_INPUT,
                 "grains %d and %d have two bonds", core->held_by[2 * b], core->held_by[2 * b + 1]);
  return CDEM_OK;
}

void cdem_bonds_release(cdem_dem_core *core) {
  free(core->bond);
  free(core->bond_spare);
  free(core->bond_start);
  free(core->held_by);
}

/* ---- after a build ---- */

/* A and B change places: way and rotation are those of B against A; the 2-D way is along t, which
 * turns around as well. */
static void exchange(int dim, cdem_bond_state *bond) {
  int32_t id = bond->id[0];
  bond->id[0] = bond->id[1];
  bond->id[1] = id;
  for (int k = dim == 2 ? 1 : 0; k < 6; k++)
    bond->stretch[k] = -bond->stretch[k];
  bond->image = (uint8_t)(2 * CDEM_IMAGE_SELF - bond->image);
}

static int64_t pair_of(const cdem_dem_store *s, const cdem_bond_state *bond) {
  for (int64_t p = s->pair_start[bond->owner]; p < s->pair_start[bond->owner + 1]; p++)
    if (s->pair_other[p] == bond->other &&
        (s->pair_image == NULL || s->pair_image[p] == bond->image))
      return p;
  return -1;
}

/* A bond is one with one image, wherever its grains were brought back; the first time it is the
 * nearest one. */
cdem_status cdem_bonds_carry(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  for (int64_t b = 0; b < core->bonds; b++) {
    cdem_bond_state *bond = &core->bond[b];
    double d[3];
    int image = CDEM_IMAGE_SELF;
    if (s->builds == 1)
      image = nearest_image(s, cdem_place(s, s->slot[bond->id[0]]),
                            cdem_place(s, s->slot[bond->id[1]]), d);
    else if (s->pair_image != NULL && bond->holds)
      image = cdem_neighbours_image_now(s, bond->owner, bond->other, bond->image);
    CDEM_REQUIRE(image >= 0, fault, CDEM_NUMERIC,
                 "the bond of grains %d and %d is longer than the cell is wide at t = %.6g s; "
                 "give it a strength, or take a larger cell",
                 bond->id[0], bond->id[1], dem->time);
    bond->image = (uint8_t)image;
  }
  return CDEM_OK;
}

cdem_status cdem_bonds_sort(cdem_dem *dem, cdem_fault *fault) {
  cdem_dem_store *s = dem->store;
  cdem_dem_core *core = s->core;
  int64_t *start = core->bond_start;
  (void)fault;
  memset(start, 0, ((size_t)s->grains + 1) * sizeof *start);
  for (int64_t b = 0; b < core->bonds; b++) {
    cdem_bond_state *bond = &core->bond[b];
    if (s->slot[bond->id[0]] > s->slot[bond->id[1]])
      exchange(s->dim, bond);
    bond->owner = s->slot[bond->id[0]];
    bond->other = s->slot[bond->id[1]];
    start[bond->owner + 1]++;
  }
  for (int32_t i = 0; i < s->grains; i++)
    start[i + 1] += start[i];
  memcpy(core->bond_spare, core->bond, (size_t)core->bonds * sizeof *core->bond);
  for (int64_t b = 0; b < core->bonds; b++)
    core->bond[start[core->bond_spare[b].owner]++] = core->bond_spare[b];
  for (int32_t i = s->grains; i > 0; i--)
    start[i] = start[i - 1];
  start[0] = 0;
  for (int32_t i = 0; i < s->grains; i++) /* rows are short */
    for (int64_t b = start[i] + 1; b < start[i + 1]; b++)
      for (int64_t k = b; k > start[i] && core->bond[k].other < core->bond[k - 1].other; k--) {
        cdem_bond_state swap = core->bond[k];
        core->bond[k] = core->bond[k - 1];
        core->bond[k - 1] = swap;
      }
  for (int64_t b = 0; b < core->bonds; b++) {
    cdem_bond_state *bond = &core->bond[b];
    bond->pair = pair_of(s, bond);
    if (bond->pair >= 0 && bond->holds)
      s->pair_touch[bond->pair] = 2;
  }
  return CDEM_OK;
}

/* ---- saving ---- */

cdem_status cdem_bonds_save(const cdem_dem *dem, cdem_state *state, cdem_fault *fault) {
  const cdem_dem_core *core = dem->store->core;
  return cdem_state_add(state, "dem/bonds", CDEM_ARRAY_BYTE,
                        core->bonds * (int64_t)sizeof *core->bond, core->bond, fault);
}

/* Owners, pairs and far rows follow from the ids when the lists are made again. */
static bool can_be(const cdem_dem_store *s, const cdem_bond_state *bond) {
  bool good = bond->id[0] >= 0 && bond->id[0] < s->grains && bond->id[1] >= 0 &&
              bond->id[1] < s->grains && bond->id[0] != bond->id[1] && bond->law >= 0 &&
              bond->law < s->options.bond_laws && bond->image < 27 && bond->holds <= 1 &&
              bond->rest > 0.0 && isfinite(bond->rest);
  for (int k = 0; k < CDEM_BOND_HISTORY; k++)
    good = good && isfinite(bond->stretch[k]);
  return good;
}

cdem_status cdem_bonds_restore(cdem_dem *dem, const cdem_state *state, cdem_fault *fault) {
  cdem_dem_core *core = dem->store->core;
  CDEM_TRY(cdem_state_get(state, "dem/bonds", CDEM_ARRAY_BYTE,
                          core->bonds * (int64_t)sizeof *core->bond, core->bond, fault));
  for (int64_t b = 0; b < core->bonds; b++)
    CDEM_REQUIRE(can_be(dem->store, &core->bond[b]), fault, CDEM_INPUT,
                 "bond %lld of the checkpoint cannot be: it joins grains %d and %d by law %d; the "
                 "checkpoint does not belong to this case",
                 (long long)b, core->bond[b].id[0], core->bond[b].id[1], core->bond[b].law);
  cdem_bonds_update(dem);
  return CDEM_OK;
}
