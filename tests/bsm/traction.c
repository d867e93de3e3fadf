/* Room bsm: loads on the edge of the grains. */
#include "bsm/bsm_support.h"
#include "dem/packing.h"

static cdem_fault fault;

enum { MOST_FACES = 256 };

typedef struct {
  cdem_mesh mesh;
  cdem_grains grains;
  int64_t faces;
  cdem_bsm_face face[MOST_FACES];
  double *area, *normal;
} scene;

/* The faces of a mesh whose corners all have y = 1. */
static void find_faces(scene *s) {
  int32_t cells, *cell = cells_of_mesh(&s->mesh, &cells);
  const cdem_shape_info *shape = cdem_shape_get((cdem_shape)s->mesh.cell_shape[cell[0]]);
  bool plane = shape->dimension == 2;
  s->faces = 0;
  for (int32_t k = 0; k < cells; k++)
    for (int i = 0; i < (plane ? shape->edges : shape->faces); i++) {
      cdem_bsm_face f = {.corners = plane ? 2 : shape->face_corners[i]};
      bool top = true;
      for (int c = 0; c < f.corners; c++) {
        f.node[c] =
            cdem_mesh_cell(&s->mesh, cell[k])[plane ? shape->edge[i][c] : shape->face[i][c]];
        top = top && s->mesh.xyz[3 * f.node[c] + 1] == 1.0;
      }
      if (top && s->faces < MOST_FACES)
        s->face[s->faces++] = f;
    }
  assert_true(s->faces > 0 && s->faces < MOST_FACES);
  free(cell);
}

/* A unit square or cube of 4 bricks a direction and its top; no grains yet. */
static void scene_mesh(cdem_shape shape, double distortion, scene *s) {
  bool solid = is_solid(shape);
  cdem_mesh_grid_options grid = {.shape = shape,
                                 .count = {4, 4, solid ? 4 : 0},
                                 .size = {1.0, 1.0, solid ? 1.0 : 0.0},
                                 .distortion = distortion,
                                 .seed = 4};
  memset(s, 0, sizeof *s);
  check_ok(cdem_mesh_grid(&grid, &s->mesh, &fault));
  s->grains.dim = solid ? 3 : 2;
  find_faces(s);
}

static void add_grain(scene *s, double x, double y, double z, double radius) {
  const double at[3] = {x, y, z};
  check_ok(cdem_grains_add(&s->grains, at, radius, &fault));
}

static void lattice(scene *s, double radius) {
  cdem_packing_options o = {.dim = s->grains.dim,
                            .high = {1.0, 1.0, 1.0},
                            .sizes = {.kind = CDEM_SIZES_EQUAL, .radius = radius}};
  check_ok(cdem_packing_make(cdem_packing_find("cubic"), &o, &s->grains, &fault));
}

static void share(scene *s, double thickness) {
  s->area = cdem_allocate(4 * s->grains.grains, sizeof *s->area, &fault);
  s->normal = s->area + s->grains.grains;
  check_ok(cdem_bsm_tributary(&s->mesh, s->faces, s->face, &s->grains, 0.1, thickness, s->area,
                              s->normal, &fault));
}

static void scene_release(scene *s) {
  cdem_mesh_release(&s->mesh);
  cdem_grains_release(&s->grains);
  free(s->area);
}

/* sum of area_a (one + slope x_a) x_a^power. */
static double moment(const scene *s, double one, double slope, int power) {
  double sum = 0.0;
  for (int64_t i = 0; i < s->grains.grains; i++) {
    double x = s->grains.xyz[3 * i];
    sum += s->area[i] * (one + slope * x) * (power == 1 ? x : 1.0);
  }
  return sum;
}

static void check_normals(const scene *s, double x, double y, double z, double bound) {
  const double wanted[3] = {x, y, z};
  double sum[3] = {0};
  for (int64_t i = 0; i < 3 * s->grains.grains; i++)
    sum[i % 3] += s->normal[i];
  for (int c = 0; c < 3; c++)
    check_near(sum[c], wanted[c], 0.0, bound);
}

/* A regular row in a plane: every disc its spacing, in all the resultant of uniform and linear
 * tractions and the moment of uniform ones. */
