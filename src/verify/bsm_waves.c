/* The reflection of a plane wave at the interface, measured with the solvers themselves: two rows
 * of discs and a strip of elements, coupled, and a pulse from the far end of the rows.
 *
 * |R| by the transforms of the motion of two discs, which part it into the wave that goes right and
 * the wave that goes left; so nothing needs to be told apart in time. The rows are so long that
 * what their far end throws back has not reached the two when the record ends, and the strip so
 * long that nothing comes back from its end. */
#include "verify/bsm_waves.h"

#include "base/memory.h"
#include "bsm/bsm.h"
#include "verify/bsm.h"
#include "verify/dem_world.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 2, EARS = 7 }; /* two, so that discs determine the nodes of an element */
static const double pi = 3.14159265358979323846;
static const double width = 1.001; /* of a row: the discs of two rows do not touch */
static const double amplitude = 1e-3;
static const double margin = 0.06; /* rad/s, of the pulse's band: Blackman's window at 150 s */

typedef struct {
  cdem_bsm_chain chain;
  int row;          /* discs in a row, before the interface grain */
  double ends;      /* s, of the record */
  double pulse;     /* s, its length */
  double low, high; /* its frequencies, rad/s */
  cdem_mesh mesh;
  cdem_dem_world grains;
  int32_t cells, *cell;
  cdem_partition partition;
  cdem_material material;
  cdem_model model;
  cdem_body body;
  cdem_support held;
  cdem_solver solver;
  cdem_tie tie, fine_tie;
  cdem_absorb absorb;
  cdem_coupling coupling;
  int32_t *id, *node;
  double *xi; /* [grains][3] of one part */
} scene;

static void scene_release(scene *s) {
  cdem_coupling_release(&s->coupling);
  cdem_absorb_release(&s->absorb);
  cdem_tie_release(&s->tie);
  cdem_tie_release(&s->fine_tie);
  cdem_solver_release(&s->solver);
  cdem_series_release(&s->held.series);
  cdem_body_release(&s->body);
  cdem_model_release(&s->model);
  cdem_partition_release(&s->partition);
  cdem_dem_world_release(&s->grains);
  cdem_mesh_release(&s->mesh);
  free(s->cell);
  free(s->id);
  free(s->node);
  free(s->xi);
}

/* ---- rows and strip ---- */

static cdem_status make_mesh(scene *s, cdem_fault *fault) {
  double h = s->chain.ratio;
  int fine = s->row / s->chain.ratio, outer = (int)ceil(0.5 * s->ends / h) + 2;
  cdem_mesh_grid_options grid = {.shape = CDEM_SHAPE_QUAD4,
                                 .count = {fine + outer, 1, 0},
                                 .size = {(fine + outer) * h, ROWS * width, 0.0}};
  CDEM_TRY(cdem_mesh_grid(&grid, &s->mesh, fault));
  for (int32_t n = 0; n < s->mesh.nodes; n++)
    s->mesh.xyz[3 * n] -= s->row;
  const cdem_bsm_box box = {.low = {-1.0 - s->row, -1.0, 0.0}, .high = {0.0, 3.0, 0.0}};
  return cdem_bsm_cells(&s->mesh, 1, &box, &s->cells, &s->cell, fault);
}

/* Row after row from left to right; the first disc of a row sends the pulse. */
static cdem_status make_grains(scene *s, cdem_fault *fault) {
  cdem_dem_world *world = &s->grains;
  CDEM_TRY(cdem_dem_world_init(world, 2, "linear", 4.0 / pi, fault));
  cdem_dem_world_set(world, CDEM_LAW_normal_stiffness, 1.0);
  cdem_dem_world_set(world, CDEM_LAW_damping_ratio, 0.0);
  world->bond_law = (cdem_bond_law){.normal_stiffness = 1.0, .shear_stiffness = 0.1};
  for (int r = 0; r < ROWS; r++)
    for (int j = 0; j <= s->row; j++) {
      const double at[3] = {j - s->row + s->chain.place, (r + 0.5) * width, 0.0};
      int32_t id = r * (s->row + 1) + j;
      CDEM_TRY(cdem_dem_world_add(world, at, 0.5, NULL, NULL, fault));
      world->grains.motion[id] = j == 0 || j == s->row ? CDEM_GRAIN_DRIVEN : CDEM_GRAIN_FREE;
      if (j > 0)
        CDEM_TRY(cdem_dem_world_bond(world, id - 1, id, fault));
    }
  world->options.step = s->chain.step;
  world->options.energies = true;
  CDEM_TRY(cdem_dem_world_start(world, fault));
  return cdem_partition_init(&s->mesh, s->cells, s->cell, &world->grains, 0.3, &s->partition,
                             fault);
}

