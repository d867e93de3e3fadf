/* Pictures of grains: discs, chains, arrows, walls, as parts of a map. */
#include "dem/pictures.h"

#include "base/sort.h"
#include "dem/pictures_kernels.h"

#include <stdlib.h>
#include <string.h>

#define PALE      "#dcdcdc"
#define PALER     "#f1f1f1"
#define WALL      "#3c3c3c"
#define BEYOND    0.01 /* part of the grains whose values are beyond the end of the bar */
#define STRONGEST 5.0  /* chains: times the mean push, where width stops growing */
#define FILLED    1.16 /* bands: grains so large that few gaps show in dense packings ... */
#define GROUND    1.45 /* ... and, below, so large that the gaps of a square lattice are covered */
#define CHAIN     0.28 /* width at the mean push, mean radii */
#define CUT_CHAIN 0.14 /* ... where chains at several depths cross */
enum { ARROWS = 1500 };

static const struct {
  const char *name, *label;
  bool diverging, zero;
} fields[CDEM_GRAIN_FIELDS] = {
    [CDEM_GRAIN_RADIUS] = {"radius", "radius R, m", false, false},
    [CDEM_GRAIN_SPEED] = {"speed", "speed |v|, m/s", false, true},
    [CDEM_GRAIN_DISPLACEMENT] = {"displacement", "displacement |u|, m", false, true},
    [CDEM_GRAIN_ROTATION] = {"rotation", "rotation θ, rad", true, true},
    [CDEM_GRAIN_PRESSURE] = {"pressure", "pressure p, Pa", false, true},
    [CDEM_GRAIN_EFFECTIVE_STRESS] = {"effective_stress", "effective stress σ_e, Pa", false, true},
    [CDEM_GRAIN_VOLUMETRIC_STRAIN] = {"volumetric_strain", "nominal volumetric strain ε_v", true,
                                      true},
    [CDEM_GRAIN_EFFECTIVE_STRAIN] = {"effective_strain", "nominal effective strain ε_e", false,
                                     true},
    [CDEM_GRAIN_CONTACTS] = {"contacts", "contacts of a grain", false, true},
};

const char *cdem_grain_field_name(int field) {
  return field >= 0 && field < CDEM_GRAIN_FIELDS ? fields[field].name : NULL;
}

int cdem_grain_field_find(const char *name) {
  for (int k = 0; k < CDEM_GRAIN_FIELDS; k++)
    if (strcmp(fields[k].name, name) == 0)
      return k;
  return -1;
}

/* ---- the eye ---- */

static cdem_status eye_init(const cdem_snapshot *s, const cdem_picture *p, cdem_picture_eye *eye,
                            cdem_fault *fault) {
  double low[3], high[3], length = cdem_norm3(p->view);
  *eye = (cdem_picture_eye){.right = {1, 0, 0}, .up = {0, 1, 0}, .into = {0, 0, -1}};
  eye->flat = s->dim == 2;
  eye->window = p->window;
  eye->left_out = p->left_out;
  eye->most = p->value_min < p->value_max ? p->value_max : 0.0;
  for (int64_t i = 0; i < s->grains; i++)
    eye->mean_radius += s->radius[i] / (double)s->grains;
  eye->reach = 2.0 * eye->mean_radius;
  if (eye->flat)
    return CDEM_OK;
  static const double along_y[3] = {0, 1, 0}, zenith[3] = {0, 0, 1};
  const double *view = length > 0.0 ? p->view : along_y;
  const double *up = cdem_norm3(p->up) > 0.0 ? p->up : zenith;
  double right[3];
  cdem_cross3(view, up, right);
  double size = cdem_norm3(right), far = cdem_norm3(view);
  CDEM_REQUIRE(size > 1e-6 * far * cdem_norm3(up) && isfinite(size), fault, CDEM_USAGE,
               "grains cannot be seen along (%g, %g, %g) with (%g, %g, %g) upwards; choose two "
               "directions that are not parallel",
               view[0], view[1], view[2], up[0], up[1], up[2]);
  cdem_snapshot_box(s, low, high);
  for (int c = 0; c < 3; c++) {
    eye->right[c] = right[c] / size;
    eye->into[c] = view[c] / far;
  }
  cdem_cross3(eye->right, eye->into, eye->up);
  for (int c = 0; c < 3; c++)
    eye->plane +=
        (p->slice && !p->middle ? p->through[c] : 0.5 * (low[c] + high[c])) * eye->into[c];
  eye->cut = p->slice || p->kind == CDEM_PICTURE_CHAINS || p->kind == CDEM_PICTURE_ARROWS;
  return CDEM_OK;
}

