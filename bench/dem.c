/* How many particle-steps a second: a lattice of discs pushed by a plate, and equal spheres settled
 * in a box. For each the rate with one and two threads, the time a contact
 * takes, what each phase takes (of one thread, with clocks in between, which cost a little
 * themselves), the plain reference and the book of energies beside; and two limits:
 *
 * - bytes: what a step must read and write at least, each array once in each of its two sweeps (of
 *   moving and of forces), at the rate of a triad a = b + s c on arrays of that size all together;
 * - flops: of motion, candidates and contacts, counted in the source (a root or division counts
 *   one), at the rate of independent multiply-adds.
 *
 * "of limit" is the larger limit over the time taken. Times are processor times with one thread and
 * the best of many short runs, because other work on the machine only ever adds.
 *
 * usage: bench_dem [WORK GRAINS]...     works are lattice and box */
#include "dem/dem.h"

#include "base/random.h"
#include "base/simd.h"
#include "bench.h"
#include "dem/solver_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { PHASES = 8 };

/* With one thread its processor time, which a loaded machine leaves alone. */
static double now(bool alone) {
  return clock_now(alone ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC);
}

typedef struct {
  const char *name;
  cdem_grains grains;
  cdem_wall wall[6];
  int walls;
  cdem_series push;
  double push_time, push_value;
  cdem_grain_material material;
  cdem_contact_input contact;
  cdem_dem_options options;
} work;

static void add_wall(work *w, double x, double y, double z, double nx, double ny, double nz) {
  cdem_wall *wall = &w->wall[w->walls++];
  *wall = (cdem_wall){.name = "side", .shape = CDEM_WALL_PLANE};
  const double center[3] = {x, y, z}, normal[3] = {nx, ny, nz};
  memcpy(wall->center, center, sizeof center);
  memcpy(wall->normal, normal, sizeof normal);
}

static void law_of(work *w, double friction, double ratio, double restitution) {
  for (int k = 0; k < CDEM_LAW_KEYS; k++)
    w->contact.value[k] = NAN;
  w->contact.value[CDEM_LAW_normal_stiffness] = 1e6;
  w->contact.value[CDEM_LAW_shear_ratio] = ratio;
  w->contact.value[CDEM_LAW_friction] = friction;
  w->contact.value[CDEM_LAW_restitution] = restitution;
  w->material =
      (cdem_grain_material){.name = "grain", .density = 2600.0, .young = NAN, .poisson = NAN};
  w->options.grains = &w->grains;
  w->options.materials = 1;
  w->options.material = &w->material;
  w->options.contact = &w->contact;
  w->options.law = cdem_law_find("linear");
  w->options.wall = w->wall;
  w->options.walls = w->walls;
}

/* Spheres on a shaken lattice in a box. */
static void spheres(work *w, int64_t count, cdem_fault *fault) {
  const double r = 0.01, spacing = 2.2 * r;
  int side = (int)lround(0.93 * cbrt((double)count));
  cdem_random random = {.state = 7};
  w->grains.dim = 3;
  for (int64_t k = 0; k < count; k++) {
    double at[3] = {(double)(k % side), (double)(k / side % side), (double)(k / side / side)};
    for (int c = 0; c < 3; c++)
      at[c] = (at[c] + 0.5) * spacing + 0.09 * r * cdem_random_uniform(&random, -1.0, 1.0);
    give_up(cdem_grains_add(&w->grains, at, r, fault), fault);
  }
  double box = side * spacing;
  add_wall(w, 0, 0, 0, 0, 0, 1);
  add_wall(w, 0, 0, 0, 1, 0, 0);
  add_wall(w, 0, 0, 0, 0, 1, 0);
  add_wall(w, box, 0, 0, -1, 0, 0);
  add_wall(w, 0, box, 0, 0, -1, 0);
  law_of(w, 0.5, 2.0 / 7.0, 0.5);
  /* A fixed step, because the automatic one is short while grains fall. */
  double kn = 2.5e5;
  w->contact.value[CDEM_LAW_normal_stiffness] = kn;
  w->options.step =
      0.2 * sqrt(w->material.density * 4.0 / 3.0 * acos(-1.0) * r * r * r / (2.0 * kn));
}

/* Without friction grains pack densely, with nearly six contacts each. They weigh tenfold: they
 * fall and collapse sooner, and contacts of the top layers are not as easily shaken open. */
static double settle(work *w, double *unbalanced, cdem_fault *fault) {
  double start = now(false);
  w->options.threads = 1; /* beside other work a team waits for its threads at every step */
  w->options.most_overlap = 0.5;
  w->options.gravity[2] = -98.1;
  w->contact.value[CDEM_LAW_friction] = 0.0;
  for (int stage = 0; stage < 2; stage++) {
    cdem_dem dem;
    w->options.local_damping = stage == 0 ? 0.3 : 0.7;
    give_up(cdem_dem_init(&w->options, &dem, fault), fault);
    give_up(cdem_dem_steps(&dem, stage == 0 ? 6000 : 2000, fault), fault);
    *unbalanced = cdem_dem_unbalanced(&dem);
    cdem_dem_look(&dem, &(cdem_dem_view){.xyz = w->grains.xyz});
    cdem_dem_release(&dem);
  }
  w->options.local_damping = 0.0;
  w->contact.value[CDEM_LAW_friction] = 0.5;
  return now(false) - start;
}

