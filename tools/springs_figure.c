/* Three cumulative distributions: stiffness, angle of the stiffest spring to the line of its nodes,
 * skew fraction. */
#include "springs_figure.h"

#include "io/io.h"

#include <stdlib.h>

enum { KEPT_PAIRS = 100000, QUANTITIES = 3 };
enum { STIFFNESS, ANGLE, SKEW };

typedef struct {
  double *value;
  int64_t count, capacity;
} sample;

struct springs_figure {
  const cdem_model *model;
  int64_t stride, seen;
  sample sample[QUANTITIES][CDEM_CLASS_COUNT];
  double *share[QUANTITIES][CDEM_CLASS_COUNT];
};

cdem_status springs_figure_create(const cdem_model *model, springs_figure **figure,
                                  cdem_fault *fault) {
  *figure = cdem_allocate(1, sizeof **figure, fault);
  if (*figure == NULL)
    return CDEM_MEMORY;
  (*figure)->model = model;
  (*figure)->stride = 1 + model->pairs / KEPT_PAIRS;
  return CDEM_OK;
}

void springs_figure_destroy(springs_figure **figure) {
  if (*figure == NULL)
    return;
  for (int q = 0; q < QUANTITIES; q++)
    for (int c = 0; c < CDEM_CLASS_COUNT; c++) {
      free((*figure)->sample[q][c].value);
      free((*figure)->share[q][c]);
    }
  free(*figure);
  *figure = NULL;
}

static cdem_status keep(sample *s, double value, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&s->value, &s->capacity, s->count + 1, sizeof *s->value, fault));
  s->value[s->count++] = value;
  return CDEM_OK;
}

/* Degrees between the direction of the largest stiffness and the line of the two nodes. */
static double angle_of(const cdem_model *model, const cdem_pair *pair) {
  const double *xi = model->mesh->xyz + 3 * (int64_t)pair->node[0],
               *xj = model->mesh->xyz + 3 * (int64_t)pair->node[1];
  const cdem_spring_row *stiffest = &pair->set.row[0];
  for (int r = 1; r < pair->set.rows; r++)
    if (pair->set.row[r].stiffness > stiffest->stiffness)
      stiffest = &pair->set.row[r];
  double line[3],
      dir[3] = {stiffest->dir[0], stiffest->dir[1], model->dimension == 3 ? stiffest->dir[2] : 0.0};
  for (int c = 0; c < 3; c++)
    line[c] = xj[c] - xi[c];
  double cosine = fabs(cdem_dot3(line, dir)) / (cdem_norm3(line) * cdem_norm3(dir));
  return acos(fmin(cosine, 1.0)) * 180.0 / acos(-1.0);
}

static cdem_status write(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                         cdem_fault *fault) {
  (void)buffer;
  springs_figure *figure = context;
  for (int64_t p = 0; p < chunk->pairs; p++) {
    if (figure->seen++ % figure->stride != 0)
      continue;
    const cdem_pair *pair = &chunk->pair[p];
    for (int r = 0; r < pair->set.rows; r++)
      CDEM_TRY(
          keep(&figure->sample[STIFFNESS][pair->class_], 1e-6 * pair->set.row[r].stiffness, fault));
    CDEM_TRY(keep(&figure->sample[ANGLE][pair->class_], angle_of(chunk->model, pair), fault));
    CDEM_TRY(keep(&figure->sample[SKEW][pair->class_],
                  cdem_springs_skew(pair->block, pair->set.size), fault));
  }
  return CDEM_OK;
}

cdem_pair_sink springs_figure_sink(springs_figure *figure) {
  return (cdem_pair_sink){.context = figure, .write = write};
}

static int ascending(const void *left, const void *right) {
  double a = *(const double *)left, b = *(const double *)right;
  return (a > b) - (a < b);
}

/* Sorts a sample and thins it to 400 points of its cumulative distribution. */
static cdem_status distribute(sample *s, double **share, cdem_fault *fault) {
  enum { POINTS = 400 };
  if (s->count > 1)
    qsort(s->value, (size_t)s->count, sizeof *s->value, ascending);
  int64_t points = s->count < POINTS ? s->count : POINTS;
  CDEM_NEW(*share, points, fault);
  for (int64_t i = 0; i < points; i++) {
    int64_t at = points > 1 ? i * (s->count - 1) / (points - 1) : 0;
    s->value[i] = s->value[at];
    (*share)[i] = s->count > 1 ? (double)at / (double)(s->count - 1) : 1.0;
  }
  s->count = points;
  return CDEM_OK;
}

cdem_status springs_figure_write(springs_figure *figure, const char *folder, cdem_fault *fault) {
  static const char *const title[QUANTITIES] = {"stiffness", "stiffest spring", "skewness"};
  static const char *const label[QUANTITIES] = {"stiffness of a spring (MN/m)",
                                                "angle to the line of its nodes (degrees)",
                                                "skew fraction |S - S^T| / (2 |S|)"};
  cdem_curve curve[QUANTITIES][CDEM_CLASS_COUNT];
  cdem_panel panel[QUANTITIES];
  for (int q = 0; q < QUANTITIES; q++) {
    int curves = 0;
    for (int c = 0; c < CDEM_CLASS_COUNT; c++) {
      sample *s = &figure->sample[q][c];
      CDEM_TRY(distribute(s, &figure->share[q][c], fault));
      if (s->count > 0)
        curve[q][curves++] = (cdem_curve){.title = cdem_class_name((cdem_class)c),
                                          .x = s->value,
                                          .y = figure->share[q][c],
                                          .points = s->count,
                                          .style = c};
    }
    panel[q] =
        (cdem_panel){.title = title[q],
                     .x_label = label[q],
                     .y_label = q == 0 ? "share of the springs below" : "share of the pairs below",
                     .curves = curves,
                     .curve = curve[q],
                     .y_min = 0.0,
                     .y_max = 1.0};
  }
  const cdem_figure drawing = {.title = "", .columns = 3, .panels = QUANTITIES, .panel = panel};
  return cdem_write_figure(folder, "springs", &drawing, fault);
}
