/* The touches of one grain's nodes and their forces. Whatever a node touches is looked for among
 * the grains and walls that the ball about its own grain reaches. */
#include "base/memory.h"
#include "base/simd.h"
#include "fdem/contact_store.h"

#include <string.h>

typedef struct {
  const cdem_contact_view *view;
  int64_t grain;
  const cdem_contact_work *work;
  int64_t near;
  int walls;
  cdem_touch_row *row;
} finder;

/* ---- who may be touched ---- */

static int64_t near_grains(const cdem_fdem_contacts *contacts, const cdem_contact_view *view,
                           int64_t grain, cdem_near_grain *near) {
  const cdem_contact_neighbours *list = &contacts->list;
  const double *center = view->center + 3 * grain;
  int64_t count = 0;
  for (int64_t k = list->row[grain]; k < list->row[grain + 1]; k++) {
    int32_t o = list->other[k];
    double d[3], sum = contacts->reach[grain] + contacts->reach[o];
    for (int c = 0; c < 3; c++) {
      near[count].center[c] = view->center[3 * (int64_t)o + c];
      d[c] = near[count].center[c] - center[c];
    }
    near[count].square = contacts->reach[o] * contacts->reach[o];
    near[count].grain = o;
    count += cdem_dot3(d, d) < sum * sum;
  }
  return count;
}

static int walls_in_reach(const cdem_contact_view *view, const double *center, double reach,
                          int32_t *wall) {
  int count = 0;
  for (int32_t w = 0; w < view->walls; w++)
    if (cdem_wall_in_reach(view->wall + w, center, reach))
      wall[count++] = w;
  return count;
}

/* Most nodes are in no ball of a neighbour. This only sifts, with a little room for another
 * rounding: what it lets pass is decided by touch_of_grains, so results do not depend on the
 * processor. */
CDEM_MULTIVERSION static void mark_nodes(const double *restrict x, const double *restrict y,
                                         const double *restrict z, int32_t nodes,
                                         const cdem_near_grain *near, uint8_t *restrict mark) {
  const double a = near->center[0], b = near->center[1], c = near->center[2];
  const double square = near->square * (1.0 + 0x1p-40);
  for (int32_t n = 0; n < nodes; n++) {
    double p = x[n] - a, q = y[n] - b, r = z[n] - c;
    mark[n] |= p * p + q * q + r * r < square;
  }
}

static void mark_all(const finder *f, const double *now, int32_t nodes) {
  const cdem_contact_work *work = f->work;
  double *x = work->x, *y = x + work->nodes, *z = y + work->nodes;
  memset(work->mark, 0, (size_t)nodes);
  for (int32_t n = 0; n < nodes; n++) {
    x[n] = now[3 * n];
    y[n] = now[3 * n + 1];
    z[n] = now[3 * n + 2];
  }
  for (int64_t k = 0; k < f->near; k++)
    mark_nodes(x, y, z, nodes, work->near + k, work->mark);
}

/* ---- one node ---- */

static bool touch_of_grains(const finder *f, const double x[3], cdem_node_touch *t) {
  const cdem_contact_view *view = f->view;
  t->depth = 0.0;
  for (int64_t k = 0; k < f->near; k++) {
    const cdem_near_grain *near = f->work->near + k;
    cdem_skin_touch touch;
    double d[3], y[3];
    for (int c = 0; c < 3; c++)
      d[c] = x[c] - near->center[c];
    if (cdem_dot3(d, d) >= near->square)
      continue;
    int64_t o = near->grain;
    cdem_wall_turned_back(view->turn + 9 * o, d, y);
    if (!cdem_skin_touches(view->surface[o], view->place + 3 * view->first[o], view->scale[o], y,
                           &touch) ||
        touch.depth <= t->depth)
      continue;
    t->depth = touch.depth;
    t->partner = near->grain;
    cdem_wall_turned(view->turn + 9 * o, touch.normal, t->normal);
    for (int c = 0; c < 3; c++) {
      t->corner[c] = touch.node[c];
      t->weight[c] = touch.weight[c];
    }
  }
  return t->depth > 0.0;
}

