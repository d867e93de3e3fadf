/* The sphere as hexahedra: a core of n x n x n, rounded a little so that its corners are not sharp,
 * and six blocks around it. `refinement` is n; the blocks are max(1, n/2) thick. */
#include "fdem/template.h"

#include <stdlib.h>

/* Half edge of the core as a cube, and as a ball; the core is halfway between them. */
static const double cube = 0.42, ball = 0.60;

typedef struct {
  int n, layers;
  int32_t *node; /* [layers + 1][(n + 1)^3] node of a lattice point; shells hold its skin alone */
} sphere;

static bool on_skin(const sphere *s, const int at[3]) {
  for (int c = 0; c < 3; c++)
    if (at[c] == 0 || at[c] == s->n)
      return true;
  return false;
}

static int64_t index_of(const sphere *s, int layer, const int at[3]) {
  int m = s->n + 1;
  return (((int64_t)layer * m + at[0]) * m + at[1]) * m + at[2];
}

/* Unit vector through a point of the surface of the cube [-1, 1]^3: equal angles between the lines
 * of each face. */
static void outwards(const double t[3], double u[3]) {
  const double quarter = 0.78539816339744830962;
  for (int c = 0; c < 3; c++)
    u[c] = fabs(t[c]) == 1.0 ? t[c] : tan(quarter * t[c]);
  double norm = cdem_norm3(u);
  for (int c = 0; c < 3; c++)
    u[c] /= norm;
}

/* Place of a lattice point; layer 0 is the core. */
static void place(const sphere *s, int layer, const int at[3], double x[3]) {
  double t[3], u[3], level = 0.0;
  for (int c = 0; c < 3; c++) {
    t[c] = 2.0 * at[c] / s->n - 1.0;
    level = fmax(level, fabs(t[c]));
  }
  for (int c = 0; c < 3; c++)
    x[c] = 0.0;
  if (level == 0.0)
    return;
  for (int c = 0; c < 3; c++)
    t[c] /= level;
  outwards(t, u);
  double out = (double)layer / s->layers;
  for (int c = 0; c < 3; c++) {
    double core = level * 0.5 * (cube * t[c] + ball * u[c]);
    x[c] = (1.0 - out) * core + out * u[c];
  }
}

static cdem_status add_nodes(sphere *s, cdem_mesh *mesh, cdem_fault *fault) {
  for (int layer = 0; layer <= s->layers; layer++)
    for (int i = 0; i <= s->n; i++)
      for (int j = 0; j <= s->n; j++)
        for (int k = 0; k <= s->n; k++) {
          const int at[3] = {i, j, k};
          double x[3];
          if (layer > 0 && !on_skin(s, at))
            continue;
          place(s, layer, at, x);
          s->node[index_of(s, layer, at)] = mesh->nodes;
          CDEM_TRY(cdem_mesh_add_nodes(mesh, 1, x, NULL, fault));
        }
  return CDEM_OK;
}

static cdem_status add_hex(cdem_mesh *mesh, const int32_t corner[8], cdem_fault *fault) {
  int32_t node[8];
  double e[9];
  const double *x = mesh->xyz;
  for (int c = 0; c < 3; c++) {
    e[c] = x[3 * corner[1] + c] - x[3 * corner[0] + c];
    e[3 + c] = x[3 * corner[3] + c] - x[3 * corner[0] + c];
    e[6 + c] = x[3 * corner[4] + c] - x[3 * corner[0] + c];
  }
  bool turned = cdem_det3(e) < 0.0;
  for (int k = 0; k < 8; k++)
    node[k] = corner[turned ? (k + 4) % 8 : k];
  return cdem_mesh_add_cells(mesh, CDEM_SHAPE_HEX8, 1, node, NULL, fault);
}

static cdem_status add_core(const sphere *s, cdem_mesh *mesh, cdem_fault *fault) {
  static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (int i = 0; i < s->n; i++)
    for (int j = 0; j < s->n; j++)
      for (int k = 0; k < s->n; k++) {
        int32_t node[8];
        for (int c = 0; c < 8; c++) {
          const int at[3] = {i + corner[c][0], j + corner[c][1], k + corner[c][2]};
          node[c] = s->node[index_of(s, 0, at)];
        }
        CDEM_TRY(add_hex(mesh, node, fault));
      }
  return CDEM_OK;
}

/* The blocks over the face of the core where lattice direction `normal` is 0 or n. */
static cdem_status add_side(const sphere *s, int normal, int end, cdem_mesh *mesh,
                            cdem_fault *fault) {
  static const int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int layer = 0; layer < s->layers; layer++)
    for (int i = 0; i < s->n; i++)
      for (int j = 0; j < s->n; j++) {
        int32_t node[8];
        for (int k = 0; k < 8; k++) {
          int at[3];
          at[normal] = end;
          at[(normal + 1) % 3] = i + corner[k % 4][0];
          at[(normal + 2) % 3] = j + corner[k % 4][1];
          node[k] = s->node[index_of(s, layer + k / 4, at)];
        }
        CDEM_TRY(add_hex(mesh, node, fault));
      }
  return CDEM_OK;
}

static cdem_status fill(sphere *s, cdem_mesh *mesh, cdem_fault *fault) {
  int64_t m = s->n + 1;
  CDEM_NEW(s->node, (s->layers + 1) * m * m * m, fault);
  CDEM_TRY(add_nodes(s, mesh, fault));
  CDEM_TRY(add_core(s, mesh, fault));
  for (int c = 0; c < 3; c++) {
    CDEM_TRY(add_side(s, c, 0, mesh, fault));
    CDEM_TRY(add_side(s, c, s->n, mesh, fault));
  }
  return CDEM_OK;
}

static cdem_status make(const cdem_grain_shape_options *options, cdem_mesh *mesh,
                        cdem_fault *fault) {
  int n = options->refinement;
  sphere s = {.n = n, .layers = n < 2 ? 1 : n / 2};
  *mesh = (cdem_mesh){0};
  cdem_status status = fill(&s, mesh, fault);
  free(s.node);
  if (status != CDEM_OK)
    cdem_mesh_release(mesh);
  return status;
}

const cdem_grain_shape cdem_grain_shape_cubesphere = {
    .name = "cubesphere",
    .help = "sphere of hexahedra, a core of n x n x n (n: `refinement`) in six blocks (2: 32 "
            "elements, 53 nodes)",
    .least = 1,
    .most = 6,
    .ball = true,
    .make = make};
