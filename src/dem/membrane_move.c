/* Motion of a membrane, its energy book, and its state.
 *
 * Works are taken over the two half steps around t_n, kinetic energy is m v- v+/2: as in the solver
 * of grains. Components that are given (end rings) have no kinetic energy of their own: what moves
 * them does the work against all other forces. */
#include "base/mat3.h"
#include "base/simd.h"
#include "dem/membrane_store.h"

#include <math.h>
#include <string.h>

static bool is_given(const cdem_membrane *m, bool end, int component) {
  return end && (component == 2 || m->options.clamped);
}

/* (1 + drag dt/2) v_+ = (1 - drag dt/2) v_- + dt F/m, as for grains. */
static double kicked(const cdem_membrane *m, int64_t at, double step) {
  double half = 0.5 * m->drag * step;
  return ((1.0 - half) * m->v[at] + step * (m->force[at] / m->mass[at / 3])) / (1.0 + half);
}

/* Work of one node's component while it goes on from v to `after`: over both half steps, or the
 * first only. */
static void book(const cdem_membrane *m, int64_t at, bool given, double after, double way,
                 double sum[CDEM_MEMBRANE_SUMS]) {
  double now = 0.5 * (m->v[at] + after);
  sum[CDEM_MEMBRANE_PRESSED] += m->store->press[at] * way;
  sum[CDEM_MEMBRANE_DAMPED] -= m->store->damp[at] * way;
  if (!given)
    sum[CDEM_MEMBRANE_DAMPED] += m->drag * m->mass[at / 3] * now * way;
  if (given)
    sum[CDEM_MEMBRANE_PLATES] -= m->force[at] * way;
}

/* A node that is free in all directions. Returns its squared distance from its mark. */
CDEM_ALWAYS_INLINE double move_free(cdem_membrane *m, int64_t i, double keep, double kick,
                                    double step, double sum[CDEM_MEMBRANE_SUMS]) {
  const double *force = m->force + 3 * i, *press = m->store->press + 3 * i;
  const double *damp = m->store->damp + 3 * i, *marked = m->store->marked + 3 * i;
  double *v = m->v + 3 * i, *x = m->x + 3 * i, way2 = 0.0, pressed = 0.0, damped = 0.0;
  double by = kick / m->mass[i], drag = 0.5 * m->drag * m->mass[i];
  for (int c = 0; c < 3; c++) {
    double after = keep * v[c] + by * force[c], both = v[c] + after;
    pressed += press[c] * both;
    damped += (drag * both - damp[c]) * both;
    v[c] = after;
    x[c] += step * after;
    way2 += (x[c] - marked[c]) * (x[c] - marked[c]);
  }
  sum[CDEM_MEMBRANE_PRESSED] += 0.5 * step * pressed;
  sum[CDEM_MEMBRANE_DAMPED] += 0.5 * step * damped;
  return way2;
}

/* One of an end ring, which goes with `plate` along z. */
static double move_end(cdem_membrane *m, int64_t i, double plate, double step,
                       double sum[CDEM_MEMBRANE_SUMS]) {
  double way2 = 0.0;
  for (int c = 0; c < 3; c++) {
    int64_t at = 3 * i + c;
    bool given = is_given(m, true, c);
    double after = !given ? kicked(m, at, step) : c == 2 ? plate : 0.0;
    book(m, at, given, after, 0.5 * step * (m->v[at] + after), sum);
    m->v[at] = after;
    m->x[at] += step * after;
    double way = m->x[at] - m->store->marked[at];
    way2 += way * way;
  }
  return way2;
}

double cdem_membrane_move(cdem_membrane *m, double step, double low, double high) {
  double most = 0.0, sum[CDEM_MEMBRANE_SUMS] = {0}, half = 0.5 * m->drag * step;
  double keep = (1.0 - half) / (1.0 + half), kick = step / (1.0 + half);
  for (int64_t i = 0; i < m->nodes; i++) {
    bool end = cdem_membrane_is_end(m, (int32_t)i);
    double way2 = end ? move_end(m, i, i < m->around ? low : high, step, sum)
                      : move_free(m, i, keep, kick, step, sum);
    most = way2 > most || !(way2 == way2) ? way2 : most;
  }
  for (int k = 0; k < CDEM_MEMBRANE_SUMS; k++)
    m->store->sum[k] += sum[k];
  return most;
}

void cdem_membrane_mark(cdem_membrane *m) {
  memcpy(m->store->marked, m->x, (size_t)m->nodes * 3 * sizeof *m->x);
}

