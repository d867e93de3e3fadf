/* Writes 256 spheres of a close packing in a box of six walls as LAMMPS reads them, runs them in
 * our solver, and prints what came of each: id, place, velocity, spin, force.
 *
 *     test_cli_grains pressed|loose|held|finer STEPS DATA >STATE
 *     test_cli_grains numbers pressed|loose|held|finer
 *
 * pressed: overlaps of 1e-3 radii, for forces. loose: gaps and ways of 1e-6 radii, for motion:
 * there LAMMPS' arms (the radii) and ours (to the contact point) differ by no more than that. */
#include "base/random.h"
#include "dem/dem.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846, radius = 0.01, density = 2600.0, kn = 1e6;
static const double friction = 0.5, damping = 0.1;
enum { CELLS = 4 };

static void need(cdem_status status, const cdem_fault *fault) {
  if (status == CDEM_OK)
    return;
  fprintf(stderr, "error: %s\n", fault->message);
  exit(1);
}

/* Spacing over touching, less one; shaking over the radius; speeds (m/s) and spins (rad/s). */
typedef struct {
  double gap, shake, speed, spin;
} kind;

static kind kind_of(const char *name) {
  if (strcmp(name, "pressed") == 0)
    return (kind){-1e-3, 2e-4, 0.1, 10.0};
  if (strcmp(name, "held") == 0)
    return (kind){-2e-6, 5e-7, 1e-5, 1e-3};
  if (strcmp(name, "finer") == 0)
    return (kind){-2e-7, 5e-8, 1e-6, 1e-4};
  return (kind){1e-6, 1e-6, 1e-4, 1e-2};
}

static double width(const kind *k) {
  return 2.0 * radius + (CELLS - 0.5) * 2.0 * sqrt(2.0) * radius * (1.0 + k->gap);
}

static void pack(const kind *k, cdem_grains *grains) {
  static const double corner[4][3] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
  const double edge = 2.0 * sqrt(2.0) * radius * (1.0 + k->gap);
  cdem_fault fault = {0};
  cdem_random random = {11};
  for (int n = 0; n < 4 * CELLS * CELLS * CELLS; n++) {
    int cell = n / 4, place[3] = {cell % CELLS, cell / CELLS % CELLS, cell / CELLS / CELLS};
    double x[3];
    for (int d = 0; d < 3; d++)
      x[d] = radius + (place[d] + corner[n % 4][d]) * edge +
             cdem_random_uniform(&random, -k->shake, k->shake) * radius;
    need(cdem_grains_add(grains, x, radius, &fault), &fault);
  }
  need(cdem_grains_complete(grains, &fault), &fault);
  for (int64_t i = 0; i < 3 * grains->grains; i++) {
    grains->velocity[i] = cdem_random_uniform(&random, -k->speed, k->speed);
    grains->spin[i] = cdem_random_uniform(&random, -k->spin, k->spin);
  }
}

static void write_data(const char *path, double side, const cdem_grains *g) {
  FILE *file = fopen(path, "w");
  if (file == NULL)
    exit(1);
  fprintf(file, "spheres\n\n%" PRId64 " atoms\n1 atom types\n", g->grains);
  for (int d = 0; d < 3; d++)
    fprintf(file, "0 %.17g %clo %chi\n", side, "xyz"[d], "xyz"[d]);
  fprintf(file, "\nAtoms\n\n");
  for (int64_t i = 0; i < g->grains; i++)
    fprintf(file, "%" PRId64 " 1 %.17g %.17g %.17g %.17g %.17g\n", i + 1, 2.0 * radius, density,
            g->xyz[3 * i], g->xyz[3 * i + 1], g->xyz[3 * i + 2]);
  fprintf(file, "\nVelocities\n\n");
  for (int64_t i = 0; i < g->grains; i++)
    fprintf(file, "%" PRId64 " %.17g %.17g %.17g %.17g %.17g %.17g\n", i + 1, g->velocity[3 * i],
            g->velocity[3 * i + 1], g->velocity[3 * i + 2], g->spin[3 * i], g->spin[3 * i + 1],
            g->spin[3 * i + 2]);
  fclose(file);
}

static void run(const cdem_grains *grains, double side, int64_t steps) {
  cdem_fault fault = {0};
  cdem_grain_material material = {
      .name = "grain", .density = density, .young = NAN, .poisson = NAN};
  cdem_contact_input contact;
  cdem_wall wall[6];
  for (int i = 0; i < CDEM_LAW_KEYS; i++)
    contact.value[i] = NAN;
  contact.value[CDEM_LAW_normal_stiffness] = kn;
  contact.value[CDEM_LAW_shear_ratio] = 2.0 / 7.0;
  contact.value[CDEM_LAW_friction] = friction;
  contact.value[CDEM_LAW_damping_ratio] = damping;
  contact.value[CDEM_LAW_shear_dashpot] = 0.0;
  for (int i = 0; i < 6; i++) {
    wall[i] = (cdem_wall){.name = "wall", .shape = CDEM_WALL_PLANE};
    wall[i].center[i / 2] = i % 2 * side;
    wall[i].normal[i / 2] = i % 2 == 0 ? 1.0 : -1.0;
  }
  cdem_dem_options options = {.grains = grains,
                              .materials = 1,
                              .material = &material,
                              .law = cdem_law_find("linear"),
                              .contact = &contact,
                              .walls = 6,
                              .wall = wall,
                              .step = 1e-5};
  cdem_dem dem;
  need(cdem_dem_init(&options, &dem, &fault), &fault);
  need(cdem_dem_steps(&dem, steps, &fault), &fault);
  size_t n = (size_t)dem.grains;
  double *all = calloc(12 * n, sizeof *all);
  if (all == NULL)
    exit(1);
  cdem_dem_look(
      &dem, &(cdem_dem_view){
                .xyz = all, .velocity = all + 3 * n, .spin = all + 6 * n, .force = all + 9 * n});
  for (size_t i = 0; i < n; i++) {
    printf("%zu", i + 1);
    for (size_t k = 0; k < 12; k++)
      printf(" %.17g", all[3 * n * (k / 3) + 3 * i + k % 3]);
    printf("\n");
  }
  free(all);
  cdem_dem_release(&dem);
}

int main(int argc, char **argv) {
  if (argc == 3 && strcmp(argv[1], "numbers") == 0) {
    kind k = kind_of(argv[2]);
    double mass = density * 4.0 / 3.0 * pi * radius * radius * radius;
    printf(
        "-var kn %.17g -var kt %.17g -var mu %.17g -var gn %.17g -var gw %.17g -var width %.17g\n",
        kn, kn * 2.0 / 7.0, friction, 2.0 * damping * sqrt(2.0 * kn / mass),
        2.0 * damping * sqrt(kn / mass), width(&k));
    return 0;
  }
  if (argc != 4)
    return 2;
  kind k = kind_of(argv[1]);
  cdem_grains grains = {.dim = 3};
  pack(&k, &grains);
  write_data(argv[3], width(&k), &grains);
  run(&grains, width(&k), strtoll(argv[2], NULL, 10));
  cdem_grains_release(&grains);
  return 0;
}
