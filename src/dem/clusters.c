/* Nodes to clusters: of each grain, what neighbourhoods connect. */
#include "dem/clusters.h"

#include "base/sets.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  int32_t owner, partner;
  double along; /* place along x, m: neighbours are near each other in this order */
  int32_t point;
} filed;

static int in_order(const void *one, const void *two) {
  const filed *a = one, *b = two;
  if (a->owner != b->owner)
    return a->owner < b->owner ? -1 : 1;
  if (a->partner != b->partner)
    return a->partner < b->partner ? -1 : 1;
  if (a->along != b->along)
    return a->along < b->along ? -1 : 1;
  return (a->point > b->point) - (a->point < b->point);
}

static bool pushes(const cdem_contact_points *p, int64_t i) {
  const double *f = p->force + 3 * i;
  return f[0] != 0.0 || f[1] != 0.0 || f[2] != 0.0;
}

static bool near(const cdem_contact_points *p, int64_t i, int64_t j, double reach) {
  double square = 0.0;
  for (int c = 0; c < 3; c++) {
    double d = p->xyz[3 * i + c] - p->xyz[3 * j + c];
    square += d * d;
  }
  return square <= reach * reach;
}

static void connect(const cdem_contact_points *p, double reach, const filed *list, int64_t count,
                    int32_t *parent) {
  for (int64_t k = 0; k < count; k++)
    for (int64_t m = k + 1;
         m < count && list[m].owner == list[k].owner && list[m].partner == list[k].partner &&
         list[m].along - list[k].along <= reach;
         m++)
      if (near(p, list[k].point, list[m].point, reach))
        cdem_sets_join(parent, list[k].point, list[m].point);
}

static int64_t file(const cdem_contact_points *p, filed *list) {
  int64_t count = 0;
  for (int32_t i = 0; i < p->points; i++)
    if (pushes(p, i))
      list[count++] = (filed){.owner = p->owner[i],
                              .partner = p->partner != NULL ? p->partner[i] : 0,
                              .along = p->xyz[3 * i],
                              .point = i};
  qsort(list, (size_t)count, sizeof *list, in_order);
  return count;
}

cdem_status cdem_clusters_find(const cdem_contact_points *points, double reach, int32_t *cluster,
                               int64_t *clusters, cdem_fault *fault) {
  CDEM_REQUIRE(reach > 0.0, fault, CDEM_INPUT,
               "clusters of contact nodes: the neighbourhood is %g m; it must be positive", reach);
  CDEM_REQUIRE(points->points <= INT32_MAX, fault, CDEM_INPUT,
               "clusters of contact nodes: %lld nodes; there may be %d", (long long)points->points,
               (int)INT32_MAX);
  for (int64_t i = 0; i < points->points; i++)
    CDEM_REQUIRE(points->owner[i] >= 0, fault, CDEM_INPUT,
                 "clusters of contact nodes: node %lld belongs to grain %d", (long long)i,
                 (int)points->owner[i]);
  filed *list = cdem_allocate(points->points, sizeof *list, fault);
  int32_t *parent = cdem_allocate(points->points, sizeof *parent, fault);
  int64_t found = 0;
  bool made = list != NULL && parent != NULL;
  if (made) {
    cdem_sets_init(parent, 0, (int32_t)points->points);
    connect(points, reach, list, file(points, list), parent);
  }
  for (int32_t i = 0; made && i < points->points; i++) {
    int32_t first = cdem_sets_root(parent, i);
    cluster[i] = !pushes(points, i) ? -1 : first == i ? (int32_t)found++ : cluster[first];
  }
  free(list);
  free(parent);
  if (!made)
    return CDEM_MEMORY;
  *clusters = found;
  return CDEM_OK;
}
