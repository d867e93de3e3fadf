/* Room io: triangulated surfaces (.stl), in text and binary, on their way to a wall of grains. */
#include "dem/walls.h"
#include "io/mesh_support.h"

/* A tetrahedron with its right angle at the origin, 2 x 1 x 0.5 m. */
static const float tetrahedron[4][3][3] = {{{0, 0, 0}, {0, 1, 0}, {2, 0, 0}},
                                           {{0, 0, 0}, {2, 0, 0}, {0, 0, 0.5f}},
                                           {{0, 0, 0}, {0, 0, 0.5f}, {0, 1, 0}},
                                           {{2, 0, 0}, {0, 1, 0}, {0, 0, 0.5f}}};

static char *in_text(void) {
  char *text = malloc(8192), *at = text;
  at += sprintf(at, "solid tetrahedron\n");
  for (int f = 0; f < 4; f++) {
    at += sprintf(at, "facet normal 0 0 0\n outer loop\n");
    for (int k = 0; k < 3; k++)
      at += sprintf(at, "  vertex %g %g %g\n", (double)tetrahedron[f][k][0],
                    (double)tetrahedron[f][k][1], (double)tetrahedron[f][k][2]);
    at += sprintf(at, " endloop\nendfacet\n");
  }
  sprintf(at, "endsolid tetrahedron\n");
  return text;
}

/* 80 bytes of anything, the number of triangles, 50 bytes each. */
static size_t in_binary(unsigned char *data) {
  uint32_t triangles = 4;
  size_t size = 84;
  memset(data, 0, 84 + 4 * 50);
  memcpy(data, "made for a test", 15);
  memcpy(data + 80, &triangles, 4);
  for (int f = 0; f < 4; f++, size += 50)
    memcpy(data + size + 12, tetrahedron[f], sizeof tetrahedron[f]);
  return size;
}

static void check_tetrahedron(const char *path) {
  cdem_mesh mesh = read_mesh(path);
  cdem_wall_mesh surface = {0};
  assert_int_equal(count_shape(&mesh, CDEM_SHAPE_TRI3), 4);
  assert_int_equal(mesh.nodes, 4); /* joined */
  check_ok(cdem_wall_take_surface(3, &mesh, NULL, &surface, &fault));
  assert_int_equal(surface.facets, 4);
  assert_int_equal(surface.corners, 4);
  double sum[3] = {0, 0, 0};
  for (int32_t f = 0; f < surface.facets; f++) {
    const double *a = surface.corner + 3 * surface.facet[3 * f];
    const double *b = surface.corner + 3 * surface.facet[3 * f + 1];
    const double *c = surface.corner + 3 * surface.facet[3 * f + 2];
    for (int i = 0; i < 3; i++) {
      int j = (i + 1) % 3, k = (i + 2) % 3;
      sum[i] += (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
    }
  }
  for (int i = 0; i < 3; i++) /* closed, all seen from one side */
    check_near(sum[i], 0.0, 0.0, 1e-15);
  cdem_wall wall = {.name = "t",
                    .shape = CDEM_WALL_MESH,
                    .corners = surface.corners,
                    .corner = surface.corner,
                    .facets = surface.facets,
                    .facet = surface.facet};
  check_ok(cdem_wall_check(3, &wall, &fault));
  cdem_wall_mesh_release(&surface);
  cdem_mesh_release(&mesh);
}

static void text_and_binary_give_the_same(void **state) {
  (void)state;
  unsigned char data[84 + 4 * 50];
  char *text = in_text();
  check_tetrahedron(write_text("a.stl", text));
  size_t size = in_binary(data);
  check_tetrahedron(write_bytes("b.STL", data, size));
  /* many programs start the head of a binary file like one in text */
  memcpy(data, "solid binary", 12);
  check_tetrahedron(write_bytes("c.stl", data, size));
  free(text);
}

static void what_is_cut_or_none_is_refused(void **state) {
  (void)state;
  unsigned char data[84 + 4 * 50];
  char *text = in_text();
  size_t size = in_binary(data);
  check_unreadable(write_bytes("a.stl", data, size - 20), CDEM_INPUT,
                   "no complete STL file: of 4 triangles, its 264 bytes hold another number");
  check_unreadable(write_bytes("a.stl", data, 40), CDEM_INPUT, "no complete STL file");
  data[80] = 0;
  check_unreadable(write_bytes("a.stl", data, 84), CDEM_INPUT, "it holds no triangles");
  check_unreadable(write_text("a.stl", ""), CDEM_INPUT, "the file is empty");
  text[strlen(text) - 40] = '\0';
  check_unreadable(write_text("a.stl", text), CDEM_INPUT, "does not end with 'endsolid'");
  check_unreadable(write_text("a.stl", "solid nothing\nendsolid nothing\n"), CDEM_INPUT, "");
  free(text);
}

static void the_hopper_is_as_its_readme_says(void **state) {
  (void)state;
  cdem_mesh mesh = read_mesh(CDEM_DATA "/meshes/hopper.stl");
  assert_int_equal(count_shape(&mesh, CDEM_SHAPE_TRI3), 160);
  assert_int_equal(mesh.nodes, 120);
  for (int32_t n = 0; n < mesh.nodes; n++) {
    const double *x = mesh.xyz + 3 * n;
    double r = sqrt(x[0] * x[0] + x[1] * x[1]);
    check_near(r, x[2] > 0.2 ? 0.25 : 0.04, 1e-6, 0);
  }
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(text_and_binary_give_the_same),
      cmocka_unit_test(what_is_cut_or_none_is_refused),
      cmocka_unit_test(the_hopper_is_as_its_readme_says),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
