/* Room io: Abaqus and CalculiX decks: numbering, sets, and every refusal with its line. */
#include "io/mesh_support.h"

static const char deck[] = "** two squares\n"                            /* 1 */
                           "*Heading\n"                                  /* 2 */
                           " anything, 1, 2\n"                           /* 3 */
                           "*ELEMENT, TYPE=CPS4, ELSET=Left\n"           /* 4 */
                           "12, 1, 2, 5, 4\n"                            /* 5 */
                           "*element , type = cps4 ,\n"                  /* 6 */
                           "  elset = \"right part\"\n"                  /* 7 */
                           "40, 2, 3,\n"                                 /* 8 */
                           "    7000, 5\n"                               /* 9 */
                           "*NODE, NSET=all\n"                           /* 10 */
                           "1, 0., 0.\n"                                 /* 11 */
                           "2 1. 0. 0.\n"                                /* 12 */
                           "** a comment inside\n"                       /* 13 */
                           "3, 2.0D+00, 0, 0, 1, 0, 0\n"                 /* 14 */
                           "4, , 1.\r\n"                                 /* 15 */
                           "5, 1, 1\n"                                   /* 16 */
                           "\n"                                          /* 17 */
                           "7000, 2, 1.\n"                               /* 18 */
                           "*NSET, NSET=fix\n1, 4\n"                     /* 19 */
                           "*ELSET, ELSET=one\n12,\n"                    /* 21 */
                           "*ELSET, ELSET=Range, GENERATE\n12, 40, 28\n" /* 23 */
                           "*ELSET, ELSET=UNION\nleft, 40\n"             /* 25 */
                           "*ELEMENT OUTPUT\nS, E\n"                     /* 27 */
                           "*MATERIAL, NAME=m\n*ELASTIC\n210e9, .3\n*STEP\n*END STEP\n";

static void a_deck_with_its_oddities(void **state) {
  (void)state;
  cdem_mesh mesh = read_mesh(write_text("deck.INP", deck));
  assert_int_equal(mesh.nodes, 6);
  assert_int_equal(mesh.cells, 2);
  assert_int_equal(mesh.cell_tag[1], 40);
  assert_int_equal(mesh.node_tag[5], 7000);
  assert_int_equal(cdem_mesh_cell(&mesh, 1)[2], 5);
  check_near(mesh.xyz[3 * 2], 2, 0, 0);
  check_near(mesh.xyz[3 * 3], 0, 0, 0);
  assert_int_equal(mesh.groups, 5);
  check_near(group_measure(&mesh, "Left"), 1, 1e-15, 0);
  check_near(group_measure(&mesh, "right part"), 1, 1e-15, 0);
  assert_int_equal(cdem_mesh_find_group(&mesh, "one")->cells, 1);
  assert_int_equal(cdem_mesh_find_group(&mesh, "Range")->cells, 2);
  assert_int_equal(cdem_mesh_find_group(&mesh, "UNION")->cells, 2);
  cdem_mesh_release(&mesh);
}

/* Forty sets, each of which names the one before eight times, hold one element each. */
static void sets_of_sets_do_not_multiply(void **state) {
  (void)state;
  enum { SETS = 40 };
  char text[SETS * 80], *out = text;
  out += sprintf(out, "*NODE\n1,0,0\n2,1,0\n3,1,1\n*ELEMENT,TYPE=CPE3,ELSET=s0\n7,1,2,3\n");
  for (int i = 1; i <= SETS; i++) {
    out += sprintf(out, "*ELSET,ELSET=s%d\n", i);
    for (int k = 0; k < 8; k++)
      out += sprintf(out, "s%d%s", i - 1, k < 7 ? "," : "\n");
  }
  cdem_mesh mesh = read_mesh(write_text("sets.inp", text));
  assert_int_equal(mesh.groups, SETS + 1);
  assert_int_equal(cdem_mesh_find_group(&mesh, "s40")->cells, 1);
  cdem_mesh_release(&mesh);
}

/* One element of each type on the reference cube; deck order of the mid nodes from the Abaqus
 * manual: edges of the bottom, of the top, uprights (hexahedron); of the base, then to the apex
 * (tetrahedron). */
