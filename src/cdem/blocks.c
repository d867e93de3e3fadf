/* Blocks: choosing cells, matching faces, finding what hangs together. */
#include "cdem/blocks.h"

#include "base/sets.h"
#include "cdem/blocks_cut.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

cdem_status cdem_cut_group(const cdem_mesh *mesh, const char *name, const cdem_group **group,
                           cdem_fault *fault) {
  *group = cdem_mesh_find_group(mesh, name);
  if (*group != NULL)
    return CDEM_OK;
  char list[CDEM_FAULT_LENGTH / 2] = "";
  size_t used = 0;
  for (int32_t g = 0; g < mesh->groups && used < sizeof list - 4; g++) {
    int written =
        snprintf(list + used, sizeof list - used, "%s'%s'", g > 0 ? ", " : "", mesh->group[g].name);
    if (written < 0 || (size_t)written >= sizeof list - used) {
      snprintf(list + used, sizeof list - used, " ...");
      break;
    }
    used += (size_t)written;
  }
  return mesh->groups == 0
             ? cdem_fail(fault, CDEM_INPUT,
                         "there is no group '%s': the mesh has no groups; name one in the mesh",
                         name)
             : cdem_fail(fault, CDEM_INPUT, "there is no group '%s' in the mesh; there are %s",
                         name, list);
}

/* The dimension of the chosen groups; they agree. */
static cdem_status choose_dimension(cdem_cut *cut, const cdem_blocks_options *options,
                                    cdem_fault *fault) {
  cut->dimension = cdem_mesh_dimension(cut->mesh);
  for (int g = 0; g < options->groups; g++) {
    const cdem_group *group;
    CDEM_TRY(cdem_cut_group(cut->mesh, options->group[g], &group, fault));
    if (g == 0)
      cut->dimension = group->dimension;
    CDEM_REQUIRE(group->dimension == cut->dimension, fault, CDEM_INPUT,
                 "group '%s' has dimension %d, but '%s' has %d; choose cells of one dimension",
                 group->name, group->dimension, options->group[0], cut->dimension);
  }
  CDEM_REQUIRE(cut->dimension >= 2, fault, CDEM_INPUT,
               "the chosen cells have dimension %d; blocks need plane cells or bodies",
               cut->dimension);
  return CDEM_OK;
}

static cdem_status check_order(const cdem_cut *cut, cdem_fault *fault) {
  for (int32_t i = 0; i < cut->chosen; i++) {
    const cdem_shape_info *info = cdem_cut_info(cut, i);
    CDEM_REQUIRE(info->nodes == info->corners, fault, CDEM_INPUT,
                 "element %" PRId64
                 " is a %s; blocks know first-order elements only: mesh with order 1",
                 cut->mesh->cell_tag[cut->cell[i]], info->name);
  }
  return CDEM_OK;
}

cdem_status cdem_cut_choose(cdem_cut *cut, const cdem_blocks_options *options, cdem_fault *fault) {
  const cdem_mesh *mesh = cut->mesh;
  CDEM_TRY(choose_dimension(cut, options, fault));
  CDEM_NEW(cut->position, mesh->cells, fault);
  for (int32_t c = 0; c < mesh->cells; c++) {
    int own = cdem_shape_get((cdem_shape)mesh->cell_shape[c])->dimension;
    cut->position[c] = options->groups == 0 && own == cut->dimension ? 0 : -1;
  }
  for (int g = 0; g < options->groups; g++) {
    const cdem_group *group = cdem_mesh_find_group(mesh, options->group[g]);
    for (int32_t k = 0; k < group->cells; k++)
      cut->position[group->cell[k]] = 0;
  }
  for (int32_t c = 0; c < mesh->cells; c++)
    if (cut->position[c] == 0)
      cut->position[c] = cut->chosen++;
  CDEM_REQUIRE(cut->chosen > 0, fault, CDEM_INPUT,
               "the chosen groups hold no cells; choose at least one with cells");
  CDEM_NEW(cut->cell, cut->chosen, fault);
  CDEM_NEW(cut->slot_start, (int64_t)cut->chosen + 1, fault);
  CDEM_NEW(cut->corner_start, (int64_t)cut->chosen + 1, fault);
  for (int32_t c = 0; c < mesh->cells; c++)
    if (cut->position[c] >= 0)
      cut->cell[cut->position[c]] = c;
  for (int32_t i = 0; i < cut->chosen; i++) {
    cut->slot_start[i + 1] = cut->slot_start[i] + cdem_cut_slots(cdem_cut_info(cut, i));
    cut->corner_start[i + 1] = cut->corner_start[i] + cdem_cut_info(cut, i)->nodes;
  }
  CDEM_REQUIRE(cut->corner_start[cut->chosen] < INT32_MAX, fault, CDEM_INPUT,
               "%" PRId32 " cells are too many to cut: their corners exceed %" PRId32, cut->chosen,
               INT32_MAX);
  return check_order(cut, fault);
}

