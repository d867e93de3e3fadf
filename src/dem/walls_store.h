/* Private to dem: walls as they stand now, and who may touch them.
 *
 * A shape = one file wall_NAME.c with one cdem_wall_kind + one line in the table of walls.c. Shapes
 * of one piece give `nearest`; a mesh, made of facets, gives `collect` and `find` of its own.
 *
 * Pose: a point X of the body (from `wall.center` at the start, in the directions of the start) is
 * now at center + turn X. Facets of a mesh stay in the body; grains are taken there.
 *
 * Candidates stand as rows of grains in the internal order, by wall and facet within a row. A slot
 * is the place of a candidate in these arrays and holds the history of its contact. `touch` is 1
 * where that history is in use.
 */
#ifndef CDEM_DEM_WALLS_STORE_H
#define CDEM_DEM_WALLS_STORE_H

#include "base/mat3.h"
#include "dem/store.h"

typedef struct cdem_wall_facets cdem_wall_facets; /* wall_mesh.h */
typedef struct cdem_wall_body cdem_wall_body;
typedef struct cdem_wall_finding cdem_wall_finding;

/* A grain near a wall: its internal index, the wall, the facet (0 for walls of one piece). */
typedef struct {
  int32_t grain, wall, facet;
} cdem_wall_candidate;

typedef struct {
  int64_t count, capacity;
  cdem_wall_candidate *item;
} cdem_wall_list;

typedef struct {
  double distance; /* of the grain's centre; negative: beyond a wall that has one side */
  double n[3];     /* unit, from the grain to the wall */
} cdem_wall_near;

typedef struct {
  const char *name;
  /* Beside what all walls have (walls_check.c). */
  cdem_status (*check)(int dim, const cdem_wall *wall, cdem_fault *fault);
  /* Memory of the shape; NULL: needs none. body->wall was checked and has unit directions. */
  cdem_status (*init)(cdem_wall_body *body, int dim, const cdem_grains *grains, cdem_fault *fault);
  void (*release)(cdem_wall_body *body);
  /* Of one piece: nearest point if it is closer than `within`. */
  bool (*nearest)(const cdem_wall_body *body, const double x[3], double within,
                  cdem_wall_near *near);
  /* Else: appends grains closer than radius + skin/2, facets ascending; and what a grain touches.
   */
  cdem_status (*collect)(const cdem_dem_store *s, int32_t wall, cdem_wall_list *list,
                         cdem_fault *fault);
  int (*find)(const cdem_wall_finding *finding, int room, cdem_wall_touch *touch);
  /* Furthest way its surface, near grains, has gone since the last build. */
  double (*moved)(const cdem_wall_body *body);
  /* How far a centre is on the wrong side; 0: it is not. NULL: both sides are right. */
  double (*beyond)(const cdem_wall_body *body, const double x[3]);
} cdem_wall_kind;

typedef enum {
  CDEM_WALL_STILL,  /* no spin */
  CDEM_WALL_ABOUT,  /* about a fixed direction: the angle is an exact integral */
  CDEM_WALL_TUMBLES /* one exponential a step */
} cdem_wall_turning;

struct cdem_wall_body {
  const cdem_wall_kind *kind;
  cdem_wall wall; /* directions are unit vectors; corner and facet are not kept */
  cdem_wall_facets *facets;
  int dim;
  bool here; /* between start and stop */

  /* pose now, and the velocities of the step that led here */
  double center[3], turn[9];
  double normal[3], axis[3], third[3];
  double velocity[3], spin[3];

  /* motion: path of the center, without the servo's, up to the last change of functions */
  double quaternion[4], path[3];
  double since, path_since[3], quaternion_since[4];
  cdem_wall_turning turning;
  double about[3];
  bool servo;
  double servo_path, servo_speed;
  double radius_speed; /* with servo_radius, m/s */

  /* at the last build */
  double built_center[3], built_turn[9], built_radius;
  double reach; /* furthest grain from built_center, with the skin */
};

typedef struct {
  int64_t count, capacity;
  int32_t *wall, *facet; /* [count] */
  int32_t *id;           /* [count] of the grain */
  uint8_t *touch;        /* [count] */
  double *last;    /* [count][3] point of the last touch, in the body; meshes only, else NULL */
  double *history; /* [count][histories] */
} cdem_wall_slots;

struct cdem_walls {
  int walls;
  cdem_wall_body *body; /* [walls] */
  bool meshes;          /* any */
  double time;
  int32_t *row; /* [grains + 1] */
  cdem_wall_slots slots, old;
  cdem_wall_list list;
  int32_t *fill; /* [grains + 1] scratch */
};

/* What a shape made of facets is asked: the slots of one wall in the row of one grain. */
struct cdem_wall_finding {
  cdem_dem_store *store;
  int32_t wall, from, to;
  double x[3], radius;
};

extern const cdem_wall_kind cdem_wall_plane_kind, cdem_wall_plate_kind, cdem_wall_cylinder_kind,
    cdem_wall_mesh_kind;
const cdem_wall_kind *cdem_wall_kind_of(cdem_wall_shape shape);

/* walls_check.c: a direction of length 1; false when it has none. */
bool cdem_wall_unit(double v[3]);
/* "wall 'floor'" for messages. */
const char *cdem_wall_name(const cdem_wall *wall);

/* walls_build.c */
cdem_status cdem_wall_list_add(cdem_wall_list *list, int32_t grain, int32_t wall, int32_t facet,
                               cdem_fault *fault);
/* Makes rows and slots (all unused) from a list, in which the candidates of each grain stand by
 * wall and facet. The slots of before are in `old` then. */
cdem_status cdem_walls_arrange(cdem_dem_store *s, const cdem_wall_list *list, cdem_fault *fault);
/* For the lists there are; 0 for a wall that does not turn. */
void cdem_wall_set_reach(const cdem_dem_store *s, cdem_wall_body *body);

/* walls_motion.c */
void cdem_wall_motion_init(cdem_wall_body *body);
void cdem_wall_place(cdem_wall_body *body, double time); /* turn, directions, here */
void cdem_wall_keep_built(cdem_wall_body *body);

/* Material velocity of the wall where it is touched. */
static inline void cdem_wall_fill(const cdem_wall_body *body, const double x[3], double radius,
                                  double distance, cdem_wall_touch *touch) {
  double arm[3];
  for (int c = 0; c < 3; c++) {
    touch->point[c] = x[c] + distance * touch->n[c];
    arm[c] = touch->point[c] - body->center[c];
    touch->spin[c] = body->spin[c];
  }
  cdem_cross3(body->spin, arm, touch->velocity);
  for (int c = 0; c < 3; c++)
    touch->velocity[c] += body->velocity[c];
  for (int c = 0; body->wall.servo_radius && c < 3; c++)
    touch->velocity[c] += body->radius_speed * touch->n[c];
  touch->overlap = radius - distance;
  touch->material = body->wall.material;
}

/* m v and m^T v. */
static inline void cdem_wall_turned(const double m[9], const double v[3], double out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
}
static inline void cdem_wall_turned_back(const double m[9], const double v[3], double out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = m[i] * v[0] + m[3 + i] * v[1] + m[6 + i] * v[2];
}

#endif