static bool touch_of_walls(const finder *f, const double x[3], cdem_node_touch *t) {
  const cdem_contact_view *view = f->view;
  t->depth = 0.0;
  for (int k = 0; k < f->walls; k++) {
    int32_t w = f->work->wall[k];
    double depth, normal[3];
    if (!cdem_wall_passed(view->wall + w, view->center + 3 * f->grain, x, &depth, normal) ||
        depth <= t->depth)
      continue;
    t->depth = depth;
    t->partner = -1 - w;
    for (int c = 0; c < 3; c++)
      t->normal[c] = normal[c];
  }
  return t->depth > 0.0;
}

/* What the node is and how it went in the step. */
static cdem_touch_motion motion_of(const finder *f, int64_t n, int32_t material) {
  const cdem_contact_view *view = f->view;
  cdem_touch_motion motion = {.law = view->law +
                                     (int64_t)view->material[f->grain] * view->materials + material,
                              .area = view->area[n],
                              .mass = view->mass[n],
                              .step = view->step};
  for (int c = 0; c < 3 && view->step > 0.0; c++)
    motion.move[c] = view->now[3 * n + c] - view->before[3 * n + c];
  return motion;
}

/* Takes off the way of the partner's material, by the triangle of the middle of the step: so a pair
 * that turns as one body does not slip, but for the third power of the angle. */
static void take_off_way(const finder *f, int64_t n, const cdem_node_touch *t,
                         cdem_touch_motion *motion) {
  const cdem_contact_view *view = f->view;
  double middle[3][3], way[3][3], carried[3], x[3];
  const double *corner[3] = {middle[0], middle[1], middle[2]};
  cdem_touched_triangle triangle;
  for (int k = 0; k < 3; k++) {
    int64_t at = 3 * (view->first[t->partner] + t->corner[k]);
    for (int c = 0; c < 3; c++) {
      middle[k][c] = 0.5 * (view->now[at + c] + view->before[at + c]);
      way[k][c] = view->now[at + c] - view->before[at + c];
    }
  }
  for (int c = 0; c < 3; c++)
    x[c] = 0.5 * (view->now[3 * n + c] + view->before[3 * n + c]);
  cdem_touched_triangle_set(&triangle, corner, t->weight, x);
  cdem_touched_triangle_carry(&triangle, t->weight, way, carried);
  for (int c = 0; c < 3; c++)
    motion->move[c] -= carried[c];
}

static void against_grain(finder *f, int64_t n, cdem_node_touch *t, const cdem_node_touch *old) {
  const cdem_contact_view *view = f->view;
  const double *corner[3];
  cdem_touched_triangle triangle;
  cdem_touch_motion motion = motion_of(f, n, view->material[t->partner]);
  if (view->step > 0.0)
    take_off_way(f, n, t, &motion);
  motion.turn = view->turn + 9 * (int64_t)t->partner;
  cdem_touch_evaluate(t, old, &motion, &f->row->book);
  for (int k = 0; k < 3; k++)
    corner[k] = view->now + 3 * (view->first[t->partner] + t->corner[k]);
  cdem_touched_triangle_set(&triangle, corner, t->weight, view->now + 3 * n);
  cdem_touched_triangle_take(&triangle, t->weight, t->force, t->reaction);
}

static void wall_way(const finder *f, int64_t n, int32_t partner, double way[3]) {
  const cdem_contact_view *view = f->view;
  cdem_wall_way(view->wall + (-1 - partner), view->now + 3 * n, view->before + 3 * n, view->step,
                way);
}

static void against_wall(finder *f, int64_t n, cdem_node_touch *t, const cdem_node_touch *old) {
  const cdem_contact_view *view = f->view;
  const cdem_wall_body *body = view->wall + (-1 - t->partner);
  cdem_touch_motion motion = motion_of(f, n, body->wall.material);
  double way[3];
  wall_way(f, n, t->partner, way);
  for (int c = 0; c < 3; c++)
    motion.move[c] -= way[c];
  motion.turn = body->turn;
  memset(t->corner, 0, sizeof t->corner);
  memset(t->weight, 0, sizeof t->weight);
  memset(t->reaction, 0, sizeof t->reaction);
  cdem_touch_evaluate(t, old, &motion, &f->row->book);
  f->row->book.walls += 0.5 * cdem_dot3(t->force, way);
  if (old != NULL) {
    wall_way(f, n, old->partner, way);
    f->row->book.walls += 0.5 * cdem_dot3(old->force, way);
  }
}