void cdem_cut_key(const int32_t *node, const int8_t *local, int corners, int32_t key[4]) {
  for (int k = 0; k < 4; k++)
    key[k] = -1;
  for (int k = 0; k < corners; k++) {
    int32_t id = local != NULL ? node[local[k]] : node[k];
    int at = k;
    for (; at > 0 && key[at - 1] > id; at--)
      key[at] = key[at - 1];
    key[at] = id;
  }
}

uint64_t cdem_cut_hash(const int32_t key[4]) {
  cdem_random mix = {(uint64_t)(uint32_t)key[0] << 32 | (uint32_t)key[1]};
  mix.state = cdem_random_next(&mix) ^ ((uint64_t)(uint32_t)key[2] << 32 | (uint32_t)key[3]);
  return cdem_random_next(&mix);
}

static void slot_key(const cdem_cut *cut, int32_t slot, int32_t key[4]) {
  int32_t position = cut->slot_cell[slot];
  const int8_t *local;
  int corners =
      cdem_cut_face(cdem_cut_info(cut, position), (int)(slot - cut->slot_start[position]), &local);
  cdem_cut_key(cdem_mesh_cell(cut->mesh, cut->cell[position]), local, corners, key);
}

/* The entry of this key, or the empty one where it belongs. */
static int64_t entry_of(const cdem_cut *cut, const int32_t key[4]) {
  int64_t at = (int64_t)(cdem_cut_hash(key) & (uint64_t)(cut->entries - 1));
  for (; cut->entry[at] != 0; at = (at + 1) & (cut->entries - 1)) {
    int32_t other[4];
    slot_key(cut, cut->entry[at] - 1, other);
    if (memcmp(key, other, sizeof other) == 0)
      break;
  }
  return at;
}

int32_t cdem_cut_find(const cdem_cut *cut, const int32_t key[4]) {
  return cut->entry[entry_of(cut, key)] - 1;
}

cdem_status cdem_cut_match(cdem_cut *cut, cdem_fault *fault) {
  int32_t slots = (int32_t)cut->slot_start[cut->chosen];
  for (cut->entries = 16; cut->entries < 2 * (int64_t)slots;)
    cut->entries *= 2;
  CDEM_NEW(cut->entry, cut->entries, fault);
  CDEM_NEW(cut->slot_cell, slots, fault);
  CDEM_NEW(cut->mate, slots, fault);
  for (int32_t i = 0; i < cut->chosen; i++)
    for (int64_t s = cut->slot_start[i]; s < cut->slot_start[i + 1]; s++)
      cut->slot_cell[s] = i;
  for (int32_t s = 0; s < slots; s++) {
    int32_t key[4];
    slot_key(cut, s, key);
    int64_t at = entry_of(cut, key);
    int32_t first = cut->entry[at] - 1;
    cut->mate[s] = first;
    if (first < 0) {
      cut->entry[at] = s + 1;
      continue;
    }
    const int64_t *tag = cut->mesh->cell_tag;
    int32_t second = cut->mate[first];
    CDEM_REQUIRE(second < 0, fault, CDEM_INPUT,
                 "elements %" PRId64 ", %" PRId64 " and %" PRId64
                 " share one face; at most two can: mend the mesh",
                 tag[cut->cell[cut->slot_cell[first]]], tag[cut->cell[cut->slot_cell[second]]],
                 tag[cut->cell[cut->slot_cell[s]]]);
    cut->mate[first] = s;
  }
  return CDEM_OK;
}

cdem_status cdem_cut_joints(cdem_cut *cut, const cdem_blocks_options *options, cdem_fault *fault) {
  int32_t slots = (int32_t)cut->slot_start[cut->chosen];
  CDEM_NEW(cut->joint, slots, fault);
  for (int32_t s = 0; s < slots; s++)
    cut->joint[s] = -1;
  CDEM_REQUIRE(options->joints <= INT16_MAX, fault, CDEM_INPUT, "%d joints are too many: up to %d",
               options->joints, INT16_MAX);
  for (int j = 0; j < options->joints; j++) {
    const cdem_group *group;
    CDEM_TRY(cdem_cut_group(cut->mesh, options->joint_group[j], &group, fault));
    CDEM_REQUIRE(group->dimension == cut->dimension - 1, fault, CDEM_INPUT,
                 "joint group '%s' has dimension %d; a joint between cells of dimension %d is a "
                 "group of %s",
                 group->name, group->dimension, cut->dimension,
                 cut->dimension == 3 ? "faces" : "edges");
    for (int32_t k = 0; k < group->cells; k++) {
      int32_t id = group->cell[k], key[4];
      const cdem_shape_info *info = cdem_shape_get((cdem_shape)cut->mesh->cell_shape[id]);
      cdem_cut_key(cdem_mesh_cell(cut->mesh, id), NULL, info->corners, key);
      int32_t slot = cdem_cut_find(cut, key);
      CDEM_REQUIRE(slot >= 0 && cut->mate[slot] >= 0, fault, CDEM_INPUT,
                   "joint group '%s': element %" PRId64
                   " is no face between two chosen cells; a joint must lie on the faces of the "
                   "mesh, inside it",
                   group->name, cut->mesh->cell_tag[id]);
      if (cut->joint[slot] < 0)
        cut->joint[slot] = cut->joint[cut->mate[slot]] = (int16_t)j;
    }
  }
  return CDEM_OK;
}

