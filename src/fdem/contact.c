/* Contact of deformed grains: forces on surface nodes, by three passes over the grains.
 *
 *     reaches     how far each grain's nodes are from its centre; the list of neighbours if
 * outlived touches     of each grain's nodes, with their forces (contact_find.c) forces      each
 * grain gathers those of its nodes, then, from its neighbours' touches in the order of ids, the
 * reactions on its triangles
 */
#include "base/memory.h"
#include "fdem/contact_store.h"

#include <inttypes.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- making ---- */

static cdem_status make(const cdem_contact_view *view, double skin, cdem_fdem_contacts *contacts,
                        cdem_fault *fault) {
  CDEM_TRY(cdem_contact_neighbours_init(&contacts->list, view, skin, fault));
  CDEM_NEW(contacts->reach, view->grains, fault);
  CDEM_NEW(contacts->row, view->grains, fault);
  CDEM_NEW(contacts->work, contacts->threads, fault);
  int64_t most = 0;
  for (int64_t g = 0; g < view->grains; g++)
    most = view->first[g + 1] - view->first[g] > most ? view->first[g + 1] - view->first[g] : most;
  for (int t = 0; t < contacts->threads; t++) {
    contacts->work[t].nodes = most;
    CDEM_NEW(contacts->work[t].wall, view->walls, fault);
    CDEM_NEW(contacts->work[t].x, 3 * most, fault);
    CDEM_NEW(contacts->work[t].mark, most, fault);
  }
  return CDEM_OK;
}

cdem_status cdem_fdem_contacts_create(const cdem_contact_view *view, double skin, int threads,
                                      cdem_fdem_contacts **contacts, cdem_fault *fault) {
  *contacts = NULL;
  CDEM_REQUIRE(skin >= 0.0 && isfinite(skin), fault, CDEM_INPUT,
               "the skin of the list of neighbours is %g mean radii; it must not be negative",
               skin);
  for (int w = 0; w < view->walls; w++)
    CDEM_REQUIRE(view->wall[w].wall.shape != CDEM_WALL_MESH, fault, CDEM_INPUT,
                 "wall '%s' is a mesh, which deformable grains cannot touch; build it of planes, "
                 "plates and cylinders",
                 cdem_wall_name(&view->wall[w].wall));
  CDEM_NEW(*contacts, 1, fault);
  (*contacts)->grains = view->grains;
  (*contacts)->walls = view->walls;
  (*contacts)->threads = threads > 0 ? threads : omp_get_max_threads();
  cdem_status status = make(view, skin > 0.0 ? skin : 0.1, *contacts, fault);
  if (status != CDEM_OK)
    cdem_fdem_contacts_destroy(contacts);
  return status;
}

void cdem_fdem_contacts_destroy(cdem_fdem_contacts **contacts) {
  cdem_fdem_contacts *c = *contacts;
  if (c == NULL)
    return;
  for (int64_t g = 0; c->row != NULL && g < c->grains; g++) {
    free(c->row[g].item);
    free(c->row[g].old);
  }
  for (int t = 0; c->work != NULL && t < c->threads; t++) {
    free(c->work[t].near);
    free(c->work[t].wall);
    free(c->work[t].x);
    free(c->work[t].mark);
  }
  cdem_contact_neighbours_release(&c->list);
  free(c->reach);
  free(c->row);
  free(c->work);
  free(c);
  *contacts = NULL;
}

/* ---- passes ---- */

static void set_reaches(cdem_fdem_contacts *contacts, const cdem_contact_view *view) {
#pragma omp parallel for schedule(static) num_threads(contacts->threads)
  for (int64_t g = 0; g < contacts->grains; g++) {
    double most = 0.0;
    for (int64_t n = view->first[g]; n < view->first[g + 1]; n++) {
      const double *p = view->place + 3 * n;
      double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
      most = square > most ? square : most;
    }
    contacts->reach[g] = sqrt(most) * (1.0 + 0x1p-40); /* the same length in space */
  }
}

/* Skins find the nearest triangle of shapes that have changed by less than their margin. */
static cdem_status check_shapes(const cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                                cdem_fault *fault) {
  for (int64_t g = 0; g < contacts->grains; g++) {
    const cdem_skin *skin = view->surface[g];
    CDEM_REQUIRE(contacts->reach[g] <= view->scale[g] * (skin->reach + skin->margin), fault,
                 CDEM_NUMERIC,
                 "grain %" PRId64 " has grown from %g to %g radii: its strains are not small; take "
                 "stiffer grains, a larger penalty or smaller loads",
                 g, skin->reach, contacts->reach[g] / view->scale[g]);
  }
  return CDEM_OK;
}

static cdem_status make_room(cdem_fdem_contacts *contacts, cdem_fault *fault) {
  const int64_t *row = contacts->list.row;
  int64_t most = 1;
  for (int64_t g = 0; g < contacts->grains; g++)
    most = row[g + 1] - row[g] >= most ? row[g + 1] - row[g] + 1 : most;
  for (int t = 0; t < contacts->threads; t++)
    if (contacts->work[t].capacity < most)
      CDEM_TRY(cdem_grow(&contacts->work[t].near, &contacts->work[t].capacity, most,
                         sizeof *contacts->work[t].near, fault));
  return CDEM_OK;
}

