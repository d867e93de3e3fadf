/* Figures 2 to 7 of Wei et al. 2006, for any element: stiffness and direction against Poisson's
 * ratio. Signs of directions are followed, so that curves are continuous (the source turns some of
 * them over at 1/4). Complex and Jordan intervals leave a gap in directions; their stiffnesses are
 * drawn as single value, real and imaginary part. */
#include "io/io.h"
#include "poisson.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { POINTS = 481, MOST_CURVES = 7 + CDEM_POISSON_ROOTS, MOST_PANELS = 12, SPRINGS = 4 };

/* Numbers of one class over nu; NaN where there is none. */
typedef struct {
  const cdem_specimen_pair *pair;
  cdem_poisson_study study;
  bool frame; /* four springs everywhere: k[0], k[1] = h, dir[spring] */
  double nu[POINTS];
  double k[3][POINTS];
  double complex[3][POINTS]; /* single value, real and imaginary part of the pair */
  double dir[SPRINGS][3][POINTS];
  double complex_dir[3][3][POINTS]; /* of the single value, Re v and Im v */
  double guide_x[CDEM_POISSON_ROOTS][2], guide_y[CDEM_POISSON_ROOTS][2];
  double axis_x[2], axis_y[2]; /* the line of zero; it also sets the range of the axis */
  int guides;
} samples;

typedef struct {
  samples data;
  cdem_curve curve[MOST_PANELS][MOST_CURVES];
  cdem_panel panel[MOST_PANELS];
  char title[MOST_PANELS][64];
} drawing;

static const char *const class_title[] = {"Edge", "Face-diagonal", "Body-diagonal"};
static const char *const component[] = {"x", "y", "z"};

static bool is_cosserat(const samples *data) {
  return data->pair->specimen->options.element->formulation == CDEM_PLANE_COSSERAT;
}

/* The source's range: where the set is diagonal around 1/4, from 0 to where stiffnesses begin to
 * grow without bound. The ends step aside from changes of form, where directions have no limit. */
static void choose_range(const cdem_poisson_study *study, const poisson_range *range, double *from,
                         double *to) {
  *from = range != NULL ? range->from : 0.0;
  *to = range != NULL ? range->to : 0.45;
  for (int i = 0; i < study->roots.count && range == NULL; i++) {
    const cdem_poisson_root *root = &study->roots.root[i];
    if (root->from == root->to)
      continue;
    if (root->nu < 0.25)
      *from = fmax(*from, root->nu + 5e-7);
    else
      *to = root->nu - 5e-7; /* bounded stiffnesses: up to the change itself */
  }
}

static void note_guides(samples *data, double from, double to) {
  const cdem_poisson_roots *roots = &data->study.roots;
  for (int i = 0; i < roots->count; i++)
    if (roots->root[i].nu > from && roots->root[i].nu < to) {
      data->guide_x[data->guides][0] = data->guide_x[data->guides][1] = roots->root[i].nu;
      data->guides++;
    }
}

static void keep_row(samples *data, int i, const cdem_poisson_row *row) {
  bool real = row->form == CDEM_FORM_DIAGONAL, complex_pair = row->form == CDEM_FORM_COMPLEX;
  int pair = row->size - 2;
  for (int k = 0; k < 3; k++) {
    data->k[k][i] = real ? row->k[k] : NAN;
    data->complex[k][i] = NAN;
    for (int d = 0; d < 3; d++)
      data->dir[k][d][i] = data->complex_dir[k][d][i] = NAN;
  }
  for (int k = 0; k < row->size; k++)
    for (int d = 0; d < row->size; d++)
      if (real)
        data->dir[k][d][i] = row->dir[k][d];
      else if (complex_pair)
        data->complex_dir[k + 1 - pair][d][i] = row->dir[k][d];
  if (complex_pair) {
    data->complex[0][i] = pair == 1 ? row->k[0] : NAN;
    data->complex[1][i] = row->k[pair];
    data->complex[2][i] = row->coupling;
  }
  data->frame = data->frame && !isnan(row->frame_h);
  if (data->frame)
    data->k[1][i] = row->frame_h;
}

/* The directions of four springs come from the frame itself. */
static cdem_status keep_frame(samples *data, int i, cdem_fault *fault) {
  double s[9];
  cdem_spring_set set;
  const cdem_poisson_family *family = &data->study.family;
  CDEM_TRY(family->block(family->context, data->nu[i], s, fault));
  CDEM_TRY(cdem_springs_from_block(s, 3, true, &set, fault));
  for (int k = 0; k < SPRINGS; k++)
    for (int d = 0; d < 3; d++)
      data->dir[k][d][i] = set.form == CDEM_FORM_FRAME ? set.row[k].dir[d] : NAN;
  return CDEM_OK;
}

static bool is_empty(const double *y) {
  for (int i = 0; i < POINTS; i++)
    if (!isnan(y[i]))
      return false;
  return true;
}

