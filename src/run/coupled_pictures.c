/* A state of a coupled case: grains and coarse medium in one picture, of one scale. */
#include "io/run_files.h"
#include "results/map.h"
#include "run/axis.h"
#include "run/coupled.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double view_flat[3] = {0, 0, -1}, up_flat[3] = {0, 1, 0};

/* ---- the coarse medium ---- */

/* Elements as polygons, and the cracks between them. */
static cdem_status take_body(void *context, const cdem_frame *frame, cdem_fault *fault) {
  static const struct {
    cdem_interface_state state;
    const char *title, *colour;
  } crack[] = {{CDEM_INTERFACE_TENSION_FAILED, "failed in tension", "#d7191c"},
               {CDEM_INTERFACE_SHEAR_FAILED, "failed in shear", "#2166ac"}};
  cdem_map *map = context;
  if (strcmp(frame->set, "body") == 0)
    return cdem_map_from_frame(frame, "displacement", -1, view_flat, up_flat, 0.0, map, fault);
  if (strcmp(frame->set, "interfaces") != 0)
    return CDEM_OK;
  for (size_t i = 0; i < sizeof crack / sizeof *crack; i++) {
    CDEM_TRY(cdem_map_add_lines(map, frame, "state", 1u << crack[i].state, view_flat, up_flat,
                                crack[i].title, crack[i].colour, 1.6, fault));
    cdem_map_lines *lines = &map->lines[map->line_sets - 1];
    lines->title = lines->segments > 0 ? crack[i].title : NULL;
  }
  return CDEM_OK;
}

/* The grains' field in an element; NaN where the body has no such thing. */
static double cell_value(const double stress[6], const double strain[6], cdem_grain_field field) {
  cdem_run_cell_numbers n = cdem_run_coupled_cell(2, stress, strain);
  switch (field) {
  case CDEM_GRAIN_PRESSURE:
    return -n.volumetric_stress;
  case CDEM_GRAIN_EFFECTIVE_STRESS:
    return n.effective_stress;
  case CDEM_GRAIN_VOLUMETRIC_STRAIN:
    return n.volumetric_strain;
  case CDEM_GRAIN_EFFECTIVE_STRAIN:
    return n.effective_strain;
  default:
    return NAN;
  }
}

static cdem_status colour_body(const cdem_run_body *body, int field, cdem_map *map,
                               cdem_fault *fault) {
  double *all;
  if (field == CDEM_GRAIN_DISPLACEMENT)
    return CDEM_OK; /* as taken */
  CDEM_NEW(all, 12 * (int64_t)body->model.cells, fault);
  double *stress = all, *strain = all + 6 * (int64_t)body->model.cells;
  cdem_body_cell_fields(&body->body, body->solver.u,
                        &(cdem_body_fields){.stress = stress, .strain = strain});
  for (int64_t p = 0; p < map->polygons; p++)
    map->value[p] = field < CDEM_GRAIN_FIELDS && p < body->model.cells
                        ? cell_value(stress + 6 * p, strain + 6 * p, (cdem_grain_field)field)
                        : NAN;
  free(all);
  return CDEM_OK;
}

/* Only what has its middle in the window is drawn of the body. */
static void keep_window(const cdem_region *window, cdem_map *map) {
  int64_t kept = 0, corner = 0;
  for (int64_t p = 0; p < map->polygons; p++) {
    int64_t from = map->start[p], corners = map->start[p + 1] - from;
    bool in = true;
    for (int c = 0; c < 2; c++) {
      double middle = 0.0;
      for (int64_t i = 0; i < corners; i++)
        middle += map->xy[2 * (from + i) + c] / (double)corners;
      in = in && (!(window->low[c] < window->high[c]) ||
                  (middle >= window->low[c] && middle < window->high[c]));
    }
    if (!in)
      continue;
    memmove(map->xy + 2 * corner, map->xy + 2 * from, 2 * (size_t)corners * sizeof *map->xy);
    map->value[kept] = map->value[p];
    if (map->shade != NULL)
      map->shade[kept] = map->shade[p];
    map->start[kept++] = corner;
    corner += corners;
  }
  if (map->polygons > 0)
    map->start[kept] = corner;
  map->polygons = kept;
}

static cdem_status draw_body(const cdem_run_coupled *c, const cdem_picture *picture, int choice,
                             cdem_map *map, cdem_fault *fault) {
  const cdem_frame_sink sink = {.context = map, .frame = take_body};
  CDEM_TRY(cdem_solver_frames(&c->body->solver, 0, &sink, fault));
  CDEM_TRY(colour_body(c->body, choice, map, fault));
  map->outlines = c->body->model.cells <= 1000; /* of finer meshes they would hide the colours */
  keep_window(&picture->window, map);
  return CDEM_OK;
}

/* ---- both ---- */

/* Spheres are cut through the centres next to the middle: the plane of symmetry of a lattice may
 * run between its spheres. */
static void cut_through(const cdem_grains *grains, double through[3]) {
  double low[3], high[3], best = INFINITY;
  cdem_grains_box(grains, low, high);
  for (int64_t i = 0; i < grains->grains; i++) {
    double off = fabs(grains->xyz[3 * i + 1] - 0.5 * (low[1] + high[1]));
    if (off < best) {
      best = off;
      memcpy(through, grains->xyz + 3 * i, 3 * sizeof *through);
    }
  }
}

