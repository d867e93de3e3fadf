/* Scenes for the contact tests: boxes of quadrilaterals or hexahedra, each a block, placed and
 * turned at will, and moved as rigid bodies. The cut mesh is filled by hand. */
#ifndef CDEM_TESTS_CDEM_CONTACT_SUPPORT_H
#define CDEM_TESTS_CDEM_CONTACT_SUPPORT_H

#include "cdem/contact.h"
#include "support/test.h"

enum { SCENE_BOXES = 400 };

typedef struct {
  int32_t first, nodes; /* of the mesh */
  double mass, centre[3];
} scene_body;

typedef struct {
  int dim, dofs;
  cdem_blocks blocks;
  int32_t bodies;
  scene_body body[SCENE_BOXES];
  double *mass, *u, *v, *force;
  cdem_contact contact;
} scene;

typedef struct {
  int count[3];
  double size[3], origin[3], turn; /* about z, rad, about the origin corner */
} scene_box;

static const double scene_density = 1000.0;

static inline void scene_release(scene *s) {
  cdem_contact_release(&s->contact);
  cdem_mesh_release(&s->blocks.mesh);
  free(s->blocks.block);
  free(s->blocks.facet);
  free(s->blocks.pair);
  free(s->blocks.pair_facet);
  free(s->mass);
  free(s->u);
  free(s->v);
  free(s->force);
  memset(s, 0, sizeof *s);
}

static inline void scene_node(const scene_box *b, int dim, const int at[3], double x[3]) {
  double local[3] = {0.0};
  for (int i = 0; i < dim; i++)
    local[i] = b->size[i] * at[i] / b->count[i];
  x[0] = b->origin[0] + cos(b->turn) * local[0] - sin(b->turn) * local[1];
  x[1] = b->origin[1] + sin(b->turn) * local[0] + cos(b->turn) * local[1];
  x[2] = dim == 3 ? b->origin[2] + local[2] : 0.0;
}

static inline int32_t scene_id(const scene_box *b, int dim, int i, int j, int k) {
  return i + (b->count[0] + 1) * (j + (dim == 3 ? (b->count[1] + 1) * k : 0));
}

/* Faces of a cell on the outside of the box: all their nodes on one of its sides. */
static inline void scene_facets(scene *s, const scene_box *b, int32_t cell, int32_t first,
                                const int32_t *local) {
  const cdem_shape_info *shape = cdem_shape_get(s->dim == 2 ? CDEM_SHAPE_QUAD4 : CDEM_SHAPE_HEX8);
  int faces = s->dim == 2 ? shape->edges : shape->faces, row = b->count[0] + 1;
  for (int f = 0; f < faces; f++) {
    int corners = s->dim == 2 ? 2 : 4, low[3] = {0}, high[3] = {0};
    cdem_facet facet = {.cell = cell, .corners = (uint8_t)corners, .pair = -1};
    for (int c = 0; c < corners; c++) {
      int32_t n = local[s->dim == 2 ? shape->edge[f][c] : shape->face[f][c]];
      int at[3] = {n % row, s->dim == 2 ? n / row : n / row % (b->count[1] + 1),
                   s->dim == 2 ? 0 : n / row / (b->count[1] + 1)};
      facet.node[c] = first + n;
      for (int i = 0; i < s->dim; i++) {
        low[i] += at[i] == 0;
        high[i] += at[i] == b->count[i];
      }
    }
    bool outside = false;
    for (int i = 0; i < s->dim; i++)
      outside |= low[i] == corners || high[i] == corners;
    if (!outside)
      continue;
    s->blocks.facet[s->blocks.facets++] = facet;
  }
}