/* A direction is a line: each curve family is turned to the side on which its largest component is
 * positive, unless a complex interval, whose pair turns together, continues it. */
static void turn_directions(samples *data) {
  if (!is_empty(data->complex[1]))
    return;
  for (int k = 0; k < SPRINGS; k++) {
    double sum[3] = {0}, size[3] = {0};
    int largest = 2;
    for (int d = 2; d >= 0; d--) {
      for (int i = 0; i < POINTS; i++)
        if (!isnan(data->dir[k][d][i])) {
          sum[d] += data->dir[k][d][i];
          size[d] += fabs(data->dir[k][d][i]);
        }
      if (size[d] > size[largest] * (1.0 + 1e-9))
        largest = d;
    }
    for (int d = 0; d < 3 && sum[largest] < 0.0; d++)
      for (int i = 0; i < POINTS; i++)
        data->dir[k][d][i] = -data->dir[k][d][i];
  }
}

static cdem_status sample(cdem_specimen_pair *pair, const poisson_range *range, samples *data,
                          cdem_fault *fault) {
  cdem_poisson_family family = cdem_specimen_family(pair);
  cdem_poisson_row row = {0};
  double from, to;
  *data = (samples){.pair = pair, .frame = true};
  CDEM_TRY(cdem_poisson_study_init(&family, &data->study, fault));
  choose_range(&data->study, range, &from, &to);
  note_guides(data, from, to);
  data->axis_x[0] = range != NULL ? from : 0.0;
  data->axis_x[1] = range != NULL ? to : 0.5;
  for (int i = 0; i < POINTS; i++) {
    data->nu[i] = from + (to - from) * (1.0 - cos(acos(-1.0) * i / (POINTS - 1))) /
                             2.0; /* dense at the ends, where roots are vertical */
    CDEM_TRY(cdem_poisson_follow(&data->study, data->nu[i], &row, fault));
    keep_row(data, i, &row);
  }
  for (int i = 0; i < POINTS && data->frame; i++)
    CDEM_TRY(keep_frame(data, i, fault));
  turn_directions(data);
  return CDEM_OK;
}

/* ---- panels ---- */

static void add_curve(drawing *d, int panel, const char *title, const double *y, int style) {
  if (is_empty(y))
    return;
  cdem_curve *curve = &d->curve[panel][d->panel[panel].curves++];
  *curve = (cdem_curve){title, d->data.nu, y, POINTS, style};
}

/* The line of zero and vertical lines at the critical ratios, behind the curves that come after. */
static void add_guides(drawing *d, int panel) {
  d->curve[panel][d->panel[panel].curves++] =
      (cdem_curve){NULL, d->data.axis_x, d->data.axis_y, 2, -1};
  for (int g = 0; g < d->data.guides; g++)
    d->curve[panel][d->panel[panel].curves++] =
        (cdem_curve){NULL, d->data.guide_x[g], d->data.guide_y[g], 2, -1};
}

static void begin_panel(drawing *d, int panel, const char *y_label, double low, double high) {
  d->panel[panel] = (cdem_panel){.title = d->title[panel],
                                 .x_label = "Poisson's ratio ν",
                                 .y_label = y_label,
                                 .curve = d->curve[panel],
                                 .y_min = low,
                                 .y_max = high};
}

static void widen(const double *y, double *low, double *high) {
  for (int i = 0; i < POINTS; i++)
    if (!isnan(y[i])) {
      *low = fmin(*low, y[i]);
      *high = fmax(*high, y[i]);
    }
}

static const char *stiffness_label(const cdem_specimen *specimen) {
  const cdem_specimen_options *o = &specimen->options;
  bool unit = specimen->regular && o->young == 1.0 && o->box[0] == 1.0 &&
              (o->element->formulation == CDEM_SOLID || o->section.thickness == 1.0);
  if (!unit)
    return "spring stiffness, N/m";
  return o->element->formulation == CDEM_SOLID ? "spring stiffness / (E L)"
                                               : "spring stiffness / (E t)";
}

/* From the lowest to the highest value there, and a little more: clear of the legend. */
static void place_guides(samples *data, double margin) {
  for (int g = 0; g < data->guides; g++) {
    double low = INFINITY, high = -INFINITY;
    int i = 0;
    while (i + 2 < POINTS && data->nu[i + 1] < data->guide_x[g][0])
      i++;
    for (int k = 0; k < 3; k++)
      for (int side = i; side < i + 2; side++) {
        low = fmin(low, fmin(data->k[k][side], data->complex[k][side]));
        high = fmax(high, fmax(data->k[k][side], data->complex[k][side]));
      }
    data->guide_y[g][0] = low - margin;
    data->guide_y[g][1] = high + margin;
  }
}

