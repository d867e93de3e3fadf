/* Some hundred grains of different sizes: conservation, the energy book, and bits. */
#include "base/bits.h"
#include "base/memory.h"
#include "base/random.h"
#include "verify/dem.h"
#include "verify/dem_world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  int dim, side; /* grains a side of the lattice they start from */
  const char *law;
  bool box;       /* gravity and walls; else a free cloud that falls together */
  bool backwards; /* numbered the other way round */
  bool energies;
  double length, time, mass; /* units, SI = 1 */
  int threads;
} assembly;

static const assembly plain = {
    .dim = 3, .side = 6, .law = "linear", .length = 1.0, .time = 1.0, .mass = 1.0, .threads = 1};

static void words(cdem_dem_world *world, const assembly *a) {
  double stiffness = a->mass / (a->time * a->time) * (a->dim == 2 ? 1e7 : 1e5);
  bool li_chu = strcmp(a->law, "li-chu") == 0, hertz = strcmp(a->law, "hertz") == 0;
  double pressure = a->mass / (a->length * a->time * a->time);
  cdem_dem_world_set(world, CDEM_LAW_friction, 0.4);
  cdem_dem_world_elastic(world, 1e8 * pressure, 0.25, 1.0);
  if (!hertz)
    cdem_dem_world_set(world, CDEM_LAW_normal_stiffness, stiffness);
  if (!li_chu) {
    cdem_dem_world_set(world, CDEM_LAW_restitution, 0.6);
    return;
  }
  cdem_dem_world_set(world, CDEM_LAW_shear_stiffness, 0.2 * stiffness);
  cdem_dem_world_set(world, CDEM_LAW_normal_dashpot, 5e-6 * stiffness * a->time);
  cdem_dem_world_set(world, CDEM_LAW_rolling_stiffness, 1e-6 * stiffness * a->length * a->length);
  cdem_dem_world_set(world, CDEM_LAW_rolling_length, 1e-4 * a->length);
  if (a->box) { /* F_r makes or takes energy: its own line in the book */
    cdem_dem_world_set(world, CDEM_LAW_rolling_force_stiffness, 0.1 * stiffness);
    cdem_dem_world_set(world, CDEM_LAW_rolling_force_friction, 0.1);
  }
}

/* A lattice of spacing 2.1 largest radii, shaken; radii between half of it and all. */
static cdem_status add_grains(cdem_dem_world *world, const assembly *a, cdem_fault *fault) {
  const double largest = 0.01, spacing = 2.1 * largest, middle = 0.5 * a->side * spacing;
  int count = a->dim == 2 ? a->side * a->side : a->side * a->side * a->side;
  for (int n = 0; n < count; n++) {
    int at = a->backwards ? count - 1 - n : n,
        place[3] = {at % a->side, at / a->side % a->side, at / a->side / a->side};
    cdem_random random = {1000u + (uint64_t)at};
    double x[3] = {0}, v[3] = {0}, w[3] = {0};
    double r = largest * cdem_random_uniform(&random, 0.5, 1.0);
    for (int d = 0; d < a->dim; d++) {
      double y = (place[d] + 0.5) * spacing + cdem_random_uniform(&random, -0.05, 0.05) * largest;
      x[d] = y * a->length;
      v[d] = ((a->box ? 0.0 : 5.0 * (middle - y)) + cdem_random_uniform(&random, -0.2, 0.2)) *
             a->length / a->time;
    }
    for (int d = a->dim == 2 ? 2 : 0; d < 3; d++)
      w[d] = cdem_random_uniform(&random, -20.0, 20.0) / a->time;
    CDEM_TRY(cdem_dem_world_add(world, x, r * a->length, v, w, fault));
  }
  for (int d = 0; d < a->dim && a->box; d++)
    for (int end = 0; end < (d == a->dim - 1 ? 1 : 2); end++) {
      double center[3] = {0}, normal[3] = {0};
      center[d] = end * a->side * spacing * a->length;
      normal[d] = end == 0 ? 1.0 : -1.0;
      CDEM_TRY(cdem_dem_world_plane(world, center, normal, fault));
    }
  return CDEM_OK;
}

static cdem_status start(const assembly *a, cdem_dem_world *world, cdem_fault *fault) {
  double density = 2600.0 * a->mass / (a->length * a->length * a->length);
  CDEM_TRY(cdem_dem_world_init(world, a->dim, a->law, density, fault));
  words(world, a);
  if (a->box) {
    world->options.gravity[a->dim - 1] = -9.81 * a->length / (a->time * a->time);
    if (strcmp(a->law, "linear") == 0 && a->dim == 3) {
      world->options.rolling = cdem_rolling_find("spring");
      cdem_dem_world_set(world, CDEM_LAW_rolling_friction, 0.05);
    }
  }
  CDEM_TRY(add_grains(world, a, fault));
  world->options.thickness = a->length;
  world->options.step = (a->energies || !a->box ? 1e-5 : 2e-5) * a->time;
  world->options.threads = a->threads;
  world->options.energies = a->energies;
  return cdem_dem_world_start(world, fault);
}

/* ---- conservation ---- */

static double change(const double before[3], const double after[3]) {
  double sum = 0.0;
  for (int d = 0; d < 3; d++)
    sum += (after[d] - before[d]) * (after[d] - before[d]);
  return sqrt(sum);
}

