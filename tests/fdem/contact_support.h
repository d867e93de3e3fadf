/* Rigid grains with surface nodes for tests of contact: places, a small integrator, sums of forces.
 */
#ifndef CDEM_TESTS_FDEM_CONTACT_SUPPORT_H
#define CDEM_TESTS_FDEM_CONTACT_SUPPORT_H

#include "fdem/store.h"
#include "surface_support.h"

enum { MOST_WALLS = 4 };

typedef struct {
  int grains;
  int64_t nodes;
  cdem_contact_view view;
  const cdem_skin **skin;
  int64_t *first;
  double *scale, *center, *turn, *place, *now, *before, *area, *mass;
  int32_t *material;
  double *velocity, *momentum; /* [grains][3]: m/s; angular, about the centre */
  double *weight, *inertia;    /* [grains], [grains][9] in the frame of the body */
  cdem_wall_body wall[MOST_WALLS];
  cdem_fdem_contact_law law[4];
  double time;
  /* what contact says */
  cdem_fdem_contacts *contacts;
  double *force, wall_force[MOST_WALLS][3], wall_stiff[MOST_WALLS], *stiff;
  cdem_contact_book book, sum; /* sum: dissipated and work so far */
} model;

static void turn_about(double turn[9], const double axis[3], double angle) {
  double norm = cdem_norm3(axis), s = sin(angle), c = cos(angle), old[9], by[9];
  if (norm == 0.0)
    return;
  double u[3] = {axis[0] / norm, axis[1] / norm, axis[2] / norm};
  const double cross[9] = {0.0, -u[2], u[1], u[2], 0.0, -u[0], -u[1], u[0], 0.0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      by[3 * i + j] = (i == j ? c : 0.0) + s * cross[3 * i + j] + (1.0 - c) * u[i] * u[j];
  memcpy(old, turn, sizeof old);
  cdem_product3(by, old, turn);
}

static void set_now(model *m) {
  for (int g = 0; g < m->grains; g++)
    for (int64_t n = m->first[g]; n < m->first[g + 1]; n++) {
      cdem_wall_turned(m->turn + 9 * g, m->place + 3 * n, m->now + 3 * n);
      for (int c = 0; c < 3; c++)
        m->now[3 * n + c] += m->center[3 * g + c];
    }
}

/* Grains of these skins at the origin, not turned, at rest; density 1000. */
static void model_make_sized(model *m, int grains, const cdem_skin *const *skin,
                             const double *scales, cdem_fdem_contact_law law) {
  *m = (model){.grains = grains};
  m->first = calloc((size_t)grains + 1, sizeof *m->first);
  for (int g = 0; g < grains; g++)
    m->first[g + 1] = m->first[g] + skin[g]->nodes;
  m->nodes = m->first[grains];
  double **each[] = {&m->place, &m->now, &m->before, &m->force, &m->area, &m->mass};
  for (int k = 0; k < 6; k++)
    *each[k] = calloc((size_t)(k < 4 ? 3 : 1) * (size_t)m->nodes, sizeof(double));
  double **per[] = {&m->scale,    &m->stiff,    &m->weight, &m->center,
                    &m->velocity, &m->momentum, &m->turn,   &m->inertia};
  for (int k = 0; k < 8; k++)
    *per[k] = calloc((size_t)(k < 3 ? 1 : (k < 6 ? 3 : 9)) * (size_t)grains, sizeof(double));
  m->material = calloc((size_t)grains, sizeof *m->material);
  m->skin = calloc((size_t)grains, sizeof *m->skin);
  for (int g = 0; g < grains; g++) {
    double scale = scales[g];
    m->skin[g] = skin[g];
    m->scale[g] = scale;
    for (int c = 0; c < 3; c++)
      m->turn[9 * g + 4 * c] = 1.0;
    for (int64_t n = m->first[g]; n < m->first[g + 1]; n++) {
      int64_t local = n - m->first[g];
      double *p = m->place + 3 * n, square = 0.0;
      m->area[n] = scale * scale * skin[g]->area[local];
      m->mass[n] = 1000.0 * scale * scale * scale * skin[g]->volume / skin[g]->nodes;
      m->weight[g] += m->mass[n];
      for (int c = 0; c < 3; c++) {
        p[c] = scale * skin[g]->reference[3 * local + c];
        square += p[c] * p[c];
      }
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
          m->inertia[9 * g + 3 * i + j] += m->mass[n] * ((i == j ? square : 0.0) - p[i] * p[j]);
    }
  }
  m->law[0] = m->law[1] = m->law[2] = m->law[3] = law;
}

static inline void model_make(model *m, int grains, const cdem_skin *const *skin, double scale,
                              cdem_fdem_contact_law law) {
  double *scales = calloc((size_t)grains, sizeof *scales);
  for (int g = 0; g < grains; g++)
    scales[g] = scale;
  model_make_sized(m, grains, skin, scales, law);
  free(scales);
}

/* After places and walls are set. */
static void model_start(model *m, double skin, int threads) {
  cdem_fault fault = {0};
  set_now(m);
  memcpy(m->before, m->now, 3 * (size_t)m->nodes * sizeof *m->now);
  m->view = (cdem_contact_view){.grains = m->grains,
                                .surface = m->skin,
                                .first = m->first,
                                .scale = m->scale,
                                .material = m->material,
                                .center = m->center,
                                .turn = m->turn,
                                .place = m->place,
                                .now = m->now,
                                .before = m->before,
                                .area = m->area,
                                .mass = m->mass,
                                .walls = m->view.walls,
                                .wall = m->wall,
                                .materials = 2,
                                .law = m->law};
  check_ok(cdem_fdem_contacts_create(&m->view, skin, threads, &m->contacts, &fault));
}

static inline void model_wall(model *m, const cdem_wall *wall) {
  cdem_fault fault = {0};
  check_ok(cdem_wall_check(3, wall, &fault));
  check_ok(cdem_wall_body_init(m->wall + m->view.walls++, 3, wall, NULL, &fault));
}

static inline void model_release(model *m) {
  void *all[] = {m->first,    m->place, m->now,     m->before,   m->force,  m->area,
                 m->mass,     m->scale, m->stiff,   m->weight,   m->center, m->velocity,
                 m->momentum, m->turn,  m->inertia, m->material, m->skin};
  cdem_fdem_contacts_destroy(&m->contacts);
  for (int w = 0; w < m->view.walls; w++)
    cdem_wall_body_release(m->wall + w);
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
    free(all[k]);
}

static inline cdem_contact_forces model_out(model *m) {
  return (cdem_contact_forces){m->force, m->wall_force[0], m->wall_stiff, m->stiff};
}

static void model_forces(model *m, double step) {
  cdem_fault fault = {0};
  const cdem_contact_forces out = model_out(m);
  m->view.step = step;
  check_ok(cdem_fdem_contacts_forces(m->contacts, &m->view, &out, &m->book, &fault));
  m->sum.friction += m->book.friction;
  m->sum.damping += m->book.damping;
  m->sum.walls += m->book.walls;
}

static void spin_of(const model *m, int g, const double turn[9], double spin[3]) {
  double inverse[9], in_body[3], turned[3];
  cdem_inverse3(m->inertia + 9 * g, inverse);
  cdem_wall_turned_back(turn, m->momentum + 3 * g, in_body);
  cdem_wall_turned(inverse, in_body, turned);
  cdem_wall_turned(turn, turned, spin);
}

static void drift(model *m, double step) {
  memcpy(m->before, m->now, 3 * (size_t)m->nodes * sizeof *m->now);
  for (int g = 0; g < m->grains; g++) {
    double half[9], spin[3];
    spin_of(m, g, m->turn + 9 * g, spin);
    memcpy(half, m->turn + 9 * g, sizeof half);
    turn_about(half, spin, 0.5 * step * cdem_norm3(spin));
    spin_of(m, g, half, spin);
    turn_about(m->turn + 9 * g, spin, step * cdem_norm3(spin));
    for (int c = 0; c < 3; c++)
      m->center[3 * g + c] += step * m->velocity[3 * g + c];
  }
  set_now(m);
  for (int w = 0; w < m->view.walls; w++)
    cdem_wall_body_advance(m->wall + w, m->time, step, m->wall_force[w], m->wall_stiff[w]);
  m->time += step;
}

/* Force and moment about the centre, of contact. */
static void load_of(const model *m, int g, double force[3], double moment[3]) {
  for (int c = 0; c < 3; c++)
    force[c] = moment[c] = 0.0;
  for (int64_t n = m->first[g]; n < m->first[g + 1]; n++) {
    double arm[3], turning[3];
    for (int c = 0; c < 3; c++)
      arm[c] = m->now[3 * n + c] - m->center[3 * g + c];
    cdem_cross3(arm, m->force + 3 * n, turning);
    for (int c = 0; c < 3; c++) {
      force[c] += m->force[3 * n + c];
      moment[c] += turning[c];
    }
  }
}

/* From t_n, with the forces there are, to t_{n+1} and its forces; velocities half a step behind. */
static inline void model_step(model *m, double step) {
  for (int g = 0; g < m->grains; g++) {
    double force[3], moment[3];
    load_of(m, g, force, moment);
    for (int c = 0; c < 3; c++) {
      m->velocity[3 * g + c] += step * force[c] / m->weight[g];
      m->momentum[3 * g + c] += step * moment[c];
    }
  }
  drift(m, step);
  model_forces(m, step);
}

/* While nothing touches. */
static inline double kinetic(const model *m) {
  double sum = 0.0;
  for (int g = 0; g < m->grains; g++) {
    double spin[3];
    spin_of(m, g, m->turn + 9 * g, spin);
    sum += 0.5 * m->weight[g] * cdem_dot3(m->velocity + 3 * g, m->velocity + 3 * g) +
           0.5 * cdem_dot3(spin, m->momentum + 3 * g);
  }
  return sum;
}

#endif