cdem_status cdem_contacts_reach(cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                                cdem_fault *fault) {
  set_reaches(contacts, view);
  CDEM_TRY(check_shapes(contacts, view, fault));
  CDEM_TRY(cdem_contact_neighbours_update(&contacts->list, view->center, contacts->reach, fault));
  return make_room(contacts, fault);
}

static cdem_status find(cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                        cdem_fault *fault) {
#pragma omp parallel for schedule(static) num_threads(contacts->threads)
  for (int64_t g = 0; g < contacts->grains; g++)
    cdem_contact_find(contacts, view, g, contacts->work + omp_get_thread_num());
  for (int64_t g = 0; g < contacts->grains; g++) {
    const cdem_touch_row *row = contacts->row + g;
    CDEM_REQUIRE(row->status == CDEM_OK, fault, row->status,
                 "out of memory: no room for the touches of grain %" PRId64, g);
    if (row->sunk < 0)
      continue;
    const cdem_node_touch *t = row->item + row->sunk;
    const double *x = view->now + 3 * (view->first[g] + t->node);
    char partner[160];
    if (t->partner >= 0)
      snprintf(partner, sizeof partner, "grain %" PRId32, t->partner);
    else
      snprintf(partner, sizeof partner, "wall '%.100s'",
               cdem_wall_name(&view->wall[-1 - t->partner].wall));
    return cdem_fail(fault, CDEM_NUMERIC,
                     "grain %" PRId64 ": its node at (%g, %g, %g) m is %g m deep in %s, more than "
                     "half a radius; take a larger penalty, a smaller step or a slower motion",
                     g, x[0], x[1], x[2], t->depth, partner);
  }
  return CDEM_OK;
}

static void add(double *to, const double *what) {
  for (int c = 0; c < 3; c++)
    to[c] += what[c];
}

static double stiffest(const cdem_node_touch *t) {
  return fmax(t->stiffness, t->shear_stiffness);
}

/* One grain's nodes; returns the stiffnesses of its touches. */
static double gather(const cdem_fdem_contacts *contacts, const cdem_contact_view *view, int64_t g,
                     double *force) {
  const cdem_touch_row *own = contacts->row + g;
  double sum = 0.0;
  memset(force, 0, 3 * (size_t)(view->first[g + 1] - view->first[g]) * sizeof *force);
  for (int32_t k = 0; k < own->count; k++) {
    add(force + 3 * (int64_t)own->item[k].node, own->item[k].force);
    sum += stiffest(own->item + k);
  }
  for (int64_t j = contacts->list.row[g]; j < contacts->list.row[g + 1]; j++) {
    const cdem_touch_row *row = contacts->row + contacts->list.other[j];
    for (int32_t k = 0; k < row->count; k++) {
      const cdem_node_touch *t = row->item + k;
      if (t->partner != g)
        continue;
      for (int corner = 0; corner < 3; corner++)
        add(force + 3 * (int64_t)t->corner[corner], t->reaction[corner]);
      sum += stiffest(t);
    }
  }
  return sum;
}

static void sum_walls(const cdem_fdem_contacts *contacts, double *force, double *stiff) {
  for (int w = 0; w < contacts->walls; w++)
    stiff[w] = force[3 * w] = force[3 * w + 1] = force[3 * w + 2] = 0.0;
  for (int64_t g = 0; g < contacts->grains; g++) {
    const cdem_touch_row *row = contacts->row + g;
    for (int32_t k = 0; row->walls > 0 && k < row->count; k++) {
      const cdem_node_touch *t = row->item + k;
      int w = -1 - t->partner;
      if (w < 0)
        continue;
      for (int c = 0; c < 3; c++)
        force[3 * w + c] -= t->force[c];
      stiff[w] += t->stiffness + t->dashpot;
    }
  }
}

static void sum_books(const cdem_fdem_contacts *contacts, cdem_contact_book *book) {
  *book = (cdem_contact_book){0};
  for (int64_t g = 0; g < contacts->grains; g++) {
    const cdem_contact_book *part = &contacts->row[g].book;
    book->normal += part->normal;
    book->shear += part->shear;
    book->friction += part->friction;
    book->damping += part->damping;
    book->walls += part->walls;
  }
}

void cdem_fdem_contacts_gather(const cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                               const cdem_contact_forces *out) {
#pragma omp parallel for schedule(static) num_threads(contacts->threads)
  for (int64_t g = 0; g < contacts->grains; g++)
    out->stiff[g] = gather(contacts, view, g, out->force + 3 * view->first[g]);
  sum_walls(contacts, out->wall_force, out->wall_stiff);
}

cdem_status cdem_fdem_contacts_forces(cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                                      const cdem_contact_forces *out, cdem_contact_book *book,
                                      cdem_fault *fault) {
  CDEM_TRY(cdem_contacts_reach(contacts, view, fault));
  CDEM_TRY(find(contacts, view, fault));
  cdem_fdem_contacts_gather(contacts, view, out);
  sum_books(contacts, book);
  return CDEM_OK;
}
