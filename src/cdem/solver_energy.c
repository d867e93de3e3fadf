#include "base/mat3.h"
#include "cdem/solver_store.h"

#include <string.h>

/* ---- the energy book ---- */

/* The potential of gravity is linear in the displacements: its work by the trapezoid is the
 * difference of m g . u. */
static double gravity_potential(const cdem_solver *solver) {
  const cdem_solver_store *s = solver->store;
  const double *mass = s->options.body->mass, *g = s->options.gravity;
  size_t dofs = (size_t)solver->dofs;
  int64_t chunks = (solver->nodes + CDEM_SOLVER_CHUNK - 1) / CDEM_SOLVER_CHUNK;
  double sum = 0.0;
  if (g[0] == 0.0 && g[1] == 0.0 && g[2] == 0.0)
    return 0.0;
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int64_t c = 0; c < chunks; c++) {
    int64_t end = (c + 1) * CDEM_SOLVER_CHUNK;
    double own = 0.0;
    for (int64_t n = c * CDEM_SOLVER_CHUNK; n < end && n < solver->nodes; n++)
      for (int i = 0; i < s->dimension; i++)
        own += mass[(size_t)n * dofs + (size_t)i] * g[i] * solver->u[(size_t)n * dofs + (size_t)i];
    s->partial[c] = own;
  }
  for (int64_t c = 0; c < chunks; c++)
    sum += s->partial[c];
  return sum;
}

static void add_joints(const cdem_solver *solver, cdem_energy_book *book) {
  const cdem_solver_store *s = solver->store;
  if (s->options.interfaces != NULL) {
    cdem_interfaces_totals totals = {0};
    cdem_interfaces_sum(s->options.interfaces, &totals);
    book->interface = totals.stored;
    book->fracture = totals.fracture;
    book->friction += totals.friction;
  }
  if (s->options.contact != NULL) {
    cdem_contact_totals totals = {0};
    cdem_contact_sum(s->options.contact, &totals);
    book->contact = totals.stored;
    book->friction += totals.friction;
    book->damping += totals.damping;
  }
  for (int p = 0; p < s->options.plates; p++)
    book->plate += s->plate[p].stored;
  book->friction += s->plate_friction;
}

/* Everything but error and exchange. Works up to t_n: whole steps, and the halves before t_n of
 * the forces at t_n. */
static void fill_book(const cdem_solver *solver, cdem_energy_book *book) {
  const cdem_solver_store *s = solver->store;
  double sums[CDEM_SUMS] = {0};
  *book = (cdem_energy_book){.initial = s->initial};
  if (!s->stale)
    cdem_solver_pass(solver, false, NULL, sums);
  for (int k = 0; k < CDEM_SUMS; k++)
    sums[k] += k < CDEM_SUM_CHANGE ? s->total[k] : 0.0;
  book->kinetic = sums[CDEM_SUM_KINETIC];
  double by_class[CDEM_CLASSES];
  book->elastic = cdem_body_energy(s->options.body, solver->u, by_class);
  book->load = sums[CDEM_SUM_LOAD];
  book->support = sums[CDEM_SUM_SUPPORT] + s->plate_work;
  book->damping = sums[CDEM_SUM_MASS] + sums[CDEM_SUM_LOCAL];
  book->quiet = sums[CDEM_SUM_QUIET];
  book->step = s->total[CDEM_SUM_CHANGE]; /* a change at t_n itself is still to come */
  book->gravity = gravity_potential(solver) - s->gravity_start;
  add_joints(solver, book);
}

static double imbalance(const cdem_energy_book *b) {
  double stored = b->kinetic + b->elastic + b->interface + b->contact + b->plate;
  double dissipated = b->fracture + b->friction + b->damping + b->quiet;
  return stored + dissipated - (b->load + b->gravity + b->support) - b->step - b->initial;
}

void cdem_solver_energies(cdem_solver *solver, cdem_energy_book *book) {
  cdem_solver_store *s = solver->store;
  fill_book(solver, book);
  book->error = imbalance(book);
  const double term[] = {book->kinetic, book->elastic,  book->interface, book->contact,
                         book->plate,   book->fracture, book->friction,  book->damping,
                         book->quiet,   book->load,     book->gravity,   book->support,
                         book->step,    book->initial};
  for (size_t k = 0; k < sizeof term / sizeof term[0]; k++)
    s->exchange = fmax(s->exchange, fabs(term[k]));
  book->exchange = s->exchange;
}