static void project(const cdem_picture_eye *eye, const double xyz[3], double xy[2]) {
  xy[0] = cdem_dot3(xyz, eye->right);
  xy[1] = cdem_dot3(xyz, eye->up);
}

static double depth_of(const cdem_picture_eye *eye, const double xyz[3]) {
  return eye->flat ? 0.0 : cdem_dot3(xyz, eye->into) - eye->plane;
}

bool cdem_picture_shows(const cdem_picture_eye *eye, const double xyz[3]) {
  bool in = true;
  for (int c = 0; c < 3; c++)
    in &= !(eye->window.low[c] < eye->window.high[c]) ||
          (xyz[c] >= eye->window.low[c] && xyz[c] < eye->window.high[c]);
  return in;
}

/* Near enough to the plane for chains and arrows. */
static bool is_near(const cdem_picture_eye *eye, const double xyz[3]) {
  return cdem_picture_shows(eye, xyz) && fabs(depth_of(eye, xyz)) <= eye->reach;
}

/* Radius of the circle that is seen of a grain; 0: it is hidden, or not cut. */
static double radius_seen(const cdem_picture_eye *eye, const cdem_snapshot *s, int64_t i) {
  double r = s->radius[i], d = depth_of(eye, s->xyz + 3 * i);
  if (eye->left_out != NULL && eye->left_out[i])
    return 0.0;
  return fabs(d) < r && cdem_picture_shows(eye, s->xyz + 3 * i) ? sqrt((r - d) * (r + d)) : 0.0;
}

/* ---- grains ---- */

static cdem_status put_discs(const cdem_snapshot *s, const cdem_picture_eye *eye,
                             const double *value, double larger, cdem_map *map, cdem_fault *fault) {
  int64_t seen = 0;
  cdem_map_marks *discs;
  for (int64_t i = 0; i < s->grains; i++)
    seen += radius_seen(eye, s, i) > 0.0;
  CDEM_TRY(cdem_map_add_marks(map, CDEM_MAP_DISCS, seen, true, false, &discs, fault));
  discs->rims = larger == 1.0;
  discs->colour = PALE;
  seen = 0;
  for (int64_t i = 0; i < s->grains; i++) {
    double radius = radius_seen(eye, s, i);
    if (!(radius > 0.0))
      continue;
    project(eye, s->xyz + 3 * i, discs->xy + 4 * seen);
    discs->size[seen] = larger * radius;
    discs->value[seen++] = value[i];
  }
  return CDEM_OK;
}

/* Grains below chains and arrows: pale, and paler where they carry nothing. */
static cdem_status put_pale(const cdem_snapshot *s, const cdem_picture_eye *eye, bool carry,
                            cdem_map *map, cdem_fault *fault) {
  for (int kind = 0; kind < 2; kind++) {
    int64_t seen = 0;
    cdem_map_marks *discs;
    for (int64_t i = 0; i < s->grains; i++)
      seen += radius_seen(eye, s, i) > 0.0 && (carry && s->touching[i] < 2) == (kind == 1);
    CDEM_TRY(cdem_map_add_marks(map, CDEM_MAP_DISCS, seen, false, false, &discs, fault));
    discs->colour = kind == 0 ? PALE : PALER;
    discs->rims = true;
    seen = 0;
    for (int64_t i = 0; i < s->grains; i++) {
      double radius = radius_seen(eye, s, i);
      if (!(radius > 0.0) || (carry && s->touching[i] < 2) != (kind == 1))
        continue;
      project(eye, s->xyz + 3 * i, discs->xy + 4 * seen);
      discs->size[seen++] = radius;
    }
  }
  return CDEM_OK;
}

