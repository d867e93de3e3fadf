/* The works on which the granular solver is timed against other programs; see dem-peers.sh.
 *
 *     bench_dem_work numbers WORK GRAINS          the numbers of a work, as shell assignments
 *     bench_dem_work make WORK GRAINS FILE        where its grains stand at the start
 *     bench_dem_work run WORK GRAINS FILE STEPS THREADS
 *
 * WORK is box (spheres settled in a box with five walls) or plate (discs in a lattice at 45
 * degrees, pushed by a row of discs). FILE has one line a grain: x y z radius driven(0/1).
 * A rate counts the steps alone, without set-up, as the loop timers of the others do.
 */
#include "base/random.h"
#include "bench.h"
#include "dem/dem.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double pi = 3.14159265358979323846, radius = 0.01, density = 2600.0, friction = 0.5;
static const double shear_ratio = 2.0 / 7.0, speed = -1.0;
static const double damping =
                        0.25527564, /* of critical: restitution 0.5, forces that cannot pull */
    slack = 1.025;                  /* of the lattice that settles, over touching */

typedef struct {
  int dim, across; /* grains along the box; lattice: twice the points of a row */
  int64_t grains;
  double kn, mass, width, step;
} work;

static double now(void) {
  return clock_now(CLOCK_MONOTONIC);
}

/* Spacing of rows and half that of points in a row: touching less an overlap of 2e-4 radii, so that
 * all contacts are there from the first step on. */
static double lattice_step(void) {
  return sqrt(2.0) * radius * (1.0 - 1e-4);
}

static work work_of(const char *name, int64_t grains) {
  work w = {.grains = grains};
  if (strcmp(name, "box") == 0) {
    w.dim = 3;
    w.kn = 1e6;
    w.step = 5e-6;
    w.mass = density * 4.0 / 3.0 * pi * radius * radius * radius;
    w.across = (int)lround(0.93 * cbrt((double)grains));
    w.width = w.across * 2.0 * radius * slack;
  } else if (strcmp(name, "plate") == 0) {
    w.dim = 2;
    w.kn = 1e8;
    w.step = 1e-5;
    w.mass = density * pi * radius * radius;
    w.across = 2 * (int)lround(sqrt(2.0 * (double)grains));
    w.width = 2.0 * radius * (1.0 - 1e-4) + (w.across - 1) * lattice_step();
  } else {
    fprintf(stderr, "error: there is no work '%s'; works are box, plate\n", name);
    exit(2);
  }
  return w;
}

/* F = m_eff gamma v is how LAMMPS and LIGGGHTS count: gamma = 2 zeta sqrt(k/m_eff). */
static void print_numbers(const work *w) {
  printf("dim=%d kn=%.17g kt=%.17g kt_kn=%.17g mu=%.17g dt=%.17g speed=%.17g rho=%.17g "
         "radius=%.17g width=%.17g "
         "gn=%.17g gw=%.17g\n",
         w->dim, w->kn, w->kn * shear_ratio, shear_ratio, friction, w->step, speed, density, radius,
         w->width, 2.0 * damping * sqrt(2.0 * w->kn / w->mass),
         2.0 * damping * sqrt(w->kn / w->mass));
}

/* ---- model ---- */

typedef struct {
  cdem_grain_material material;
  cdem_contact_input contact;
  cdem_wall wall[5];
  cdem_dem_options options;
} model;