static cdem_status make_body(scene *s, cdem_fault *fault) {
  static const char *const outer[1] = {"outer"};
  static const double density = 1.0 / width; /* a disc on a times the width of its row */
  CDEM_TRY(cdem_mesh_add_group(&s->mesh, outer[0], 2, s->partition.outer_cells,
                               s->partition.outer_cell, fault));
  s->material = cdem_material_isotropic(1.0 / width, 0.0);
  const cdem_model_options options = {.mesh = &s->mesh,
                                      .groups = 1,
                                      .group = outer,
                                      .materials = 1,
                                      .material = &s->material,
                                      .section = {CDEM_PLANE_STRAIN, 1.0}};
  CDEM_TRY(cdem_model_init(&options, &s->model, fault));
  return cdem_body_init(&s->model, &(cdem_body_options){.density = &density, .threads = 1},
                        &s->body, fault);
}

/* Grains of one part with the places they have; xi is overwritten. */
static cdem_status make_tie(scene *s, cdem_bsm_part part, cdem_tie *tie, int64_t *count,
                            cdem_fault *fault) {
  const cdem_partition *p = &s->partition;
  int32_t *cell = s->id + p->grains;
  *count = 0;
  for (int64_t i = 0; i < p->grains; i++) {
    if (p->part[i] != part)
      continue;
    s->id[*count] = (int32_t)i;
    cell[*count] = p->cell[i];
    memcpy(s->xi + 3 * *count, p->xi + 3 * i, 3 * sizeof *s->xi);
    ++*count;
  }
  return cdem_tie_init(&s->mesh, 2, *count, s->id, cell, s->xi, tie, fault);
}

/* Virtual work: masses of the fine grains in the nodes, by row sums. */
static void add_masses(scene *s) {
  const cdem_weights *w = &s->fine_tie.weights;
  for (int64_t k = 0; k < w->start[w->points]; k++)
    for (int c = 0; c < 2; c++)
      s->body.mass[2 * w->node[k] + c] += w->n[k];
}

static cdem_status make_ties(scene *s, cdem_fault *fault) {
  int64_t count;
  CDEM_NEW(s->id, 2 * s->partition.grains, fault);
  CDEM_NEW(s->xi, 3 * s->partition.grains, fault);
  CDEM_TRY(make_tie(s, CDEM_PART_INTERFACE, &s->tie, &count, fault));
  CDEM_TRY(make_tie(s, CDEM_PART_FINE, &s->fine_tie, &count, fault));
  if (s->chain.form == CDEM_BSM_VIRTUAL_WORK)
    add_masses(s);
  if (s->chain.layers == 0)
    return CDEM_OK;
  cdem_absorb_options layer = {.mesh = &s->mesh,
                               .grains = count,
                               .grain = s->id,
                               .cell = s->id + s->partition.grains,
                               .xi = s->xi,
                               .fine = &s->grains.dem,
                               .rate = s->chain.rate / s->chain.ratio};
  int32_t *cell;
  CDEM_TRY(
      cdem_absorb_cells(&s->mesh, s->cells, s->cell, s->chain.layers, &layer.cells, &cell, fault));
  layer.layer = cell;
  cdem_status status = cdem_absorb_init(&layer, &s->absorb, fault);
  free(cell);
  return status;
}

