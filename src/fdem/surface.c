/* The skin of a mesh: faces that belong to one cell, cut into triangles. */
#include "fdem/surface.h"

#include "base/mat3.h"
#include "base/memory.h"
#include "fdem/surface_near.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* ---- faces of one cell ---- */

typedef struct {
  int32_t corner[4]; /* ascending; -1 first where there are three */
  int32_t cell;
  int8_t face;
} face_key;

static int compare_faces(const void *a, const void *b) {
  const face_key *p = a, *q = b;
  for (int k = 0; k < 4; k++)
    if (p->corner[k] != q->corner[k])
      return p->corner[k] < q->corner[k] ? -1 : 1;
  return 0;
}

static const cdem_shape_info *shape_of(const cdem_mesh *mesh, int32_t cell) {
  return cdem_shape_get((cdem_shape)mesh->cell_shape[cell]);
}

static face_key key_of(const cdem_mesh *mesh, int32_t cell, int face) {
  const cdem_shape_info *info = shape_of(mesh, cell);
  face_key key = {{-1, -1, -1, -1}, cell, (int8_t)face};
  for (int k = 0; k < info->face_corners[face]; k++) {
    int at = 0; /* those that are smaller move one place down */
    key.corner[0] = cdem_mesh_cell(mesh, cell)[info->face[face][k]];
    for (; at < 3 && key.corner[at + 1] < key.corner[at]; at++) {
      int32_t swap = key.corner[at];
      key.corner[at] = key.corner[at + 1];
      key.corner[at + 1] = swap;
    }
  }
  return key;
}

/* skin [cells * CDEM_SHAPE_MAX_FACES]: is the face on the surface? */
static cdem_status mark_skin(const cdem_mesh *mesh, uint8_t *skin, cdem_fault *fault) {
  int64_t count = 0, faces = 0;
  for (int32_t i = 0; i < mesh->cells; i++)
    count += shape_of(mesh, i)->dimension == 3 ? shape_of(mesh, i)->faces : 0;
  CDEM_REQUIRE(count > 0, fault, CDEM_INPUT,
               "the mesh of a grain has no volume cells (tetrahedra, hexahedra, ...); a surface "
               "alone has no stiffness");
  face_key *key;
  CDEM_NEW(key, count, fault);
  for (int32_t i = 0; i < mesh->cells; i++)
    for (int f = 0; shape_of(mesh, i)->dimension == 3 && f < shape_of(mesh, i)->faces; f++)
      key[faces++] = key_of(mesh, i, f);
  qsort(key, (size_t)count, sizeof *key, compare_faces);
  for (int64_t k = 0; k < count; k++) {
    bool before = k > 0 && compare_faces(key + k - 1, key + k) == 0;
    bool after = k + 1 < count && compare_faces(key + k + 1, key + k) == 0;
    skin[(int64_t)CDEM_SHAPE_MAX_FACES * key[k].cell + key[k].face] = !before && !after;
  }
  free(key);
  return CDEM_OK;
}

/* ---- triangles ---- */

typedef struct {
  const cdem_mesh *mesh;
  cdem_skin *surface;
  int64_t capacity;
  int32_t nodes;
} cutter;

static cdem_status add(cutter *c, int32_t a, int32_t b, int32_t d, cdem_fault *fault) {
  cdem_skin *s = c->surface;
  const int32_t node[3] = {a, b, d};
  CDEM_TRY(cdem_grow(&s->triangle, &c->capacity, s->triangles + 1, 3 * sizeof *s->triangle, fault));
  for (int k = 0; k < 3; k++) {
    CDEM_REQUIRE(node[k] < c->nodes, fault, CDEM_INPUT,
                 "node %" PRId64 " of the mesh of a grain is on its surface but not among the "
                 "first %" PRId32 "; surface nodes come first",
                 c->mesh->node_tag[node[k]], c->nodes);
    s->triangle[3 * s->triangles + k] = node[k];
  }
  s->triangles++;
  return CDEM_OK;
}

static double square_between(const cdem_mesh *mesh, int32_t a, int32_t b) {
  double sum = 0.0;
  for (int c = 0; c < 3; c++) {
    double d = mesh->xyz[3 * (int64_t)a + c] - mesh->xyz[3 * (int64_t)b + c];
    sum += d * d;
  }
  return sum;
}

static cdem_status add_quad(cutter *c, const int32_t q[4], cdem_fault *fault) {
  int from = square_between(c->mesh, q[0], q[2]) <= square_between(c->mesh, q[1], q[3]) ? 0 : 1;
  CDEM_TRY(add(c, q[from], q[from + 1], q[from + 2], fault));
  return add(c, q[from], q[from + 2], q[(from + 3) % 4], fault);
}

