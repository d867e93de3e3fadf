#include "rebuild_case.h"

#include "support/test.h"

#include <string.h>

static const double young = 4e10, shear_coupling = 3e9, couple_length = 0.4, thickness = 0.37;

static void option(rebuild_body *body, const char *name, const char *value) {
  assert_true(body->options + 2 < REBUILD_MAX_OPTIONS);
  body->option[body->options++] = name;
  if (value != NULL)
    body->option[body->options++] = value;
}

static void number_option(rebuild_body *body, int slot, const char *name, double value) {
  snprintf(body->text[slot], sizeof body->text[slot], "%.17g", value);
  option(body, name, body->text[slot]);
}

/* What stands in a material file; `indent` before every key. */

/* Axis 1 is not of unit length and axis 2 leans towards it: the program makes them orthonormal. */
static void write_axes(FILE *file, const char *indent, uint64_t *seed, double moduli[6][6]) {
  double axis[3][3];
  rebuild_random_axes(seed, 3, axis);
  for (int k = 0; k < 2; k++)
    fprintf(file, "%saxis%d: [%.17g, %.17g, %.17g]\n", indent, k + 1, axis[k][0] + axis[0][0] / 2,
            axis[k][1] + axis[0][1] / 2, axis[k][2] + axis[0][2] / 2);
  reference_turn(moduli, axis);
}

static void write_orthotropic(FILE *file, const char *indent, uint64_t *seed, double moduli[6][6]) {
  static const char *const key[9] = {"e1", "e2", "e3", "nu12", "nu13", "nu23", "g12", "g13", "g23"};
  static const double value[9] = {10e9, 6e9, 3e9, 0.2, 0.3, 0.25, 2.5e9, 1.7e9, 1.1e9};
  fprintf(file, "%smodel: orthotropic\n", indent);
  for (int k = 0; k < 9; k++)
    fprintf(file, "%s%s: %.17g\n", indent, key[k], value[k]);
  reference_orthotropic(value, moduli);
  write_axes(file, indent, seed, moduli);
}

/* 21 different constants: turned orthotropic ones, each moved a little; positive definite because
 * the movement stays below the smallest modulus. */
static void write_anisotropic(FILE *file, const char *indent, uint64_t *seed, double moduli[6][6]) {
  static const double value[9] = {30e9, 22e9, 17e9, 0.2, 0.3, 0.25, 9e9, 7e9, 8e9};
  double axis[3][3];
  reference_orthotropic(value, moduli);
  rebuild_random_axes(seed, 3, axis);
  reference_turn(moduli, axis);
  fprintf(file, "%smodel: anisotropic\n", indent);
  for (int a = 0; a < 6; a++)
    for (int b = a; b < 6; b++) {
      moduli[a][b] += 5e8 * rebuild_random(seed);
      moduli[b][a] = moduli[a][b];
      fprintf(file, "%sc%d%d: %.17g\n", indent, a + 1, b + 1, moduli[a][b]);
    }
  write_axes(file, indent, seed, moduli);
}

/* D11 = lambda + 2 G, D12 = lambda, D1212 = G + Gc, D1221 = G - Gc, couple f G l^2; in plane stress
 * sigma_zz = 0 makes 2 G lambda / (lambda + 2 G) of lambda. */
static void isotropic_cosserat(const rebuild_case *c, double moduli[6][6]) {
  double shear = young / (2 * (1 + c->poisson));
  double lambda = young * c->poisson / ((1 + c->poisson) * (1 - 2 * c->poisson));
  if (c->plane_stress)
    lambda = 2 * shear * lambda / (lambda + 2 * shear);
  double constants[5] = {lambda + 2 * shear, lambda, shear + shear_coupling, shear - shear_coupling,
                         c->couple_factor * shear * couple_length * couple_length};
  reference_cosserat_cubic(constants, moduli);
}

static void write_cosserat(const rebuild_case *c, FILE *file, rebuild_body *body) {
  if (c->material == MATERIAL_COSSERAT_FILE) {
    fprintf(file,
            "model: cosserat\nyoung: %.17g\npoisson: %.17g\ncosserat_modulus: %.17g\n"
            "characteristic_length: %.17g\ncouple_factor: %.17g\n",
            young, c->poisson, shear_coupling, couple_length, c->couple_factor);
    isotropic_cosserat(c, body->material[0].cosserat);
    return;
  }
  static const double value[5] = {150e6, 100e6, 140e6, 90e6, 6e6};
  fprintf(file,
          "model: cosserat-cubic\nd11: %.17g\nd12: %.17g\nd1212: %.17g\nd1221: %.17g\n"
          "couple_modulus: %.17g\n",
          value[0], value[1], value[2], value[3], value[4]);
  reference_cosserat_cubic(value, body->material[0].cosserat);
}

static void write_by_group(FILE *file, uint64_t *seed, rebuild_body *body) {
  body->mesh.groups = 2;
  body->mesh.group[1] = "rock";
  body->mesh.group[2] = "soft layer";
  fputs("materials:\n  bedded rock:\n", file);
  write_orthotropic(file, "    ", seed, body->material[1].moduli);
  fprintf(file, "  clay: {young: %.17g, poisson: %.17g}\n  crystal:\n", young / 7, 0.44);
  reference_isotropic(young / 7, 0.44, body->material[2].moduli);
  write_anisotropic(file, "    ", seed, body->material[0].moduli);
  fputs("groups: {rock: bedded rock, soft layer: clay}\ndefault: crystal\n", file);
}

