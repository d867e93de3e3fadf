/* Rigid plates: surface nodes against a moving plane, by a penalty with Coulomb friction.
 *
 * The area of a node's spring is its share of the facets that face the plate, projected onto it, as
 * they lie when the node begins to touch; it then stays, so that the spring has an energy.
 */
#include "base/mat3.h"
#include "cdem/solver_store.h"

#include <stdlib.h>
#include <string.h>

/* A node touches where it comes through the face. One that was beyond the plane without touching
 * has come from the side or from behind and is left alone until it is in front again: a spring that
 * began with an overlap would make energy out of nothing. A node found deeper at once than this
 * part of its own size (of its share of the surface) has not come through the face either. */
static const double deepest_entry = 0.5;
enum { AWAY, TOUCHES, PASSED }; /* values of `touch` */

static cdem_status make_axes(const cdem_plate *plate, int dimension, cdem_plate_store *store,
                             cdem_fault *fault) {
  double size = cdem_norm3(plate->normal);
  CDEM_REQUIRE(size > 0.0, fault, CDEM_INPUT, "plate '%s' has no normal", plate->name);
  double(*a)[3] = store->axis;
  for (int k = 0; k < 3; k++)
    a[0][k] = plate->normal[k] / size;
  double along = cdem_dot3(plate->axis, a[0]);
  for (int k = 0; k < 3; k++)
    a[1][k] = plate->axis[k] - along * a[0][k];
  if (dimension == 2) {
    a[1][0] = -a[0][1];
    a[1][1] = a[0][0];
    a[1][2] = 0.0;
  }
  size = cdem_norm3(a[1]);
  if (size <= 1e-9 * cdem_norm3(plate->axis)) {
    CDEM_REQUIRE(plate->half[0] <= 0.0 && plate->half[1] <= 0.0, fault, CDEM_INPUT,
                 "plate '%s' is finite and needs an axis in its plane", plate->name);
    double e[3] = {0};
    e[fabs(a[0][0]) < 0.6 ? 0 : 1] = 1.0;
    cdem_cross3(a[0], e, a[1]);
    size = cdem_norm3(a[1]);
  }
  for (int k = 0; k < 3; k++)
    a[1][k] /= size;
  cdem_cross3(a[0], a[1], a[2]);
  return CDEM_OK;
}

/* The facets of every surface node: 4 facet + corner, [start[n], start[n + 1]). */
static cdem_status link_facets(cdem_solver_store *s, int32_t nodes, cdem_fault *fault) {
  const cdem_blocks *blocks = s->options.blocks;
  CDEM_NEW(s->surface_start, (int64_t)nodes + 1, fault);
  int64_t *start = s->surface_start, *next;
  for (int32_t f = 0; f < blocks->facets; f++)
    for (int c = 0; c < blocks->facet[f].corners && blocks->facet[f].pair < 0; c++)
      start[blocks->facet[f].node[c] + 1]++;
  for (int32_t n = 0; n < nodes; n++)
    start[n + 1] += start[n];
  CDEM_NEW(s->surface_facet, start[nodes], fault);
  CDEM_NEW(next, (int64_t)nodes + 1, fault);
  memcpy(next, start, ((size_t)nodes + 1) * sizeof *next);
  for (int32_t f = 0; f < blocks->facets; f++)
    for (int c = 0; c < blocks->facet[f].corners && blocks->facet[f].pair < 0; c++)
      s->surface_facet[next[blocks->facet[f].node[c]]++] = 4 * (int64_t)f + c;
  free(next);
  return CDEM_OK;
}

/* Share of the surface of every node, from the facets that are free from the start. */
static int32_t surface_shares(const cdem_solver *solver, double *share) {
  int32_t nodes = 0;
  const cdem_blocks *blocks = solver->store->options.blocks;
  for (int32_t f = 0; f < blocks->facets; f++) {
    const cdem_facet *facet = &blocks->facet[f];
    double part[4], normal[3];
    if (facet->pair >= 0)
      continue;
    cdem_solver_shares(solver, f, part, normal);
    for (int c = 0; c < facet->corners; c++)
      share[facet->node[c]] += part[c];
  }
  for (int32_t n = 0; n < solver->nodes; n++)
    nodes += share[n] > 0.0;
  return nodes;
}