void cdem_solver_book_start(cdem_solver *solver) {
  cdem_solver_store *s = solver->store;
  cdem_energy_book book;
  memset(s->total, 0, sizeof s->total);
  s->initial = 0.0;
  s->exchange = 0.0;
  s->gravity_start = gravity_potential(solver);
  fill_book(solver, &book);
  s->initial = imbalance(&book);
}

/* ---- what acts where ---- */

double cdem_solver_reaction(const cdem_solver *solver, int support) {
  const cdem_solver_store *s = solver->store;
  const cdem_support *k = &s->options.support[support];
  cdem_motion motion;
  double sum = 0.0;
  cdem_solver_motion(solver, false, &motion);
  for (int32_t i = 0; i < k->nodes; i++) {
    int32_t node = k->node[i];
    cdem_point point;
    double after[3], reaction[3], unused[CDEM_SUMS] = {0}, own;
    if (s->flag[node] & CDEM_NODE_EMPTY)
      continue;
    cdem_solver_point(solver, node, &point);
    if (s->stale) { /* after a static solution: nothing moves */
      own = -point.force[k->component];
    } else {
      cdem_point_move(&motion, solver->dofs, &point, after, reaction, unused);
      own = reaction[k->component];
    }
    if (s->flag[node] & CDEM_NODE_TIED) { /* what holds the cluster, shared by those held */
      const cdem_ties *ties = &s->options.interfaces->ties;
      int32_t c = s->cluster_of[node], held = 0;
      for (int32_t m = ties->start[c]; m < ties->start[c + 1]; m++)
        held += s->flag[ties->member[m]] >> k->component & 1;
      own /= held;
    }
    sum += own;
  }
  return sum;
}

static bool is_listed(int32_t nodes, const int32_t *node, int32_t sought) {
  int32_t from = 0, to = nodes;
  while (from < to) {
    int32_t middle = from + (to - from) / 2;
    if (node[middle] < sought)
      from = middle + 1;
    else
      to = middle;
  }
  return from < nodes && node[from] == sought;
}

static void add_held(const cdem_solver *solver, int32_t node, double force[3]) {
  const cdem_solver_options *o = &solver->store->options;
  for (int i = 0; i < solver->dofs; i++) {
    int64_t at = (int64_t)node * solver->dofs + i;
    double weight = i < solver->store->dimension ? o->body->mass[at] * o->gravity[i] : 0.0;
    force[i] += solver->external[at] - weight - solver->force[at];
  }
}

void cdem_solver_held(const cdem_solver *solver, int32_t nodes, const int32_t *node,
                      double force[3]) {
  const cdem_solver_store *s = solver->store;
  memset(force, 0, 3 * sizeof *force);
  for (int32_t k = 0; k < nodes; k++) {
    if (!(s->flag[node[k]] & CDEM_NODE_TIED)) {
      add_held(solver, node[k], force);
      continue;
    }
    const cdem_ties *ties = &s->options.interfaces->ties;
    int32_t c = s->cluster_of[node[k]], first = ties->start[c], end = ties->start[c + 1];
    while (!is_listed(nodes, node, ties->member[first]))
      first++;
    for (int32_t m = ties->start[c]; m < end && ties->member[first] == node[k]; m++)
      add_held(solver, ties->member[m], force);
  }
}

void cdem_solver_plate(const cdem_solver *solver, int plate, double force[3], double moved[3]) {
  const cdem_plate_store *store = &solver->store->plate[plate];
  memcpy(force, store->force, sizeof store->force);
  memcpy(moved, store->moved, sizeof store->moved);
}

void cdem_solver_velocity(const cdem_solver *solver, double *velocity) {
  const cdem_solver_store *s = solver->store;
  int64_t count = (int64_t)solver->nodes * solver->dofs;
  double sums[CDEM_SUMS];
  memcpy(velocity, solver->v, (size_t)count * sizeof *velocity);
  if (s->stale)
    return;
  cdem_solver_pass(solver, false, velocity, sums);
#pragma omp parallel for schedule(static) num_threads(s->threads)
  for (int64_t i = 0; i < count; i++)
    velocity[i] = 0.5 * (solver->v[i] + velocity[i]);
}