static inline void scene_add_one(scene *s, const scene_box *b) {
  cdem_mesh *mesh = &s->blocks.mesh;
  int32_t first = mesh->nodes;
  int nz = s->dim == 3 ? b->count[2] : 0, layers = s->dim == 3 ? nz : 1;
  cdem_fault fault = {0};
  for (int k = 0; k <= nz; k++)
    for (int j = 0; j <= b->count[1]; j++)
      for (int i = 0; i <= b->count[0]; i++) {
        double x[3];
        scene_node(b, s->dim, (int[3]){i, j, k}, x);
        check_ok(cdem_mesh_add_nodes(mesh, 1, x, NULL, &fault));
      }
  int64_t cells = (int64_t)b->count[0] * b->count[1] * layers;
  s->blocks.facet =
      realloc(s->blocks.facet, (size_t)(s->blocks.facets + 6 * cells) * sizeof *s->blocks.facet);
  s->blocks.block =
      realloc(s->blocks.block, (size_t)(mesh->cells + cells) * sizeof *s->blocks.block);
  for (int k = 0; k < layers; k++)
    for (int j = 0; j < b->count[1]; j++)
      for (int i = 0; i < b->count[0]; i++) {
        int32_t local[8], node[8];
        for (int c = 0; c < (s->dim == 2 ? 4 : 8); c++) {
          local[c] =
              scene_id(b, s->dim, i + (c % 4 == 1 || c % 4 == 2), j + (c % 4 >= 2), k + c / 4);
          node[c] = first + local[c];
        }
        check_ok(cdem_mesh_add_cells(mesh, s->dim == 2 ? CDEM_SHAPE_QUAD4 : CDEM_SHAPE_HEX8, 1,
                                     node, NULL, &fault));
        s->blocks.block[mesh->cells - 1] = s->blocks.blocks;
        scene_facets(s, b, mesh->cells - 1, first, local);
      }
  s->blocks.blocks++;
  scene_body *body = &s->body[s->bodies++];
  double volume = b->size[0] * b->size[1] * (s->dim == 3 ? b->size[2] : 1.0);
  *body = (scene_body){.first = first, .nodes = mesh->nodes - first};
  body->mass = scene_density * volume;
}

/* Lumped: an eighth (a quarter) of each cell to its corners. */
static inline void scene_masses(scene *s) {
  const cdem_mesh *mesh = &s->blocks.mesh;
  for (int32_t b = 0; b < s->bodies; b++) {
    scene_body *body = &s->body[b];
    int64_t corners = 0;
    for (int32_t c = 0; c < mesh->cells; c++)
      if (s->blocks.block[c] == b)
        corners += mesh->cell_start[c + 1] - mesh->cell_start[c];
    for (int32_t c = 0; c < mesh->cells; c++)
      for (int64_t i = mesh->cell_start[c]; i < mesh->cell_start[c + 1] && s->blocks.block[c] == b;
           i++)
        for (int k = 0; k < s->dofs; k++)
          s->mass[mesh->cell_node[i] * s->dofs + k] += body->mass / (double)corners;
    for (int32_t n = body->first; n < body->first + body->nodes; n++)
      for (int k = 0; k < 3; k++)
        body->centre[k] += mesh->xyz[3 * n + k] * s->mass[n * s->dofs] / body->mass;
  }
}

static inline void scene_make(scene *s, int dim, int boxes, const scene_box *box) {
  memset(s, 0, sizeof *s);
  s->dim = s->dofs = s->blocks.dimension = dim;
  for (int b = 0; b < boxes; b++)
    scene_add_one(s, &box[b]);
  size_t nodes = (size_t)s->blocks.mesh.nodes;
  s->mass = calloc(nodes * (size_t)dim, sizeof(double));
  s->u = calloc(nodes * (size_t)dim, sizeof(double));
  s->v = calloc(nodes * (size_t)dim, sizeof(double));
  s->force = calloc(nodes * (size_t)dim, sizeof(double));
  s->blocks.pair_facet = calloc(1, sizeof(int32_t));
  s->blocks.pair = calloc(1, sizeof(cdem_face_pair));
  scene_masses(s);
}

static inline void scene_start_with(scene *s, const cdem_contact_options *extra) {
  cdem_fault fault = {0};
  cdem_contact_options o = *extra;
  o.blocks = &s->blocks;
  o.dofs = s->dofs;
  o.thickness = 1.0;
  o.mass = s->mass;
  check_ok(cdem_contact_init(&o, &s->contact, &fault));
  for (int32_t f = 0; f < s->blocks.facets; f++)
    cdem_contact_activate(&s->contact, f);
}

static inline void scene_start(scene *s, const cdem_contact_law *law) {
  cdem_contact_options o = {.law = *law, .threads = 1};
  scene_start_with(s, &o);
}

static inline void scene_move(scene *s, int body, const double by[3]) {
  for (int32_t n = s->body[body].first; n < s->body[body].first + s->body[body].nodes; n++)
    for (int k = 0; k < s->dim; k++)
      s->u[n * s->dofs + k] += by[k];
}

