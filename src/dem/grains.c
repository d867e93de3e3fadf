#include "dem/grains.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void cdem_grains_release(cdem_grains *grains) {
  free(grains->xyz);
  free(grains->radius);
  free(grains->velocity);
  free(grains->spin);
  free(grains->material);
  free(grains->motion);
  *grains = (cdem_grains){.dim = grains->dim};
}

/* One array of `width` numbers a grain, grown where it is there. */
static cdem_status grow(void *array, bool wanted, int64_t capacity, int64_t needed, size_t size,
                        cdem_fault *fault) {
  return wanted ? cdem_grow(array, &capacity, needed, size, fault) : CDEM_OK;
}

cdem_status cdem_grains_add(cdem_grains *grains, const double xyz[3], double radius,
                            cdem_fault *fault) {
  int64_t at = grains->grains, room = grains->capacity, needed = at + 1;
  CDEM_REQUIRE(needed < INT32_MAX, fault, CDEM_INPUT, "more than %d grains", INT32_MAX);
  if (needed > room) {
    CDEM_TRY(grow(&grains->xyz, true, room, needed, 3 * sizeof(double), fault));
    CDEM_TRY(
        grow(&grains->velocity, grains->velocity != NULL, room, needed, 3 * sizeof(double), fault));
    CDEM_TRY(grow(&grains->spin, grains->spin != NULL, room, needed, 3 * sizeof(double), fault));
    CDEM_TRY(grow(&grains->material, grains->material != NULL, room, needed,
                  sizeof *grains->material, fault));
    CDEM_TRY(
        grow(&grains->motion, grains->motion != NULL, room, needed, sizeof *grains->motion, fault));
    CDEM_TRY(cdem_grow(&grains->radius, &grains->capacity, needed, sizeof(double), fault));
  }
  memcpy(grains->xyz + 3 * at, xyz, 3 * sizeof *xyz);
  grains->radius[at] = radius;
  grains->grains = needed;
  return CDEM_OK;
}

cdem_status cdem_grains_complete(cdem_grains *grains, cdem_fault *fault) {
  int64_t room = grains->capacity > grains->grains ? grains->capacity : grains->grains;
  if (grains->velocity == NULL)
    CDEM_NEW(grains->velocity, 3 * room, fault);
  if (grains->spin == NULL)
    CDEM_NEW(grains->spin, 3 * room, fault);
  if (grains->material == NULL)
    CDEM_NEW(grains->material, room, fault);
  if (grains->motion == NULL)
    CDEM_NEW(grains->motion, room, fault);
  return CDEM_OK;
}

static cdem_status copy(const void *from, void *to, int64_t count, size_t size, cdem_fault *fault) {
  void **target = to;
  if (from == NULL)
    return CDEM_OK;
  *target = cdem_allocate(count, size, fault);
  if (*target == NULL)
    return CDEM_MEMORY;
  memcpy(*target, from, (size_t)count * size);
  return CDEM_OK;
}

cdem_status cdem_grains_copy(const cdem_grains *from, cdem_grains *to, cdem_fault *fault) {
  int64_t n = from->grains;
  *to = (cdem_grains){.dim = from->dim, .grains = n, .capacity = n};
  cdem_status status = copy(from->xyz, &to->xyz, 3 * n, sizeof(double), fault);
  if (status == CDEM_OK)
    status = copy(from->radius, &to->radius, n, sizeof(double), fault);
  if (status == CDEM_OK)
    status = copy(from->velocity, &to->velocity, 3 * n, sizeof(double), fault);
  if (status == CDEM_OK)
    status = copy(from->spin, &to->spin, 3 * n, sizeof(double), fault);
  if (status == CDEM_OK)
    status = copy(from->material, &to->material, n, sizeof *from->material, fault);
  if (status == CDEM_OK)
    status = copy(from->motion, &to->motion, n, sizeof *from->motion, fault);
  if (status != CDEM_OK)
    cdem_grains_release(to);
  return status;
}

cdem_status cdem_grains_check(const cdem_grains *grains, cdem_fault *fault) {
  CDEM_REQUIRE(grains->dim == 2 || grains->dim == 3, fault, CDEM_INPUT,
               "grains have dimension %d; 2 (discs) or 3 (spheres) is wanted", grains->dim);
  CDEM_REQUIRE(grains->grains > 0, fault, CDEM_INPUT, "there are no grains");
  for (int64_t i = 0; i < grains->grains; i++) {
    const double *x = grains->xyz + 3 * i;
    CDEM_REQUIRE(isfinite(grains->radius[i]) && grains->radius[i] > 0.0, fault, CDEM_INPUT,
                 "grain %lld has radius %g m; a radius is positive", (long long)i,
                 grains->radius[i]);
    CDEM_REQUIRE(isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]), fault, CDEM_INPUT,
                 "grain %lld has no place: (%g, %g, %g)", (long long)i, x[0], x[1], x[2]);
    CDEM_REQUIRE(grains->dim == 3 || x[2] == 0.0, fault, CDEM_INPUT,
                 "disc %lld stands at z = %g m; discs are in the plane z = 0", (long long)i, x[2]);
  }
  return CDEM_OK;
}

double cdem_grain_solid(int dim, double radius) {
  const double pi = 3.14159265358979323846;
  return dim == 2 ? pi * radius * radius : 4.0 / 3.0 * pi * radius * radius * radius;
}

double cdem_grains_solid(const cdem_grains *grains) {
  double sum = 0.0;
  for (int64_t i = 0; i < grains->grains; i++)
    sum += cdem_grain_solid(grains->dim, grains->radius[i]);
  return sum;
}

void cdem_grains_box(const cdem_grains *grains, double low[3], double high[3]) {
  for (int c = 0; c < 3; c++) {
    low[c] = INFINITY;
    high[c] = -INFINITY;
    for (int64_t i = 0; i < grains->grains; i++) {
      double r = c < grains->dim ? grains->radius[i] : 0.0;
      low[c] = fmin(low[c], grains->xyz[3 * i + c] - r);
      high[c] = fmax(high[c], grains->xyz[3 * i + c] + r);
    }
  }
}
