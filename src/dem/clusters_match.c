/* Clusters to contacts: the two sides of each. */
#include "base/mat3.h"
#include "base/sort.h"
#include "dem/clusters.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One cluster: sums over its nodes. */
typedef struct {
  int32_t owner, partner;
  double force[3], middle[3], weight; /* N; m, weighted by the size of the force */
  int64_t cluster;
  int64_t other; /* the other side, an index of this list; -1: none */
} side;

typedef struct {
  double distance;
  int64_t one, two;
} candidate;

typedef struct {
  const cdem_contact_points *points;
  const cdem_cluster_pairing *pairing;
  side *sides;
  int64_t count;
  candidate *list;
  int64_t candidates, room;
} match;

static void add_up(match *m, const int32_t *cluster) {
  const cdem_contact_points *p = m->points;
  for (int64_t i = 0; i < p->points; i++) {
    if (cluster[i] < 0)
      continue;
    side *s = &m->sides[cluster[i]];
    double size = cdem_norm3(p->force + 3 * i);
    s->owner = p->owner[i];
    s->partner = p->partner != NULL ? p->partner[i] : 0;
    s->cluster = cluster[i];
    s->other = -1;
    s->weight += size;
    for (int c = 0; c < 3; c++) {
      s->force[c] += p->force[3 * i + c];
      s->middle[c] += size * p->xyz[3 * i + c];
    }
  }
  for (int64_t k = 0; k < m->count; k++)
    for (int c = 0; c < 3; c++)
      m->sides[k].middle[c] /= m->sides[k].weight;
}

/* Partners known: the sides of a pair of grains stand together; else what is near stands near. */
static int by_pair(const void *one, const void *two) {
  const side *a = one, *b = two;
  int32_t low[2] = {a->owner < a->partner ? a->owner : a->partner,
                    b->owner < b->partner ? b->owner : b->partner};
  int32_t high[2] = {a->owner < a->partner ? a->partner : a->owner,
                     b->owner < b->partner ? b->partner : b->owner};
  if (low[0] != low[1])
    return low[0] < low[1] ? -1 : 1;
  if (high[0] != high[1])
    return high[0] < high[1] ? -1 : 1;
  return (a->cluster > b->cluster) - (a->cluster < b->cluster);
}

static int by_place(const void *one, const void *two) {
  const side *a = one, *b = two;
  if (a->middle[0] != b->middle[0])
    return a->middle[0] < b->middle[0] ? -1 : 1;
  return (a->cluster > b->cluster) - (a->cluster < b->cluster);
}

static int nearest_first(const void *one, const void *two) {
  const candidate *a = one, *b = two;
  if (a->distance != b->distance)
    return a->distance < b->distance ? -1 : 1;
  if (a->one != b->one)
    return a->one < b->one ? -1 : 1;
  return (a->two > b->two) - (a->two < b->two);
}

static cdem_status consider(match *m, int64_t i, int64_t j, cdem_fault *fault) {
  const side *a = &m->sides[i], *b = &m->sides[j];
  double way[3], one = cdem_norm3(a->force), two = cdem_norm3(b->force);
  for (int c = 0; c < 3; c++)
    way[c] = b->middle[c] - a->middle[c];
  double distance = cdem_norm3(way);
  bool known = m->points->partner != NULL;
  if (distance > m->pairing->apart || a->owner == b->owner)
    return CDEM_OK;
  if (!known && fabs(one - two) > m->pairing->alike * fmax(one, two))
    return CDEM_OK;
  CDEM_TRY(cdem_grow(&m->list, &m->room, m->candidates + 1, sizeof *m->list, fault));
  bool order = a->cluster < b->cluster;
  m->list[m->candidates++] =
      (candidate){.distance = distance, .one = order ? i : j, .two = order ? j : i};
  return CDEM_OK;
}

/* Both are within reach of each other in the list. */
static bool may_pair(const match *m, const side *a, const side *b) {
  if (m->points->partner == NULL)
    return b->middle[0] - a->middle[0] <= m->pairing->apart;
  return (a->owner == b->owner && a->partner == b->partner) ||
         (a->owner == b->partner && a->partner == b->owner);
}

