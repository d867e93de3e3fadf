/* Contact from inside: what the files contact*.c share.
 *
 * Points are the corners of active facets, ordered by (facet, corner). Candidates are listed by
 * surface node (all points of a node share them). A slot is a place for one contact: (point,
 * component of the opposing surface), or a pair of sharp edges; slots live from one rebuild to the
 * next and carry the history.
 */
#ifndef CDEM_CDEM_CONTACT_STORE_H
#define CDEM_CDEM_CONTACT_STORE_H

#include "cdem/contact.h"

#include <stddef.h>

enum { CDEM_ACTIVE = 1, CDEM_FRESH = 2 }; /* fresh: not yet seen by an evaluation */

/* One contact and its history. Node-face: the master's nodes come first, then the slave (all nodes
 * of its facet when the point is inset). Edge-edge: 0, 1 of edge 1 (master), 2, 3 of edge 2. */
typedef struct {
  int32_t facet;                  /* master facet (edges: lower facet of edge 1), -1: no contact */
  double friction, damping;       /* J, dissipated in the last step */
  uint8_t nodes, sliding, handed; /* handed: starts its history with this evaluation */
  int32_t node[8];
  double shape[4];    /* shape functions of the master facet at the projection; edges: t1, t2 */
  double stick[3];    /* elastic sliding in the axes of `facet`, m */
  double own[4];      /* of the slave point in its own facet */
  double weight, gap; /* m^2, m (overlap positive) */
  double kn, kt;      /* Pa/m */
  double dashpot;     /* N, of F_n */
  double stored;      /* J, what the nodes have put in and not got back */
  double force[3], normal[3], position[3];
  double nodal[8][3]; /* N */
} cdem_touch;

typedef struct {
  int32_t facet, node, surface; /* surface: position among the surface nodes */
  uint8_t corner;
} cdem_contact_point;

/* A sharp convex edge of the surface: side k of facet runs from corner k to corner k + 1. */
typedef struct {
  int32_t facet[2]; /* facet[0] < facet[1] */
  uint8_t side[2];
  int32_t node[2]; /* of facet[0] */
  double size, depth;
} cdem_contact_edge;

typedef struct {
  int32_t edge[2]; /* edge[0] < edge[1]: 1 and 2 of contact_edge.c */
} cdem_edge_pair;

/* A facet now: mean normal, centre, how far a corner is off the mean plane and off the centre. */
typedef struct {
  double normal[3], centre[3], warp, radius;
} cdem_contact_face;

/* A touch that waits for its slot in a new list. */
typedef struct {
  int64_t key; /* 4 facet + corner of the slave; of an edge -1 - (its index in `carried_edge`) */
  cdem_touch touch;
} cdem_carried;

/* Of a cell of a broad phase. */
static inline uint64_t cdem_contact_hash(const int64_t c[3]) {
  uint64_t h = (uint64_t)c[0] * 0x9e3779b97f4a7c15u ^ (uint64_t)c[1] * 0xc2b2ae3d27d4eb4fu ^
               (uint64_t)c[2] * 0x165667b19e3779f9u;
  h ^= h >> 32;
  h *= 0xd6e8feb86659fd93u;
  return h ^ h >> 32;
}

struct cdem_contact_store {
  int dim, dofs, threads, colours;
  double thickness, skin;
  cdem_contact_law *law; /* [1 + laws]: the default first */
  int16_t *law_of;       /* [colours][colours], + 1; NULL: default everywhere */
  int16_t *colour;       /* [cells] or NULL */
  const double *mass;

  /* of the reference configuration, by facet */
  double (*share)[4], *size, *depth;
  double *patch;     /* largest distance from a corner to the rest of its patch */
  double *node_area; /* [nodes] */

  uint8_t *active; /* [facets] */
  bool topology_stale, list_stale;
  int32_t handed;
  int32_t *handed_pair;         /* [pairs] waiting for the next evaluation */
  double (*handed_force)[4][3]; /* [pairs] */
  uint8_t *handed_mark;         /* [pairs] 1: waiting */

  /* topology of the active surface */
  int32_t *cluster;   /* [nodes] lowest node of those bonded together */
  int32_t *component; /* [facets] */
  uint8_t *border;    /* [facets] bit k: side k is a sharp convex edge */
  int32_t facets, points, surface_nodes, edges;
  int32_t *facet;       /* [facets] active ones, ascending */
  int32_t *point_start; /* [blocks->facets] first point, -1 */
  cdem_contact_point *point;
  int32_t *surface_node; /* [surface_nodes] ascending */
  cdem_contact_edge *edge;

  /* positions */
  double *x;       /* [nodes][3], of surface nodes only */
  double *built;   /* [surface_nodes][3] positions at the rebuild */
  double *reach;   /* [nodes] largest patch around a surface node */
  double sweep;    /* largest motion of a step at the rebuild, m */
  const double *v; /* of the present evaluation, may be NULL */
  double dt;
  cdem_contact_face *face; /* [blocks->facets] */
  int32_t marked;
  int32_t *marked_facet; /* those in any candidate pair */
  uint8_t *mark;         /* [facets] */