/* ---- range of colours ---- */

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static cdem_status set_range(const double *value, int64_t count, bool diverging, bool zero,
                             cdem_map *map, cdem_fault *fault) {
  double *sorted;
  int64_t n = 0;
  CDEM_NEW(sorted, count, fault);
  for (int64_t i = 0; i < count; i++)
    if (isfinite(value[i]))
      sorted[n++] = diverging ? fabs(value[i]) : value[i];
  cdem_sort(sorted, n, sizeof *sorted, ascending);
  int64_t cut = (int64_t)(BEYOND * (double)n);
  if (n > 0) {
    map->value_max = sorted[n - 1 - cut];
    map->value_min = diverging ? -map->value_max : zero ? fmin(0.0, sorted[cut]) : sorted[0];
    if (!zero)
      map->value_max = sorted[n - 1];
  }
  free(sorted);
  return CDEM_OK;
}

/* ---- chains ---- */

typedef struct {
  double push;
  int64_t contact;
} chain;

static int by_push(const void *a, const void *b) {
  const chain *x = a, *y = b;
  if (x->push != y->push)
    return x->push > y->push ? 1 : -1;
  return (x->contact > y->contact) - (x->contact < y->contact);
}

/* A contact across the cell is drawn twice, half from either grain. */
static bool is_across(const cdem_snapshot *s, const cdem_dem_contact *c) {
  double off[3];
  if (s->cell == NULL || c->b < 0)
    return false;
  for (int k = 0; k < 3; k++)
    off[k] = s->xyz[3 * (int64_t)c->b + k] - s->xyz[3 * (int64_t)c->a + k] - c->branch[k];
  return cdem_norm3(off) > 1e-3 * cdem_norm3(c->branch);
}

static void put_chain(const cdem_snapshot *s, const cdem_picture_eye *eye, const chain *from,
                      double mean, cdem_map_marks *strokes) {
  const cdem_dem_contact *c = &s->contact[from->contact];
  bool across = is_across(s, c);
  for (int side = 0; side < (across ? 2 : 1); side++) {
    const double *x = s->xyz + 3 * (int64_t)(side == 0 ? c->a : c->b);
    double end[3], part = across ? 0.5 : 1.0, *xy = strokes->xy + 4 * strokes->marks;
    for (int k = 0; k < 3; k++)
      end[k] = x[k] + (side == 0 ? part : -part) * c->branch[k];
    project(eye, x, xy);
    project(eye, end, xy + 2);
    strokes->value[strokes->marks] = from->push / mean;
    strokes->size[strokes->marks++] = (eye->flat ? CHAIN : CUT_CHAIN) * eye->mean_radius *
                                      fmax(0.1, fmin(from->push / mean, STRONGEST));
  }
}

static cdem_status sort_chains(const cdem_snapshot *s, const cdem_picture_eye *eye, chain *list,
                               int64_t *count, double *mean, int64_t *strokes) {
  int64_t pushing = 0;
  *count = *strokes = 0;
  *mean = 0.0;
  for (int64_t k = 0; k < s->contacts; k++) {
    const cdem_dem_contact *c = &s->contact[k];
    if (!(c->push > 0.0))
      continue;
    *mean += c->push;
    pushing++;
    if (!is_near(eye, c->point))
      continue;
    list[(*count)++] = (chain){c->push, k};
    *strokes += is_across(s, c) ? 2 : 1;
  }
  *mean = pushing > 0 ? *mean / (double)pushing : 1.0;
  cdem_sort(list, *count, sizeof *list, by_push);
  return CDEM_OK;
}