/* Mid nodes follow the corners, the k-th between corners k and k + 1. */
static cdem_status cut_face(cutter *c, int32_t cell, int face, cdem_fault *fault) {
  const cdem_shape_info *info = shape_of(c->mesh, cell);
  const int32_t *node = cdem_mesh_cell(c->mesh, cell);
  const int8_t *local = info->face[face];
  int corners = info->face_corners[face];
  int32_t n[8], middle[4];
  bool quadratic = info->nodes > info->corners;
  for (int k = 0; k < (quadratic ? 2 : 1) * corners; k++)
    n[k] = node[local[k]];
  if (!quadratic)
    return corners == 3 ? add(c, n[0], n[1], n[2], fault) : add_quad(c, n, fault);
  for (int k = 0; k < corners; k++) {
    middle[k] = n[corners + k];
    CDEM_TRY(add(c, n[k], n[corners + k], n[corners + (k + corners - 1) % corners], fault));
  }
  return corners == 3 ? add(c, middle[0], middle[1], middle[2], fault) : add_quad(c, middle, fault);
}

static cdem_status cut_skin(cutter *c, const uint8_t *skin, cdem_fault *fault) {
  for (int32_t i = 0; i < c->mesh->cells; i++)
    for (int f = 0; f < CDEM_SHAPE_MAX_FACES; f++)
      if (skin[(int64_t)CDEM_SHAPE_MAX_FACES * i + f])
        CDEM_TRY(cut_face(c, i, f, fault));
  return CDEM_OK;
}

/* ---- what is next to what ---- */

static cdem_status set_around(cdem_skin *s, cdem_fault *fault) {
  CDEM_NEW(s->around_from, (int64_t)s->nodes + 1, fault);
  CDEM_NEW(s->around, 3 * (int64_t)s->triangles, fault);
  for (int64_t k = 0; k < 3 * (int64_t)s->triangles; k++)
    s->around_from[s->triangle[k] + 1]++;
  for (int32_t n = 0; n < s->nodes; n++)
    s->around_from[n + 1] += s->around_from[n];
  for (int64_t k = 3 * (int64_t)s->triangles - 1; k >= 0; k--) /* from behind: ascending */
    s->around[--s->around_from[s->triangle[k] + 1]] = (int32_t)(k / 3);
  /* around_from[n + 1] is now where n begins; nobody needs the ends apart from the total */
  for (int32_t n = 0; n < s->nodes; n++)
    s->around_from[n] = s->around_from[n + 1];
  s->around_from[s->nodes] = 3 * s->triangles;
  return CDEM_OK;
}

static int edge_of(const int32_t node[3], int32_t from, int32_t to) {
  for (int k = 0; k < 3; k++)
    if (node[k] == from && node[(k + 1) % 3] == to)
      return k;
  return -1;
}

static cdem_status find_beside(const cdem_skin *s, const cdem_mesh *mesh, int32_t t, int edge,
                               int32_t *beside, cdem_fault *fault) {
  int32_t from = s->triangle[3 * (int64_t)t + edge];
  int32_t to = s->triangle[3 * (int64_t)t + (edge + 1) % 3];
  int across = 0, along = 0;
  for (int32_t k = s->around_from[from]; k < s->around_from[from + 1]; k++) {
    const int32_t *node = s->triangle + 3 * (int64_t)s->around[k];
    along += edge_of(node, from, to) >= 0;
    if (edge_of(node, to, from) >= 0) {
      across++;
      *beside = s->around[k];
    }
  }
  CDEM_REQUIRE(across == 1 && along == 1, fault, CDEM_INPUT,
               "the surface of a grain is not one closed skin: %d triangles meet at the edge of "
               "nodes %" PRId64 " and %" PRId64 "; two must, turned the same way",
               across + along, mesh->node_tag[from], mesh->node_tag[to]);
  return CDEM_OK;
}

/* Going from triangle to triangle about a node must pass them all: else two skins touch there, and
 * no normal tells inside from outside. */
static cdem_status check_fan(const cdem_skin *s, const cdem_mesh *mesh, int32_t node,
                             cdem_fault *fault) {
  int32_t count = s->around_from[node + 1] - s->around_from[node], passed = 0;
  CDEM_REQUIRE(count > 0, fault, CDEM_INPUT,
               "node %" PRId64 " of the mesh of a grain is among the first %" PRId32
               " but not on the surface",
               mesh->node_tag[node], s->nodes);
  int32_t first = s->around[s->around_from[node]], t = first;
  do {
    const int32_t *at = s->triangle + 3 * (int64_t)t;
    int k = at[0] == node ? 0 : (at[1] == node ? 1 : 2);
    t = s->beside[3 * (int64_t)t + k];
    passed++;
  } while (t != first && passed <= count);
  CDEM_REQUIRE(passed == count, fault, CDEM_INPUT,
               "the surface of a grain touches itself at node %" PRId64 "; give each part a node "
               "of its own",
               mesh->node_tag[node]);
  return CDEM_OK;
}

