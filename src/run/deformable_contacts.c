/* Nodes that touch become contacts: one for each two grains, and for each grain and wall. */
#include "base/sort.h"
#include "run/deformable.h"

#include <stdlib.h>
#include <string.h>

static int32_t lower(const cdem_fdem_touch *t) {
  return t->partner >= 0 && t->partner < t->grain ? t->partner : t->grain;
}

static int32_t higher(const cdem_fdem_touch *t) {
  return t->partner > t->grain || t->partner < 0 ? t->partner : t->grain;
}

static int by_pair(const void *a, const void *b) {
  const cdem_fdem_touch *s = a, *t = b;
  if (lower(s) != lower(t))
    return lower(s) < lower(t) ? -1 : 1;
  if (higher(s) != higher(t))
    return higher(s) < higher(t) ? -1 : 1;
  if (s->grain != t->grain)
    return s->grain < t->grain ? -1 : 1;
  return s->node < t->node ? -1 : s->node > t->node;
}

/* Adds a node; its push is the weight of its place and normal. */
static void add(const cdem_fdem_touch *t, cdem_dem_contact *c) {
  double sign = t->grain == c->a ? 1.0 : -1.0;
  for (int k = 0; k < 3; k++) {
    c->force[k] += sign * t->force[k];
    c->point[k] += t->push * t->point[k];
    c->normal[k] += sign * t->push * t->normal[k];
  }
  c->push += t->push;
  c->overlap = t->depth > c->overlap ? t->depth : c->overlap;
}

/* Sums become means; push is what the sum of all forces is along the mean normal. */
static void finish(const cdem_run_deformable *d, const double *center, cdem_dem_contact *c) {
  double size = cdem_norm3(c->normal);
  for (int k = 0; k < 3; k++) {
    c->point[k] /= c->push;
    c->normal[k] /= size;
    const double *to = c->b >= 0 ? center + 3 * (int64_t)c->b : c->point;
    c->branch[k] = to[k] - center[3 * (int64_t)c->a + k];
  }
  c->push = -cdem_dot3(c->force, c->normal);
  double across[3], friction;
  for (int k = 0; k < 3; k++)
    across[k] = c->force[k] + c->push * c->normal[k];
  int a = d->grains->grains.material[c->a];
  int b = c->b >= 0 ? d->grains->grains.material[c->b] : d->grains->wall[-1 - c->b].material;
  friction = d->law[a * d->grains->materials + b].friction;
  c->sliding = friction > 0.0 && cdem_norm3(across) >= (1.0 - 1e-6) * friction * c->push;
}

/* touch is sorted by pairs. */
static int64_t gather(int64_t touches, const cdem_fdem_touch *touch, cdem_dem_contact *contact) {
  int64_t count = 0;
  for (int64_t i = 0; i < touches; i++) {
    if (!(touch[i].push > 0.0))
      continue;
    int32_t a = lower(&touch[i]), b = higher(&touch[i]);
    if (count == 0 || contact[count - 1].a != a || contact[count - 1].b != b)
      contact[count++] = (cdem_dem_contact){.a = a, .b = b};
    add(&touch[i], &contact[count - 1]);
  }
  return count;
}

cdem_status cdem_run_deformable_contacts(const cdem_run_deformable *d, int64_t *contacts,
                                         cdem_dem_contact **contact, cdem_fault *fault) {
  cdem_fdem_touch *touch = NULL;
  int64_t touches = 0;
  *contacts = 0;
  CDEM_TRY(cdem_fdem_touches(&d->fdem, &touches, &touch, fault));
  cdem_sort(touch, touches, sizeof *touch, by_pair);
  double *center = cdem_allocate(3 * d->fdem.grains, sizeof *center, fault);
  *contact = center != NULL ? cdem_allocate(touches, sizeof **contact, fault) : NULL;
  cdem_status status = *contact != NULL ? CDEM_OK : CDEM_MEMORY;
  if (status == CDEM_OK) {
    cdem_fdem_look(&d->fdem, &(cdem_fdem_view){.xyz = center});
    *contacts = gather(touches, touch, *contact);
    for (int64_t k = 0; k < *contacts; k++)
      finish(d, center, *contact + k);
  }
  free(center);
  free(touch);
  return status;
}