static const struct {
  const char *type;
  cdem_shape shape;
  int corners, mids;
  double volume;
  int8_t corner[8]; /* of the cube, bits x y z */
  int8_t mid[12][2];
} solids[] = {
    {"C3D4", CDEM_SHAPE_TET4, 4, 0, 1. / 6, {0, 1, 2, 4}, {{0}}},
    {"C3D5", CDEM_SHAPE_PYR5, 5, 0, 1. / 3, {0, 1, 3, 2, 4}, {{0}}},
    {"C3D6", CDEM_SHAPE_WEDGE6, 6, 0, 1. / 2, {0, 1, 2, 4, 5, 6}, {{0}}},
    {"C3D8", CDEM_SHAPE_HEX8, 8, 0, 1, {0, 1, 3, 2, 4, 5, 7, 6}, {{0}}},
    {"C3D8R", CDEM_SHAPE_HEX8, 8, 0, 1, {0, 1, 3, 2, 4, 5, 7, 6}, {{0}}},
    {"C3D10",
     CDEM_SHAPE_TET10,
     4,
     6,
     1. / 6,
     {0, 1, 2, 4},
     {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
    {"C3D20",
     CDEM_SHAPE_HEX20,
     8,
     12,
     1,
     {0, 1, 3, 2, 4, 5, 7, 6},
     {{0, 1},
      {1, 2},
      {2, 3},
      {3, 0},
      {4, 5},
      {5, 6},
      {6, 7},
      {7, 4},
      {0, 4},
      {1, 5},
      {2, 6},
      {3, 7}}},
    {"C3D20R",
     CDEM_SHAPE_HEX20,
     8,
     12,
     1,
     {0, 1, 3, 2, 4, 5, 7, 6},
     {{0, 1},
      {1, 2},
      {2, 3},
      {3, 0},
      {4, 5},
      {5, 6},
      {6, 7},
      {7, 4},
      {0, 4},
      {1, 5},
      {2, 6},
      {3, 7}}},
    {"CPS3", CDEM_SHAPE_TRI3, 3, 0, .5, {0, 1, 2}, {{0}}},
    {"CPE3", CDEM_SHAPE_TRI3, 3, 0, .5, {0, 1, 2}, {{0}}},
    {"CPE4", CDEM_SHAPE_QUAD4, 4, 0, 1, {0, 1, 3, 2}, {{0}}},
    {"CPS4R", CDEM_SHAPE_QUAD4, 4, 0, 1, {0, 1, 3, 2}, {{0}}},
    {"CPE4R", CDEM_SHAPE_QUAD4, 4, 0, 1, {0, 1, 3, 2}, {{0}}},
    {"CPS6", CDEM_SHAPE_TRI6, 3, 3, .5, {0, 1, 2}, {{0, 1}, {1, 2}, {2, 0}}},
    {"CPE6", CDEM_SHAPE_TRI6, 3, 3, .5, {0, 1, 2}, {{0, 1}, {1, 2}, {2, 0}}},
    {"CPS8", CDEM_SHAPE_QUAD8, 4, 4, 1, {0, 1, 3, 2}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
    {"CPE8", CDEM_SHAPE_QUAD8, 4, 4, 1, {0, 1, 3, 2}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
    {"CPS8R", CDEM_SHAPE_QUAD8, 4, 4, 1, {0, 1, 3, 2}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
    {"CPE8R", CDEM_SHAPE_QUAD8, 4, 4, 1, {0, 1, 3, 2}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
};

static void every_type_is_numbered_by_gmsh_afterwards(void **state) {
  (void)state;
  for (size_t s = 0; s < sizeof solids / sizeof solids[0]; s++) {
    char text[2000], *out = text;
    int nodes = solids[s].corners + solids[s].mids;
    out += sprintf(out, "*NODE\n");
    for (int n = 0; n < nodes; n++) {
      const int8_t *mid = solids[s].mid[n - solids[s].corners < 0 ? 0 : n - solids[s].corners];
      bool corner = n < solids[s].corners;
      int a = solids[s].corner[corner ? n : mid[0]], b = solids[s].corner[corner ? n : mid[1]];
      out += sprintf(out, "%d, %g, %g, %g\n", n + 1, ((a & 1) + (b & 1)) / 2.,
                     ((a >> 1 & 1) + (b >> 1 & 1)) / 2., ((a >> 2) + (b >> 2)) / 2.);
    }
    out += sprintf(out, "*ELEMENT, TYPE=%s, ELSET=all\n1", solids[s].type);
    for (int n = 0; n < nodes; n++) /* CalculiX writes no comma before the line goes on */
      out += sprintf(out, n == 15 ? "\n%d" : ", %d", n + 1);
    sprintf(out, "\n*ELEMENT, TYPE=%s\n", solids[s].type);
    heard said = {0};
    cdem_mesh mesh = {0};
    check_ok(
        cdem_read_mesh(write_text("one.inp", text), &mesh, &(cdem_warnings){&said, hear}, &fault));
    assert_int_equal(mesh.cell_shape[0], solids[s].shape);
    check_mid_nodes(&mesh, 0);
    check_near(group_measure(&mesh, "all"), solids[s].volume, 1e-15, 0);
    bool reduced = solids[s].type[strlen(solids[s].type) - 1] == 'R';
    bool plane_stress = strncmp(solids[s].type, "CPS", 3) == 0;
    assert_int_equal(said.count, reduced + plane_stress); /* once, although the type comes twice */
    if (plane_stress)
      assert_non_null(strstr(said.last, "plane stress (CPS); here --plane and --thickness decide"));
    else if (reduced)
      assert_non_null(strstr(said.last, "are taken with full integration, as C"));
    cdem_mesh_release(&mesh);
  }
}

static const struct {
  const char *old, *with, *message;
} wrong[] = {
    {"12, 1, 2, 5, 4", "12, 1, 2, 9000, 4",
     "line 5: element 12 names node 9000, which is not defined"},
    {"12, 1, 2, 5, 4", "12, 1, 2, 5, 2", "line 5: element 12 names node 2 twice"},
    {"12, 1, 2, 5, 4", "12, 1, 2, 5", "line 5: element 12 has 3 nodes, CPS4 needs 4 (a line that"},
    {"12, 1, 2, 5, 4", "12, 1, 2, 5, 4, 3", "line 5: element 12 has 5 nodes, CPS4 needs 4"},
    {"12, 1, 2, 5, 4", "12, 1, 2, , 4", "line 5: node number '' is not a whole number"},
    {"12, 1, 2, 5, 4", "12, 1, 2, 5.0, 4", "line 5: node number '5.0' is not a whole number"},
    {"12, 1, 2, 5, 4", "e12, 1, 2, 5, 4", "line 5: element number 'e12' is not a whole number"},
    {"    7000, 5\n", "    7000\n", "line 8: element 40 has 3 nodes, CPS4 needs 4"},
    {"40, 2, 3", "12, 2, 3", "line 8: element 12 is defined twice"},
    {"2 1. 0. 0.", "1 1. 0. 0.", "line 12: node 1 is defined twice"},
    {"2 1. 0. 0.", "2 1. nan 0.", "line 12: node 2: coordinate y is nan, not a finite number"},
    {"2 1. 0. 0.", "2 1. inf 0.", "line 12: node 2: coordinate y is inf, not a finite number"},
    {"2 1. 0. 0.", "2 1. 1.2.3 0.", "line 12: node 2: '1.2.3' is not a number"},
    {"2 1. 0. 0.", "2", "line 12: node 2 has no coordinates"},
    {"2 1. 0. 0.", "x 1. 0. 0.", "line 12: node number 'x' is not a whole number"},
    {"*NODE, NSET=all", "*NODE, INPUT=nodes.txt", "line 10: *NODE with INPUT="},
    {"*NODE, NSET=all", "*NODE, SYSTEM=C", "line 10: *NODE with SYSTEM="},
    {"TYPE=CPS4", "TYPE=S4", "line 4: elements of type 'S4' are not known; known are CPS"},
    {"TYPE=CPS4", "TYPE=M3D4", "line 4: elements of type 'M3D4' are not known"},
    {"TYPE=CPS4", "TYPE=C3D8I", "line 4: elements of type C3D8I have incompatible modes"},
    {"TYPE=CPS4, ", "", "line 4: *ELEMENT has no TYPE"},
    {"TYPE=CPS4", "TYPE=CPS4, INPUT=e.txt", "line 4: *ELEMENT with INPUT="},
    {"ELSET=one\n12,", "ELSET=one\n13,",
     "line 22: set 'one' names element 13, which is not defined"},
    {"ELSET=one", "NAME=one", "line 21: *ELSET has no ELSET=NAME"},
    {"12, 40, 28", "12, 40", "line 24: set 'Range' names element 13, which is not defined"},
    {"12, 40, 28", "40, 12, 1", "line 24: GENERATE in set 'Range' needs first, last"},
    {"12, 40, 28", "12, 40, 0", "line 24: GENERATE in set 'Range' needs first, last"},
    {"12, 40, 28", "12, forty", "line 24: range of a set 'forty' is not a whole number"},
    {"left, 40", "later, 40", "line 26: set 'UNION' names set 'later', which is not defined"},
    {"left, 40", "union, 40", "line 26: set 'UNION' names set 'union', which is not defined yet"},
    {"*Heading", "*INCLUDE, INPUT=more.inp", "line 2: *INCLUDE is not read; put the other file's"},
    {"*Heading", "*Ngen", "line 2: *NGEN is not read; write the nodes out"},
    {"*Heading", "*PART\n*PART", "line 3: a second *PART"},
    {"*Heading", "*INSTANCE, NAME=i", "line 3: *INSTANCE moves its part, which is not read"},
    {"** two squares\n*Heading", "words", "line 1: the file does not start with a keyword"},
};

static void errors_name_line_and_cause(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    char *text = replaced(deck, wrong[i].old, wrong[i].with);
    const char *path = write_text("wrong.inp", text);
    char start[160];
    snprintf(start, sizeof start, "cannot read '%s': line ", path);
    check_unreadable(path, CDEM_INPUT, wrong[i].message);
    check_unreadable(path, CDEM_INPUT, start);
    free(text);
  }
  check_unreadable(write_text("a.inp", ""), CDEM_INPUT, "the file is empty");
  check_unreadable(write_text("a.inp", "** only\n"), CDEM_INPUT, "no *ELEMENT lines");
  check_unreadable(write_text("a.inp", "*NODE\n1, 0, 0\n"), CDEM_INPUT, "no *ELEMENT lines");
  check_unreadable(in_folder("none.inp"), CDEM_FILE, "No such file");
}

/* Cut anywhere, a deck is read whole or refused; where it is read nothing of the mesh is missing.
 * (A deck has no end mark: cut behind a full element line it is a smaller deck, which no reader
 * can tell; so only cuts inside nodes and inside lines are asked about.) */
static void cut_decks_do_not_crash(void **state) {
  (void)state;
  for (size_t size = 0; size < sizeof deck - 1; size += 3) {
    cdem_mesh mesh = {0};
    memset(&fault, 0, sizeof fault);
    cdem_status status = cdem_read_mesh(write_bytes("cut.inp", deck, size), &mesh, NULL, &fault);
    assert_true(status == CDEM_OK || (status == CDEM_INPUT && fault.message[0] != '\0'));
    if (status == CDEM_OK)
      assert_int_equal(mesh.cells, 2);
    cdem_mesh_release(&mesh);
  }
  memset(&fault, 0, sizeof fault);
}

static void allocation_failures_leave_nothing(void **state) {
  (void)state;
  const char *path = write_text("a.inp", deck);
  for (int after = 0;; after++) {
    cdem_mesh mesh = {0};
    memset(&fault, 0, sizeof fault);
    cdem_memory_fail_after(after);
    cdem_status status = cdem_read_mesh(path, &mesh, NULL, &fault);
    cdem_memory_fail_after(-1);
    cdem_mesh_release(&mesh);
    if (status == CDEM_OK) {
      assert_true(after > 20);
      break;
    }
    assert_int_equal(status, CDEM_MEMORY);
  }
  memset(&fault, 0, sizeof fault);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_deck_with_its_oddities),
      cmocka_unit_test(sets_of_sets_do_not_multiply),
      cmocka_unit_test(every_type_is_numbered_by_gmsh_afterwards),
      cmocka_unit_test(errors_name_line_and_cause),
      cmocka_unit_test(cut_decks_do_not_crash),
      cmocka_unit_test(allocation_failures_leave_nothing),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