static cdem_status connect(cdem_skin *s, const cdem_mesh *mesh, cdem_fault *fault) {
  CDEM_TRY(set_around(s, fault));
  CDEM_NEW(s->beside, 3 * (int64_t)s->triangles, fault);
  for (int32_t t = 0; t < s->triangles; t++)
    for (int k = 0; k < 3; k++)
      CDEM_TRY(find_beside(s, mesh, t, k, s->beside + 3 * (int64_t)t + k, fault));
  for (int32_t n = 0; n < s->nodes; n++)
    CDEM_TRY(check_fan(s, mesh, n, fault));
  return CDEM_OK;
}

/* ---- measures ---- */

static cdem_status measure(cdem_skin *s, const cdem_mesh *mesh, cdem_fault *fault) {
  static const double origin[3] = {0.0, 0.0, 0.0};
  double least = INFINITY, most = 0.0;
  CDEM_NEW(s->area, s->nodes, fault);
  for (int32_t t = 0; t < s->triangles; t++) {
    const int32_t *node = s->triangle + 3 * (int64_t)t;
    const double *p[3];
    double ab[3], ac[3], cross[3];
    cdem_near near;
    for (int k = 0; k < 3; k++)
      p[k] = s->reference + 3 * (int64_t)node[k];
    for (int c = 0; c < 3; c++) {
      ab[c] = p[1][c] - p[0][c];
      ac[c] = p[2][c] - p[0][c];
    }
    cdem_cross3(ab, ac, cross);
    double area = 0.5 * cdem_norm3(cross);
    CDEM_REQUIRE(area > 0.0 && isfinite(area), fault, CDEM_INPUT,
                 "nodes %" PRId64 ", %" PRId64 ", %" PRId64 " make a triangle of area %g on the "
                 "surface of a grain; it must be positive",
                 mesh->node_tag[node[0]], mesh->node_tag[node[1]], mesh->node_tag[node[2]], area);
    s->total += area;
    s->volume += cdem_dot3(cross, p[0]) / 6.0;
    for (int k = 0; k < 3; k++) {
      s->area[node[k]] += area / 3.0;
      most = fmax(most, cdem_dot3(p[k], p[k]));
    }
    cdem_near_triangle(p[0], p[1], p[2], origin, &near);
    least = fmin(least, near.square);
  }
  s->reach = sqrt(most);
  s->least = sqrt(least);
  CDEM_REQUIRE(s->volume > 0.0, fault, CDEM_INPUT,
               "the surface of a grain encloses a volume of %g; it must be positive: the cells of "
               "its mesh are inside out",
               s->volume);
  return CDEM_OK;
}

/* ---- all ---- */

static cdem_status make(const cdem_mesh *mesh, cdem_skin *s, cdem_fault *fault) {
  cutter c = {mesh, s, 0, s->nodes};
  uint8_t *skin;
  CDEM_NEW(skin, (int64_t)CDEM_SHAPE_MAX_FACES * mesh->cells, fault);
  cdem_status status = mark_skin(mesh, skin, fault);
  if (status == CDEM_OK)
    status = cut_skin(&c, skin, fault);
  free(skin);
  CDEM_TRY(status);
  CDEM_NEW(s->reference, 3 * (int64_t)s->nodes, fault);
  memcpy(s->reference, mesh->xyz, 3 * (size_t)s->nodes * sizeof *s->reference);
  CDEM_TRY(connect(s, mesh, fault));
  CDEM_TRY(measure(s, mesh, fault));
  return cdem_skin_grid(s, fault);
}

cdem_status cdem_skin_build(const cdem_mesh *mesh, int32_t nodes, double margin, cdem_skin *surface,
                            cdem_fault *fault) {
  *surface = (cdem_skin){.nodes = nodes, .margin = margin};
  cdem_status status = CDEM_OK;
  if (nodes < 4 || nodes > mesh->nodes)
    status = cdem_fail(fault, CDEM_INPUT,
                       "a grain of %" PRId32 " nodes cannot have %" PRId32 " surface nodes; it has "
                       "at least 4, at most all",
                       mesh->nodes, nodes);
  else if (!(margin >= 0.0 && isfinite(margin)))
    status = cdem_fail(fault, CDEM_INPUT,
                       "the margin of a surface is %g radii; it must not be negative", margin);
  else
    status = make(mesh, surface, fault);
  if (status != CDEM_OK)
    cdem_skin_release(surface);
  return status;
}

void cdem_skin_release(cdem_skin *surface) {
  free(surface->reference);
  free(surface->triangle);
  free(surface->beside);
  free(surface->around_from);
  free(surface->around);
  free(surface->area);
  free(surface->list);
  free(surface->start);
  free(surface->item);
  *surface = (cdem_skin){0};
}
