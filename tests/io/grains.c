/* Room io: files of grains. Round trips to the bit, other orders and units, what is refused and
 * where, nothing half-written. */
#include "io/grains_file.h"
#include "io/support.h"

static cdem_fault fault;

static cdem_grains sample(int dim, bool whole) {
  cdem_grains grains = {.dim = dim};
  cdem_random random = {11};
  for (int i = 0; i < 50; i++) {
    double place[3] = {0};
    for (int c = 0; c < dim; c++)
      place[c] = cdem_random_uniform(&random, -1.0, 1.0) / 3.0;
    check_ok(cdem_grains_add(&grains, place, cdem_random_uniform(&random, 1e-300, 0.1), &fault));
  }
  if (!whole)
    return grains;
  check_ok(cdem_grains_complete(&grains, &fault));
  for (int i = 0; i < 50; i++) {
    for (int c = 0; c < dim; c++)
      grains.velocity[3 * i + c] = cdem_random_uniform(&random, -9.0, 9.0);
    for (int c = dim == 2 ? 2 : 0; c < 3; c++)
      grains.spin[3 * i + c] = cdem_random_uniform(&random, -1e9, 1e9);
    grains.material[i] = i % 3;
    grains.motion[i] = i % 7 == 0;
  }
  return grains;
}

static const char *const names[3] = {"sand", "clay, \"blue\"", "steel"};

static void same_array(const void *a, const void *b, size_t bytes) {
  assert_int_equal(a == NULL, b == NULL);
  if (a != NULL)
    assert_memory_equal(a, b, bytes);
}

static void round_trip(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++)
    for (int whole = 0; whole < 2; whole++) {
      cdem_grains a = sample(dim, whole);
      cdem_grain_table back;
      check_ok(cdem_write_grains(in_scratch("g.csv"), &a, 3, names, &fault));
      check_ok(cdem_read_grains(in_scratch("g.csv"), whole ? dim : 0, &back, &fault));
      const cdem_grains *b = &back.grains;
      size_t n = (size_t)a.grains;
      assert_int_equal(b->dim, dim);
      assert_int_equal(b->grains, a.grains);
      same_array(a.xyz, b->xyz, 24 * n);
      same_array(a.radius, b->radius, 8 * n);
      same_array(a.velocity, b->velocity, 24 * n);
      same_array(a.spin, b->spin, 24 * n);
      same_array(a.material, b->material, 4 * n);
      same_array(a.motion, b->motion, n);
      assert_int_equal(back.names, whole ? 3 : 0);
      for (int i = 0; i < back.names; i++)
        assert_string_equal(back.name[i], names[i]);
      cdem_grains_release(&a);
      cdem_grain_table_release(&back);
      cdem_grain_table_release(&back);
    }
}

static void header_is_stable(void **state) {
  (void)state;
  cdem_grains grains = {.dim = 2};
  check_ok(cdem_grains_add(&grains, (double[3]){0.5, 0.1, 0.0}, 0.05, &fault));
  check_ok(cdem_write_grains(in_scratch("h.csv"), &grains, 0, NULL, &fault));
  char *text = read_whole(in_scratch("h.csv"), NULL);
  assert_string_equal(text,
                      "x [m],y [m],radius [m]\n0.5,0.10000000000000001,0.050000000000000003\n");
  free(text);
  check_ok(cdem_grains_complete(&grains, &fault));
  check_ok(cdem_write_grains(in_scratch("h.csv"), &grains, 1, names, &fault));
  text = read_whole(in_scratch("h.csv"), NULL);
  assert_string_equal(text, "x [m],y [m],radius [m],material,motion,vx [m/s],vy [m/s],wz [rad/s]\n"
                            "0.5,0.10000000000000001,0.050000000000000003,sand,free,0,0,0\n");
  free(text);
  cdem_grains_release(&grains);
}

static void other_orders_and_units(void **state) {
  (void)state;
  cdem_grain_table t;
  write_whole(in_scratch("o.csv"), "\xef\xbb\xbf# made by hand\r\n"
                                   "material, radius [mm],z, y [cm] ,x [m],wz [rpm]\r\n"
                                   "\r\n"
                                   "steel, 50 ,1,20,3,60\r\n"
                                   "# between\r\n"
                                   "sand,25,1.5,-20,4,0");
  check_ok(cdem_read_grains(in_scratch("o.csv"), 0, &t, &fault));
  assert_int_equal(t.grains.dim, 3);
  assert_int_equal(t.grains.grains, 2);
  check_near(t.grains.radius[0], 0.05, 1e-15, 0.0);
  check_near(t.grains.xyz[1], 0.2, 1e-15, 0.0);
  check_near(t.grains.xyz[0], 3.0, 0.0, 0.0);
  check_near(t.grains.xyz[5], 1.5, 0.0, 0.0);
  check_near(t.grains.spin[2], 2.0 * 3.14159265358979323846, 1e-14, 0.0);
  assert_null(t.grains.velocity);
  assert_string_equal(t.name[0], "steel");
  assert_int_equal(t.grains.material[1], 1);
  cdem_grain_table_release(&t);
  /* A table with a z that is zero can be of discs. */
  write_whole(in_scratch("o.csv"), "x,y,z,radius\n1,2,0,3\n");
  check_ok(cdem_read_grains(in_scratch("o.csv"), 2, &t, &fault));
  assert_int_equal(t.grains.dim, 2);
  cdem_grain_table_release(&t);
}