static inline void scene_velocity(scene *s, int body, const double v[3]) {
  for (int32_t n = s->body[body].first; n < s->body[body].first + s->body[body].nodes; n++)
    for (int k = 0; k < s->dim; k++)
      s->v[n * s->dofs + k] = v[k];
}

static inline void scene_at(const scene *s, int32_t n, double x[3]) {
  for (int k = 0; k < 3; k++)
    x[k] = s->blocks.mesh.xyz[3 * n + k] + (k < s->dim ? s->u[n * s->dofs + k] : 0.0);
}

/* Places every node of a body at centre + R (X - X_centre); `v` becomes the motion over dt. */
static inline void scene_place(scene *s, int body, const double centre[3], const double r[9],
                               double dt) {
  const scene_body *b = &s->body[body];
  for (int32_t n = b->first; n < b->first + b->nodes; n++) {
    double d[3];
    for (int k = 0; k < 3; k++)
      d[k] = s->blocks.mesh.xyz[3 * n + k] - b->centre[k];
    for (int k = 0; k < s->dim; k++) {
      double to = centre[k] + cdem_dot3(r + 3 * k, d) - s->blocks.mesh.xyz[3 * n + k];
      s->v[n * s->dofs + k] = dt > 0.0 ? (to - s->u[n * s->dofs + k]) / dt : 0.0;
      s->u[n * s->dofs + k] = to;
    }
  }
}

static inline void scene_forces(scene *s, double dt) {
  cdem_fault fault = {0};
  memset(s->force, 0, (size_t)s->blocks.mesh.nodes * (size_t)s->dofs * sizeof(double));
  check_ok(cdem_contact_forces(&s->contact, s->u, s->v, dt, s->force, &fault));
}

static inline void scene_resultant(const scene *s, int body, double force[3]) {
  const scene_body *b = &s->body[body];
  force[0] = force[1] = force[2] = 0.0;
  for (int32_t n = b->first; n < b->first + b->nodes; n++)
    for (int k = 0; k < s->dim; k++)
      force[k] += s->force[n * s->dofs + k];
}

/* Sum of forces, of moments about the origin, and of the absolute forces. */
static inline void scene_balance(const scene *s, double force[3], double moment[3], double *scale) {
  memset(force, 0, 3 * sizeof(double));
  memset(moment, 0, 3 * sizeof(double));
  *scale = 0.0;
  for (int32_t n = 0; n < s->blocks.mesh.nodes; n++) {
    double x[3], f[3] = {0.0}, m[3];
    scene_at(s, n, x);
    for (int k = 0; k < s->dim; k++)
      f[k] = s->force[n * s->dofs + k];
    cdem_cross3(x, f, m);
    for (int k = 0; k < 3; k++) {
      force[k] += f[k];
      moment[k] += m[k];
    }
    *scale += cdem_norm3(f);
  }
}

static inline cdem_contact_totals scene_totals(const scene *s) {
  cdem_contact_totals totals;
  cdem_contact_sum(&s->contact, &totals);
  return totals;
}

/* A heap of boxes in all places and sizes. */
static inline void make_heap(scene *s, int boxes, int dim, int threads) {
  static scene_box box[SCENE_BOXES];
  cdem_random random = {3};
  for (int b = 0; b < boxes; b++) {
    box[b] = (scene_box){{1 + b % 2, 1 + b % 3, 1}, {0}, {0}, cdem_random_uniform(&random, 0, 6)};
    for (int k = 0; k < 3; k++) {
      box[b].size[k] = cdem_random_uniform(&random, 0.5, b % 17 == 0 ? 4.0 : 1.0);
      box[b].origin[k] = cdem_random_uniform(&random, 0.0, 0.9 * pow(boxes, 1.0 / dim));
    }
  }
  scene_make(s, dim, boxes, box);
  cdem_contact_options o = {.threads = threads,
                            .law = {.kn = 1e8, .kt = 5e7, .friction = 0.4, .damping = 0.1}};
  scene_start_with(s, &o);
}

static inline int status_of_heap(scene *s, double dt) {
  memset(s->force, 0, (size_t)s->blocks.mesh.nodes * (size_t)s->dofs * sizeof(double));
  return cdem_contact_forces(&s->contact, s->u, s->v, dt, s->force, NULL);
}

#endif