static cdem_status pair_up(match *m, cdem_fault *fault) {
  for (int64_t i = 0; i < m->count; i++)
    for (int64_t j = i + 1; j < m->count && may_pair(m, &m->sides[i], &m->sides[j]); j++)
      CDEM_TRY(consider(m, i, j, fault));
  cdem_sort(m->list, m->candidates, sizeof *m->list, nearest_first);
  for (int64_t k = 0; k < m->candidates; k++) {
    side *a = &m->sides[m->list[k].one], *b = &m->sides[m->list[k].two];
    if (a->other >= 0 || b->other >= 0)
      continue;
    a->other = m->list[k].two;
    b->other = m->list[k].one;
  }
  return CDEM_OK;
}

/* The force on a, from both sides where there are two, points from b to a. */
static cdem_push contact_of(const match *m, const side *a, const side *b) {
  cdem_push made = {.a = a->owner, .b = b != NULL ? b->owner : -1};
  double force[3], weight = a->weight + (b != NULL ? b->weight : 0.0);
  if (b == NULL && m->points->partner != NULL)
    made.b = a->partner;
  for (int c = 0; c < 3; c++) {
    force[c] = a->force[c] - (b != NULL ? b->force[c] : 0.0);
    made.point[c] = (a->weight * a->middle[c] + (b != NULL ? b->weight * b->middle[c] : 0.0));
    made.point[c] /= weight;
  }
  double size = cdem_norm3(force), sign = 1.0;
  made.push = b != NULL && m->pairing->shared ? 0.5 * size : size;
  if (made.b >= 0 && made.b < made.a) {
    int64_t other = made.a;
    made.a = made.b;
    made.b = other;
    sign = -1.0;
  }
  for (int c = 0; c < 3 && size > 0.0; c++)
    made.normal[c] = -sign * force[c] / size;
  return made;
}

static int by_ids(const void *one, const void *two) {
  const cdem_push *a = one, *b = two;
  if (a->a != b->a)
    return a->a < b->a ? -1 : 1;
  if (a->b != b->b)
    return a->b < b->b ? -1 : 1;
  for (int c = 0; c < 3; c++)
    if (a->point[c] != b->point[c])
      return a->point[c] < b->point[c] ? -1 : 1;
  return 0;
}

static cdem_status collect(const match *m, cdem_cluster_contacts *contacts, cdem_fault *fault) {
  CDEM_NEW(contacts->contact, m->count, fault);
  for (int64_t i = 0; i < m->count; i++) {
    const side *a = &m->sides[i], *b = a->other >= 0 ? &m->sides[a->other] : NULL;
    bool boundary = m->points->partner != NULL && a->partner < 0;
    if (b != NULL && b->owner < a->owner)
      continue;
    contacts->single += b == NULL && !boundary;
    contacts->contact[contacts->contacts++] = contact_of(m, a, b);
  }
  cdem_sort(contacts->contact, contacts->contacts, sizeof *contacts->contact, by_ids);
  return CDEM_OK;
}

cdem_status cdem_clusters_match(const cdem_contact_points *points, const int32_t *cluster,
                                int64_t clusters, const cdem_cluster_pairing *pairing,
                                cdem_cluster_contacts *contacts, cdem_fault *fault) {
  match m = {.points = points, .pairing = pairing, .count = clusters};
  cdem_cluster_contacts made = {0};
  CDEM_REQUIRE(pairing->apart > 0.0 && pairing->alike >= 0.0, fault, CDEM_INPUT,
               "pairs of clusters: the largest distance is %g m, the largest difference of forces "
               "%g; the first must be positive, the second not negative",
               pairing->apart, pairing->alike);
  CDEM_NEW(m.sides, clusters, fault);
  add_up(&m, cluster);
  cdem_sort(m.sides, clusters, sizeof *m.sides, points->partner != NULL ? by_pair : by_place);
  cdem_status status = pair_up(&m, fault);
  if (status == CDEM_OK)
    status = collect(&m, &made, fault);
  free(m.sides);
  free(m.list);
  if (status == CDEM_OK)
    *contacts = made;
  else
    cdem_cluster_contacts_release(&made);
  return status;
}

void cdem_cluster_contacts_release(cdem_cluster_contacts *contacts) {
  free(contacts->contact);
  *contacts = (cdem_cluster_contacts){0};
}