static void model_init(const work *w, const cdem_grains *grains, double kn, int threads, model *m) {
  memset(m, 0, sizeof *m);
  m->material =
      (cdem_grain_material){.name = "grain", .density = density, .young = NAN, .poisson = NAN};
  for (int i = 0; i < CDEM_LAW_KEYS; i++)
    m->contact.value[i] = NAN;
  m->contact.value[CDEM_LAW_normal_stiffness] = kn;
  m->contact.value[CDEM_LAW_shear_ratio] = shear_ratio;
  m->contact.value[CDEM_LAW_friction] = friction;
  m->contact.value[CDEM_LAW_damping_ratio] = damping;
  m->contact.value[CDEM_LAW_shear_dashpot] = 0.0;
  int up = w->dim - 1, walls = 0;
  for (int d = 0; d < w->dim; d++)
    for (int side = 0; side < (d == up ? 1 : 2); side++) {
      cdem_wall *wall = &m->wall[walls++];
      *wall = (cdem_wall){.name = "wall", .shape = CDEM_WALL_PLANE};
      wall->center[d] = side * w->width;
      wall->normal[d] = side == 0 ? 1.0 : -1.0;
    }
  m->options = (cdem_dem_options){.grains = grains,
                                  .materials = 1,
                                  .material = &m->material,
                                  .law = cdem_law_find("linear"),
                                  .contact = &m->contact,
                                  .walls = walls,
                                  .wall = m->wall,
                                  .step = w->step,
                                  .threads = threads};
  m->options.gravity[up] = -9.81;
}

/* ---- make ---- */

static void add(cdem_grains *grains, double x, double y, double z, bool driven) {
  cdem_fault fault = {0};
  give_up(cdem_grains_add(grains, (double[]){x, y, z}, radius, &fault), &fault);
  int64_t i = grains->grains - 1;
  grains->motion[i] = driven ? CDEM_GRAIN_DRIVEN : CDEM_GRAIN_FREE;
  grains->material[i] = 0;
  memset(grains->spin + 3 * i, 0, 3 * sizeof(double));
  memset(grains->velocity + 3 * i, 0, 3 * sizeof(double));
  if (driven)
    grains->velocity[3 * i + 1] = speed;
}

/* A first grain, then all arrays: later grains are added to complete arrays. */
static void start_grains(int dim, cdem_grains *grains) {
  cdem_fault fault = {0};
  memset(grains, 0, sizeof *grains);
  grains->dim = dim;
  give_up(cdem_grains_add(grains, (double[]){0.0, 0.0, 0.0}, radius, &fault), &fault);
  give_up(cdem_grains_complete(grains, &fault), &fault);
  grains->grains = 0;
}

static void write_grains(const char *path, const cdem_grains *grains, const double *xyz) {
  FILE *file = fopen(path, "w");
  for (int64_t i = 0; file != NULL && i < grains->grains; i++)
    fprintf(file, "%.17g %.17g %.17g %.17g %d\n", xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2],
            grains->radius[i], grains->motion[i] == CDEM_GRAIN_DRIVEN);
  if (file == NULL || fclose(file) != 0) {
    fprintf(stderr, "error: cannot write '%s'\n", path);
    exit(6);
  }
}

/* Rows of alternate points; the plate is a row of discs on the middle seventh of the top. */
static void make_plate(const work *w, const char *path) {
  cdem_grains grains;
  start_grains(2, &grains);
  double a = lattice_step(), edge = radius * (1.0 - 1e-4);
  for (int64_t n = 0; n < w->grains; n++) {
    int64_t row = n / (w->across / 2), column = 2 * (n % (w->across / 2)) + row % 2;
    add(&grains, edge + (double)column * a, edge + (double)row * a, 0.0, false);
  }
  double top = edge + (double)((w->grains - 1) / (w->across / 2)) * a + 2.0 * radius;
  int discs = (int)(w->width / 14.0 / radius);
  for (int i = 0; i < discs; i++)
    add(&grains, 0.5 * w->width + (2 * i - discs + 1) * radius, top, 0.0, true);
  write_grains(path, &grains, grains.xyz);
  cdem_grains_release(&grains);
}

/* First with springs a sixteenth as stiff and four times the step, then with the springs of the
 * work and damping of mass. */