static void refuse(const char *text, int dim, const char *message) {
  cdem_grain_table t;
  write_whole(in_scratch("bad.csv"), text);
  check_fails(cdem_read_grains(in_scratch("bad.csv"), dim, &t, &fault), CDEM_INPUT, message);
  assert_null(t.grains.xyz);
  assert_int_equal(t.names, 0);
}

static void refusals(void **state) {
  (void)state;
  refuse("", 0, "bad.csv': the header is missing");
  refuse("# only this\n", 0, "the header is missing");
  refuse("x,y,radius\n", 0, "there are no grains in it");
  refuse("x,y\n1,2\n", 0, "bad.csv': line 1: the column 'radius' is missing");
  refuse("x,y,radus\n1,2,3\n", 0, "no column 'radus' in a table of grains; did you mean 'radius'?");
  refuse("x,y,radius,temperature\n", 0, "no column 'temperature' in a table of grains; it has x");
  refuse("x,y,x,radius\n", 0, "the column 'x' is there twice");
  refuse("x,y,radius [s]\n1,2,3\n", 0, "line 1: unit of column 'radius'");
  refuse("x,y,radius\n1,2,3\n", 3, "the column 'z' is missing; without it the grains are discs");
  refuse("x,y,radius,vz\n1,2,3,4\n", 0, "discs have no column 'vz'");
  refuse("x,y,radius\n1,2,3\n\n# a\n1,b,3\n", 0, "line 5: y is 'b', which is no number");
  refuse("x,y,radius\n1,,3\n", 0, "line 2: y is '', which is no number");
  refuse("x,y,radius\n1,2 m,3\n", 0, "line 2: y is '2 m', which is no number");
  refuse("x,y,radius\n1,nan,3\n", 0, "line 2: y is nan; a finite number is wanted");
  refuse("x,y,radius [km]\n1,2,1e308\n", 0, "line 2: radius is inf; a finite number is wanted");
  refuse("x;y;radius\n1,5;2,5;3\n", 0, "line 1: there is no column 'x;y;radius'");
  refuse("x,y,radius\n1;2;3\n", 0, "line 2: x is '1;2;3', which is no number");
  refuse("x,y,radius\n1,2,3\n1,2,0\n", 0, "line 3: the radius is 0 m; a radius is positive");
  refuse("x,y,radius\n1,2,-3\n", 0, "line 2: the radius is -3 m");
  refuse("x,y,radius\n1,2\n", 0, "line 2: it has 2 fields, but the header has 3");
  refuse("x,y,radius\n1,2,3,4\n", 0, "line 2: it has more fields than the header, which has 3");
  refuse("x,y,z,radius\n1,2,3,4\n", 2, "line 2: a disc stands at z = 3 m");
  refuse("x,y,radius,material\n1,2,3,\n", 0, "line 2: the material is missing");
  refuse("x,y,radius,motion\n1,2,3,frozen\n", 0, "'frozen' is no motion; free or driven");
  cdem_grain_table t;
  check_fails(cdem_read_grains(in_scratch("none.csv"), 0, &t, &fault), CDEM_FILE, "none.csv");
}

static void refuse_sizes(const char *text, const char *message) {
  int classes = -1;
  double *radius = NULL, *fraction = NULL;
  write_whole(in_scratch("bad.csv"), text);
  check_fails(cdem_read_sizes(in_scratch("bad.csv"), &classes, &radius, &fraction, &fault),
              CDEM_INPUT, message);
  assert_true(classes == -1 && radius == NULL && fraction == NULL);
}