static cdem_status fill_plate(const cdem_solver *solver, const cdem_plate *plate,
                              const double *share, int32_t nodes, cdem_plate_store *store,
                              cdem_fault *fault) {
  const cdem_mesh *mesh = solver->store->options.body->model->mesh;
  CDEM_REQUIRE(plate->kn > 0.0 && plate->kt >= 0.0 && plate->friction >= 0.0, fault, CDEM_INPUT,
               "plate '%s': kn must be positive, kt and friction not negative (%g, %g Pa/m, %g)",
               plate->name, plate->kn, plate->kt, plate->friction);
  CDEM_TRY(make_axes(plate, solver->store->dimension, store, fault));
  CDEM_NEW(store->node, nodes, fault);
  CDEM_NEW(store->share, nodes, fault);
  CDEM_NEW(store->area, nodes, fault);
  CDEM_NEW(store->distance, nodes, fault);
  CDEM_NEW(store->slip, 2 * (int64_t)nodes, fault);
  CDEM_NEW(store->last, 2 * (int64_t)nodes, fault);
  CDEM_NEW(store->normal, nodes, fault);
  CDEM_NEW(store->touch, nodes, fault);
  for (int32_t n = 0; n < solver->nodes; n++) {
    double from[3];
    if (!(share[n] > 0.0))
      continue;
    for (int k = 0; k < 3; k++)
      from[k] = mesh->xyz[3 * (size_t)n + (size_t)k] - plate->point[k];
    store->node[store->nodes] = n;
    store->share[store->nodes] = share[n];
    store->distance[store->nodes++] = cdem_dot3(store->axis[0], from);
  }
  return CDEM_OK;
}

cdem_status cdem_solver_plates_init(cdem_solver *solver, cdem_fault *fault) {
  cdem_solver_store *s = solver->store;
  int plates = s->options.plates;
  if (plates == 0)
    return CDEM_OK;
  CDEM_NEW(s->plate, plates, fault);
  CDEM_NEW(s->plate_part, solver->nodes / CDEM_SOLVER_CHUNK + 1, fault);
  CDEM_TRY(link_facets(s, solver->nodes, fault));
  double *share;
  CDEM_NEW(share, solver->nodes, fault);
  int32_t nodes = surface_shares(solver, share);
  cdem_status status = CDEM_OK;
  for (int p = 0; p < plates && status == CDEM_OK; p++)
    status = fill_plate(solver, &s->options.plate[p], share, nodes, &s->plate[p], fault);
  free(share);
  return status;
}

void cdem_solver_plates_release(cdem_solver *solver) {
  cdem_solver_store *s = solver->store;
  for (int p = 0; p < s->options.plates && s->plate != NULL; p++) {
    cdem_plate_store *store = &s->plate[p];
    free(store->node);
    free(store->share);
    free(store->area);
    free(store->distance);
    free(store->slip);
    free(store->last);
    free(store->normal);
    free(store->touch);
  }
  free(s->plate);
  free(s->plate_part);
  free(s->surface_start);
  free(s->surface_facet);
}

typedef struct {
  const cdem_solver *solver;
  const cdem_plate *plate;
  cdem_plate_store *store;
} plate_view;

/* Closer to the plate's middle than its edges and `more`. */
static bool within(const plate_view *v, int32_t i, const double place[2], double more) {
  const cdem_mesh *mesh = v->solver->store->options.body->model->mesh;
  for (int k = 0; k < v->solver->store->dimension - 1; k++) {
    double from = place[k];
    if (!(v->plate->half[k] > 0.0))
      continue;
    for (int c = 0; c < 3; c++)
      from += v->store->axis[k + 1][c] *
              (mesh->xyz[3 * (size_t)v->store->node[i] + (size_t)c] - v->plate->point[c]);
    if (fabs(from) > v->plate->half[k] + more)
      return false;
  }
  return true;
}

