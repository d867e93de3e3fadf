/* Private to interfaces: what is kept for each point and face, and the frame of a mid-face. */
#ifndef CDEM_CDEM_INTERFACES_STORE_H
#define CDEM_CDEM_INTERFACES_STORE_H

#include "cdem/interfaces.h"

#include <math.h>
#include <string.h>

/* What a point is at present. */
typedef enum {
  CDEM_POINT_NONE,   /* both sides are one node (the tip of a joint) */
  CDEM_POINT_VIRGIN, /* elastic, no history */
  CDEM_POINT_ACTIVE, /* follows the law with its history */
  CDEM_POINT_TIED,   /* its nodes move as one */
  CDEM_POINT_GONE    /* released */
} cdem_point_phase;

enum { CDEM_INTERFACE_CHUNK = 128 }; /* faces whose sums are one part, whatever the threads */

/* Sums over a chunk of faces, J; faces released in this call. */
typedef struct {
  double stored, fracture, friction, constant;
  int64_t released;
} cdem_interface_part;

struct cdem_interfaces_store {
  int dimension, threads;
  double release;
  int64_t points;
  int64_t *first;              /* [pairs + 1] points of each pair */
  double *area;                /* [points] m^2, at the start */
  double *size;                /* [pairs] m */
  uint8_t *phase;              /* [points] cdem_point_phase */
  cdem_interface_point *point; /* [points] */
  double *force;               /* [points][2][dimension] on the nodes of both sides */
  int64_t chunks;
  cdem_interface_part *part; /* [chunks] */
  double stored, fracture, friction, constant;
  /* Gather: nodes that have points, and where in `force` (2 point + side) theirs are. */
  int32_t nodes;
  int32_t *node;         /* [nodes] */
  int64_t *gather_start; /* [nodes + 1] */
  int64_t *gather;       /* [2 points] */
  /* Ties: the copies of one original node are one range of node ids. */
  int64_t tied_faces;
  bool *tied;         /* [pairs] */
  bool *opens;        /* [pairs] room of insert */
  int32_t *root;      /* [mesh nodes] smallest node it moves with */
  int64_t *tie_start; /* [originals + 1] corners of faces that began tied, at each original node */
  int64_t *tie;       /* 4 pair + corner */
  double *room;       /* [2][mesh nodes] of the frequency bound */
};

/* Axes of a mid-face (rows n, s, t), its size, and what its spin takes. */
typedef struct {
  double axis[3][3];
  double size; /* m^2; 2-D: m */
  double edge; /* length of the first edge along s, m */
  double lean; /* of the first edge along n (warped faces), m */
} cdem_interface_frame;

/* Mid-face corners [corners][3] at displacements u, then its frame. false: it has no area. */
static inline void cdem_interface_middle_of(const cdem_interfaces *interfaces, int32_t p,
                                            int dimension, int corners, const double *u,
                                            double middle[4][3]) {
  const cdem_face_pair *pair = &interfaces->blocks->pair[p];
  const double *xyz = interfaces->blocks->mesh.xyz;
  int dofs = interfaces->dofs;
  for (int k = 0; k < corners; k++) {
    const double *x = xyz + 3 * (int64_t)pair->node[0][k];
    const double *a = u + (int64_t)pair->node[0][k] * dofs;
    const double *b = u + (int64_t)pair->node[1][k] * dofs;
    for (int i = 0; i < dimension; i++)
      middle[k][i] = x[i] + (a[i] + b[i]) / 2;
    if (dimension == 2)
      middle[k][2] = 0;
  }
}

static inline bool cdem_interface_frame_of(int dimension, int corners, const double middle[4][3],
                                           cdem_interface_frame *frame) {
  double(*axis)[3] = frame->axis, d[3][3];
  for (int i = 0; i < 3; i++) {
    d[0][i] = middle[1][i] - middle[0][i];
    d[1][i] = corners == 4 ? middle[2][i] - middle[0][i] : d[0][i];
    d[2][i] = dimension == 2 ? 0
              : corners == 4 ? middle[3][i] - middle[1][i]
                             : middle[2][i] - middle[0][i];
  }
  memset(axis, 0, 9 * sizeof(double));
  if (dimension == 2) {
    frame->size = frame->edge = sqrt(d[0][0] * d[0][0] + d[0][1] * d[0][1]);
    frame->lean = 0;
    if (!(frame->size > 0))
      return false;
    axis[1][0] = d[0][0] / frame->size;
    axis[1][1] = d[0][1] / frame->size;
    axis[0][0] = axis[1][1];
    axis[0][1] = -axis[1][0];
    axis[2][2] = 1;
    return true;
  }
  double area[3];
  cdem_cross3(d[1], d[2], area);
  double twice = cdem_norm3(area);
  frame->size = twice / 2;
  if (!(twice > 0))
    return false;
  for (int i = 0; i < 3; i++)
    axis[0][i] = area[i] * (1 / twice);
  frame->lean = cdem_dot3(axis[0], d[0]);
  for (int i = 0; i < 3; i++)
    axis[1][i] = d[0][i] - frame->lean * axis[0][i];
  frame->edge = cdem_norm3(axis[1]);
  if (!(frame->edge > 0))
    return false;
  for (int i = 0; i < 3; i++)
    axis[1][i] *= 1 / frame->edge;
  cdem_cross3(axis[0], axis[1], axis[2]);
  return true;
}

static inline void cdem_interface_middle(const cdem_interfaces *interfaces, int32_t pair,
                                         const double *u, double middle[4][3]) {
  cdem_interface_middle_of(interfaces, pair, interfaces->store->dimension,
                           interfaces->blocks->pair[pair].corners, u, middle);
}

/* u_1 - u_0 of a corner, global, z = 0 in 2-D. */
static inline void cdem_interface_jump(const cdem_interfaces *interfaces,
                                       const cdem_face_pair *pair, int corner, const double *u,
                                       double jump[3]) {
  const double *a = u + (int64_t)pair->node[0][corner] * interfaces->dofs;
  const double *b = u + (int64_t)pair->node[1][corner] * interfaces->dofs;
  jump[0] = b[0] - a[0];
  jump[1] = b[1] - a[1];
  jump[2] = interfaces->store->dimension == 3 ? b[2] - a[2] : 0;
}

static inline void cdem_interface_local(const cdem_interface_frame *frame, const double global[3],
                                        double local[3]) {
  for (int i = 0; i < 3; i++)
    local[i] = cdem_dot3(frame->axis[i], global);
}

/* Both sides of a corner are one node: there is nothing to break. */
static inline bool cdem_interface_is_welded(const cdem_face_pair *pair, int corner) {
  return pair->node[0][corner] == pair->node[1][corner];
}

/* Labels and clusters anew from `tied`. */
void cdem_interfaces_tie_all(cdem_interfaces *interfaces);

/* No strength from the start. */
static inline bool cdem_interface_is_loose(const cdem_interface_law *law) {
  return law->tension == 0 && law->cohesion == 0;
}

#endif
