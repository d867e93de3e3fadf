/* A triaxial test of rigid grains: its plates and side, its stages, its columns. */
#include "run/grains.h"

#include <math.h>
#include <string.h>

enum { LOW, HIGH, SIDE };

/* ---- sizes ---- */

static void look_at_grains(const cdem_run_grains *g, cdem_run_triaxial_sizes *sizes) {
  double mass = 0.0, sum = 0.0, smallest = INFINITY;
  *sizes = (cdem_run_triaxial_sizes){.solid = cdem_grains_solid(&g->grains)};
  for (int64_t i = 0; i < g->grains.grains; i++) {
    double r = g->grains.radius[i];
    int32_t m = g->grains.material != NULL ? g->grains.material[i] : 0;
    mass += g->material[m].density * (r * r * r);
    sum += r * r * r;
    sizes->diameter += 2.0 * r / (double)g->grains.grains;
    smallest = fmin(smallest, 2.0 * r);
  }
  sizes->smallest = smallest;
  sizes->density = mass / sum;
}

/* Of grains from a table: the upright cylinder about the middle of their box that holds them. */
static void fit_cylinder(cdem_run_grains *g) {
  double radius = 0.0, middle[2] = {0.5 * (g->low[0] + g->high[0]), 0.5 * (g->low[1] + g->high[1])};
  for (int64_t i = 0; i < g->grains.grains; i++) {
    const double *x = &g->grains.xyz[3 * i];
    double away = hypot(x[0] - middle[0], x[1] - middle[1]) + g->grains.radius[i];
    radius = fmax(radius, away);
  }
  for (int c = 0; c < 2; c++) {
    g->low[c] = middle[c] - radius;
    g->high[c] = middle[c] + radius;
  }
}

/* ---- walls ---- */

/* Plates and a cylinder look for contacts at this part of the speed sqrt(pressure/density). */
static const double part_of_speed = 0.05;
/* A servo that must go on moving lags behind by the force of the dashpots, by its gain. */
static const double servo_gain = 0.8;

static int side_material(const cdem_run_grains *g) {
  const cdem_case_triaxial *t = &cdem_run_grains_values(g)->triaxial;
  return cdem_run_grains_material(g, t->side_material != NULL ? t->side_material : t->material);
}

void cdem_run_grains_triaxial_materials(cdem_run_grains *g,
                                        void (*take)(cdem_run_grains *g, int from)) {
  take(g, cdem_run_grains_material(g, cdem_run_grains_values(g)->triaxial.material));
  take(g, side_material(g));
}

static void make_walls(cdem_run_grains *g) {
  const cdem_case_triaxial *t = &cdem_run_grains_values(g)->triaxial;
  int plates = cdem_run_grains_material(g, t->material);
  double speed = part_of_speed * sqrt(t->pressure / g->triaxial.sizes.density);
  double middle[3] = {0.5 * (g->low[0] + g->high[0]), 0.5 * (g->low[1] + g->high[1]), 0.0};
  g->wall[LOW] = (cdem_wall){.name = "bottom", .shape = CDEM_WALL_PLANE, .normal = {0, 0, 1}};
  g->wall[HIGH] = (cdem_wall){.name = "top",
                              .shape = CDEM_WALL_PLANE,
                              .normal = {0, 0, -1},
                              .servo = {0, 0, 1},
                              .servo_gain = servo_gain,
                              .servo_speed = speed};
  if (g->walls > SIDE)
    g->wall[SIDE] =
        (cdem_wall){.name = "side",
                    .shape = CDEM_WALL_CYLINDER,
                    .axis = {0, 0, 1},
                    .radius = 0.5 * fmin(g->high[0] - g->low[0], g->high[1] - g->low[1]),
                    .servo_radius = true,
                    .servo_gain = servo_gain,
                    .servo_speed = speed};
  for (int w = 0; w < g->walls; w++) {
    g->wall[w].material = g->model_of[w == SIDE ? side_material(g) : plates];
    memcpy(g->wall[w].center, middle, sizeof middle);
    g->wall[w].center[2] = w == HIGH ? g->high[2] : g->low[2];
  }
}

cdem_status cdem_run_grains_triaxial(cdem_run_grains *g, cdem_fault *fault) {
  const cdem_case_triaxial *t = &cdem_run_grains_values(g)->triaxial;
  cdem_run_triaxial_sizes sizes;
  bool cylinder = t->boundary == CDEM_TRIAXIAL_CYLINDER;
  g->has_triaxial = cdem_case_is_triaxial(&g->run->cases);
  if (!g->has_triaxial)
    return CDEM_OK;
  if (cdem_run_grains_values(g)->grains.file != NULL)
    fit_cylinder(g);
  look_at_grains(g, &sizes);
  CDEM_TRY(cdem_run_triaxial_plan(g->run, &sizes, &g->triaxial, fault));
  g->walls = cylinder ? 3 : 2;
  CDEM_NEW(g->wall, g->walls, fault);
  CDEM_NEW(g->facets, g->walls, fault);
  make_walls(g);
  g->confinement = (cdem_confinement){.low = LOW,
                                      .high = HIGH,
                                      .side = SIDE,
                                      .presses = true,
                                      .pressure = g->triaxial.pressure,
                                      .quiet = g->triaxial.time[1]};
  if (cylinder)
    return CDEM_OK;
  cdem_run_triaxial_membrane(g->run, &g->triaxial, g->low, g->high, &g->membrane);
  g->confinement.membrane = &g->membrane;
  cdem_status status = cdem_membrane_check(&g->membrane, sizes.smallest, fault);
  return status == CDEM_INPUT ? cdem_case_blame(&g->run->cases, "triaxial.membrane", fault)
                              : status;
}

/* ---- stages ---- */

cdem_status cdem_run_grains_advance(cdem_run_grains *g, int64_t steps, cdem_fault *fault) {
  while (g->has_triaxial && !g->triaxial.shears) {
    const cdem_run_now now = {.time = g->dem.time, .step = g->dem.step, .steps = g->dem.steps};
    int64_t before = cdem_run_triaxial_steps(&g->triaxial, &now);
    if (before > steps)
      break;
    CDEM_TRY(cdem_dem_steps(&g->dem, before, fault));
    steps -= before;
    if (before > 0)
      continue;
    cdem_specimen at;
    cdem_dem_specimen(&g->dem, &at);
    cdem_dem_shear(&g->dem, cdem_run_triaxial_shear(&g->triaxial, at.height, at.volume));
  }
  return cdem_dem_steps(&g->dem, steps, fault);
}

void cdem_run_grains_triaxial_columns(cdem_run_grains *g, cdem_run_row *row) {
  cdem_run_specimen specimen = {0};
  cdem_specimen at = {0};
  if (!g->has_triaxial)
    return;
  if (!row->declare) {
    cdem_dem_wall top;
    cdem_dem_specimen(&g->dem, &at);
    cdem_dem_wall_now(&g->dem, HIGH, &top);
    specimen = (cdem_run_specimen){.pressure = at.pressure,
                                   .height = at.height,
                                   .volume = at.volume,
                                   .axial = at.axial,
                                   .bottom = at.bottom,
                                   .lateral = at.lateral,
                                   .speed = top.velocity[2]};
  }
  cdem_run_triaxial_columns(&g->triaxial, &specimen, row);
  if (g->confinement.membrane != NULL)
    cdem_run_put(row, "", (double)at.touching, "membrane_touching");
}