/* The node's share of the facets that face the plate now, projected; at least a tenth of its whole
 * share, so that a node of which no facet does is not lost. */
static double facing_area(const plate_view *v, int32_t i) {
  const cdem_solver_store *s = v->solver->store;
  int32_t node = v->store->node[i];
  double area = 0.0;
  for (int64_t k = s->surface_start[node]; k < s->surface_start[node + 1]; k++) {
    const cdem_facet *facet = &s->options.blocks->facet[s->surface_facet[k] / 4];
    double xyz[4][3], vector[4][3];
    cdem_solver_corners(v->solver, facet, v->solver->u, xyz);
    cdem_surface_vectors((const double(*)[3])xyz, facet->corners, s->options.thickness, vector);
    area += fmax(0.0, -cdem_dot3(vector[s->surface_facet[k] % 4], v->store->axis[0]));
  }
  return fmax(area, 0.1 * v->store->share[i]);
}

/* Length that a node stands for. */
static double size_of(const plate_view *v, int32_t i) {
  const cdem_solver_store *s = v->solver->store;
  return s->dimension == 2 ? v->store->share[i] / s->options.thickness : sqrt(v->store->share[i]);
}

/* A node that touches stays until all that it stands for has left the plate by the side. */
static bool touches(const plate_view *v, int32_t i, double overlap, const double place[2]) {
  double size = size_of(v, i);
  if (!(overlap > 0.0) || v->store->touch[i] == PASSED)
    return false;
  if (v->store->touch[i] == TOUCHES)
    return within(v, i, place, 0.5 * size);
  return within(v, i, place, 0.0) && overlap <= deepest_entry * size;
}

/* Tangential force kt A slip, cut back to the friction; what slides between two evaluations takes
 * the mean of the forces before and after times the way: with the trapezoid of the works the book
 * closes exactly. So it does where a node leaves by the side: what its spring still holds beyond
 * that trapezoid is lost, and counted as friction. */
static void node_forces(const plate_view *v, int32_t i, cdem_plate_sums *sums) {
  cdem_plate_store *p = v->store;
  const cdem_solver *solver = v->solver;
  size_t first = (size_t)p->node[i] * (size_t)solver->dofs, j = 2 * (size_t)i;
  double relative[3] = {0}, place[2], slip[2] = {0}, force = 0.0;
  for (int k = 0; k < solver->store->dimension; k++)
    relative[k] = solver->u[first + (size_t)k] - p->moved[k];
  double overlap = -(p->distance[i] + cdem_dot3(p->axis[0], relative));
  for (int k = 0; k < 2; k++)
    place[k] = cdem_dot3(p->axis[k + 1], relative);
  const bool before = p->touch[i] == TOUCHES, touch = touches(v, i, overlap, place);
  if (touch && !before)
    p->area[i] = facing_area(v, i);
  if (before && !touch && overlap > 0.0)
    sums->friction += 0.5 * p->normal[i] * overlap;
  const double spring = v->plate->kt * p->area[i], normal_spring = v->plate->kn * p->area[i];
  if (touch) {
    force = normal_spring * overlap;
    for (int k = 0; k < 2 && before; k++)
      slip[k] = p->slip[j + (size_t)k] + place[k] - p->last[j + (size_t)k];
    double tangential = spring * hypot(slip[0], slip[1]), most = v->plate->friction * force;
    for (int k = 0; k < 2 && tangential > most; k++)
      slip[k] *= most / tangential;
  }
  for (int k = 0; k < 2; k++) {
    double *old = &p->slip[j + (size_t)k];
    double way = before ? place[k] - p->last[j + (size_t)k] - (slip[k] - *old) : 0.0;
    sums->friction += 0.5 * spring * (*old + slip[k]) * way;
    for (int c = 0; c < solver->store->dimension; c++) {
      sums->before[c] -= spring * *old * p->axis[k + 1][c];
      sums->force[c] -= spring * slip[k] * p->axis[k + 1][c];
      solver->force[first + (size_t)c] -= spring * slip[k] * p->axis[k + 1][c];
    }
    sums->stored += 0.5 * spring * slip[k] * slip[k];
    *old = slip[k];
    p->last[j + (size_t)k] = place[k];
  }
  for (int c = 0; c < solver->store->dimension; c++) {
    sums->before[c] += p->normal[i] * p->axis[0][c];
    sums->force[c] += force * p->axis[0][c];
    solver->force[first + (size_t)c] += force * p->axis[0][c];
  }
  sums->stored += touch ? 0.5 * force * overlap : 0.0;
  p->normal[i] = force;
  p->touch[i] = touch ? TOUCHES : overlap > 0.0 ? PASSED : AWAY;
}