static cdem_status draw_stiffness(drawing *d, const char *folder, cdem_fault *fault) {
  static const char *const real_title[] = {"k_1", "k_2", "k_3"};
  static const char *const complex_title[] = {"single value", "pair, real part",
                                              "pair, imaginary part"};
  samples *data = &d->data;
  const cdem_specimen *specimen = data->pair->specimen;
  char name[32], pair[24];
  double low = INFINITY, high = -INFINITY;
  for (int k = 0; k < (data->frame ? 2 : 3); k++) {
    widen(data->k[k], &low, &high);
    widen(data->complex[k], &low, &high);
  }
  place_guides(data, 0.08 * (high - low));
  poisson_pair_name(data->pair, pair);
  snprintf(d->title[0], sizeof d->title[0], "%s springs, %s, pair %s",
           class_title[data->pair->class_], specimen->options.element->name, pair);
  begin_panel(d, 0, stiffness_label(specimen), 0.0, 0.0);
  add_guides(d, 0);
  if (data->frame) {
    add_curve(d, 0, "k_1, along the diagonal", data->k[0], 0);
    add_curve(d, 0, "h, each of three across", data->k[1], 1);
  }
  for (int k = 0; k < 3 && !data->frame; k++)
    add_curve(d, 0, real_title[k], data->k[k], k);
  for (int k = 0; k < 3 && !data->frame; k++)
    add_curve(d, 0, complex_title[k], data->complex[k], 3 + k);
  const cdem_figure figure = {.columns = 1, .panels = 1, .panel = d->panel};
  snprintf(name, sizeof name, "%s-stiffness", cdem_class_name(data->pair->class_));
  return cdem_write_figure(folder, name, &figure, fault);
}

/* Panel of one spring (row) and component; with complex sets in the range, both forms with their
 * legend, for which the axis leaves room. */
static void draw_component(drawing *d, int panel, int spring, int axis) {
  static const char *const complex_title[] = {"complex: single value", "complex: Re v",
                                              "complex: Im v"};
  static const char *const real_title[] = {"k_1", "k_2", "k_3"};
  samples *data = &d->data;
  int size = data->study.family.size, part = spring < 3 ? spring + 3 - size : 0;
  bool both = !data->frame && !is_empty(data->complex[1]);
  const char *letter = axis == 2 && is_cosserat(data) ? "ℓω" : component[axis];
  if (data->frame)
    snprintf(d->title[panel], sizeof d->title[panel], "spring %d (%s), %s component", spring + 1,
             spring == 0 ? "k_1" : "h", letter);
  else
    snprintf(d->title[panel], sizeof d->title[panel], "spring %d, %s component", spring + 1,
             letter);
  begin_panel(d, panel, axis == 0 ? "component of unit vector" : NULL, -1.1, both ? 1.9 : 1.1);
  add_guides(d, panel);
  add_curve(d, panel, both ? real_title[spring] : NULL, data->dir[spring][axis], spring);
  if (both)
    add_curve(d, panel, complex_title[part], data->complex_dir[part][axis], 3 + part);
}

/* Labels stand at the left and at the bottom only. */
static cdem_status draw_directions(drawing *d, const char *folder, cdem_fault *fault) {
  samples *data = &d->data;
  int size = data->study.family.size, rows = data->frame ? SPRINGS : size;
  char name[32];
  for (int g = 0; g < data->guides; g++) {
    data->guide_y[g][0] = -1.1;
    data->guide_y[g][1] = 1.1;
  }
  for (int p = 0; p < rows * size; p++) {
    draw_component(d, p, p / size, p % size);
    if (p / size + 1 < rows)
      d->panel[p].x_label = NULL;
  }
  const cdem_figure figure = {.columns = size, .panels = rows * size, .panel = d->panel};
  snprintf(name, sizeof name, "%s-directions", cdem_class_name(data->pair->class_));
  return cdem_write_figure(folder, name, &figure, fault);
}

static cdem_status draw_pair(const cdem_specimen *specimen, int index, const poisson_range *range,
                             const char *folder, drawing *d, cdem_fault *fault) {
  cdem_specimen_pair pair = cdem_specimen_pair_at(specimen, index);
  CDEM_TRY(sample(&pair, range, &d->data, fault));
  CDEM_TRY(draw_stiffness(d, folder, fault));
  return draw_directions(d, folder, fault);
}

cdem_status poisson_draw_figures(const cdem_specimen *specimen, const poisson_range *range,
                                 const char *folder, cdem_fault *fault) {
  int pairs[CDEM_MAX_PAIRS], count = poisson_choose_pairs(specimen, false, pairs);
  drawing *d;
  CDEM_NEW(d, 1, fault);
  cdem_status status = CDEM_OK;
  for (int p = 0; p < count && status == CDEM_OK; p++)
    status = draw_pair(specimen, pairs[p], range, folder, d, fault);
  free(d);
  return status;
}