/* Rows at +-45 degrees, touching, on a floor between walls, pushed by a plate from above. */
static void discs(work *w, int64_t count, cdem_fault *fault) {
  const double r = 0.01, step = sqrt(2.0) * r;
  int columns = 200;
  w->grains.dim = 2;
  for (int64_t k = 0; k < count; k++) {
    int64_t row = k / columns;
    double at[3] = {r + (2.0 * (double)(k % columns) + (double)(row % 2)) * step,
                    r + (double)row * step, 0.0};
    give_up(cdem_grains_add(&w->grains, at, r * 1.0001, fault), fault);
  }
  double width = 2.0 * r + (2.0 * columns - 1.0) * step;
  double height = 2.0 * r + (double)((count - 1) / columns) * step;
  add_wall(w, 0, 0, 0, 0, 1, 0);
  add_wall(w, 0, 0, 0, 1, 0, 0);
  add_wall(w, width, 0, 0, -1, 0, 0);
  add_wall(w, 0, height - 0.001 * r, 0, 0, -1, 0);
  cdem_wall *plate = &w->wall[w->walls - 1];
  w->push_value = -0.05;
  plate->velocity[1] = (cdem_series){.points = 1, .time = &w->push_time, .value = &w->push_value};
  law_of(w, 0.5, 0.2, 0.9);
}

static int64_t pairs_touching(const cdem_dem_store *s) {
  int64_t touching = 0;
  for (int64_t p = 0; p < s->pairs; p++)
    touching += s->pair_touch[p] == 1;
  return touching;
}

static double rate_of(cdem_dem *dem, int64_t steps, bool alone, cdem_fault *fault) {
  double best = INFINITY;
  for (int round = 0; round < 60; round++) {
    double start = now(alone);
    give_up(cdem_dem_steps(dem, steps, fault), fault);
    best = fmin(best, now(alone) - start);
  }
  return best / (double)steps;
}

/* ---- limits ---- */

/* Bytes a step reads and writes, each array once in each sweep. */
static double bytes_of(const cdem_dem_store *s, double touching) {
  double place = 32.0, pack = 64.0, history = 8.0 * s->histories;
  double rows = (double)s->core->far_start[s->grains];
  double moving = 2.0 * (place + 3.0 * pack) + 4.0; /* motion, force, way since the last build */
  double forces = place + pack + 2.0 * pack;
  double candidate = 4.0 + 4.0 + 2.0 * 1.0, contact = 4.0 + 2.0 * history; /* target, history */
  return (double)s->grains * (moving + forces) + (double)s->pairs * candidate + touching * contact +
         4.0 * pack * rows;
}

static double flops_of(const cdem_dem_store *s, double touching) {
  double candidate = s->dim == 3 ? 9.0 : 7.0, contact = s->dim == 3 ? 240.0 : 100.0;
  return 30.0 * (double)s->grains + candidate * (double)s->pairs + contact * touching;
}

CDEM_MULTIVERSION static void triad(double *restrict a, const double *restrict b,
                                    const double *restrict c, int64_t count) {
  for (int64_t i = 0; i < count; i++)
    a[i] = b[i] + 3.0 * c[i];
}

/* Bytes a second, with arrays of so many bytes all together. */
static double triad_rate(double bytes, cdem_fault *fault) {
  int64_t count = (int64_t)(bytes / 24.0) + 64;
  double best = INFINITY, *a = cdem_allocate(3 * count, sizeof *a, fault);
  give_up(a == NULL ? CDEM_MEMORY : CDEM_OK, fault);
  for (int round = 0; round < 60; round++) {
    double start = now(true);
    for (int k = 0; k < 4; k++)
      triad(a, a + count, a + 2 * count, count);
    best = fmin(best, now(true) - start);
  }
  free(a);
  return 4.0 * 24.0 * (double)count / best;
}

CDEM_MULTIVERSION static void multiply_add(double *restrict x, int64_t times) {
  double lane[96];
  memcpy(lane, x, sizeof lane);
  for (int64_t t = 0; t < times; t++)
    for (int i = 0; i < 96; i++)
      lane[i] = lane[i] * 0.999 + 1e-3;
  memcpy(x, lane, sizeof lane);
}

/* Operations a second; a multiply-add counts two. */
static double flop_rate(void) {
  double best = INFINITY, x[96] = {0};
  for (int round = 0; round < 60; round++) {
    double start = now(true);
    multiply_add(x, 20000);
    best = fmin(best, now(true) - start);
  }
  return x[0] < 2.0 ? 96.0 * 2.0 * 20000.0 / best : 0.0;
}

