/* Interface laws of a case: which entry of `interfaces` fits which face, and its stiffness.
 *
 * kn = factor (lambda + 2G)/h of the stiffer neighbour, h = volume/area of the face: the height of
 * a brick, half of a triangle's, a third of a tetrahedron's. Derived stiffnesses are rounded to
 * single precision, so that the faces of a regular mesh share one law.
 */
#include "base/bits.h"
#include "run/body.h"

#include <stdlib.h>
#include <string.h>

/* What an entry of the case names, resolved. */
typedef struct {
  const cdem_group *between[2]; /* NULL: any */
  int joint;                    /* index of the joint group; -1: none named */
} entry_groups;

/* Laws found so far, with a table of places by hash. */
typedef struct {
  cdem_interface_law *law;
  int64_t laws, capacity;
  int32_t *slot; /* [slots] index of a law or -1 */
  int64_t slots;
} law_table;

static cdem_status resolve(const cdem_run_body *setup, int64_t index, entry_groups *groups,
                           cdem_fault *fault) {
  const cdem_case_values *values = cdem_run_values(setup->run);
  const cdem_case_interface *entry = &values->interfaces.item[index];
  int dimension = setup->blocks.dimension;
  char key[96];
  *groups = (entry_groups){.joint = -1};
  cdem_run_key(key, "interfaces", index, "between");
  for (int64_t i = 0; i < entry->between.count && i < 2; i++)
    CDEM_TRY(cdem_run_find_group(setup, key, entry->between.item[i], dimension, dimension,
                                 &groups->between[i], fault));
  if (entry->between.count == 1)
    groups->between[1] = groups->between[0];
  if (entry->joint == NULL)
    return CDEM_OK;
  for (int64_t j = 0; j < values->blocks.joints.count; j++)
    if (strcmp(values->blocks.joints.item[j], entry->joint) == 0)
      groups->joint = (int)j;
  if (groups->joint >= 0)
    return CDEM_OK;
  return cdem_case_fail(&setup->run->cases, cdem_run_key(key, "interfaces", index, "joint"),
                        CDEM_INPUT, fault,
                        "'%s' is not among `blocks.joints`; name it there, so that the mesh "
                        "is cut along it",
                        entry->joint);
}

static bool fits(const entry_groups *groups, const cdem_face_pair *pair) {
  if (groups->joint >= 0 && pair->joint != groups->joint)
    return false;
  if (groups->between[0] == NULL)
    return true;
  for (int side = 0; side < 2; side++)
    if (cdem_run_group_holds(groups->between[0], pair->cell[side]) &&
        cdem_run_group_holds(groups->between[1], pair->cell[1 - side]))
      return true;
  return false;
}

static bool is_breakable(const cdem_run_body *setup, int32_t cell) {
  const cdem_case_texts *list = &cdem_run_values(setup->run)->blocks.breakable;
  for (int64_t i = 0; i < list->count; i++)
    if (cdem_run_group_holds(cdem_mesh_find_group(&setup->blocks.mesh, list->item[i]), cell))
      return true;
  return false;
}

/* A face without an entry: contact from the start where that is on and the face is not one of a
 * breakable region; else an error that names the groups. */
static cdem_status no_entry(const cdem_run_body *setup, const cdem_face_pair *pair,
                            cdem_fault *fault) {
  const cdem_blocks *blocks = &setup->blocks;
  bool both = is_breakable(setup, pair->cell[0]) && is_breakable(setup, pair->cell[1]);
  if (cdem_run_values(setup->run)->contact.active && !both)
    return CDEM_OK;
  char name[2][200];
  for (int side = 0; side < 2; side++)
    cdem_run_group_names(&blocks->mesh, pair->cell[side], blocks->dimension, blocks->dimension,
                         name[side]);
  return cdem_case_fail(
      &setup->run->cases, "interfaces", CDEM_INPUT, fault,
      "no entry fits the faces between groups %s and %s%s%s (elements %lld and "
      "%lld); add one with `between`, or one without that fits all faces",
      name[0], name[1], pair->joint >= 0 ? " along joint " : "",
      pair->joint >= 0 ? cdem_run_values(setup->run)->blocks.joints.item[pair->joint] : "",
      (long long)blocks->mesh.cell_tag[pair->cell[0]],
      (long long)blocks->mesh.cell_tag[pair->cell[1]]);
}

