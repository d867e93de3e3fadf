/* Curves of the contacts between grains as figures: how hard they push, where they point. */
#include "dem/measures.h"
#include "io/io.h"
#include "run/grains.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Ten degrees a bin of the plane, a tenth of the cosine to z in space. */
enum { DIRECTIONS = 18, COSINES = 10 };

static const double pi = 3.14159265358979323846;

/* The first term of the series of the density that the fabric gives (Rothenburg & Bathurst 1989):
 * (1 + a cos 2 (angle - of)) / pi in the plane; in space 1 + a (3 c^2 - 1)/2 over |cos| to z. */
typedef struct {
  double a, of;
} first_term;

static first_term term_of(int dim, const double fabric[9]) {
  if (dim == 3)
    return (first_term){2.5 * (3.0 * fabric[8] - 1.0), 0.0};
  const double cosine = 2.0 * (fabric[0] - fabric[4]), sine = 4.0 * fabric[1];
  double of = 0.5 * atan2(sine, cosine);
  return (first_term){hypot(cosine, sine), of < 0.0 ? of + pi : of};
}

static double density_at(int dim, first_term term, double place) {
  return dim == 2 ? (1.0 + term.a * cos(2.0 * (place - term.of))) / pi
                  : 1.0 + 0.5 * term.a * (3.0 * place * place - 1.0);
}

static void say_term(int dim, first_term term, char text[48]) {
  if (dim == 2)
    snprintf(text, 48, "a = %.3f at %.0f°", term.a, term.of * 180.0 / pi);
  else
    snprintf(text, 48, "a = %.3f", term.a);
}

static cdem_status draw_directions(int dim, const cdem_table *table, first_term term,
                                   const char *title, const char *folder, const char *name,
                                   cdem_fault *fault) {
  double x[DIRECTIONS], density[DIRECTIONS], fit[DIRECTIONS], push[DIRECTIONS];
  const int bins = (int)table->rows;
  const int column[2] = {cdem_table_find(table, "density"), cdem_table_find(table, "mean_push")};
  char term_text[48], whole[128];
  for (int b = 0; b < bins; b++) {
    const double place = cdem_table_at(table, b, 0)->real;
    x[b] = dim == 2 ? place * 180.0 / pi : place;
    density[b] = cdem_table_at(table, b, column[0])->real;
    push[b] = cdem_table_at(table, b, column[1])->real;
    fit[b] = density_at(dim, term, place);
  }
  say_term(dim, term, term_text);
  snprintf(whole, sizeof whole, "Directions of contacts between grains, %s", title);
  const char *along = dim == 2 ? "angle of the normal to x, degrees" : "|cos| of the normal to z";
  const cdem_curve shares[2] = {
      {.title = "contacts", .x = x, .y = density, .points = bins},
      {.title = "first term", .x = x, .y = fit, .points = bins, .style = 1}};
  const cdem_curve pushes[1] = {{.x = x, .y = push, .points = bins}};
  const cdem_panel panel[2] = {
      {.title = term_text,
       .x_label = along,
       .curves = 2,
       .curve = shares,
       .y_label = dim == 2 ? "density, 1/rad" : "density"},
      {.x_label = along, .curves = 1, .curve = pushes, .y_label = "mean push, N"}};
  const cdem_figure figure = {.title = whole, .columns = 2, .panels = 2, .panel = panel};
  return cdem_write_figure(folder, name, &figure, fault);
}

static cdem_status directions(const cdem_dem *dem, const char *title, const char *folder,
                              const char *name, cdem_fault *fault) {
  cdem_table table = {0};
  cdem_assembly all;
  CDEM_TRY(cdem_measure(dem, NULL, &all, fault));
  CDEM_TRY(cdem_normal_distribution(dem, dem->dim == 2 ? DIRECTIONS : COSINES, &table, fault));
  cdem_status status =
      draw_directions(dem->dim, &table, term_of(dem->dim, all.fabric), title, folder, name, fault);
  cdem_table_release(&table);
  return status;
}

static cdem_status pushes(const cdem_dem *dem, const char *title, const char *folder,
                          const char *name, cdem_fault *fault) {
  cdem_push *push;
  int64_t contacts;
  CDEM_TRY(cdem_dem_pushes(dem, &contacts, &push, fault));
  cdem_status status = cdem_run_pushes(contacts, push, title, folder, name, fault);
  free(push);
  return status;
}

cdem_status cdem_run_grains_curve(const cdem_run_grains *g, int choice, const char *title,
                                  const char *folder, const char *tag, cdem_fault *fault) {
  char name[96];
  cdem_run_picture_file(name, choice, tag);
  return (choice == CDEM_RUN_PUSHES ? pushes : directions)(&g->dem, title, folder, name, fault);
}