/* With a range given, widths are against that, so that pictures can be compared. */
static cdem_status put_chains(const cdem_snapshot *s, const cdem_picture_eye *eye, cdem_map *map,
                              cdem_fault *fault) {
  chain *list;
  int64_t count, strokes;
  double mean;
  cdem_map_marks *marks;
  CDEM_NEW(list, s->contacts, fault);
  sort_chains(s, eye, list, &count, &mean, &strokes);
  cdem_status status =
      cdem_map_add_marks(map, CDEM_MAP_STROKES, strokes, true, false, &marks, fault);
  if (status == CDEM_OK) {
    marks->marks = 0;
    bool ranged = eye->most > 0.0;
    for (int64_t k = 0; k < count; k++)
      put_chain(s, eye, &list[k], ranged ? eye->most / STRONGEST : mean, marks);
    for (int64_t k = 0; ranged && k < marks->marks; k++)
      marks->value[k] *= eye->most / STRONGEST;
    map->value_label = ranged ? "push F_n, N" : "push over its mean, F_n/⟨F_n⟩";
    map->value_max = STRONGEST;
    map->reversed = true;
  }
  free(list);
  return status;
}

/* ---- arrows ---- */

/* Of each square the grain nearest to its middle. */
static cdem_status choose_arrows(const cdem_snapshot *s, const cdem_picture_eye *eye,
                                 int64_t *count, int64_t *chosen, double *size, cdem_fault *fault) {
  double low[2] = {0, 0}, high[2] = {0, 0}, xy[2], r = eye->mean_radius;
  int64_t seen = 0;
  for (int64_t i = 0; i < s->grains; i++) {
    if (!is_near(eye, s->xyz + 3 * i))
      continue;
    project(eye, s->xyz + 3 * i, xy);
    for (int c = 0; c < 2; c++) {
      low[c] = seen == 0 ? xy[c] : fmin(low[c], xy[c]);
      high[c] = seen == 0 ? xy[c] : fmax(high[c], xy[c]);
    }
    seen++;
  }
  double wide = high[0] - low[0] + 2.0 * r, tall = high[1] - low[1] + 2.0 * r;
  *size = seen > ARROWS ? fmax(2.0 * r, sqrt(wide * tall / ARROWS)) : 2.0 * r;
  int64_t columns = (int64_t)ceil(wide / *size), rows = (int64_t)ceil(tall / *size);
  int64_t *nearest;
  CDEM_NEW(nearest, seen > ARROWS ? columns * rows : 0, fault);
  *count = 0;
  for (int64_t i = 0; i < s->grains; i++) {
    if (!is_near(eye, s->xyz + 3 * i))
      continue;
    if (seen <= ARROWS) {
      chosen[(*count)++] = i;
      continue;
    }
    double off[2] = {0, 0};
    project(eye, s->xyz + 3 * i, xy);
    int64_t x = (int64_t)((xy[0] - low[0]) / *size), y = (int64_t)((xy[1] - low[1]) / *size);
    int64_t *at = &nearest[(y < rows ? y : rows - 1) * columns + (x < columns ? x : columns - 1)];
    for (int k = 0; k < 2 && *at > 0; k++) {
      project(eye, s->xyz + 3 * (k == 0 ? i : *at - 1), xy);
      off[k] = hypot(xy[0] - low[0] - ((double)x + 0.5) * *size,
                     xy[1] - low[1] - ((double)y + 0.5) * *size);
    }
    if (*at == 0 || off[0] < off[1])
      *at = i + 1;
  }
  for (int64_t k = 0; k < columns * rows && seen > ARROWS; k++)
    if (nearest[k] > 0)
      chosen[(*count)++] = nearest[k] - 1;
  free(nearest);
  return CDEM_OK;
}

