/* The distribution of the pushes between grains as a figure. */
#include "dem/pushes.h"
#include "io/io.h"
#include "run/grains.h"

#include <math.h>

/* From a hundredth of the mean to twenty of it, ten bins a decade. */
enum { BINS = 33 };
#define LOW  0.01
#define HIGH 20.0

static cdem_status draw(const cdem_table *table, const char *title, const char *folder,
                        const char *name, cdem_fault *fault) {
  double x[BINS], y[BINS];
  for (int b = 0; b < BINS; b++) {
    double density = cdem_table_at(table, b, 2)->real;
    x[b] = log10(cdem_table_at(table, b, 0)->real);
    y[b] = density > 0.0 ? log10(density) : NAN;
  }
  const cdem_curve curve = {.x = x, .y = y, .points = BINS};
  const cdem_panel panel = {.title = title,
                            .x_label = "log_{10} of push over mean",
                            .y_label = "log_{10} of density",
                            .curves = 1,
                            .curve = &curve};
  const cdem_figure figure = {
      .title = "Normal forces between grains", .columns = 1, .panels = 1, .panel = &panel};
  return cdem_write_figure(folder, name, &figure, fault);
}

cdem_status cdem_run_pushes(int64_t contacts, const cdem_push *push, const char *title,
                            const char *folder, const char *name, cdem_fault *fault) {
  cdem_table table = {0};
  cdem_status status = cdem_push_distribution(contacts, push, BINS, LOW, HIGH, &table, fault);
  if (status == CDEM_OK)
    status = draw(&table, title, folder, name, fault);
  cdem_table_release(&table);
  return status;
}
