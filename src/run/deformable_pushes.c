/* Clusters of nodes that touch: what the source calls a contact. */
#include "run/deformable.h"

#include <math.h>
#include <stdlib.h>

/* Nodes further apart than one and a half times the longest edge of a skin are two contacts. */
static const double edges_apart = 1.5;

static double reach_of(const cdem_run_deformable *d) {
  double longest = 0.0, radius = 0.0;
  for (int s = 0; s < d->shapes; s++) {
    const cdem_skin *skin = &d->shape[s].surface;
    for (int32_t t = 0; t < 3 * skin->triangles; t++) {
      const double *a = skin->reference + 3 * skin->triangle[t];
      const double *b = skin->reference + 3 * skin->triangle[t % 3 < 2 ? t + 1 : t - 2];
      double edge[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
      longest = fmax(longest, cdem_norm3(edge));
    }
  }
  for (int64_t g = 0; g < d->grains->grains.grains; g++)
    radius = fmax(radius, d->grains->grains.radius[g]);
  return edges_apart * longest * radius;
}

typedef struct {
  double *xyz, *force;
  int32_t *owner, *partner, *cluster;
} points;

static cdem_status fill(int64_t touches, const cdem_fdem_touch *touch, points *p,
                        cdem_fault *fault) {
  CDEM_NEW(p->xyz, 3 * touches, fault);
  CDEM_NEW(p->force, 3 * touches, fault);
  CDEM_NEW(p->owner, touches, fault);
  CDEM_NEW(p->partner, touches, fault);
  CDEM_NEW(p->cluster, touches, fault);
  for (int64_t i = 0; i < touches; i++) {
    p->owner[i] = touch[i].grain;
    p->partner[i] = touch[i].partner;
    for (int c = 0; c < 3; c++) {
      p->xyz[3 * i + c] = touch[i].point[c];
      p->force[3 * i + c] = -touch[i].push * touch[i].normal[c];
    }
  }
  return CDEM_OK;
}

static cdem_status find(const cdem_run_deformable *d, int64_t touches, const points *p,
                        cdem_cluster_contacts *contacts, cdem_fault *fault) {
  const cdem_contact_points all = {touches, p->xyz, p->force, p->owner, p->partner};
  const cdem_cluster_pairing pairing = {.apart = INFINITY};
  int64_t clusters = 0;
  CDEM_TRY(cdem_clusters_find(&all, reach_of(d), p->cluster, &clusters, fault));
  return cdem_clusters_match(&all, p->cluster, clusters, &pairing, contacts, fault);
}

cdem_status cdem_run_deformable_pushes(const cdem_run_deformable *d,
                                       cdem_cluster_contacts *contacts, cdem_fault *fault) {
  cdem_fdem_touch *touch = NULL;
  int64_t touches = 0;
  points p = {0};
  *contacts = (cdem_cluster_contacts){0};
  CDEM_TRY(cdem_fdem_touches(&d->fdem, &touches, &touch, fault));
  cdem_status status = fill(touches, touch, &p, fault);
  if (status == CDEM_OK)
    status = find(d, touches, &p, contacts, fault);
  free(p.xyz);
  free(p.force);
  free(p.owner);
  free(p.partner);
  free(p.cluster);
  free(touch);
  return status;
}