static void regular_row(void **state) {
  (void)state;
  scene s;
  const double thickness = 0.7, spacing = 1.0 / 16.0;
  scene_mesh(CDEM_SHAPE_QUAD4, 0.0, &s);
  lattice(&s, 0.5 * spacing);
  share(&s, thickness);
  for (int64_t i = 0; i < s.grains.grains; i++) {
    bool top = s.grains.xyz[3 * i + 1] > 1.0 - spacing;
    check_near(s.area[i], top ? spacing * thickness : 0.0, 1e-12, 0.0);
    check_near(s.normal[3 * i + 1], s.area[i], 1e-14, 0.0);
  }
  check_near(moment(&s, 1.0, 0.0, 0), thickness, 1e-13, 0.0);
  check_near(moment(&s, 2.0, 3.0, 0), 3.5 * thickness, 1e-13, 0.0);
  check_near(moment(&s, 1.0, 0.0, 1), 0.5 * thickness, 1e-13, 0.0);
  check_normals(&s, 0.0, thickness, 0.0, 1e-14);
  scene_release(&s);
}

/* Grains that go their own way carry nothing, and nothing is lost at them. */
static void driven_neighbours(void **state) {
  (void)state;
  for (int solid = 0; solid < 2; solid++) {
    scene s;
    scene_mesh(solid ? CDEM_SHAPE_HEX8 : CDEM_SHAPE_QUAD4, 0.0, &s);
    lattice(&s, 1.0 / 32.0);
    s.grains.motion = cdem_allocate(s.grains.grains, sizeof *s.grains.motion, &fault);
    for (int64_t i = 0; i < s.grains.grains; i++)
      if (s.grains.xyz[3 * i] > 0.5)
        s.grains.motion[i] = CDEM_GRAIN_DRIVEN;
    for (int64_t k = s.faces - 1; k >= 0; k--) { /* the faces beside them alone */
      double most = 0.0;
      for (int c = 0; c < s.face[k].corners; c++)
        most = fmax(most, s.mesh.xyz[3 * s.face[k].node[c]]);
      if (most > 0.5)
        s.face[k] = s.face[--s.faces];
    }
    share(&s, 1.0);
    for (int64_t i = 0; i < s.grains.grains; i++)
      if (s.grains.motion[i] == CDEM_GRAIN_DRIVEN)
        assert_true(s.area[i] == 0.0);
      else if (!solid && s.area[i] > 0.0)
        check_near(s.area[i], 1.0 / 16.0, 1e-12, 0.0);
    check_near(moment(&s, 1.0, 0.0, 0), 0.5, 1e-12, 0.0);
    scene_release(&s);
  }
}

/* Discs of any size at random places of the edge, the outermost beyond its ends: between them
 * linear fields are exact. */
static void random_row(void **state) {
  (void)state;
  for (uint64_t seed = 1; seed < 20; seed++) {
    scene s;
    cdem_random random = {seed};
    scene_mesh(seed % 2 ? CDEM_SHAPE_QUAD4 : CDEM_SHAPE_TRI3, 0.2, &s);
    for (double x = -0.01, last = x; last < 1.0;
         last = x, x += cdem_random_uniform(&random, 0.005, 0.05)) {
      double radius = cdem_random_uniform(&random, 0.02, 0.03);
      add_grain(&s, x, 1.0 - radius - cdem_random_uniform(&random, 0.0, 0.002), 0.0, radius);
    }
    share(&s, 1.0);
    for (int64_t i = 0; i < s.grains.grains; i++)
      assert_true(s.area[i] >= 0.0);
    check_near(moment(&s, 1.0, 0.0, 0), 1.0, 1e-13, 0.0);
    check_near(moment(&s, 2.0, 3.0, 0), 3.5, 1e-13, 0.0);
    check_near(moment(&s, 1.0, 0.0, 1), 0.5, 1e-13, 0.0);
    check_normals(&s, 0.0, 1.0, 0.0, 1e-13);
    scene_release(&s);
  }
}