static void stiffness(const cdem_run_body *setup, const cdem_case_interface *entry, int32_t pair,
                      double *kn, double *ks) {
  const cdem_blocks *blocks = &setup->blocks;
  double area[3], share[4], best = 0.0, ratio = 0.0;
  double size = cdem_run_facet(setup, &blocks->facet[blocks->pair_facet[2 * pair]], area, share);
  for (int side = 0; side < 2; side++) {
    int32_t cell = blocks->pair[pair].cell[side];
    const cdem_run_moduli *m = cdem_run_cell_moduli(setup, cell);
    double stiff = m->wave * size / setup->volume[setup->model_of[cell]];
    if (stiff > best) {
      best = stiff;
      ratio = m->shear / m->wave;
    }
  }
  if (!isnan(entry->shear_ratio))
    ratio = entry->shear_ratio;
  *kn = entry->normal_stiffness > 0.0 ? entry->normal_stiffness
                                      : (double)(float)(entry->stiffness_factor * best);
  *ks = entry->shear_stiffness > 0.0 ? entry->shear_stiffness : (double)(float)(ratio * *kn);
}

static bool is_same(const cdem_interface_law *a, const cdem_interface_law *b) {
  return a->insertion == b->insertion && a->softening == b->softening &&
         a->unloading == b->unloading && cdem_same_bits(a->kn, b->kn) &&
         cdem_same_bits(a->ks, b->ks) && cdem_same_bits(a->tension, b->tension) &&
         cdem_same_bits(a->cohesion, b->cohesion) && cdem_same_bits(a->friction, b->friction) &&
         cdem_same_bits(a->dilation, b->dilation) && cdem_same_bits(a->energy_1, b->energy_1) &&
         cdem_same_bits(a->energy_2, b->energy_2);
}

/* Position of a law in the table, added when new. `entry` is kept apart by its numbers. */
static cdem_status intern(law_table *table, const cdem_interface_law *law, uint64_t entry,
                          int32_t *index, cdem_fault *fault) {
  uint64_t bits[2];
  memcpy(bits, (double[2]){law->kn, law->ks}, sizeof bits);
  uint64_t hash = (bits[0] ^ (bits[1] << 1) ^ (entry << 56)) * 0x9e3779b97f4a7c15u;
  int64_t place = (int64_t)(hash >> 20) & (table->slots - 1);
  for (; table->slot[place] >= 0; place = (place + 1) & (table->slots - 1))
    if (is_same(&table->law[table->slot[place]], law)) {
      *index = table->slot[place];
      return CDEM_OK;
    }
  CDEM_TRY(cdem_grow(&table->law, &table->capacity, table->laws + 1, sizeof *table->law, fault));
  table->law[table->laws] = *law;
  *index = table->slot[place] = (int32_t)table->laws++;
  return CDEM_OK;
}

/* The key of the case that a message of the law's check speaks of. */
static const char *key_in(const char *message) {
  static const struct {
    const char *word, *key;
  } keys[] = {{"energy_1", "energy_1"},   {"energy_2", "energy_2"}, {"dilation", "dilation"},
              {"tension", "tension"},     {"cohesion", "cohesion"}, {"friction", "friction"},
              {"kn", "stiffness_factor"}, {"ks", "shear_ratio"}};
  const char *first = NULL, *key = "";
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
    const char *at = strstr(message, keys[i].word);
    if (at != NULL && (first == NULL || at < first)) {
      first = at;
      key = keys[i].key;
    }
  }
  return key;
}