static void make_box(const work *w, const char *path) {
  cdem_fault fault = {0};
  cdem_grains grains;
  cdem_random random = {7};
  start_grains(3, &grains);
  double a = 2.0 * radius * slack, shake = 0.4 * (slack - 1.0) * 2.0 * radius;
  for (int64_t n = 0; n < w->grains; n++) {
    int64_t place[3] = {n % w->across, n / w->across % w->across, n / w->across / w->across};
    double x[3];
    for (int d = 0; d < 3; d++)
      x[d] = ((double)place[d] + 0.5) * a + cdem_random_uniform(&random, -shake, shake);
    add(&grains, x[0], x[1], x[2], false);
  }
  for (int phase = 0; phase < 2; phase++) {
    model m;
    cdem_dem dem;
    model_init(w, &grains, phase == 0 ? w->kn / 16.0 : w->kn, 0, &m);
    m.options.step = phase == 0 ? 4.0 * w->step : w->step;
    m.options.mass_damping = phase == 0 ? 1.0 : 200.0;
    double start = now();
    give_up(cdem_dem_init(&m.options, &dem, &fault), &fault);
    give_up(cdem_dem_steps(&dem, phase == 0 ? 20000 : 12000, &fault), &fault);
    fprintf(stderr, "settling, phase %d: %.0f s, unbalanced %.2g\n", phase + 1, now() - start,
            cdem_dem_unbalanced(&dem));
    cdem_dem_look(&dem, &(cdem_dem_view){.xyz = grains.xyz});
    if (phase == 0)
      cdem_dem_look(&dem, &(cdem_dem_view){.velocity = grains.velocity, .spin = grains.spin});
    cdem_dem_release(&dem);
  }
  write_grains(path, &grains, grains.xyz);
  cdem_grains_release(&grains);
}

/* ---- run ---- */

static void read_grains(const char *path, int dim, cdem_grains *grains) {
  FILE *file = fopen(path, "r");
  double x, y, z, r;
  int driven;
  start_grains(dim, grains);
  if (file == NULL) {
    fprintf(stderr, "error: cannot read '%s'\n", path);
    exit(6);
  }
  while (fscanf(file, "%lf %lf %lf %lf %d", &x, &y, &z, &r, &driven) == 5)
    add(grains, x, y, z, driven != 0);
  fclose(file);
}

/* Translation and rotation, J. */
static void kinetic(const cdem_dem *dem, double energy[2]) {
  size_t n = (size_t)dem->grains;
  double *v = calloc(3 * n, sizeof *v), *w = calloc(3 * n, sizeof *w);
  double *mass = calloc(n, sizeof *mass), *inertia = calloc(n, sizeof *inertia);
  cdem_dem_look(dem, &(cdem_dem_view){.velocity = v, .spin = w, .mass = mass, .inertia = inertia});
  energy[0] = energy[1] = 0.0;
  for (size_t i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) {
      energy[0] += 0.5 * mass[i] * v[3 * i + d] * v[3 * i + d];
      energy[1] += 0.5 * inertia[i] * w[3 * i + d] * w[3 * i + d];
    }
  free(v), free(w), free(mass), free(inertia);
}

static void run(const work *w, const char *path, int64_t steps, int threads) {
  cdem_fault fault = {0};
  cdem_grains grains;
  cdem_dem dem;
  model m;
  read_grains(path, w->dim, &grains);
  model_init(w, &grains, w->kn, threads, &m);
  give_up(cdem_dem_init(&m.options, &dem, &fault), &fault);
  double start = now();
  give_up(cdem_dem_steps(&dem, steps, &fault), &fault);
  double seconds = now() - start, energy[2];
  kinetic(&dem, energy);
  printf("%" PRId64 " %.6f %.9g %.9g\n", dem.grains, seconds, energy[0], energy[1]);
  cdem_dem_release(&dem);
  cdem_grains_release(&grains);
}

int main(int argc, char **argv) {
  if (argc < 4) {
    fprintf(stderr,
            "usage: bench_dem_work numbers|make|run box|plate GRAINS [FILE [STEPS THREADS]]\n");
    return 2;
  }
  work w = work_of(argv[2], strtoll(argv[3], NULL, 10));
  if (strcmp(argv[1], "make") == 0 && argc == 5)
    w.dim == 3 ? make_box(&w, argv[4]) : make_plate(&w, argv[4]);
  else if (strcmp(argv[1], "run") == 0 && argc == 7)
    run(&w, argv[4], strtoll(argv[5], NULL, 10), atoi(argv[6]));
  else
    print_numbers(&w);
  return 0;
}