/* An edge that is not along an axis: the area vector points outwards. */
static void sloping_edge(void **state) {
  (void)state;
  scene s;
  scene_mesh(CDEM_SHAPE_QUAD4, 0.0, &s);
  lattice(&s, 1.0 / 32.0);
  const double c = cos(0.4), q = sin(0.4);
  double *const all[2] = {s.mesh.xyz, s.grains.xyz};
  const int64_t count[2] = {s.mesh.nodes, s.grains.grains};
  for (int k = 0; k < 2; k++)
    for (int64_t i = 0; i < count[k]; i++) {
      double *x = all[k] + 3 * i, old = x[0];
      x[0] = c * old - q * x[1];
      x[1] = q * old + c * x[1];
    }
  share(&s, 2.0);
  check_near(moment(&s, 1.0, 0.0, 0), 2.0, 1e-13, 0.0);
  check_normals(&s, -2.0 * q, 2.0 * c, 0.0, 1e-13);
  scene_release(&s);
}

/* In space: totals to rounding for all kinds of faces, grains their share by the resolution. */
static void faces_in_space(void **state) {
  (void)state;
  const cdem_shape shape[4] = {CDEM_SHAPE_HEX8, CDEM_SHAPE_TET4, CDEM_SHAPE_WEDGE6,
                               CDEM_SHAPE_PYR5};
  for (int k = 0; k < 4; k++) {
    scene s;
    const double spacing = 1.0 / 8.0;
    scene_mesh(shape[k], 0.2, &s);
    lattice(&s, 0.5 * spacing);
    share(&s, 5.0); /* thickness is of planes */
    for (int64_t i = 0; i < s.grains.grains; i++)
      check_near(s.area[i], s.grains.xyz[3 * i + 1] > 1.0 - spacing ? spacing * spacing : 0.0, 0.1,
                 0.0);
    check_near(moment(&s, 1.0, 0.0, 0), 1.0, 1e-12, 0.0);
    check_near(moment(&s, 1.0, 0.0, 1), 0.5, 0.01, 0.0);
    check_normals(&s, 0.0, 1.0, 0.0, 1e-12);
    scene_release(&s);
  }
}

/* A quadrilateral that is not flat has the area vector of its diagonals; a narrow one is looked at
 * as finely as its longer side wants. */
static void bent_and_narrow_faces(void **state) {
  (void)state;
  scene s;
  const double xyz[4][3] = {{0, 1, 0}, {0, 1.02, 0.1}, {1.1, 0.99, 0.1}, {1, 1.01, 0}};
  memset(&s, 0, sizeof s);
  check_ok(cdem_mesh_add_nodes(&s.mesh, 4, xyz[0], NULL, &fault));
  s.grains.dim = 3;
  for (int i = 0; i < 40; i++)
    add_grain(&s, 0.0125 + 0.025 * i, 0.99, 0.05, 0.0125);
  s.faces = 1;
  s.face[0] = (cdem_bsm_face){4, {0, 1, 2, 3}};
  share(&s, 1.0);
  double d[2][3], cross[3];
  for (int c = 0; c < 3; c++) {
    d[0][c] = xyz[2][c] - xyz[0][c];
    d[1][c] = xyz[3][c] - xyz[1][c];
  }
  cdem_cross3(d[0], d[1], cross);
  check_normals(&s, 0.5 * cross[0], 0.5 * cross[1], 0.5 * cross[2], 1e-13);
  for (int i = 2; i < 38; i++)
    check_near(s.area[i], s.area[i + 1], 0.15, 0.0);
  scene_release(&s);
}