static cdem_status fill_arrows(const cdem_snapshot *s, const cdem_picture_eye *eye, int64_t count,
                               const int64_t *chosen, double size, cdem_map *map,
                               cdem_fault *fault) {
  cdem_map_marks *arrows;
  CDEM_TRY(cdem_map_add_marks(map, CDEM_MAP_ARROWS, count, true, false, &arrows, fault));
  for (int64_t k = 0; k < count; k++)
    arrows->value[k] = cdem_norm3(s->velocity + 3 * chosen[k]);
  CDEM_TRY(set_range(arrows->value, count, false, true, map, fault));
  double fastest = eye->most > 0.0 ? eye->most : map->value_max;
  double longest = fastest > 0.0 ? 2.2 * size / fastest : 0.0;
  for (int64_t k = 0; k < count; k++) {
    double *xy = arrows->xy + 4 * k, way[2];
    project(eye, s->xyz + 3 * chosen[k], xy);
    project(eye, s->velocity + 3 * chosen[k], way);
    double length = longest * hypot(way[0], way[1]);
    double shorten = length > 3.0 * size ? 3.0 * size / length : 1.0;
    for (int c = 0; c < 2; c++)
      xy[2 + c] = xy[c] + longest * shorten * way[c];
    arrows->size[k] = 0.14 * size;
  }
  map->value_label = fields[CDEM_GRAIN_SPEED].label;
  map->reversed = true;
  return CDEM_OK;
}

static cdem_status put_arrows(const cdem_snapshot *s, const cdem_picture_eye *eye, cdem_map *map,
                              cdem_fault *fault) {
  int64_t *chosen, count;
  double size;
  CDEM_NEW(chosen, s->grains, fault);
  cdem_status status = choose_arrows(s, eye, &count, chosen, &size, fault);
  if (status == CDEM_OK)
    status = fill_arrows(s, eye, count, chosen, size, map, fault);
  free(chosen);
  return status;
}

/* ---- walls ---- */

/* Of a facet in a cut, the line where the plane goes through it; else its edges. Returns how many
 * lines; xy NULL: only counts. */
static int facet_lines(const cdem_wall_surface *w, const cdem_picture_eye *eye, int64_t facet,
                       double *xy) {
  int corners = (int)(w->offset[facet + 1] - w->offset[facet]), lines = 0;
  double ends[2][3];
  for (int k = 0; k < corners; k++) {
    const double *a = w->xyz + 3 * (int64_t)w->node[w->offset[facet] + k];
    const double *b = w->xyz + 3 * (int64_t)w->node[w->offset[facet] + (k + 1) % corners];
    if (!eye->cut) {
      if (corners == 2 && k == 1)
        break;
      if (xy != NULL) {
        project(eye, a, xy + 4 * lines);
        project(eye, b, xy + 4 * lines + 2);
      }
      lines++;
      continue;
    }
    double from = depth_of(eye, a), to = depth_of(eye, b);
    if ((from < 0.0) == (to < 0.0) || lines == 2)
      continue;
    for (int c = 0; c < 3; c++)
      ends[lines][c] = a[c] + from / (from - to) * (b[c] - a[c]);
    lines++;
  }
  if (!eye->cut)
    return lines;
  if (lines == 2 && xy != NULL) {
    project(eye, ends[0], xy);
    project(eye, ends[1], xy + 2);
  }
  return lines == 2;
}

static cdem_status put_walls(const cdem_wall_surface *walls, const cdem_picture_eye *eye,
                             cdem_map *map, cdem_fault *fault) {
  int64_t count = 0;
  cdem_map_lines *lines;
  for (int64_t f = 0; f < walls->facets; f++)
    count += facet_lines(walls, eye, f, NULL);
  if (count == 0)
    return CDEM_OK;
  CDEM_TRY(cdem_map_add_segments(map, count, NULL, eye->flat || eye->cut ? WALL : "#9a9a9a",
                                 eye->flat || eye->cut ? 1.4 : 0.5, &lines, fault));
  count = 0;
  for (int64_t f = 0; f < walls->facets; f++)
    count += facet_lines(walls, eye, f, lines->xy + 4 * count);
  return CDEM_OK;
}