/* ---- table ---- */

static void print_phases(cdem_dem *dem, int64_t steps, cdem_fault *fault) {
  double least[PHASES], part[PHASES], all = INFINITY;
  double each = 1e9 / ((double)steps * (double)dem->grains);
  for (int k = 0; k < PHASES; k++)
    least[k] = INFINITY;
  for (int round = 0; round < 100; round++) {
    memset(part, 0, sizeof part);
    dem->store->core->clock = part;
    double start = now(false);
    give_up(cdem_dem_steps(dem, steps, fault), fault);
    part[5] = now(false) - start;
    all = fmin(all, part[5]);
    for (int k = 0; k < 5; k++) {
      part[5] -= part[k];
      least[k] = fmin(least[k], part[k]);
    }
    least[5] = fmin(least[5], part[5]);
  }
  dem->store->core->clock = NULL;
  printf("#   ns a particle-step: candidates %.1f, fill %.1f, law %.1f, back %.1f, walls and bonds "
         "%.1f, motion and all else %.1f; all %.1f\n",
         least[0] * each, least[1] * each, least[2] * each, least[3] * each, least[4] * each,
         least[5] * each, all * each);
}

static void print_limits(const cdem_dem *dem, double seconds, double touching, cdem_fault *fault) {
  double n = (double)dem->grains, bytes = bytes_of(dem->store, touching);
  double flops = flops_of(dem->store, touching);
  double stream = triad_rate(bytes, fault), peak = flop_rate();
  printf(
      "#   limits: %.0f bytes a particle-step at %.1f GB/s: %.1f ns; %.0f flops at %.1f Gflop/s: "
      "%.1f ns; %.2f of limit\n",
      bytes / n, stream * 1e-9, bytes / stream / n * 1e9, flops / n, peak * 1e-9,
      flops / peak / n * 1e9, fmax(bytes / stream, flops / peak) / seconds);
}

static void report(work *w, cdem_fault *fault) {
  static const char *const name[] = {"1 thread", "2 threads", "reference", "with energies"};
  for (int mode = 0; mode < 4; mode++) {
    cdem_dem dem;
    w->options.threads = mode == 1 ? 2 : 1;
    w->options.reference = mode == 2;
    w->options.energies = mode == 3;
    give_up(cdem_dem_init(&w->options, &dem, fault), fault);
    give_up(cdem_dem_steps(&dem, 50, fault), fault);
    int64_t steps = (mode == 2 ? 50000 : 200000) / dem.grains + 2, builds = dem.store->builds;
    double seconds = rate_of(&dem, steps, mode != 1, fault), grains = (double)dem.grains;
    double touching = (double)pairs_touching(dem.store);
    printf("%-16s %7lld %-14s %8.2f %9.2f %8.2f %7.2f %6.2f %6.3f %4lld\n", w->name,
           (long long)dem.grains, name[mode], grains / seconds * 1e-6, touching / seconds * 1e-6,
           seconds * 1e9 / touching, touching / grains, (double)dem.store->pairs / grains,
           (double)dem.store->core->far_start[dem.grains] / grains,
           (long long)(dem.store->builds - builds));
    if (mode == 0) {
      print_phases(&dem, steps, fault);
      print_limits(&dem, seconds, touching, fault);
    }
    cdem_dem_release(&dem);
  }
}

static void measure(const char *name, int64_t grains, cdem_fault *fault) {
  work w = {.name = name};
  bool flat = strcmp(name, "lattice") == 0, box = strcmp(name, "box") == 0;
  if (grains <= 0 || flat == box) {
    fprintf(stderr, "usage: bench_dem [lattice|box GRAINS]...\n");
    exit(2);
  }
  if (flat) {
    discs(&w, grains, fault);
  } else {
    double unbalanced;
    spheres(&w, grains, fault);
    double took = settle(&w, &unbalanced, fault);
    printf("# settled in %.1f s, unbalanced %.2g\n", took, unbalanced);
  }
  report(&w, fault);
  cdem_grains_release(&w.grains);
}

int main(int argc, char **argv) {
  cdem_fault fault = {0};
  printf("# million particle-steps and contact-steps a second, ns a contact; contacts, candidates\n"
         "# and far rows a grain; builds meanwhile\n");
  printf("%-16s %7s %-14s %8s %9s %8s %7s %6s %6s %4s\n", "# work", "grains", "how", "grains/s",
         "contacts", "ns", "touch", "near", "far", "new");
  for (int k = 1; k < argc; k += 2)
    measure(argv[k], k + 1 < argc ? strtoll(argv[k + 1], NULL, 10) : 0, &fault);
  if (argc > 1)
    return 0;
  measure("lattice", 20000, &fault);
  measure("box", 10000, &fault);
  measure("box", 50000, &fault);
  return 0;
}