static void touching_set(void **state) {
  (void)state;
  scene s;
  scene_mesh(CDEM_SHAPE_HEX8, 0.0, &s);
  lattice(&s, 1.0 / 16.0);
  bool *touch = cdem_allocate(s.grains.grains, sizeof *touch, &fault);
  int64_t first = -1;
  for (int64_t i = 0; i < s.grains.grains; i++)
    if (s.grains.xyz[3 * i + 1] < 0.1 && first < 0)
      first = i;
  touch[first] = true; /* others are left alone */
  cdem_bsm_touching(&s.mesh, s.faces, s.face, &s.grains, 1e-6, touch);
  for (int64_t i = 0; i < s.grains.grains; i++)
    assert_int_equal(touch[i], i == first || s.grains.xyz[3 * i + 1] > 0.9);
  /* Two diameters deep: the next layer too. */
  cdem_bsm_touching(&s.mesh, s.faces, s.face, &s.grains, 2.0 + 1e-6, touch);
  for (int64_t i = 0; i < s.grains.grains; i++)
    assert_int_equal(touch[i], i == first || s.grains.xyz[3 * i + 1] > 0.8);
  /* One face alone: grains above it and at most a radius beside it. */
  memset(touch, 0, (size_t)s.grains.grains * sizeof *touch);
  cdem_bsm_touching(&s.mesh, 1, s.face, &s.grains, 1e-6, touch);
  double low[3], high[3];
  for (int c = 0; c < 3; c++) {
    low[c] = INFINITY;
    high[c] = -INFINITY;
    for (int i = 0; i < 4; i++) {
      low[c] = fmin(low[c], s.mesh.xyz[3 * s.face[0].node[i] + c] - 0.063);
      high[c] = fmax(high[c], s.mesh.xyz[3 * s.face[0].node[i] + c] + 0.063);
    }
  }
  for (int64_t i = 0; i < s.grains.grains; i++) {
    const double *x = s.grains.xyz + 3 * i;
    bool beside = x[0] > low[0] && x[0] < high[0] && x[2] > low[2] && x[2] < high[2];
    assert_int_equal(touch[i], x[1] > 0.9 && beside);
  }
  free(touch);
  scene_release(&s);
}

/* A face without grains: its place; what was there before stays. */
static void refusals(void **state) {
  (void)state;
  for (int beside = 0; beside < 2; beside++) {
    scene s;
    double area[64], normal[192];
    scene_mesh(CDEM_SHAPE_QUAD4, 0.0, &s);
    for (int i = 0; i < 16; i++) /* the face from 0.25 to 0.5 is bare, neighbours nearly reach it */
      if (!(i >= 4 && i < 8))
        add_grain(&s, (i + 0.5) / 16.0, 1.0 - 1.0 / 32.0, 0.0, (beside ? 0.9 : 0.4) / 32.0);
    for (int i = 0; i < 64; i++)
      area[i] = normal[i] = normal[64 + i] = normal[128 + i] = 42.0;
    check_fails(
        cdem_bsm_tributary(&s.mesh, s.faces, s.face, &s.grains, 2.0, 1.0, area, normal, &fault),
        CDEM_INPUT, "no grain touches the face at (0.5, 1, 0 m) that is loaded");
    for (int i = 0; i < 64; i++)
      assert_true(area[i] == 42.0 && normal[i] == 42.0 && normal[128 + i] == 42.0);
    scene_release(&s);
  }
}

/* Either array alone; both are added to. */
static void arrays_are_added_to(void **state) {
  (void)state;
  scene s;
  scene_mesh(CDEM_SHAPE_QUAD4, 0.0, &s);
  lattice(&s, 1.0 / 32.0);
  share(&s, 1.0);
  int64_t n = s.grains.grains;
  double *twice = cdem_allocate(4 * n, sizeof *twice, &fault);
  memcpy(twice, s.area, 4 * (size_t)n * sizeof *twice);
  check_ok(cdem_bsm_tributary(&s.mesh, s.faces, s.face, &s.grains, 0.1, 1.0, twice, NULL, &fault));
  check_ok(
      cdem_bsm_tributary(&s.mesh, s.faces, s.face, &s.grains, 0.1, 1.0, NULL, twice + n, &fault));
  for (int64_t i = 0; i < 4 * n; i++)
    check_near(twice[i], 2.0 * s.area[i], 1e-15, 0.0);
  for (int fail = 0; fail < 2; fail++) {
    cdem_memory_fail_after(fail);
    cdem_status status =
        cdem_bsm_tributary(&s.mesh, s.faces, s.face, &s.grains, 0.1, 1.0, twice, NULL, &fault);
    cdem_memory_fail_after(-1);
    assert_int_equal(status, CDEM_MEMORY);
    memset(&fault, 0, sizeof fault);
  }
  free(twice);
  scene_release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(regular_row),         cmocka_unit_test(driven_neighbours),
      cmocka_unit_test(random_row),          cmocka_unit_test(sloping_edge),
      cmocka_unit_test(faces_in_space),      cmocka_unit_test(bent_and_narrow_faces),
      cmocka_unit_test(touching_set),        cmocka_unit_test(refusals),
      cmocka_unit_test(arrays_are_added_to),
  };
  return cmocka_run_group_tests_name("bsm traction", tests, NULL, NULL);
}