/* Sums of absolute values: what the change is measured against. */
static cdem_status scales(const cdem_dem *dem, double *linear, double *angular, cdem_fault *fault) {
  double *all = NULL;
  int64_t n = dem->grains;
  CDEM_NEW(all, 11 * n, fault);
  double *xyz = all, *v = all + 3 * n, *w = all + 6 * n, *mass = all + 9 * n, *inertia = mass + n;
  cdem_dem_look(dem, &(cdem_dem_view){
                         .xyz = xyz, .velocity = v, .spin = w, .mass = mass, .inertia = inertia});
  *linear = *angular = 0.0;
  for (int64_t i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) {
      *linear += mass[i] * fabs(v[3 * i + d]);
      *angular += mass[i] * fabs(v[3 * i + d]) * fabs(xyz[3 * i + (d + 1) % 3]) +
                  inertia[i] * fabs(w[3 * i + d]);
    }
  free(all);
  return CDEM_OK;
}

static cdem_status drift(cdem_dem_world *world, double drifts[2], cdem_fault *fault) {
  double linear[2][3], angular[2][3], scale[2];
  CDEM_TRY(scales(&world->dem, &scale[0], &scale[1], fault));
  cdem_dem_momentum(&world->dem, linear[0], angular[0]);
  CDEM_TRY(cdem_dem_steps(&world->dem, 2000, fault));
  cdem_dem_momentum(&world->dem, linear[1], angular[1]);
  drifts[0] = change(linear[0], linear[1]) / scale[0];
  drifts[1] = change(angular[0], angular[1]) / scale[1];
  return CDEM_OK;
}

cdem_status cdem_dem_measure_cloud(int parameter, double *value, cdem_fault *fault) {
  assembly a = plain;
  if (parameter >= 2 && parameter <= 4)
    a.dim = 2, a.side = 14;
  a.law = parameter == 4 ? "li-chu" : parameter == 5 ? "hertz" : "linear";
  cdem_dem_world world;
  double drifts[2] = {0};
  cdem_status status = start(&a, &world, fault);
  if (status == CDEM_OK)
    status = drift(&world, drifts, fault);
  *value = drifts[parameter != 0 && parameter != 2];
  cdem_dem_world_release(&world);
  return status;
}

/* ---- energy ---- */

cdem_status cdem_dem_measure_book(int parameter, double *value, cdem_fault *fault) {
  assembly a = plain;
  a.box = a.energies = true;
  if (parameter >= 2)
    a.dim = 2, a.side = 14;
  a.law = parameter == 1 ? "hertz" : parameter == 3 ? "li-chu" : "linear";
  cdem_dem_world world;
  cdem_dem_energies e = {0};
  double worst = 0.0;
  cdem_status status = start(&a, &world, fault);
  for (int i = 0; i < 40 && status == CDEM_OK; i++) {
    status = cdem_dem_steps(&world.dem, 100, fault);
    if (status == CDEM_OK)
      cdem_dem_energies_now(&world.dem, &e);
    worst = fmax(worst, fabs(e.error));
  }
  /* Of the work that gravity did and the energy there was at the start. */
  *value = worst / (fabs(e.gravity) + e.initial);
  cdem_dem_world_release(&world);
  return status;
}

/* ---- bits ---- */

/* Places, velocities and spins in the units of the assembly, by the number a grain has when counted
 * forwards: [3][grains][3]. */
static cdem_status state_of(const assembly *a, const cdem_dem *dem, double **state,
                            cdem_fault *fault) {
  const int64_t n = dem->grains;
  const double unit[3] = {a->length, a->length / a->time, 1.0 / a->time};
  double *now = NULL;
  CDEM_NEW(*state, 9 * n, fault);
  CDEM_NEW(now, 9 * n, fault);
  cdem_dem_look(dem, &(cdem_dem_view){.xyz = now, .velocity = now + 3 * n, .spin = now + 6 * n});
  for (int64_t i = 0; i < 9 * n; i++) {
    int64_t array = i / (3 * n), grain = i / 3 % n;
    int64_t at = array * n + (a->backwards ? n - 1 - grain : grain);
    (*state)[3 * at + i % 3] = now[i] / unit[array];
  }
  free(now);
  return CDEM_OK;
}

static cdem_status run_for_bits(const assembly *a, int64_t steps, int64_t *count, double **state,
                                cdem_fault *fault) {
  cdem_dem_world world;
  cdem_status status = start(a, &world, fault);
  if (status == CDEM_OK)
    status = cdem_dem_steps(&world.dem, steps, fault);
  if (status == CDEM_OK)
    status = state_of(a, &world.dem, state, fault);
  *count = 9 * world.dem.grains;
  cdem_dem_world_release(&world);
  return status;
}

cdem_status cdem_dem_measure_bits(int parameter, double *value, cdem_fault *fault) {
  assembly a = plain, b = plain;
  a.box = b.box = true;
  a.side = b.side = 8; /* several chunks of grains */
  const int64_t steps =
      parameter == 0 ? 400 : 1200; /* busy cores make threads wait for each other */
  if (parameter == 0)
    b.threads = 2;
  if (parameter == 1)
    b.backwards = true;
  if (parameter == 2)
    b.length = 0.125, b.time = 4.0, b.mass = 1024.0;
  double *one = NULL, *two = NULL;
  int64_t count = 0;
  cdem_status status = run_for_bits(&a, steps, &count, &one, fault);
  if (status == CDEM_OK)
    status = run_for_bits(&b, steps, &count, &two, fault);
  *value = 0.0;
  for (int64_t i = 0; i < count && status == CDEM_OK; i++)
    *value += !cdem_same_bits(one[i], two[i]);
  free(one);
  free(two);
  return status;
}