static cdem_status law_of(const cdem_run_body *setup, int64_t index, int32_t pair,
                          cdem_interface_law *law, cdem_fault *fault) {
  const cdem_case_interface *entry = &cdem_run_values(setup->run)->interfaces.item[index];
  memset(law, 0, sizeof *law); /* laws are compared as bytes */
  law->insertion = (cdem_insertion)entry->insertion;
  law->softening = (cdem_softening)entry->softening;
  law->unloading = (cdem_unloading)entry->unloading;
  law->tension = entry->tension;
  law->cohesion = entry->cohesion;
  law->friction = entry->friction;
  law->dilation = entry->dilation;
  law->energy_1 = isnan(entry->energy_1) ? 0.0 : entry->energy_1;
  law->energy_2 = isnan(entry->energy_2) ? 0.0 : entry->energy_2;
  stiffness(setup, entry, pair, &law->kn, &law->ks);
  cdem_fault local = {0};
  if (cdem_interface_law_check(law, &local) == CDEM_OK)
    return CDEM_OK;
  char key[96];
  if (fault != NULL)
    *fault = local;
  return cdem_case_blame(&setup->run->cases,
                         cdem_run_key(key, "interfaces", index, key_in(local.message)), fault);
}

/* Laws of all pairs; law_of [pairs] is filled. */
static cdem_status find_laws(cdem_run_body *setup, const entry_groups *groups, law_table *table,
                             int32_t *pair_law, cdem_fault *fault) {
  const cdem_blocks *blocks = &setup->blocks;
  int64_t entries = cdem_run_values(setup->run)->interfaces.count;
  for (int32_t p = 0; p < blocks->pairs; p++) {
    int64_t e = 0;
    while (e < entries && !fits(&groups[e], &blocks->pair[p]))
      e++;
    pair_law[p] = -1;
    if (e == entries) {
      CDEM_TRY(no_entry(setup, &blocks->pair[p], fault));
      continue;
    }
    cdem_interface_law law;
    CDEM_TRY(law_of(setup, e, p, &law, fault));
    CDEM_TRY(intern(table, &law, (uint64_t)e, &pair_law[p], fault));
  }
  return CDEM_OK;
}

static cdem_status make(cdem_run_body *setup, entry_groups *groups, law_table *table,
                        int32_t *pair_law, cdem_fault *fault) {
  for (int64_t e = 0; e < cdem_run_values(setup->run)->interfaces.count; e++)
    CDEM_TRY(resolve(setup, e, &groups[e], fault));
  CDEM_TRY(find_laws(setup, groups, table, pair_law, fault));
  const cdem_interfaces_options options = {.blocks = &setup->blocks,
                                           .dofs = setup->body.dofs,
                                           .thickness = setup->section.thickness,
                                           .laws = (int)table->laws,
                                           .law = table->law,
                                           .law_of = pair_law,
                                           .release = cdem_run_values(setup->run)->contact.release,
                                           .threads = setup->run->threads};
  cdem_status status = cdem_interfaces_init(&options, &setup->interfaces, fault);
  setup->has_interfaces = status == CDEM_OK;
  return status == CDEM_INPUT ? cdem_case_blame(&setup->run->cases, "interfaces", fault) : status;
}

cdem_status cdem_run_body_interfaces(cdem_run_body *setup, cdem_fault *fault) {
  int32_t pairs = setup->blocks.pairs;
  law_table table = {.slots = 16};
  if (pairs == 0)
    return CDEM_OK;
  while (table.slots < 2 * (int64_t)pairs)
    table.slots *= 2;
  entry_groups *groups =
      cdem_allocate(cdem_run_values(setup->run)->interfaces.count, sizeof *groups, fault);
  int32_t *pair_law = cdem_allocate(pairs, sizeof *pair_law, fault);
  table.slot = cdem_allocate(table.slots, sizeof *table.slot, fault);
  cdem_status status =
      groups == NULL || pair_law == NULL || table.slot == NULL ? CDEM_MEMORY : CDEM_OK;
  if (status == CDEM_OK) {
    for (int64_t i = 0; i < table.slots; i++)
      table.slot[i] = -1;
    status = make(setup, groups, &table, pair_law, fault);
  }
  free(groups);
  free(pair_law);
  free(table.law);
  free(table.slot);
  return status;
}
