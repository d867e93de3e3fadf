/* Private to contact*.c: nodes that touch, by grain, and who is near whom.
 *
 * Each grain has a row of the touches of its nodes: by node, grains before walls. A node has at
 * most one touch with a grain, the one it is deepest in (of equal ones that of the lowest id), and
 * one with a wall, again the deepest; so the springs' energy is continuous where another one
 * becomes the deepest. A row is written by one thread alone, sums go over grains in their order,
 * and a touch is found or not whatever list of neighbours it was found by: so neither threads nor
 * the time of the last build of the list can be seen in any result.
 */
#ifndef CDEM_FDEM_CONTACT_STORE_H
#define CDEM_FDEM_CONTACT_STORE_H

#include "base/mat3.h"
#include "fdem/store.h"

typedef struct {
  int32_t node;      /* of its grain */
  int32_t partner;   /* grain; wall: -1 - its index */
  int32_t corner[3]; /* nodes of the partner: the triangle that is touched; walls: 0 */
  double weight[3];
  double normal[3];                                  /* out of the partner, in space */
  double depth, stiffness, shear_stiffness, dashpot; /* m, N/m; c over the step, N/m */
  double push, dash;     /* normal force and the dashpot's part in it, N */
  double spring[3];      /* way of the tangential spring, in the frame of the partner, m */
  double shear[3];       /* tangential force on the partner, in its frame, N */
  double force[3];       /* on the node, in space */
  double reaction[3][3]; /* on the corners */
} cdem_node_touch;

typedef struct {
  int32_t count, olds;
  int64_t capacity, old_capacity;
  cdem_node_touch *item, *old; /* now, at the last evaluation */
  int32_t walls;               /* touches with walls among item */
  int32_t sunk;                /* first item that is too deep, -1: none */
  cdem_status status;
  cdem_contact_book book;
} cdem_touch_row;

/* contact_neighbours.c: pairs nearer than the sum of their reaches and `length`, each in both rows,
 * ascending. Reach: of the furthest node from the centre. */
typedef struct {
  int64_t grains, capacity, entries;
  double length; /* m, of the skin */
  bool made;
  int64_t *row;     /* [grains + 1] */
  int32_t *other;   /* [row[grains]] */
  double *center;   /* [grains][3] at the last build */
  double *reach;    /* [grains] at the last build */
  int32_t (*at)[3]; /* [grains] cell */
  int32_t *next;    /* [grains] in the same hashed cell */
  int32_t *head;    /* [entries] */
  int64_t builds;   /* so far */
} cdem_contact_neighbours;

cdem_status cdem_contact_neighbours_init(cdem_contact_neighbours *list,
                                         const cdem_contact_view *view, double skin,
                                         cdem_fault *fault);
void cdem_contact_neighbours_release(cdem_contact_neighbours *list);
/* Makes the list anew if a pair that is not on it might touch. */
cdem_status cdem_contact_neighbours_update(cdem_contact_neighbours *list, const double *center,
                                           const double *reach, cdem_fault *fault);

typedef struct {
  double center[3], square;
  int32_t grain;
} cdem_near_grain;

/* A thread's own. */
typedef struct {
  cdem_near_grain *near; /* [capacity] grains whose ball meets that of the grain */
  int32_t *wall;         /* [walls] walls it may reach */
  int64_t capacity, nodes;
  double *x;     /* [3][nodes] of the grain: all x, all y, all z */
  uint8_t *mark; /* [nodes] may be in some grain that is near */
} cdem_contact_work;

struct cdem_fdem_contacts {
  int64_t grains;
  int threads, walls;
  double *reach; /* [grains] m, now */
  cdem_touch_row *row;
  cdem_contact_neighbours list;
  cdem_contact_work *work; /* [threads] */
};

/* What the law is asked about one touch. */
typedef struct {
  const cdem_fdem_contact_law *law;
  const double *turn; /* of the partner */
  double area, mass;  /* of the node */
  double step;
  double move[3]; /* of the node against the partner's material there, over the step */
} cdem_touch_motion;

/* contact_law.c. depth, normal and partner are known; sets stiffnesses, forces on the node, springs
 * and adds to the book. old: the touch of before in the same place (grain or wall), NULL: none. */
void cdem_touch_evaluate(cdem_node_touch *touch, const cdem_node_touch *old,
                         const cdem_touch_motion *motion, cdem_contact_book *book);
/* A touch that is over. way: of the wall's material in the step, NULL for grains; gone: the wall is
 * not there any more. */
void cdem_touch_settle(const cdem_node_touch *old, const double way[3], bool gone, double step,
                       cdem_contact_book *book);

/* contact_pair.c: a triangle that is carried along, and takes, with a point below it. */
typedef struct {
  double arm[3];      /* from the nearest point to the node */
  double normal[3];   /* of the triangle */
  double slope[3][3]; /* of the weights */
  double from_middle[3][3], spread;
} cdem_touched_triangle;
void cdem_touched_triangle_set(cdem_touched_triangle *triangle, const double *corner[3],
                               const double weight[3], const double x[3]);
/* Way of the material at the node, from those of the corners. */
void cdem_touched_triangle_carry(const cdem_touched_triangle *triangle, const double weight[3],
                                 double way[3][3], double carried[3]);
/* Forces on the corners with the resultant -force and its moment about the node. */
void cdem_touched_triangle_take(const cdem_touched_triangle *triangle, const double weight[3],
                                const double force[3], double reaction[3][3]);

/* contact_walls.c: how far x, a node of the grain about `center`, is beyond a wall; normal: of the
 * push. */
bool cdem_wall_passed(const cdem_wall_body *body, const double center[3], const double x[3],
                      double *depth, double normal[3]);
/* May a node within `reach` of the centre be beyond it? */
bool cdem_wall_in_reach(const cdem_wall_body *body, const double center[3], double reach);
/* Way in the step of its material where a node is now and was before. */
void cdem_wall_way(const cdem_wall_body *body, const double x[3], const double before[3],
                   double step, double way[3]);

/* contact_find.c: fills the row of a grain. */
void cdem_contact_find(cdem_fdem_contacts *contacts, const cdem_contact_view *view, int64_t grain,
                       cdem_contact_work *work);

/* contact.c: reaches and list of neighbours for the places there are. */
cdem_status cdem_contacts_reach(cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                                cdem_fault *fault);

#endif
