/* What the interface of grains and body throws back of a wave, measured with the solvers beside
 * what was derived (docs/theory/bsm-waves.md):
 *
 *     bench_bsm-waves FOLDER        the figure FOLDER/waves.png, .svg; the points as CSV to stdout
 *
 * Takes about a minute. Nothing is asserted here: `cdem verify bsm --slow` does that. */
#include "bench.h"
#include "io/io.h"
#include "verify/bsm_waves.h"

#include <math.h>
#include <string.h>

enum { LINE = 400, MOST_POINTS = 24, MOST_SERIES = 5 };

/* One chain in one panel. */
typedef struct {
  const char *title;
  cdem_bsm_chain chain;
} series;

typedef struct {
  const char *title, *x_label, *y_label;
  bool by_element; /* x is k h, else k a */
  bool decibels;   /* y is 20 log |R|, else |R| */
  double most;     /* largest x */
  double y_min, y_max;
  int points;
  double at[MOST_POINTS]; /* x of what is measured */
  int count;
  series chain[MOST_SERIES];
} panel;

static const panel panels[] =
    {{.title = "Element length",
      .x_label = "k a",
      .y_label = "|R|",
      .most = 2.0,
      .y_max = 1.1,
      .points = 15,
      .at = {0.02, 0.05, 0.1, 0.15, 0.25, 0.35, 0.5, 0.65, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0},
      .count = 3,
      .chain = {{"h = 5 a", {.ratio = 5, .grains = 800}},
                {"h = 10 a", {.ratio = 10, .grains = 800}},
                {"h = 23 a", {.ratio = 23, .grains = 1150}}}},
     {.title = "Forms, h = 10 a",
      .x_label = "k h",
      .y_label = "|R|",
      .by_element = true,
      .most = 3.0,
      .y_max = 1.1,
      .points = 11,
      .at = {0.2, 0.5, 0.75, 1.0, 1.25, 1.5, 1.7, 1.85, 2.2, 2.5, 3.0},
      .count = 3,
      .chain = {{"interface", {.ratio = 10}},
                {"virtual work", {.ratio = 10, .form = CDEM_BSM_VIRTUAL_WORK}},
                {"b = a/4", {.ratio = 10, .place = 0.25}}}},
     {.title = "Cycles, h = 5 a",
      .x_label = "k a",
      .y_label = "|R|",
      .most = 2.0,
      .y_max = 1.25,
      .points = 15,
      .at = {0.02, 0.05, 0.1, 0.15, 0.25, 0.35, 0.5, 0.65, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0},
      .count = 3,
      .chain =
          {{"m = 1", {.ratio = 5, .step = 0.1, .grains = 800}},
           {"m = 10, eq. (10)",
            {.ratio = 5, .step = 0.1, .cycles = 10, .grains = 800, .way = CDEM_BSM_ACCELERATION}},
           {"m = 10, eq. (11)", {.ratio = 5, .step = 0.1, .cycles = 10, .grains = 800}}}},
     {.title = "Absorbing layer, h = 10 a",
      .x_label = "k h",
      .y_label = "energy back, dB",
      .by_element = true,
      .decibels = true,
      .most = 16.0,
      .points = 17,
      .at = {0.5, 1.0, 1.5, 2.2, 2.6, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 14.0,
             16.0},
      .count = 4,
      .chain = {{"no layer", {.ratio = 10}},
                {"1 element, c = 5 c_0/h", {.ratio = 10, .layers = 1, .rate = 5.0}},
                {"2 elements, c = 2 c_0/h", {.ratio = 10, .layers = 2, .rate = 2.0}},
                {"3 elements, c = 1.5 c_0/h", {.ratio = 10, .layers = 3, .rate = 1.5}}}}};

enum { PANELS = sizeof panels / sizeof *panels };

typedef struct {
  double x[LINE], y[LINE], measured[MOST_POINTS];
} numbers;

static numbers all[PANELS][MOST_SERIES];

static double shown(const panel *p, double back) {
  return p->decibels ? 20.0 * log10(back) : back;
}

static cdem_status fill(const panel *p, const series *s, numbers *to, cdem_fault *fault) {
  double scale = p->by_element ? s->chain.ratio : 1.0, ka[MOST_POINTS];
  for (int i = 0; i < LINE; i++) {
    cdem_bsm_reflection r;
    to->x[i] = fmax(p->most * i / (LINE - 1), 0.01 * p->most);
    CDEM_TRY(cdem_bsm_waves_derive(&s->chain, to->x[i] / scale, &r, fault));
    to->y[i] = shown(p, r.back);
  }
  for (int i = 0; i < p->points; i++)
    ka[i] = p->at[i] / scale;
  CDEM_TRY(cdem_bsm_waves_measure(&s->chain, p->points, ka, to->measured, fault));
  for (int i = 0; i < p->points; i++) {
    cdem_bsm_reflection r;
    CDEM_TRY(cdem_bsm_waves_derive(&s->chain, ka[i], &r, fault));
    printf("\"%s\",\"%s\",%.17g,%.6f,%.6f\n", p->title, s->title, ka[i], to->measured[i], r.back);
    to->measured[i] = shown(p, to->measured[i]);
  }
  return CDEM_OK;
}

static cdem_status draw(const char *folder, cdem_fault *fault) {
  static cdem_curve curve[PANELS][2 * MOST_SERIES];
  cdem_panel drawn[PANELS];
  for (int i = 0; i < PANELS; i++) {
    const panel *p = &panels[i];
    int curves = 0;
    for (int k = 0; k < p->count; k++)
      curve[i][curves++] = (cdem_curve){.title = p->chain[k].title,
                                        .x = all[i][k].x,
                                        .y = all[i][k].y,
                                        .points = LINE,
                                        .style = k};
    for (int k = 0; k < p->count; k++)
      curve[i][curves++] = (cdem_curve){.title = NULL,
                                        .x = p->at,
                                        .y = all[i][k].measured,
                                        .points = p->points,
                                        .style = CDEM_CURVE_RINGS + k};
    drawn[i] = (cdem_panel){.title = p->title,
                            .x_label = p->x_label,
                            .y_label = p->y_label,
                            .curves = curves,
                            .curve = curve[i],
                            .y_min = p->y_min,
                            .y_max = p->y_max};
  }
  const cdem_figure figure = {.title =
                                  "Reflection at the interface: derived (lines), measured (rings)",
                              .columns = 2,
                              .panels = PANELS,
                              .panel = drawn};
  return cdem_write_figure(folder, "waves", &figure, fault);
}

int main(int argc, char **argv) {
  cdem_fault fault = {0};
  if (argc != 2) {
    fprintf(stderr, "usage: bench_bsm-waves FOLDER\n");
    return 2;
  }
  printf("panel,chain,ka,measured,derived\n");
  for (int i = 0; i < PANELS; i++)
    for (int k = 0; k < panels[i].count; k++)
      give_up(fill(&panels[i], &panels[i].chain[k], &all[i][k], &fault), &fault);
  give_up(draw(argv[1], &fault), &fault);
  return 0;
}