/* The half step before t_n, whose work is not yet in the sums. */
static void half_before(const cdem_membrane *m, double step, double sum[CDEM_MEMBRANE_SUMS]) {
  for (int64_t i = 0; i < m->nodes; i++) {
    bool end = cdem_membrane_is_end(m, (int32_t)i);
    for (int c = 0; c < 3; c++)
      book(m, 3 * i + c, is_given(m, end, c), kicked(m, 3 * i + c, step),
           0.5 * step * m->v[3 * i + c], sum);
  }
}

/* Sums take up the change of that half step, so that works go on where they were. */
void cdem_membrane_change_step(cdem_membrane *m, double old, double step) {
  double before[CDEM_MEMBRANE_SUMS] = {0}, after[CDEM_MEMBRANE_SUMS] = {0};
  half_before(m, old, before);
  for (int64_t i = 0; i < m->nodes; i++) {
    bool end = cdem_membrane_is_end(m, (int32_t)i);
    for (int c = 0; c < 3; c++) {
      int64_t at = 3 * i + c;
      if (is_given(m, end, c))
        continue;
      double now = 0.5 * (m->v[at] + kicked(m, at, old));
      m->v[at] = (1.0 + 0.5 * m->drag * step) * now - 0.5 * step * (m->force[at] / m->mass[i]);
    }
  }
  half_before(m, step, after);
  for (int k = 0; k < CDEM_MEMBRANE_SUMS; k++)
    m->store->sum[k] += before[k] - after[k];
}

void cdem_membrane_energies_now(const cdem_membrane *m, double step, cdem_membrane_energies *e) {
  const cdem_membrane_store *s = m->store;
  double sum[CDEM_MEMBRANE_SUMS];
  *e = (cdem_membrane_energies){0};
  memcpy(sum, s->sum, sizeof sum);
  half_before(m, step, sum);
  for (int64_t i = 0; i < m->nodes; i++) {
    bool end = cdem_membrane_is_end(m, (int32_t)i);
    for (int c = 0; c < 3; c++) {
      double v = m->v[3 * i + c], bent = s->bent[3 * i + c];
      double g = c < 2 ? s->size[2 * (i / m->around)] : 1.0;
      if (!is_given(m, end, c))
        e->kinetic += 0.5 * m->mass[i] * v * kicked(m, 3 * i + c, step);
      if (m->options.bending != 0.0)
        e->bending += 0.5 * bent * bent / (s->stiff[!end] * g);
    }
  }
  for (int32_t f = 0; m->options.young != 0.0 && f < m->faces; f++)
    e->stretch += s->stored[f];
  e->pressure = sum[CDEM_MEMBRANE_PRESSED];
  e->plates = sum[CDEM_MEMBRANE_PLATES];
  e->damping = sum[CDEM_MEMBRANE_DAMPED];
}

/* ---- state ---- */

typedef struct {
  const char *name;
  int64_t count;
  double *data;
} entry;

enum { ENTRIES = 8 };

static void list(const cdem_membrane *m, entry entries[ENTRIES]) {
  cdem_membrane_store *s = m->store;
  int64_t n = 3 * (int64_t)m->nodes;
  const entry all[ENTRIES] = {
      {"membrane/place", n, m->x},       {"membrane/velocity", n, m->v},
      {"membrane/force", n, m->force},   {"membrane/contact", n, m->contact},
      {"membrane/pressed", n, s->press}, {"membrane/damped", n, s->damp},
      {"membrane/marked", n, s->marked}, {"membrane/sums", CDEM_MEMBRANE_SUMS, s->sum}};
  memcpy(entries, all, sizeof all);
}

cdem_status cdem_membrane_save(const cdem_membrane *m, cdem_state *state, cdem_fault *fault) {
  entry entries[ENTRIES];
  list(m, entries);
  for (int k = 0; k < ENTRIES; k++)
    CDEM_TRY(cdem_state_add(state, entries[k].name, CDEM_ARRAY_REAL, entries[k].count,
                            entries[k].data, fault));
  const double now[2] = {m->pressure, m->drag};
  return cdem_state_add_copy(state, "membrane/now", CDEM_ARRAY_REAL, 2, now, fault);
}

/* What follows from places and velocities is found again. */
cdem_status cdem_membrane_restore(cdem_membrane *m, const cdem_state *state, cdem_fault *fault) {
  entry entries[ENTRIES];
  double now[2];
  list(m, entries);
  for (int k = 0; k < ENTRIES; k++)
    CDEM_TRY(cdem_state_get(state, entries[k].name, CDEM_ARRAY_REAL, entries[k].count,
                            entries[k].data, fault));
  CDEM_TRY(cdem_state_get(state, "membrane/now", CDEM_ARRAY_REAL, 2, now, fault));
  m->pressure = now[0];
  m->drag = now[1];
  for (int32_t k = 0; k < m->rings; k++)
    cdem_membrane_look(m, k);
  return CDEM_OK;
}