static cdem_status couple(scene *s, cdem_fault *fault) {
  char limiter[64];
  bool whole = s->chain.form == CDEM_BSM_VIRTUAL_WORK;
  CDEM_NEW(s->node, s->mesh.nodes, fault);
  for (int32_t n = 0; n < s->mesh.nodes; n++)
    s->node[n] = n;
  s->held = (cdem_support){.name = "all", .component = 1, .nodes = s->mesh.nodes, .node = s->node};
  CDEM_TRY(cdem_series_constant(0.0, &s->held.series, fault));
  const cdem_solver_options solver = {.body = &s->body,
                                      .thickness = 1.0,
                                      .supports = 1,
                                      .support = &s->held,
                                      .step = s->chain.cycles * s->chain.step,
                                      .threads = 1};
  CDEM_TRY(cdem_solver_init(&solver, &s->solver, fault));
  cdem_coupling_options options = {.coarse = &s->solver,
                                   .fine = &s->grains.dem,
                                   .form = s->chain.form,
                                   .way = s->chain.way,
                                   .cycles = s->chain.cycles,
                                   .tie = &s->tie,
                                   .fine_tie = whole ? &s->fine_tie : NULL,
                                   .absorb = s->chain.layers > 0 ? &s->absorb : NULL};
  CDEM_TRY(cdem_coupling_limit(&s->body, cdem_solver_limit(&s->solver, limiter), &s->tie,
                               &s->grains.dem, &options.most_step, fault));
  return cdem_coupling_init(&options, &s->coupling, fault);
}

static cdem_status make(scene *s, const cdem_bsm_chain *chain, cdem_fault *fault) {
  cdem_bsm_chain *c = &s->chain;
  *c = *chain;
  CDEM_REQUIRE(c->ratio >= 2, fault, CDEM_USAGE, "an element of %d spacings", c->ratio);
  c->place = c->place > 0.0 ? c->place : 0.5;
  c->cycles = c->cycles > 1 ? c->cycles : 1;
  c->step = c->step > 0.0 ? c->step : 0.2;
  int least = c->grains > 0 ? c->grains : (int)fmax(80.0 * c->ratio, 400.0);
  s->row = (least + c->ratio - 1) / c->ratio * c->ratio;
  s->ends = 3.0 * s->row - 4.0 * c->ratio - 140.0; /* the far end's echo is not yet at the ears */
  CDEM_TRY(make_mesh(s, fault));
  CDEM_TRY(make_grains(s, fault));
  CDEM_TRY(make_body(s, fault));
  CDEM_TRY(make_ties(s, fault));
  return couple(s, fault);
}

/* ---- the pulse ---- */

/* Waves of low .. high rad/s: the difference of two sinc under Blackman's window. */
static double pulse_at(const scene *s, double time) {
  double t = time - 0.5 * s->pulse, turn = 2.0 * pi * time / s->pulse;
  if (time <= 0.0 || time >= s->pulse)
    return 0.0;
  double window = 0.42 - 0.5 * cos(turn) + 0.08 * cos(2.0 * turn);
  double wave = t == 0.0 ? s->high - s->low : (sin(s->high * t) - sin(s->low * t)) / t;
  return amplitude * window * wave / pi;
}

static void send(scene *s) {
  double from = s->solver.time, step = s->coupling.step;
  cdem_dem_motion motion = {.velocity = {(pulse_at(s, from + step) - pulse_at(s, from)) / step}};
  for (int r = 0; r < ROWS; r++)
    cdem_dem_drive(&s->grains.dem, r * (s->row + 1), &motion, NULL);
}

/* ---- |R| ---- */

/* Distances of the ears from the first, in spacings. */
static int ear_at(int ear) {
  return ear == 0 ? 0 : 1 << (ear - 1);
}

/* The pair of ears whose distance is nearest below a quarter of a wave: k d <= pi/2. */
static int second_ear(double ka) {
  int ear = 1;
  while (ear + 1 < EARS && ear_at(ear + 1) * ka <= 0.5 * pi)
    ear++;
  return ear;
}