static void write_ratios(const rebuild_case *c, FILE *file, rebuild_body *body) {
  static const char *const name[] = {"", "a", "b", "c", "d", "e", "f", "g", "h", "i"};
  rebuild_mesh *mesh = &body->mesh;
  for (int k = 0; k < mesh->cells; k++)
    mesh->groups = mesh->cell[k].group > mesh->groups ? mesh->cell[k].group : mesh->groups;
  fputs("materials:\n", file);
  for (int g = 1; g <= mesh->groups; g++) {
    mesh->group[g] = name[g];
    fprintf(file, "  m%s: {young: %.17g, poisson: %.17g}\n", name[g], young, c->ratio[g - 1]);
    reference_isotropic(young, c->ratio[g - 1], body->material[g].moduli);
  }
  fputs("groups:\n", file);
  for (int g = 1; g <= mesh->groups; g++)
    fprintf(file, "  %s: m%s\n", name[g], name[g]);
}

static void material_options(const rebuild_case *c, rebuild_body *body) {
  if (c->material != MATERIAL_ISOTROPIC && c->material != MATERIAL_COSSERAT) {
    option(body, "--material", body->material_file);
    FILE *file = fopen(body->material_file, "w");
    assert_non_null(file);
    if (c->material == MATERIAL_ORTHOTROPIC)
      write_orthotropic(file, "", &body->mesh.seed, body->material[0].moduli);
    else if (c->material == MATERIAL_ANISOTROPIC)
      write_anisotropic(file, "", &body->mesh.seed, body->material[0].moduli);
    else if (c->material == MATERIAL_RATIOS)
      write_ratios(c, file, body);
    else if (c->material == MATERIAL_BY_GROUP)
      write_by_group(file, &body->mesh.seed, body);
    else
      write_cosserat(c, file, body);
    assert_int_equal(fclose(file), 0);
    return;
  }
  number_option(body, 0, "-E", young);
  number_option(body, 1, "--nu", c->poisson);
  reference_isotropic(young, c->poisson, body->material[0].moduli);
  if (c->material == MATERIAL_COSSERAT) {
    number_option(body, 2, "--cosserat-modulus", shear_coupling);
    number_option(body, 3, "--characteristic-length", couple_length);
    if (c->couple_factor != 1)
      number_option(body, 4, "--couple-factor", c->couple_factor);
    isotropic_cosserat(c, body->material[0].cosserat);
  }
}

/* Three materials: the first three boxes are in 1, 2, 1, the others in no group. */
static int group_of_box(const rebuild_case *c, int box) {
  static const int group[3] = {1, 2, 1};
  if (c->material == MATERIAL_RATIOS)
    return box + 1;
  return c->material == MATERIAL_BY_GROUP && box < 3 ? group[box] : 0;
}

static void make_mesh(const rebuild_case *c, rebuild_mesh *mesh) {
  static const double square[3] = {1, 1, 1}, stretched[3] = {1.3, 0.8, 1.1};
  char kinds[128], *rest = NULL;
  mesh->seed = 1;
  for (const char *at = c->name; *at != '\0'; at++)
    mesh->seed = mesh->seed * 131 + (unsigned char)*at;
  snprintf(kinds, sizeof kinds, "%s", c->kinds);
  int box = 0;
  for (char *kind = strtok_r(kinds, " ", &rest); kind != NULL;
       kind = strtok_r(NULL, " ", &rest), box++)
    rebuild_mesh_add_box(mesh, kind, box, group_of_box(c, box));
  rebuild_mesh_distort(mesh, c->amount, c->amount > 0 ? stretched : square);
}

void rebuild_body_make(const rebuild_case *c, const char *folder, rebuild_body *body) {
  char path[512];
  memset(body, 0, sizeof *body);
  make_mesh(c, &body->mesh);
  snprintf(body->material_file, sizeof body->material_file, "%s/%s.yaml", folder, c->name);
  material_options(c, body);
  bool plane = body->mesh.dimension == 2;
  if (plane) {
    if (c->plane_stress)
      option(body, "--plane=stress", NULL);
    number_option(body, 5, "--thickness", thickness);
  }
  for (int g = 0; g <= body->mesh.groups; g++) {
    body->material[g].plane_stress = c->plane_stress;
    body->material[g].thickness = thickness;
  }
  if (c->length > 0)
    number_option(body, 6, "--length", c->length);
  if (c->frame != NULL)
    option(body, "--frame", c->frame);
  if (c->group != NULL)
    option(body, "--group", c->group);
  snprintf(path, sizeof path, "%s/%s.msh", folder, c->name);
  assert_true(rebuild_mesh_write(&body->mesh, path));
}

bool rebuild_cell_is_taken(const rebuild_case *c, const rebuild_mesh *mesh, int cell) {
  int group = mesh->cell[cell].group;
  return c->group == NULL || (group > 0 && strcmp(mesh->group[group], c->group) == 0);
}
