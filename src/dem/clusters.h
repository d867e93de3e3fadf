/* Contacts of deformable grains out of the forces on their surface nodes.
 *
 * A grain that is meshed touches another one with some nodes; one contact is a cluster of them.
 * Wang et al. (2024, section 3.3) cluster by density: of each grain the nodes whose normal force is
 * not zero; a node joins those within its neighbourhood `reach`; a node that has none is a cluster
 * of its own (noise, with DBSCAN's words; every cluster is what neighbourhoods connect). Then the
 * clusters of two grains are paired to a contact.
 *
 * Who knows which grain a node touches says so by `partner`: nodes of different partners are then
 * never one cluster, and only clusters that name each other are paired. Without, the nearest
 * cluster of another grain with an alike force is the other side, as in the source.
 *
 * Plain arrays, nothing of meshes: points and forces of the caller's, of any numbering. The result
 * depends on neither threads nor units: `reach` and `apart` are the caller's lengths.
 */
#ifndef CDEM_DEM_CLUSTERS_H
#define CDEM_DEM_CLUSTERS_H

#include "dem/pushes.h"

typedef struct {
  int64_t points;
  const double *xyz;      /* [points][3] m */
  const double *force;    /* [points][3] normal force on the node, N; all 0: touches nothing */
  const int32_t *owner;   /* [points] its grain, >= 0 */
  const int32_t *partner; /* [points] the grain it touches, < 0: a boundary; NULL: not known */
} cdem_contact_points;

/* Cluster of each point, numbered in the order of their first points; -1: no force.
 * cluster [points]. reach > 0, m: two points that are no further apart are neighbours. */
cdem_status cdem_clusters_find(const cdem_contact_points *points, double reach, int32_t *cluster,
                               int64_t *clusters, cdem_fault *fault);

typedef struct {
  double apart; /* largest distance of the middles of two clusters that are one contact, m; with
                   partners known INFINITY does */
  double alike; /* partners not known: largest difference of the two forces, of the larger one */
  bool shared;  /* each side's forces are those of the whole contact, whose push is their mean; else
                   each side has springs of its own, and it is their sum */
} cdem_cluster_pairing;

typedef struct {
  int64_t contacts;
  cdem_push *contact; /* [contacts] a < b, or b < 0: boundary; ordered by a, b, then by place */
  int64_t single;     /* of those: with one side only; partners not known: b is -1 */
} cdem_cluster_contacts;

/* Clusters from cdem_clusters_find, paired: nearest first, each once. Middles are weighted by
 * force, normals those of the force of a (both sides, where there are two). */
cdem_status cdem_clusters_match(const cdem_contact_points *points, const int32_t *cluster,
                                int64_t clusters, const cdem_cluster_pairing *pairing,
                                cdem_cluster_contacts *contacts, cdem_fault *fault);
void cdem_cluster_contacts_release(cdem_cluster_contacts *contacts);

#endif