/* Gives the polygons and lines of the body to the map of the grains. */
static cdem_status join(cdem_map *grains, cdem_map *body, cdem_fault *fault) {
  grains->polygons = body->polygons;
  grains->start = body->start;
  grains->xy = body->xy;
  grains->value = body->value;
  grains->shade = body->shade;
  grains->outlines = body->outlines;
  body->polygons = 0;
  body->start = NULL;
  body->xy = body->value = body->shade = NULL;
  for (int i = 0; i < body->line_sets; i++) {
    const cdem_map_lines *from = &body->lines[i];
    cdem_map_lines *to;
    CDEM_TRY(cdem_map_add_segments(grains, from->segments, from->title, from->colour, from->width,
                                   &to, fault));
    memcpy(to->xy, from->xy, 4 * (size_t)from->segments * sizeof *to->xy);
  }
  return CDEM_OK;
}

static cdem_status make_map(const cdem_run_coupled *c, const cdem_picture *picture, int choice,
                            cdem_map *map, cdem_fault *fault) {
  cdem_map body = {0};
  bool flat = cdem_run_values(c->run)->grains.dimension == 2;
  cdem_status status = CDEM_OK;
  if (c->has_grains)
    status = cdem_dem_picture(&c->grains->dem, picture, map, fault);
  if (status == CDEM_OK && c->has_body && flat)
    status = draw_body(c, picture, choice, c->has_grains ? &body : map, fault);
  if (status == CDEM_OK && c->has_grains && c->has_body && flat)
    status = join(map, &body, fault);
  cdem_map_release(&body);
  return status;
}

/* What a picture of the body alone needs beside its polygons. */
static void label_body(const cdem_picture *picture, int choice, cdem_map *map) {
  static const char *const label[CDEM_GRAIN_FIELDS] = {
      [CDEM_GRAIN_DISPLACEMENT] = "displacement |u|, m",
      [CDEM_GRAIN_PRESSURE] = "pressure p, Pa",
      [CDEM_GRAIN_EFFECTIVE_STRESS] = "effective stress σ_e, Pa",
      [CDEM_GRAIN_VOLUMETRIC_STRAIN] = "volumetric strain ε_v",
      [CDEM_GRAIN_EFFECTIVE_STRAIN] = "effective strain ε_e"};
  map->title = picture->title;
  map->x_label = "x, m";
  map->y_label = "y, m";
  map->value_label = choice < CDEM_GRAIN_FIELDS ? label[choice] : NULL;
  map->diverging = choice == CDEM_GRAIN_VOLUMETRIC_STRAIN;
  map->value_min = picture->value_min;
  map->value_max = picture->value_max;
}

static cdem_status draw(const cdem_run_coupled *c, int choice, const char *title,
                        const char *folder, const char *tag, cdem_fault *fault) {
  char name[96];
  if (choice >= CDEM_RUN_MAPS)
    return c->has_grains ? cdem_run_grains_curve(c->grains, choice, title, folder, tag, fault)
                         : CDEM_OK;
  cdem_picture picture = cdem_run_picture(c->run, choice, c->strain, title);
  cdem_map map = {0};
  if (choice == CDEM_GRAIN_PRESSURE || choice == CDEM_GRAIN_EFFECTIVE_STRESS)
    picture.kind = CDEM_PICTURE_BAND; /* a field beside that of the elements: no gaps */
  if (choice < CDEM_GRAIN_FIELDS)     /* interface grains carry what the elements there carry */
    picture.left_out = c->not_fine;
  if (c->has_grains && c->grains->dim == 3) {
    picture.slice = true;
    picture.middle = false;
    cut_through(&c->grains->grains, picture.through);
  }
  if (!c->has_grains && (choice >= CDEM_GRAIN_FIELDS || c->body->model.dimension == 3))
    return CDEM_OK; /* nothing to be seen */
  cdem_status status = make_map(c, &picture, choice, &map, fault);
  if (status == CDEM_OK && !c->has_grains)
    label_body(&picture, choice, &map);
  if (status == CDEM_OK)
    status = cdem_write_map(folder, cdem_run_picture_file(name, choice, tag), &map, fault);
  cdem_map_release(&map);
  return status;
}

cdem_status cdem_run_coupled_pictures(cdem_run_setup *run, const char *folder, const char *tag,
                                      cdem_fault *fault) {
  static const char *const usual[] = {"displacement", "effective_strain", "chains"};
  const cdem_run_coupled *c = cdem_run_coupled_of(run);
  const cdem_case_texts *wanted = &cdem_run_values(run)->grains.pictures;
  const double time = cdem_run_where(run).time;
  const cdem_run_axis axis = cdem_run_axis_for("s", time);
  int64_t count = wanted->count > 0 ? wanted->count : (int64_t)(sizeof usual / sizeof *usual);
  char title[80];
  snprintf(title, sizeof title, "t = %.4g %s", axis.factor * time, axis.unit);
  for (int64_t i = 0; i < count; i++) {
    int choice = cdem_run_picture_find(wanted->count > 0 ? wanted->item[i] : usual[i]);
    CDEM_TRY(draw(c, choice, title, folder, tag, fault));
  }
  return CDEM_OK;
}