static void plate_forces(cdem_solver *solver, const cdem_plate *plate, cdem_plate_store *store) {
  cdem_solver_store *s = solver->store;
  plate_view view = {solver, plate, store};
  double moved[3] = {0};
  for (int k = 0; k < s->dimension; k++)
    moved[k] = cdem_series_integral(&plate->velocity[k], solver->time);
  double way[3] = {moved[0] - store->moved[0], moved[1] - store->moved[1],
                   moved[2] - store->moved[2]};
  memcpy(store->moved, moved, sizeof moved);
  int64_t chunks = (store->nodes + CDEM_SOLVER_CHUNK - 1) / CDEM_SOLVER_CHUNK;
  cdem_plate_sums *part = s->plate_part, sums = {0};
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int64_t c = 0; c < chunks; c++) {
    int64_t end = (c + 1) * CDEM_SOLVER_CHUNK;
    end = end < store->nodes ? end : store->nodes;
    cdem_plate_sums own = {0};
    for (int64_t i = c * CDEM_SOLVER_CHUNK; i < end; i++)
      node_forces(&view, (int32_t)i, &own);
    part[c] = own;
  }
  for (int64_t c = 0; c < chunks; c++) {
    for (int k = 0; k < 3; k++) {
      sums.force[k] += part[c].force[k];
      sums.before[k] += part[c].before[k];
    }
    sums.stored += part[c].stored;
    sums.friction += part[c].friction;
  }
  for (int k = 0; k < 3; k++) {
    s->plate_work += 0.5 * (sums.before[k] + sums.force[k]) * way[k];
    store->force[k] = -sums.force[k];
  }
  s->plate_friction += sums.friction;
  store->stored = sums.stored;
}

void cdem_solver_plates_forces(cdem_solver *solver) {
  cdem_solver_store *s = solver->store;
  for (int p = 0; p < s->options.plates; p++)
    plate_forces(solver, &s->options.plate[p], &s->plate[p]);
}

/* ---- the step ---- */

void cdem_solver_plates_row_sums(const cdem_solver *solver, double *stiffness) {
  const cdem_solver_store *s = solver->store;
  for (int p = 0; p < s->options.plates; p++)
    for (int32_t i = 0; i < s->plate[p].nodes; i++)
      stiffness[s->plate[p].node[i]] +=
          s->plate[p].share[i] * fmax(s->options.plate[p].kn, s->options.plate[p].kt);
}

double cdem_solver_plates_frequency2(const cdem_solver *solver, int *plate) {
  const cdem_solver_store *s = solver->store;
  double sum = 0.0, most = -1.0;
  *plate = -1;
  for (int p = 0; p < s->options.plates; p++) {
    double largest = 0.0;
    for (int32_t i = 0; i < s->plate[p].nodes; i++) {
      double mass = s->inertia[(size_t)s->plate[p].node[i] * (size_t)solver->dofs];
      double spring = s->plate[p].share[i] * fmax(s->options.plate[p].kn, s->options.plate[p].kt);
      if (mass > 0.0)
        largest = fmax(largest, spring / mass);
    }
    sum += largest;
    if (largest > most) {
      most = largest;
      *plate = p;
    }
  }
  return sum;
}
