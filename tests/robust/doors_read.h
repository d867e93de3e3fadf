/* Doors through which files come in: what is read is empty after a failure. */
#ifndef CDEM_TESTS_ROBUST_DOORS_READ_H
#define CDEM_TESTS_ROBUST_DOORS_READ_H

#include "cases/places.h"
#include "io/case_file.h"
#include "io/grains_file.h"
#include "io/io.h"
#include "io/run_files.h"
#include "robust/door.h"

/* A thing that is zero when it is empty is untouched or released. */
#define check_empty(thing, of)                                                                     \
  do {                                                                                             \
    static const of zero;                                                                          \
    assert_memory_equal(&(thing), &zero, sizeof zero);                                             \
  } while (0)

/* ---- meshes ---- */

static cdem_mesh door_mesh;

static uint64_t fold_mesh(uint64_t sum, const cdem_mesh *mesh) {
  sum = fold(sum, mesh->xyz, 3 * sizeof(double) * (size_t)mesh->nodes);
  sum = fold(sum, mesh->node_tag, sizeof(int64_t) * (size_t)mesh->nodes);
  sum = fold(sum, mesh->cell_shape, (size_t)mesh->cells);
  sum = fold(sum, mesh->cell_node, sizeof(int32_t) * (size_t)mesh->cell_start[mesh->cells]);
  for (int32_t g = 0; g < mesh->groups; g++) {
    sum = fold_text(sum, mesh->group[g].name);
    sum = fold(sum, mesh->group[g].cell, sizeof(int32_t) * (size_t)mesh->group[g].cells);
  }
  return sum;
}

static cdem_status read_mesh(const door *d, cdem_fault *fault) {
  return cdem_read_mesh(d->text, &door_mesh, NULL, fault);
}

static cdem_status read_parameters(const door *d, cdem_fault *fault) {
  const char *const name[] = {"n"};
  const double value[] = {5.0};
  return cdem_read_mesh_with(d->text, 1, name, value, &door_mesh, NULL, fault);
}

static uint64_t mesh_result(const door *d) {
  (void)d;
  uint64_t sum = fold_mesh(sum_start, &door_mesh);
  cdem_mesh_release(&door_mesh);
  return sum;
}

static void mesh_failed(const door *d) {
  (void)d;
  check_empty(door_mesh, cdem_mesh);
}

static const door_kind mesh_file = {NULL, read_mesh, mesh_result, mesh_failed, NULL, false};
/* The small file that gives gmsh the parameter does not last, but must be written. */
static const door_kind mesh_with = {NULL, read_parameters, mesh_result, mesh_failed, NULL, true};

/* ---- materials ---- */

static cdem_material_file door_materials;

static void materials_before(const door *d) {
  (void)d;
  door_materials = (cdem_material_file){0};
}

static cdem_status read_materials(const door *d, cdem_fault *fault) {
  return cdem_read_materials(d->text, &door_materials, fault);
}

static uint64_t materials_result(const door *d) {
  (void)d;
  uint64_t sum = sum_start;
  for (int i = 0; i < door_materials.materials; i++) {
    const cdem_material *m = &door_materials.material[i];
    sum = fold(fold_text(sum, m->name), m->parameter, sizeof m->parameter);
  }
  for (int i = 0; i < door_materials.assignments; i++)
    sum = fold_text(sum, door_materials.group[i]);
  cdem_material_file_release(&door_materials);
  return sum;
}

static void materials_failed(const door *d) {
  (void)d;
  check_empty(door_materials, cdem_material_file);
}

static const door_kind material_file = {materials_before, read_materials, materials_result,
                                        materials_failed, NULL,           false};

/* ---- cases ---- */

static cdem_case door_case;

static cdem_status read_case(const door *d, cdem_fault *fault) {
  int overrides = d->set[0] != NULL ? d->set[1] != NULL ? 2 : 1 : 0;
  return cdem_read_case(d->text, overrides, d->set, &door_case, fault);
}

static uint64_t case_result(const door *d) {
  (void)d;
  uint64_t sum = fold_text(sum_start, door_case.source);
  for (int64_t i = 0; i < door_case.places->quantities; i++) {
    const cdem_case_quantity *q = &door_case.places->quantity[i];
    sum = fold(fold_text(sum, q->key), &q->value, sizeof q->value);
  }
  cdem_case_release(&door_case);
  return sum;
}

static void case_failed(const door *d) {
  (void)d;
  assert_true(door_case.path == NULL && door_case.source == NULL && door_case.places == NULL);
}

static const door_kind case_file = {NULL, read_case, case_result, case_failed, NULL, false};

/* ---- grains ---- */

static cdem_grain_table door_table;

static cdem_status read_grains(const door *d, cdem_fault *fault) {
  return cdem_read_grains(d->text, 0, &door_table, fault);
}

static uint64_t fold_grains(uint64_t sum, const cdem_grains *grains) {
  sum = fold(sum, grains->xyz, 3 * sizeof(double) * (size_t)grains->grains);
  return fold(sum, grains->radius, sizeof(double) * (size_t)grains->grains);
}

static uint64_t table_result(const door *d) {
  (void)d;
  uint64_t sum = fold_grains(sum_start, &door_table.grains);
  for (int64_t i = 0; i < door_table.names; i++)
    sum = fold_text(sum, door_table.name[i]);
  cdem_grain_table_release(&door_table);
  return sum;
}

static void table_failed(const door *d) {
  (void)d;
  check_empty(door_table, cdem_grain_table);
}

static const door_kind grain_table = {NULL, read_grains, table_result, table_failed, NULL, false};

/* ---- a quantity with its unit ---- */

static double door_value;

static void value_before(const door *d) {
  (void)d;
  door_value = -1.0;
}

static cdem_status read_value(const door *d, cdem_fault *fault) {
  return cdem_parse_quantity(d->text, CDEM_PRESSURE, &door_value, fault);
}

static uint64_t value_result(const door *d) {
  (void)d;
  return fold(sum_start, &door_value, sizeof door_value);
}

static const door_kind quantity = {value_before, read_value, value_result, NULL, NULL, false};

#endif
