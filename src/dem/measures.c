/* Stress, fabric and contacts of a region; stress of grains. */
#include "dem/measures.h"

#include "dem/measures_kernels.h"

#include <string.h>

/* ---- regions, with the images of a periodic cell ---- */

typedef struct {
  const cdem_snapshot *s;
  cdem_region box;
  bool all; /* nothing is cut off */
  int images;
  double shift[27][3], drift[27][3];
} scope;

static void scope_init(const cdem_snapshot *s, const cdem_region *region, scope *at) {
  *at = (scope){.s = s, .all = true, .images = 1};
  cdem_region_bounds(s, region, &at->box);
  for (int c = 0; c < s->dim && region != NULL; c++)
    at->all &= !(region->low[c] < region->high[c]);
  if (s->cell == NULL || at->all)
    return;
  double shift[27][3];
  cdem_cell_images(s->cell, shift);
  for (int k = 0; k < 27; k++) {
    bool real = k != CDEM_IMAGE_SELF;
    const int step[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
    for (int c = 0; c < 3; c++)
      real &= step[c] == 0 || (c < s->dim && s->cell->periodic[c]);
    if (!real)
      continue;
    memcpy(at->drift[at->images], s->drift[k], sizeof s->drift[k]);
    memcpy(at->shift[at->images++], shift[k], sizeof shift[k]);
  }
}

static double extent_volume(const scope *at) {
  const cdem_snapshot *s = at->s;
  double volume = s->dim == 2 ? s->thickness : 1.0;
  if (at->all && s->cell != NULL && cdem_cell_volume(s->dim, s->cell) > 0.0)
    return volume * cdem_cell_volume(s->dim, s->cell);
  for (int c = 0; c < s->dim; c++)
    volume *= at->box.high[c] - at->box.low[c];
  return volume;
}

static bool is_inside(const scope *at, const double place[3], int image) {
  bool in = true;
  for (int c = 0; c < at->s->dim && !at->all; c++) {
    double x = place[c] + at->shift[image][c];
    in &= x >= at->box.low[c] && x < at->box.high[c];
  }
  return in;
}

/* How often a place and its images are in the region. */
static int places_inside(const scope *at, const double place[3]) {
  int inside = 0;
  for (int k = 0; k < at->images; k++)
    inside += is_inside(at, place, k);
  return inside;
}

static double branch_inside(const scope *at, const double from[3], const double branch[3]) {
  double part = 0.0;
  for (int k = 0; k < at->images && !at->all; k++) {
    const double moved[3] = {from[0] + at->shift[k][0], from[1] + at->shift[k][1],
                             from[2] + at->shift[k][2]};
    part += cdem_branch_inside(at->s->dim, moved, branch, &at->box);
  }
  return at->all ? 1.0 : part;
}

static double solid_inside(const scope *at, int64_t i) {
  const cdem_snapshot *s = at->s;
  double solid = 0.0;
  if (at->all)
    return cdem_grain_volume(s, s->radius[i]);
  for (int k = 0; k < at->images; k++) {
    const double *x = s->xyz + 3 * i, *shift = at->shift[k];
    const double moved[3] = {x[0] + shift[0], x[1] + shift[1], x[2] + shift[2]};
    solid += cdem_solid_inside(s->dim, moved, s->radius[i], &at->box);
  }
  return solid * s->thickness;
}

/* ---- a region ---- */

/* About the mean velocity of the region; images go with the cell. */
static void measure_motion(const scope *at, double stress[9]) {
  const cdem_snapshot *s = at->s;
  double mass = 0.0, mean[3] = {0.0};
  for (int pass = 0; pass < 2; pass++) {
    for (int64_t i = 0; i < s->grains; i++)
      for (int k = 0; k < at->images; k++) {
        if (!is_inside(at, s->xyz + 3 * i, k))
          continue;
        double v[3], m = s->mass[i];
        for (int c = 0; c < 3; c++)
          v[c] = s->velocity[3 * i + c] + at->drift[k][c] - (pass == 1 ? mean[c] : 0.0);
        mass += pass == 0 ? m : 0.0;
        for (int c = 0; c < 3 && pass == 0; c++)
          mean[c] += m * v[c];
        for (int n = 0; n < 9 && pass == 1; n++)
          stress[n] -= m * v[n / 3] * v[n % 3];
      }
    for (int c = 0; c < 3 && pass == 0 && mass > 0.0; c++)
      mean[c] /= mass;
  }
}

static void measure_grains(const scope *at, cdem_assembly *a) {
  const cdem_snapshot *s = at->s;
  double touching = 0.0, carried = 0.0;
  int64_t carrying = 0;
  for (int64_t i = 0; i < s->grains; i++) {
    int inside = places_inside(at, s->xyz + 3 * i);
    a->solid += solid_inside(at, i);
    a->grains += inside;
    touching += inside * s->touching[i];
    carrying += s->touching[i] >= 2 ? inside : 0;
    carried += s->touching[i] >= 2 ? inside * s->touching[i] : 0;
  }
  measure_motion(at, a->kinetic_stress);
  a->coordination = a->grains > 0 ? touching / (double)a->grains : 0.0;
  a->mechanical = carrying > 0 ? carried / (double)carrying : 0.0;
  a->rattlers = a->grains > 0 ? (double)(a->grains - carrying) / (double)a->grains : 0.0;
}

static void measure_contacts(const scope *at, cdem_assembly *a) {
  const cdem_snapshot *s = at->s;
  int64_t sliding = 0, between = 0;
  for (int64_t k = 0; k < s->contacts; k++) {
    const cdem_dem_contact *c = &s->contact[k];
    double part = branch_inside(at, s->xyz + 3 * (int64_t)c->a, c->branch);
    for (int m = 0; m < 9; m++)
      a->stress[m] += part * c->force[m / 3] * c->branch[m % 3];
    int inside = places_inside(at, c->point);
    if (inside == 0)
      continue;
    a->contacts += inside;
    a->mean_push += inside * c->push;
    a->largest_push = fmax(a->largest_push, c->push);
    sliding += c->sliding ? inside : 0;
    between += c->b >= 0 ? inside : 0;
    for (int m = 0; m < 9 && c->b >= 0; m++)
      a->fabric[m] += inside * c->normal[m / 3] * c->normal[m % 3];
  }
  for (int m = 0; m < 9 && between > 0; m++)
    a->fabric[m] /= (double)between;
  a->mean_push /= a->contacts > 0 ? (double)a->contacts : 1.0;
  a->sliding = a->contacts > 0 ? (double)sliding / (double)a->contacts : 0.0;
}

/* Deviator of a symmetric part, in the plane or in space: sqrt(d:d). */
static double deviation(int dim, const double t[9]) {
  double trace = 0.0, sum = 0.0;
  for (int c = 0; c < dim; c++)
    trace += t[4 * c] / dim;
  for (int i = 0; i < dim; i++)
    for (int j = 0; j < dim; j++) {
      double d = 0.5 * (t[3 * i + j] + t[3 * j + i]) - (i == j ? trace : 0.0);
      sum += d * d;
    }
  return sqrt(sum);
}

void cdem_measure_kernel(const cdem_snapshot *s, const cdem_region *region,
                         cdem_assembly *assembly) {
  cdem_assembly a = {0};
  scope at;
  double both[9], trace = 0.0;
  scope_init(s, region, &at);
  a.volume = extent_volume(&at);
  measure_grains(&at, &a);
  measure_contacts(&at, &a);
  double part = a.volume > 0.0 ? 1.0 / a.volume : 0.0;
  a.solid *= part;
  for (int k = 0; k < 9; k++) {
    a.stress[k] *= part;
    a.kinetic_stress[k] *= part;
    both[k] = a.stress[k] + a.kinetic_stress[k];
  }
  for (int c = 0; c < s->dim; c++)
    trace += both[4 * c];
  a.pressure = -trace / s->dim;
  a.deviator = deviation(s->dim, both) * (s->dim == 2 ? sqrt(0.5) : sqrt(1.5));
  a.anisotropy = deviation(s->dim, a.fabric) * (s->dim == 2 ? 4.0 * sqrt(0.5) : 7.5 * sqrt(1.5));
  *assembly = a;
}

cdem_status cdem_measure(const cdem_dem *dem, const cdem_region *region, cdem_assembly *assembly,
                         cdem_fault *fault) {
  cdem_snapshot s;
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  cdem_measure_kernel(&s, region, assembly);
  cdem_snapshot_release(&s);
  return CDEM_OK;
}

/* ---- grains ---- */

static void add_arm(const cdem_dem_contact *c, const double centre[3], double sign, double *sum) {
  static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  for (int k = 0; k < 6; k++) {
    int i = at[k][0], j = at[k][1];
    sum[k] += 0.5 * sign *
              (c->force[i] * (c->point[j] - centre[j]) + c->force[j] * (c->point[i] - centre[i]));
  }
}

void cdem_grain_stress_kernel(const cdem_snapshot *s, double *stress) {
  memset(stress, 0, 6 * (size_t)s->grains * sizeof *stress);
  for (int64_t k = 0; k < s->contacts; k++) {
    const cdem_dem_contact *c = &s->contact[k];
    const double *a = s->xyz + 3 * (int64_t)c->a;
    const double b[3] = {a[0] + c->branch[0], a[1] + c->branch[1], a[2] + c->branch[2]};
    add_arm(c, a, 1.0, stress + 6 * (int64_t)c->a);
    if (c->b >= 0)
      add_arm(c, b, -1.0, stress + 6 * (int64_t)c->b);
  }
  for (int64_t i = 0; i < s->grains; i++) {
    double volume = cdem_grain_volume(s, s->radius[i]);
    for (int k = 0; k < 6; k++)
      stress[6 * i + k] /= volume;
  }
}

cdem_status cdem_grain_stress(const cdem_dem *dem, double *stress, cdem_fault *fault) {
  cdem_snapshot s;
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  cdem_grain_stress_kernel(&s, stress);
  cdem_snapshot_release(&s);
  return CDEM_OK;
}

/* ---- what is in a region ---- */

/* A grain, or an image of it, where it is in the region and as fast as it is there. */
static void count_grain(const scope *at, int64_t i, int image, cdem_count *count) {
  const cdem_snapshot *s = at->s;
  double squared = 0.0;
  for (int c = 0; c < 3; c++) {
    double v = s->velocity[3 * i + c] + at->drift[image][c];
    double x = s->xyz[3 * i + c] + at->shift[image][c];
    count->first[c] += s->mass[i] * x;
    count->momentum[c] += s->mass[i] * v;
    squared += v * v;
    count->low[c] = count->grains == 0 || x < count->low[c] ? x : count->low[c];
    count->high[c] = count->grains == 0 || x > count->high[c] ? x : count->high[c];
  }
  count->grains++;
  count->mass += s->mass[i];
  count->kinetic += 0.5 * s->mass[i] * squared;
}

void cdem_count_kernel(const cdem_snapshot *s, const cdem_region *region, cdem_count *count) {
  scope at;
  scope_init(s, region, &at);
  *count = (cdem_count){0};
  for (int64_t i = 0; i < s->grains; i++)
    for (int k = 0; k < at.images; k++)
      if (is_inside(&at, s->xyz + 3 * i, k))
        count_grain(&at, i, k, count);
  for (int c = 0; c < s->dim && region != NULL; c++)
    if (region->low[c] < region->high[c])
      count->flow[c] = count->momentum[c] / (region->high[c] - region->low[c]);
}

cdem_status cdem_count_region(const cdem_dem *dem, const cdem_region *region, cdem_count *count,
                              cdem_fault *fault) {
  cdem_snapshot s;
  CDEM_TRY(cdem_snapshot_take(dem, &s, fault));
  cdem_count_kernel(&s, region, count);
  cdem_snapshot_release(&s);
  return CDEM_OK;
}