static void classes_of_sizes(void **state) {
  (void)state;
  int classes;
  double *radius, *fraction;
  /* As other programs leave it: mark, comment, line ends, no end of the last line. */
  write_whole(in_scratch("s.csv"), "\xef\xbb\xbf# sieve\r\nfraction [%], radius[mm]\r\n30,5\r\n"
                                   "\r\n 70 , 10");
  check_ok(cdem_read_sizes(in_scratch("s.csv"), &classes, &radius, &fraction, &fault));
  assert_int_equal(classes, 2);
  check_near(radius[0], 0.005, 1e-15, 0.0);
  check_near(radius[1], 0.010, 1e-15, 0.0);
  check_near(fraction[1], 0.7, 1e-15, 0.0);
  free(radius);
  free(fraction);
  refuse_sizes("", "bad.csv': the header is missing");
  refuse_sizes("radius,fraction\n", "bad.csv': there are no classes of sizes in it");
  refuse_sizes("radius\n1\n", "line 1: the column 'fraction' is missing");
  refuse_sizes("radius,share\n", "line 1: there is no column 'share' in a table of sizes");
  refuse_sizes("radius,radius\n", "line 1: the column 'radius' is there twice");
  refuse_sizes("radius [s],fraction\n1,1\n", "line 1: unit of column 'radius'");
  refuse_sizes("radius,fraction\n1,\n", "line 2: fraction is '', which is no number");
  refuse_sizes("radius,fraction\n1\n", "line 2: it has 1 fields, but the header has 2");
  refuse_sizes("radius,fraction\n0,5,0,5\n", "line 2: it has more fields than the header");
}

static void refuses_to_write(void **state) {
  (void)state;
  cdem_grains grains = sample(2, true);
  int before = count_files(in_scratch("."));
  check_fails(cdem_write_grains(in_scratch("g.txt"), &grains, 3, names, &fault), CDEM_INPUT,
              "names no file of grains; .csv or .vtp is wanted");
  check_fails(cdem_write_grains(in_scratch("w.csv"), &grains, 2, names, &fault), CDEM_INPUT,
              "grain 2 is of material 2; there are 2 names");
  grains.radius[7] = 0.0;
  check_fails(cdem_write_grains(in_scratch("w.vtp"), &grains, 3, names, &fault), CDEM_INPUT,
              "grain 7 has radius 0 m");
  grains.radius[7] = 1.0;
  check_fails(cdem_write_grains(in_scratch("none/w.csv"), &grains, 3, names, &fault), CDEM_FILE,
              "none/w.csv");
  assert_int_equal(count_files(in_scratch(".")), before);
  cdem_grains_release(&grains);
}

/* The VTK file: as many points and vertices as grains, and the announced bytes. */
static void points(void **state) {
  (void)state;
  cdem_grains grains = sample(3, true);
  size_t bytes;
  check_ok(cdem_write_grains(in_scratch("g.vtp"), &grains, 3, names, &fault));
  char *text = read_whole(in_scratch("g.vtp"), &bytes);
  assert_non_null(strstr(text, "<Piece NumberOfPoints=\"50\" NumberOfVerts=\"50\">"));
  assert_non_null(strstr(text, "Name=\"radius\" NumberOfComponents=\"1\" Unit=\"m\""));
  const char *data = strstr(text, "encoding=\"raw\"");
  assert_non_null(data);
  data = strchr(data, '_') + 1;
  const uint64_t width[8] = {24, 8, 4, 24, 24, 1, 8, 8};
  uint64_t length;
  for (int a = 0; a < 8; a++) {
    memcpy(&length, data, sizeof length);
    assert_int_equal(length, 50 * width[a]);
    data += sizeof length;
    if (a == 0)
      assert_memory_equal(data, grains.xyz, length);
    if (a == 1)
      assert_memory_equal(data, grains.radius, length);
    data += length;
  }
  assert_non_null(strstr(data, "</VTKFile>"));
  free(text);
  cdem_grains_release(&grains);
}

static void out_of_memory(void **state) {
  (void)state;
  cdem_grains grains = sample(3, true);
  check_ok(cdem_write_grains(in_scratch("m.csv"), &grains, 3, names, &fault));
  cdem_status status = CDEM_MEMORY;
  for (int n = 0; status != CDEM_OK; n++) {
    cdem_grain_table t;
    cdem_memory_fail_after(n);
    status = cdem_read_grains(in_scratch("m.csv"), 0, &t, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || status == CDEM_MEMORY);
    cdem_grain_table_release(&t);
    memset(&fault, 0, sizeof fault);
  }
  cdem_grains_release(&grains);
  write_whole(in_scratch("m.csv"), "radius [mm],fraction\n1,2\n3,4\n");
  status = CDEM_MEMORY;
  for (int n = 0; status != CDEM_OK; n++) {
    int classes;
    double *radius = NULL, *fraction = NULL;
    cdem_memory_fail_after(n);
    status = cdem_read_sizes(in_scratch("m.csv"), &classes, &radius, &fraction, &fault);
    cdem_memory_fail_after(-1);
    assert_true(status == CDEM_OK || (status == CDEM_MEMORY && radius == NULL));
    free(radius);
    free(fraction);
    memset(&fault, 0, sizeof fault);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(round_trip),
      cmocka_unit_test(header_is_stable),
      cmocka_unit_test(other_orders_and_units),
      cmocka_unit_test(refusals),
      cmocka_unit_test(classes_of_sizes),
      cmocka_unit_test(refuses_to_write),
      cmocka_unit_test(points),
      cmocka_unit_test(out_of_memory),
  };
  return cmocka_run_group_tests_name("io grains", tests, scratch_make, scratch_remove);
}