/* A face within a block: neither of its cells breakable, both of the same separate group (or of
 * none), and no joint. label: -1 breakable, else the separate group + 1 or 0. */
static bool holds_together(const cdem_cut *cut, const int32_t *label, int32_t slot) {
  int32_t mate = cut->mate[slot];
  if (mate < 0 || cut->joint[slot] >= 0)
    return false;
  int32_t own = label[cut->slot_cell[slot]];
  return own >= 0 && own == label[cut->slot_cell[mate]];
}

static cdem_status mark_group(const cdem_cut *cut, const char *name, const char *kind,
                              int32_t value, int32_t *label, cdem_fault *fault) {
  const cdem_group *group;
  CDEM_TRY(cdem_cut_group(cut->mesh, name, &group, fault));
  CDEM_REQUIRE(
      group->dimension == cut->dimension, fault, CDEM_INPUT,
      "%s group '%s' has dimension %d, but the chosen cells have %d; name a group of cells", kind,
      name, group->dimension, cut->dimension);
  for (int32_t k = 0; k < group->cells; k++) {
    int32_t position = cut->position[group->cell[k]];
    if (position >= 0 && label[position] == 0)
      label[position] = value;
  }
  return CDEM_OK;
}

/* Blocks by union of cells over the faces that hold; numbered by their first cell. */
static void join_cells(cdem_cut *cut, const int32_t *label) {
  cdem_sets_init(cut->block, 0, cut->chosen);
  for (int32_t s = 0; s < cut->slot_start[cut->chosen]; s++) {
    bool holds = holds_together(cut, label, s);
    cut->cut[s] = cut->mate[s] >= 0 && !holds;
    if (holds && s < cut->mate[s])
      cdem_sets_join(cut->block, cut->slot_cell[s], cut->slot_cell[cut->mate[s]]);
  }
  cdem_sets_label(cut->block, 0, cut->chosen);
  /* A root is the first of its set, so that its number is known when the others ask. */
  for (int32_t i = 0; i < cut->chosen; i++)
    cut->block[i] = cut->block[i] == i ? cut->blocks++ : cut->block[cut->block[i]];
}

cdem_status cdem_cut_blocks(cdem_cut *cut, const cdem_blocks_options *options, cdem_fault *fault) {
  CDEM_NEW(cut->block, cut->chosen, fault);
  CDEM_NEW(cut->cut, cut->slot_start[cut->chosen], fault);
  int32_t *label;
  CDEM_NEW(label, cut->chosen, fault);
  cdem_status status = CDEM_OK;
  for (int g = 0; g < options->breakable && status == CDEM_OK; g++)
    status = mark_group(cut, options->breakable_group[g], "breakable", -1, label, fault);
  for (int g = 0; g < options->separate && status == CDEM_OK; g++)
    status = mark_group(cut, options->separate_group[g], "separate", g + 1, label, fault);
  if (status == CDEM_OK)
    join_cells(cut, label);
  free(label);
  return status;
}

static void release_cut(cdem_cut *cut) {
  free(cut->cell);
  free(cut->position);
  free(cut->slot_start);
  free(cut->slot_cell);
  free(cut->mate);
  free(cut->joint);
  free(cut->cut);
  free(cut->entry);
  free(cut->block);
  free(cut->corner_start);
  free(cut->corner_node);
  free(cut->new_cell);
}

static cdem_status cut_all(cdem_cut *cut, const cdem_blocks_options *options, cdem_blocks *blocks,
                           cdem_fault *fault) {
  CDEM_TRY(cdem_cut_choose(cut, options, fault));
  CDEM_TRY(cdem_cut_match(cut, fault));
  CDEM_TRY(cdem_cut_joints(cut, options, fault));
  CDEM_TRY(cdem_cut_blocks(cut, options, fault));
  blocks->dimension = cut->dimension;
  blocks->blocks = cut->blocks;
  CDEM_TRY(cdem_cut_nodes(cut, blocks, fault));
  CDEM_TRY(cdem_cut_cells(cut, blocks, fault));
  CDEM_TRY(cdem_cut_groups(cut, blocks, fault));
  return cdem_cut_facets(cut, blocks, fault);
}

cdem_status cdem_blocks_init(const cdem_blocks_options *options, cdem_blocks *blocks,
                             cdem_fault *fault) {
  *blocks = (cdem_blocks){0};
  cdem_cut cut = {.mesh = options->mesh};
  cdem_status status = cut_all(&cut, options, blocks, fault);
  release_cut(&cut);
  if (status != CDEM_OK)
    cdem_blocks_release(blocks);
  return status;
}

void cdem_blocks_release(cdem_blocks *blocks) {
  if (blocks == NULL)
    return;
  cdem_mesh_release(&blocks->mesh);
  free(blocks->original);
  free(blocks->old_cell);
  free(blocks->block);
  free(blocks->node_block);
  free(blocks->pair);
  free(blocks->facet);
  free(blocks->pair_facet);
  *blocks = (cdem_blocks){0};
}
