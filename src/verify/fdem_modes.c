/* Grain shapes and their modes: sizes, an even stress, the vibrations of a free ball. */
#include "base/mat3.h"
#include "base/memory.h"
#include "fdem/template.h"
#include "verify/fdem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static cdem_status make(const char *name, int refinement, double poisson, cdem_template *t,
                        cdem_fault *fault) {
  const cdem_material rock = cdem_material_isotropic(1.0, poisson);
  const cdem_template_options options = {.shape = cdem_grain_shape_find(name),
                                         .options = {.refinement = refinement},
                                         .material = &rock};
  return cdem_template_init(&options, false, t, fault);
}

cdem_status cdem_fdem_measure_sizes(int parameter, double *value, cdem_fault *fault) {
  cdem_template t;
  CDEM_TRY(make("icosphere", 1, 0.2, &t, fault));
  const int32_t size[] = {t.mesh.cells, t.nodes, t.surface.nodes, t.modes};
  *value = size[parameter];
  cdem_template_release(&t);
  return CDEM_OK;
}

/* ---- an even stress ---- */

/* Tractions pull n_z along z, laid onto the nodes of flat faces: force [nodes][3]. */
static void pull(const cdem_template *t, double tension, double *force) {
  for (int32_t f = 0; f < t->surface.triangles; f++) {
    const int32_t *node = t->surface.triangle + 3 * f;
    double a[3], b[3], n[3];
    for (int c = 0; c < 3; c++) {
      a[c] = t->surface.reference[3 * node[1] + c] - t->surface.reference[3 * node[0] + c];
      b[c] = t->surface.reference[3 * node[2] + c] - t->surface.reference[3 * node[0] + c];
    }
    cdem_cross3(a, b, n);
    for (int k = 0; k < 3; k++)
      force[3 * node[k] + 2] += tension * 0.5 * n[2] / 3.0;
  }
}

static void answer(const cdem_template *t, const double *force, double *u) {
  int64_t size = 3 * (int64_t)t->nodes;
  for (int k = 0; k < t->modes; k++) {
    double load = 0.0;
    for (int64_t r = 0; r < size; r++)
      load += t->mode[k * size + r] * force[r];
    for (int64_t r = 0; r < size; r++)
      u[r] += t->mode[k * size + r] * load / t->lambda[k];
  }
}

/* Strains p along z and -nu p across it, by how far nodes went from the first one along the way to
 * it: turning does not count. In parts of p d^2. */
cdem_status cdem_fdem_measure_strain(int parameter, double *value, cdem_fault *fault) {
  const double poisson = 0.3, tension = 0.01;
  cdem_template t;
  CDEM_TRY(make("tetrasphere", parameter, poisson, &t, fault));
  double *force = cdem_allocate(3 * (int64_t)t.nodes, sizeof *force, fault);
  double *u = force != NULL ? cdem_allocate(3 * (int64_t)t.nodes, sizeof *u, fault) : NULL;
  if (u != NULL) {
    pull(&t, tension, force);
    answer(&t, force, u);
  }
  *value = 0.0;
  for (int32_t n = 1; u != NULL && n < t.nodes; n++) {
    double off = 0.0, square = 0.0;
    for (int c = 0; c < 3; c++) {
      double d = t.mesh.xyz[3 * n + c] - t.mesh.xyz[c];
      off += d * (u[3 * n + c] - u[c]) - (c == 2 ? 1.0 : -poisson) * tension * d * d;
      square += d * d;
    }
    *value = fmax(*value, fabs(off) / (tension * square));
  }
  cdem_status status = u != NULL ? CDEM_OK : CDEM_MEMORY;
  free(force);
  free(u);
  cdem_template_release(&t);
  return status;
}

/* ---- vibrations ---- */

/* Wave numbers omega a/c_s of the five torsions of degree 2 and of the five spheroidal vibrations:
 * the mean of five, which a mesh with the symmetry of a cube parts into two and three. Kept while
 * the process lives. */
static cdem_status wave_numbers(int refinement, double number[2], cdem_fault *fault) {
  static double known[7][2];
  const double poisson = 0.25, shear = 0.5 / (1.0 + poisson);
  cdem_template t;
  if (known[refinement][0] == 0.0) {
    CDEM_TRY(make("cubesphere", refinement, poisson, &t, fault));
    for (int k = 0; k < 10; k++)
      known[refinement][k / 5] += 0.2 * sqrt(t.lambda[k] / shear);
    cdem_template_release(&t);
  }
  memcpy(number, known[refinement], sizeof known[refinement]);
  return CDEM_OK;
}

/* Errors go with the square of the size. */
cdem_status cdem_fdem_measure_lamb(int parameter, double *value, cdem_fault *fault) {
  const double torsion = 2.5011326; /* of tan x = x(x^2 - 12)/(5 x^2 - 12), j_2(x) = x j_3(x) */
  const int fine = parameter == 1 || parameter == 2 ? 6 : 4, coarse = fine - 2;
  double x[2], y[2], square = (double)(fine * fine) / (coarse * coarse);
  CDEM_TRY(wave_numbers(coarse, x, fault));
  CDEM_TRY(wave_numbers(fine, y, fault));
  int kind = parameter == 2;
  *value = parameter == 3 ? (y[0] - torsion) / (x[0] - torsion)
                          : (square * y[kind] - x[kind]) / (square - 1.0);
  return CDEM_OK;
}