/* record [steps][EARS] at t_1, t_2, ... */
static double part_waves(const double *record, int64_t steps, double step, double w, double ka) {
  int ear = second_ear(ka);
  double complex first = 0.0, second = 0.0, turn = cexp(I * ka * ear_at(ear));
  for (int64_t n = 0; n < steps; n++) {
    double complex phase = cexp(I * w * step * (double)(n + 1));
    first += record[n * EARS] * phase;
    second += record[n * EARS + ear] * phase;
  }
  double complex right = second - first / turn, left = first * turn - second;
  return cabs(left) / cabs(right);
}

static cdem_status listen(scene *s, double *record, int64_t steps, cdem_fault *fault) {
  int64_t grains = s->grains.dem.grains;
  int first = s->row - 2 * s->chain.ratio * (1 + s->chain.layers) - 20 - ear_at(EARS - 1);
  double *way;
  CDEM_NEW(way, 3 * grains, fault);
  cdem_status status = CDEM_OK;
  for (int64_t n = 0; n < steps && status == CDEM_OK; n++) {
    send(s);
    status = cdem_coupling_step(&s->coupling, fault);
    cdem_dem_look(&s->grains.dem, &(cdem_dem_view){.displacement = way});
    for (int e = 0; e < EARS; e++)
      record[n * EARS + e] = way[3 * (first + ear_at(e))];
  }
  free(way);
  return status;
}

static cdem_status measure(scene *s, int waves, const double *ka, double *back, cdem_fault *fault) {
  double dt = s->chain.step, *record;
  int64_t steps = (int64_t)(s->ends / s->coupling.step);
  s->pulse = 150.0;
  s->low = 0.0;
  double most = 0.0;
  for (int i = 0; i < waves; i++)
    most = fmax(most, ka[i]);
  s->high = 2.0 * sin(0.5 * most) + margin; /* no more: shorter waves are slow and late */
  CDEM_NEW(record, steps * EARS, fault);
  cdem_status status = listen(s, record, steps, fault);
  for (int i = 0; i < waves && status == CDEM_OK; i++)
    back[i] =
        part_waves(record, steps, s->coupling.step, 2.0 / dt * asin(dt * sin(0.5 * ka[i])), ka[i]);
  free(record);
  return status;
}

cdem_status cdem_bsm_waves_measure(const cdem_bsm_chain *chain, int waves, const double *ka,
                                   double *back, cdem_fault *fault) {
  scene s = {0};
  cdem_status status = make(&s, chain, fault);
  if (status == CDEM_OK)
    status = measure(&s, waves, ka, back, fault);
  scene_release(&s);
  return status;
}

/* ---- energy ---- */

static cdem_status measure_energy(scene *s, cdem_bsm_energy *energy, cdem_fault *fault) {
  cdem_energy_book body;
  cdem_dem_energies grains;
  double sent = 0.0;
  int64_t steps = (int64_t)(s->ends / s->coupling.step);
  s->pulse = 200.0;
  for (int64_t n = 0; n < steps; n++) {
    bool sending = s->solver.time < s->pulse;
    send(s);
    CDEM_TRY(cdem_coupling_step(&s->coupling, fault));
    if (!sending || s->solver.time < s->pulse)
      continue;
    cdem_solver_energies(&s->solver, &body);
    cdem_dem_energies_now(&s->grains.dem, &grains);
    sent = body.kinetic + body.elastic + grains.translation + grains.bond;
  }
  cdem_solver_energies(&s->solver, &body);
  cdem_dem_energies_now(&s->grains.dem, &grains);
  double exchange = grains.driven + s->coupling.work - sent;
  energy->on = (body.kinetic + body.elastic) / sent;
  energy->error = fabs(body.error + grains.error + exchange) / sent;
  return CDEM_OK;
}

cdem_status cdem_bsm_waves_energy(const cdem_bsm_chain *chain, double low, double high,
                                  cdem_bsm_energy *energy, cdem_fault *fault) {
  scene s = {.low = 2.0 * sin(0.5 * low), .high = 2.0 * sin(0.5 * high)};
  cdem_status status = make(&s, chain, fault);
  if (status == CDEM_OK)
    status = measure_energy(&s, energy, fault);
  scene_release(&s);
  return status;
}