/* ---- the picture ---- */

static void label_axes(const cdem_picture_eye *eye, cdem_map *map) {
  static const char *const names[3] = {"x, m", "y, m", "z, m"};
  for (int c = 0; c < 3 && (eye->flat || eye->cut); c++) {
    map->x_label = eye->right[c] > 1.0 - 1e-12 ? names[c] : map->x_label;
    map->y_label = eye->up[c] > 1.0 - 1e-12 ? names[c] : map->y_label;
  }
  if (map->x_label == NULL || map->y_label == NULL)
    map->x_label = map->y_label = NULL;
}

static cdem_status put_field(const cdem_snapshot *s, const cdem_picture_eye *eye,
                             const double *value, const cdem_picture *p, cdem_map *map,
                             cdem_fault *fault) {
  map->value_label = fields[p->field].label;
  map->diverging = fields[p->field].diverging && (s->dim == 2 || p->field != CDEM_GRAIN_ROTATION);
  CDEM_TRY(set_range(value, s->grains, map->diverging, fields[p->field].zero, map, fault));
  if (!(map->value_min < map->value_max))
    map->value_label = NULL;
  if (!eye->flat && !eye->cut)
    return cdem_picture_spheres(s, eye, value, map, fault);
  if (p->kind == CDEM_PICTURE_GRAINS)
    return put_discs(s, eye, value, 1.0, map, fault);
  CDEM_TRY(put_discs(s, eye, value, GROUND, map, fault));
  return put_discs(s, eye, value, FILLED, map, fault);
}

/* Of many grains larger, so that single ones show. */
static double page_of(const cdem_snapshot *s, const cdem_picture_eye *eye) {
  int64_t seen = 0;
  for (int64_t i = 0; i < s->grains; i++)
    seen += cdem_picture_shows(eye, s->xyz + 3 * i);
  return fmax(1.0, fmin(1.6, 0.7 * pow((double)seen, 0.09)));
}

static cdem_status draw(const cdem_snapshot *s, const cdem_wall_surface *walls, const double *value,
                        const cdem_picture *p, cdem_map *map, cdem_fault *fault) {
  cdem_picture_eye eye;
  CDEM_TRY(eye_init(s, p, &eye, fault));
  map->title = p->title;
  map->page = page_of(s, &eye);
  label_axes(&eye, map);
  if (p->kind == CDEM_PICTURE_GRAINS || p->kind == CDEM_PICTURE_BAND)
    CDEM_TRY(put_field(s, &eye, value, p, map, fault));
  else {
    CDEM_TRY(put_pale(s, &eye, p->kind == CDEM_PICTURE_CHAINS, map, fault));
    CDEM_TRY(p->kind == CDEM_PICTURE_CHAINS ? put_chains(s, &eye, map, fault)
                                            : put_arrows(s, &eye, map, fault));
  }
  if (p->value_min < p->value_max) {
    map->value_min = p->value_min;
    map->value_max = p->value_max;
  }
  return p->no_walls || walls == NULL ? CDEM_OK : put_walls(walls, &eye, map, fault);
}

cdem_status cdem_picture_make(const cdem_snapshot *s, const cdem_wall_surface *walls,
                              const double *value, const cdem_picture *picture, cdem_map *map,
                              cdem_fault *fault) {
  cdem_map made = {0};
  cdem_status status = draw(s, walls, value, picture, &made, fault);
  if (status == CDEM_OK)
    *map = made;
  else
    cdem_map_release(&made);
  return status;
}