/* ---- the row ---- */

static void settle(finder *f, int64_t n, const cdem_node_touch *old) {
  const cdem_contact_view *view = f->view;
  const cdem_wall_body *body = old->partner < 0 ? view->wall + (-1 - old->partner) : NULL;
  double way[3];
  if (body != NULL)
    wall_way(f, n, old->partner, way);
  cdem_touch_settle(old, body != NULL ? way : NULL, body != NULL && !body->here, view->step,
                    &f->row->book);
}

/* The radius a node may sink into by half. */
static double radius_of(const finder *f, const cdem_node_touch *t) {
  double own = f->view->scale[f->grain];
  return t->partner < 0 ? own : fmin(own, f->view->scale[t->partner]);
}

/* Keeps the touch that stands behind the last item. */
static void keep(finder *f, int64_t n, int32_t node, const cdem_node_touch *old) {
  cdem_touch_row *row = f->row;
  cdem_node_touch *t = row->item + row->count;
  t->node = node;
  if (t->partner >= 0)
    against_grain(f, n, t, old);
  else
    against_wall(f, n, t, old);
  row->walls += t->partner < 0;
  if (row->sunk < 0 && !(t->depth <= 0.5 * radius_of(f, t)))
    row->sunk = row->count;
  row->count++;
}

static cdem_status visit(finder *f, int32_t node, int32_t *seen) {
  cdem_touch_row *row = f->row;
  const int64_t n = f->view->first[f->grain] + node;
  const double *x = f->view->now + 3 * n;
  for (int walls = 0; walls < 2; walls++) {
    const cdem_node_touch *old = NULL;
    if (*seen < row->olds && row->old[*seen].node == node &&
        (row->old[*seen].partner < 0) == (walls == 1))
      old = row->old + (*seen)++;
    if (row->count == row->capacity)
      CDEM_TRY(cdem_grow(&row->item, &row->capacity, row->count + 8, sizeof *row->item, NULL));
    cdem_node_touch *t = row->item + row->count;
    if (walls ? touch_of_walls(f, x, t) : f->work->mark[node] && touch_of_grains(f, x, t))
      keep(f, n, node, old);
    else if (old != NULL)
      settle(f, n, old);
  }
  return CDEM_OK;
}

static void begin(cdem_touch_row *row) {
  cdem_node_touch *item = row->item;
  int64_t capacity = row->capacity;
  row->item = row->old;
  row->capacity = row->old_capacity;
  row->old = item;
  row->old_capacity = capacity;
  row->olds = row->count;
  row->count = row->walls = 0;
  row->sunk = -1;
  row->status = CDEM_OK;
  row->book = (cdem_contact_book){0};
}

void cdem_contact_find(cdem_fdem_contacts *contacts, const cdem_contact_view *view, int64_t grain,
                       cdem_contact_work *work) {
  cdem_touch_row *row = contacts->row + grain;
  const double *center = view->center + 3 * grain;
  int32_t seen = 0, nodes = (int32_t)(view->first[grain + 1] - view->first[grain]);
  finder f = {view,
              grain,
              work,
              near_grains(contacts, view, grain, work->near),
              walls_in_reach(view, center, contacts->reach[grain], work->wall),
              row};
  begin(row);
  if (f.near + f.walls + row->olds == 0)
    return;
  mark_all(&f, view->now + 3 * view->first[grain], nodes);
  for (int32_t node = 0; node < nodes && row->status == CDEM_OK; node++)
    if (work->mark[node] || f.walls > 0 || (seen < row->olds && row->old[seen].node == node))
      row->status = visit(&f, node, &seen);
}