  /* candidates and slots */
  int64_t *candidate_start; /* [surface_nodes + 1] */
  int32_t *candidate;       /* facets, ascending for each node */
  int32_t live;             /* points with candidates */
  int32_t *live_point;
  uint8_t *busy;           /* [live] CDEM_BUSY: has or had a contact in this evaluation */
  int64_t *slot_start;     /* [points + 1] */
  int32_t *slot_component; /* [slots] */
  int32_t *trial, *deep;   /* [slots] facet of this step, -1 */
  double *score;           /* [slots] */
  int32_t *slot_touch;     /* [slots] in `pool`, -1: never had a contact */
  int64_t edge_pairs;
  cdem_edge_pair *edge_pair;
  int32_t *edge_touch; /* [edge_pairs] in `pool`, -1 */
  uint8_t *edge_busy;  /* as busy */
  int64_t pooled, pool_capacity;
  cdem_touch *pool; /* in any order: read by slots only */
  int64_t carried, carried_capacity;
  cdem_carried *carry;
  int64_t edge_carried, edge_carried_capacity;
  int64_t (*edge_key)[2]; /* of carried edge contacts: 4 facet + side of each */
  cdem_touch *edge_carry;
  int64_t edge_touch_capacity;

  double *row; /* [nodes] scratch of the frequency */
  double friction, damping;
  int64_t contacts, rebuilds, visits;
};

enum { CDEM_BUSY = 1, CDEM_DEFERRED = 2 }; /* deferred: the pool was full, to be done again */

/* The contact of a slot, or NULL. */
static inline cdem_touch *cdem_touch_of(const cdem_contact_store *s, int32_t at) {
  return at >= 0 && s->pool[at].facet >= 0 ? &s->pool[at] : NULL;
}

/* contact_pool.c */
/* Room for one more contact, without one; by any thread. -1: the pool is full. */
int32_t cdem_contact_take(cdem_contact_store *s);
/* Room for `more`. */
cdem_status cdem_contact_make_room(cdem_contact_store *s, int64_t more, cdem_fault *fault);

/* A slave point against the plane of a master facet. */
typedef struct {
  double gap, beyond; /* overlap; distance of the foot outside the facet, in its plane */
  double outside;     /* that of the corner itself */
  double normal[3], foot[3];
  double lambda[3];
  double own[4], inset; /* shape functions of the point in its own facet; 1 - that of its corner */
  double cover;         /* part of its area that is over the master */
  int part;             /* which triangle of a quadrilateral */
} cdem_projection;

/* contact_geometry.c */
void cdem_contact_face_now(const cdem_contact *contact, int32_t facet, cdem_contact_face *face);
void cdem_contact_axes(const cdem_contact *contact, int32_t facet, double axes[9]);
void cdem_contact_project(const cdem_contact *contact, int32_t facet, const double corner[4][3],
                          const double at[3], cdem_projection *projection);
/* A slave point against a facet. Of the area that the point stands for (corner, middles of the
 * sides, middle of the facet) the part over the master counts, cut at the master's sharp sides; the
 * point is the corner, or the place of that part nearest to the corner where the corner itself lies
 * beyond. False when nothing is over the master. */
bool cdem_contact_place(const cdem_contact *contact, const cdem_contact_point *point,
                        int32_t master, const double corner[4][3], cdem_projection *projection);
void cdem_contact_corners(const cdem_contact *contact, int32_t facet, double corner[4][3]);
void cdem_contact_shapes(const cdem_contact *contact, int32_t facet, const double corner[4][3],
                         const cdem_projection *projection, double shape[4], double gradient[4][3]);

/* contact_topology.c */
cdem_status cdem_contact_topology(cdem_contact *contact, cdem_fault *fault);
/* Sorts `count` keys into buckets: order [count], start [buckets + 1], buckets a power of 2. */
void cdem_contact_buckets(int64_t count, const uint64_t *hash, int64_t buckets, int64_t *start,
                          int64_t *order);
int64_t cdem_contact_bucket_count(int64_t count);

/* contact_search.c */
cdem_status cdem_contact_carry(cdem_contact *contact, cdem_fault *fault);
cdem_status cdem_contact_rebuild(cdem_contact *contact, cdem_fault *fault);
/* contact_grid.c */
cdem_status cdem_contact_candidates(cdem_contact *contact, cdem_fault *fault);
/* contact_edges.c */
cdem_status cdem_contact_edge_candidates(cdem_contact *contact, cdem_fault *fault);
int64_t cdem_contact_edges_step(cdem_contact *contact, bool again, int64_t *failed);

/* contact_point.c */
const cdem_contact_law *cdem_contact_law_between(const cdem_contact_store *s,
                                                 const cdem_blocks *blocks, int32_t slave,
                                                 int32_t master);
/* Looks through the candidates of a point: the closest facet of each component, in `trial`. `floor`
 * is the least overlap that counts (0, or minus a skin). */
void cdem_contact_look(cdem_contact *contact, int32_t point, double floor, cdem_projection *best);
enum { CDEM_CONTACT_BEST = 16 }; /* `best` [CDEM_CONTACT_BEST], or NULL: of the first slots */
/* Of live_point[live]: the slot that is too deep inside, or -1. */
int64_t cdem_contact_point_step(cdem_contact *contact, int32_t live);

/* Weight of a point on a facet, with its nodes and (in nodal[0]) their coefficients. */
double cdem_contact_lever(const cdem_contact *contact, const cdem_contact_point *point,
                          int32_t master, cdem_touch *touch);

/* contact_law.c: one contact of either kind */
typedef struct {
  const cdem_contact_law *law;
  double weight, gap, rate; /* m^2, m, m/s */
  double whole;             /* weight, if all of the patch were over the master */
  double normal[3];
  double slip[3]; /* of this step, in the plane, geometric */
  int nodes;
  int32_t node[8];
  double coefficient[8]; /* of the force on each node */
  double gradient[8][3]; /* of the correction of moments */
  double surface_mass;   /* kg/m^2, of the two sides in series */
} cdem_contact_input;
void cdem_touch_update(const cdem_contact *contact, const cdem_contact_input *input, int32_t facet,
                       cdem_touch *touch);
void cdem_touch_end(const cdem_contact *contact, cdem_touch *touch);

#endif