/* Angular momentum with the places at t_n: those half a step before lie along the velocity. */
void cdem_solver_momentum(const cdem_solver *solver, double linear[3], double angular[3]) {
  const cdem_solver_store *s = solver->store;
  const double *xyz = s->options.body->model->mesh->xyz;
  for (int k = 0; k < 3; k++)
    linear[k] = angular[k] = 0.0;
  for (int32_t n = 0; n < solver->nodes; n++) {
    size_t first = (size_t)n * (size_t)solver->dofs;
    double place[3], momentum[3] = {0}, moment[3];
    memcpy(place, xyz + 3 * (size_t)n, sizeof place);
    for (int i = 0; i < s->dimension; i++) {
      place[i] += solver->u[first + (size_t)i];
      momentum[i] = s->inertia[first + (size_t)i] * solver->v[first + (size_t)i];
      linear[i] += momentum[i];
    }
    cdem_cross3(place, momentum, moment);
    for (int k = 0; k < 3; k++)
      angular[k] += moment[k];
    if (solver->dofs > s->dimension) /* Cosserat: spin of the node itself */
      angular[2] += s->inertia[first + 2] * solver->v[first + 2];
  }
}

/* ---- the unbalanced force ---- */

static double free_force(const cdem_solver *solver, const cdem_point *p) {
  double length = solver->store->options.body->model->length, sum = 0.0;
  for (int i = 0; i < solver->dofs; i++) {
    double force = p->fixed >> i & 1U ? 0.0 : p->force[i];
    if (i >= solver->store->dimension)
      force /= length;
    sum += force * force;
  }
  return sqrt(sum);
}

/* *points: nodes, tied clusters counting as one. */
static double largest_unbalanced(const cdem_solver *solver, int32_t *points) {
  const cdem_solver_store *s = solver->store;
  double largest = 0.0;
  cdem_point point;
  *points = s->options.interfaces != NULL ? s->options.interfaces->ties.clusters : 0;
  for (int32_t n = 0; n < solver->nodes; n++) {
    if (s->flag[n] & (CDEM_NODE_EMPTY | CDEM_NODE_TIED))
      continue;
    ++*points;
    cdem_solver_point(solver, n, &point);
    largest = fmax(largest, free_force(solver, &point));
  }
  for (int32_t c = 0; s->options.interfaces != NULL && c < s->options.interfaces->ties.clusters;
       c++) {
    cdem_solver_cluster(solver, c, &point);
    largest = fmax(largest, free_force(solver, &point));
  }
  return largest;
}

/* Every spring pulls at two nodes. What interfaces, contact and plates add is the rest of the force
 * besides the body's and the external. */
static double sum_of_forces(const cdem_solver *solver) {
  const cdem_solver_store *s = solver->store;
  const cdem_solver_options *o = &s->options;
  bool rest = o->interfaces != NULL || o->contact != NULL || o->plates > 0;
  cdem_body_fields fields = {.pair_force = s->pair_force};
  cdem_body_cell_fields(o->body, solver->u, &fields);
  double sum = 0.0;
  for (int64_t k = 0; k < (int64_t)o->body->model->cells * CDEM_CLASSES; k++)
    sum += 2.0 * s->pair_force[k];
  if (rest)
    cdem_body_forces(o->body, solver->u, s->scratch);
  for (int32_t n = 0; n < solver->nodes; n++) {
    size_t first = (size_t)n * (size_t)solver->dofs;
    double external = 0.0, other = 0.0;
    for (size_t i = first; i < first + (size_t)s->dimension; i++) {
      double outside = solver->external[i] + solver->applied[i];
      double joint = rest ? solver->force[i] - solver->external[i] - s->scratch[i] : 0.0;
      external += outside * outside;
      other += joint * joint;
    }
    sum += sqrt(external) + sqrt(other);
  }
  return sum;
}

double cdem_solver_unbalanced(const cdem_solver *solver) {
  int32_t points;
  double largest = largest_unbalanced(solver, &points);
  if (largest == 0.0)
    return 0.0;
  return largest / (sum_of_forces(solver) / points);
}
