/* Room io: our reader of MSH files against gmsh's own: the same files, the same mesh. gmsh writes
 * them in all four kinds. Also: the table of element types and the node order against gmsh's. */
#include "io/mesh_build.h"
#include "io/mesh_support.h"

#include <gmshc.h>

static int error;

static void start(void) {
  gmshInitialize(0, NULL, 0, &error);
  assert_int_equal(error, 0);
  gmshOptionSetNumber("General.Terminal", 0, &error);
  gmshOptionSetNumber("General.AbortOnError", 0, &error);
}

static void type_table_agrees_with_gmsh(void **state) {
  (void)state;
  start();
  int known = 0;
  for (int number = 1; number <= 140; number++) {
    const cdem_gmsh_type *type = cdem_gmsh_type_find(number);
    if (type == NULL)
      continue;
    char *name;
    double *local;
    size_t locals;
    int dimension, order, nodes, primary;
    gmshModelMeshGetElementProperties(number, &name, &dimension, &order, &nodes, &local, &locals,
                                      &primary, &error);
    assert_int_equal(type->dimension, dimension);
    assert_int_equal(type->nodes, nodes);
    known++;
    if (type->shape != CDEM_SHAPE_COUNT) {
      const cdem_shape_info *info = cdem_shape_get(type->shape);
      assert_int_equal(info->nodes, nodes);
      assert_int_equal(info->corners, primary);
      /* gmsh's reference coordinates: mid nodes in the middle of the edges of our table. */
      for (int e = 0; e < info->edges && info->edge[e][2] >= 0; e++)
        for (int i = 0; i < dimension; i++)
          check_near(
              local[dimension * info->edge[e][2] + i],
              (local[dimension * info->edge[e][0] + i] + local[dimension * info->edge[e][1] + i]) /
                  2,
              0, 1e-15);
    }
    gmshFree(name);
    gmshFree(local);
  }
  assert_true(known > 35);
  gmshFinalize(&error);
}

/* Nodes and elements as gmsh has them in memory, checked against the mesh we read. Nodes that no
 * element we keep uses are dropped by us. */
static void check_nodes(const cdem_mesh *mesh) {
  size_t *tag, tags, coordinates, parameters;
  double *xyz, *parameter;
  gmshModelMeshGetNodes(&tag, &tags, &xyz, &coordinates, &parameter, &parameters, -1, -1, 0, 0,
                        &error);
  int64_t found = 0;
  for (size_t i = 0; i < tags; i++)
    for (int32_t n = 0; n < mesh->nodes; n++)
      if (mesh->node_tag[n] == (int64_t)tag[i]) {
        found++;
        for (int k = 0; k < 3; k++) /* gmsh writes 16 digits in text */
          check_near(mesh->xyz[3 * n + k], xyz[3 * i + (size_t)k], 1e-15, 1e-15);
      }
  assert_int_equal(found, mesh->nodes);
  gmshFree(tag);
  gmshFree(xyz);
  gmshFree(parameter);
}

/* The elements of an entity are members of the same named groups on both sides. */
static int64_t check_entity(const cdem_mesh *mesh, int dimension, int entity) {
  int *type, *physical;
  size_t types, **tag, *tags, tagss, **node, *nodes, nodess, physicals;
  gmshModelMeshGetElements(&type, &types, &tag, &tags, &tagss, &node, &nodes, &nodess, dimension,
                           entity, &error);
  gmshModelGetPhysicalGroupsForEntity(dimension, entity, &physical, &physicals, &error);
  int64_t found = 0;
  for (size_t t = 0; t < types; t++)
    for (size_t i = 0; i < tags[t]; i++) {
      const cdem_gmsh_type *kind = cdem_gmsh_type_find(type[t]);
      int32_t c = 0;
      /* By nodes: gmsh writes an element of two groups under two tags in version 2.2. */
      for (; c < mesh->cells; c++) {
        if (mesh->cell_shape[c] != kind->shape)
          continue;
        int k = 0;
        while (k < kind->nodes && mesh->node_tag[cdem_mesh_cell(mesh, c)[k]] ==
                                      (int64_t)node[t][i * (size_t)kind->nodes + (size_t)k])
          k++;
        if (k == kind->nodes)
          break;
      }
      if (kind->shape == CDEM_SHAPE_POINT1 && physicals == 0) {
        continue;
      }
      assert_true(c < mesh->cells);
      found++;
      size_t member = 0;
      for (int32_t g = 0; g < mesh->groups; g++)
        for (int32_t m = 0; m < mesh->group[g].cells; m++)
          member += mesh->group[g].cell[m] == c;
      assert_int_equal(member, physicals);
      for (size_t p = 0; p < physicals; p++) {
        char *name;
        gmshModelGetPhysicalName(dimension, physical[p], &name, &error);
        const cdem_group *group = cdem_mesh_find_group(mesh, name);
        assert_non_null(group);
        int32_t m = 0;
        while (m < group->cells && group->cell[m] != c)
          m++;
        assert_true(m < group->cells);
        gmshFree(name);
      }
    }
  for (size_t t = 0; t < types; t++) {
    gmshFree(tag[t]);
    gmshFree(node[t]);
  }
  gmshFree(tag);
  gmshFree(tags);
  gmshFree(node);
  gmshFree(nodes);
  gmshFree(type);
  gmshFree(physical);
  return found;
}

static void check_against_gmsh(const cdem_mesh *mesh) {
  int *pair;
  size_t numbers;
  int64_t found = 0;
  check_nodes(mesh);
  gmshModelGetEntities(&pair, &numbers, -1, &error);
  for (size_t i = 0; i < numbers; i += 2)
    found += check_entity(mesh, pair[i], pair[i + 1]);
  assert_int_equal(found, mesh->cells);
  gmshFree(pair);
}

/* A slanted quadrilateral or its extrusion: triangles, tetrahedra, or with order 2 in space all
 * hexahedra. Small, because the comparison is all with all. Two physical groups share the body. */
static void build_model(bool solid, int order) {
  gmshModelAdd("m", &error);
  int corner[4], side[4];
  const double x[4][2] = {{0, 0}, {1.3, 0}, {1.1, 1}, {0, 0.9}};
  for (int i = 0; i < 4; i++)
    corner[i] = gmshModelGeoAddPoint(x[i][0], x[i][1], 0.1, 0.5, -1, &error);
  for (int i = 0; i < 4; i++)
    side[i] = gmshModelGeoAddLine(corner[i], corner[(i + 1) % 4], -1, &error);
  int loop = gmshModelGeoAddCurveLoop(side, 4, -1, 0, &error);
  int surface = gmshModelGeoAddPlaneSurface(&loop, 1, -1, &error);
  int *out = NULL, volume = 0;
  size_t outs;
  if (solid) {
    int from[2] = {2, surface}, layers[1] = {2};
    gmshModelGeoExtrude(from, 2, 0.1, 0, 1, &out, &outs, layers, 1, NULL, 0, order == 2, &error);
    volume = out[3];
    gmshFree(out);
  }
  gmshModelGeoSynchronize(&error);
  if (solid && order == 2) { /* all hexahedra: quadrilaterals extruded */
    for (int i = 0; i < 4; i++)
      gmshModelMeshSetTransfiniteCurve(side[i], 3, "Progression", 1.2, &error);
    gmshModelMeshSetTransfiniteSurface(surface, "Left", NULL, 0, &error);
    gmshModelMeshSetRecombine(2, surface, &error);
  }
  int body = solid ? volume : surface, dimension = solid ? 3 : 2;
  int one = gmshModelAddPhysicalGroup(dimension, &body, 1, 11, &error);
  int two = gmshModelAddPhysicalGroup(dimension, &body, 1, 12, &error);
  int sides =
      gmshModelAddPhysicalGroup(dimension - 1, solid ? &surface : side, solid ? 1 : 2, 5, &error);
  gmshModelSetPhysicalName(dimension, one, "all of it", &error);
  gmshModelSetPhysicalName(dimension, two, "again", &error);
  gmshModelSetPhysicalName(dimension - 1, sides, "side", &error);
  gmshOptionSetNumber("Mesh.ElementOrder", order, &error);
  gmshOptionSetNumber("Mesh.SecondOrderIncomplete", 1, &error);
  gmshModelMeshGenerate(dimension, &error);
  assert_int_equal(error, 0);
}

static const struct {
  bool solid;
  int order;
  cdem_shape shape;
} models[] = {{false, 1, CDEM_SHAPE_TRI3},
              {false, 2, CDEM_SHAPE_TRI6},
              {true, 1, CDEM_SHAPE_TET4},
              {true, 2, CDEM_SHAPE_HEX20}};

static void all_kinds_of_file_agree_with_gmsh(void **state) {
  (void)state;
  for (int m = 0; m < 4; m++) {
    start();
    build_model(models[m].solid, models[m].order);
    const char *dimension_group = "all of it";
    cdem_mesh first = {0};
    for (int kind = 0; kind < 4; kind++) {
      gmshOptionSetNumber("Mesh.MshFileVersion", kind < 2 ? 2.2 : 4.1, &error);
      gmshOptionSetNumber("Mesh.Binary", kind % 2, &error);
      gmshWrite(in_folder("model.msh"), &error);
      cdem_mesh mesh = read_mesh(in_folder("model.msh"));
      assert_int_equal(count_shape(&mesh, models[m].shape),
                       cdem_mesh_find_group(&mesh, dimension_group)->cells);
      group_measure(&mesh, dimension_group);
      check_mid_nodes(&mesh, 1e-12);
      if (kind == 0) {
        first = mesh;
        continue;
      }
      /* gmsh saves only elements of groups; all files hold the same ones in the same order. */
      assert_int_equal(mesh.nodes, first.nodes);
      assert_int_equal(mesh.cells, first.cells);
      assert_int_equal(mesh.groups, 3);
      cdem_mesh_release(&mesh);
    }
    cdem_mesh_release(&first);
    /* With Mesh.SaveAll the file holds what gmsh has in memory. */
    gmshOptionSetNumber("Mesh.SaveAll", 1, &error);
    for (int kind = 0; kind < 2; kind++) { /* 2.2 then loses the groups, which is gmsh's way */
      gmshOptionSetNumber("Mesh.MshFileVersion", 4.1, &error);
      gmshOptionSetNumber("Mesh.Binary", kind, &error);
      gmshWrite(in_folder("model.msh"), &error);
      cdem_mesh mesh = read_mesh(in_folder("model.msh"));
      check_against_gmsh(&mesh);
      cdem_mesh_release(&mesh);
    }
    gmshFinalize(&error);
  }
}

/* Bytes of every number turned round: a file from a machine of the other order. */
static void other_byte_order(void **state) {
  (void)state;
  struct {
    char format[20];
    unsigned char data[200];
  } file;
  memset(&file, 0, sizeof file);
  char *out = (char *)&file, *begin = out;
  out += sprintf(out, "$MeshFormat\n2.2 1 8\n");
#define PUT4(value)                                                                                \
  do {                                                                                             \
    uint32_t raw = __builtin_bswap32((uint32_t)(value));                                           \
    memcpy(out, &raw, 4);                                                                          \
    out += 4;                                                                                      \
  } while (0)
#define PUT8(value)                                                                                \
  do {                                                                                             \
    double number = (value);                                                                       \
    uint64_t raw;                                                                                  \
    memcpy(&raw, &number, 8);                                                                      \
    raw = __builtin_bswap64(raw);                                                                  \
    memcpy(out, &raw, 8);                                                                          \
    out += 8;                                                                                      \
  } while (0)
  PUT4(1);
  out += sprintf(out, "\n$EndMeshFormat\n$Nodes\n2\n");
  for (int n = 0; n < 2; n++) {
    PUT4(n + 1);
    PUT8(n * 0.25);
    PUT8(0);
    PUT8(-n);
  }
  out += sprintf(out, "\n$EndNodes\n$Elements\n1\n");
  const int32_t element[] = {1, 1, 2, 9, 3, 1, 1, 2};
  for (int i = 0; i < 8; i++)
    PUT4(element[i]);
  out += sprintf(out, "\n$EndElements\n");
  cdem_mesh mesh = read_mesh(write_bytes("swapped.msh", begin, (size_t)(out - begin)));
  assert_int_equal(mesh.cell_tag[0], 9);
  check_near(mesh.xyz[3], 0.25, 0, 0);
  check_near(mesh.xyz[5], -1, 0, 0);
  assert_non_null(cdem_mesh_find_group(&mesh, "3"));
  cdem_mesh_release(&mesh);
}

/* Cut at some sixty places and more, no file crashes the reader or gives part of a mesh. */
static void cut_files_are_refused(void **state) {
  (void)state;
  start();
  build_model(true, 2);
  for (int kind = 0; kind < 4; kind++) {
    gmshOptionSetNumber("Mesh.MshFileVersion", kind < 2 ? 2.2 : 4.1, &error);
    gmshOptionSetNumber("Mesh.Binary", kind % 2, &error);
    gmshWrite(in_folder("whole.msh"), &error);
    size_t size;
    char *data = read_bytes(in_folder("whole.msh"), &size);
    for (int cut = 0; cut < 120; cut++) {
      /* half of them evenly, half among the last bytes, where the end marks are */
      size_t kept = cut < 60 ? size * (size_t)cut / 60 : size - 2 - (size_t)(cut - 60);
      cdem_mesh mesh = {0};
      memset(&fault, 0, sizeof fault);
      assert_int_equal(cdem_read_mesh(write_bytes("cut.msh", data, kept), &mesh, NULL, &fault),
                       CDEM_INPUT);
      assert_non_null(strstr(fault.message, "cannot read"));
      assert_null(mesh.xyz);
    }
    free(data);
  }
  memset(&fault, 0, sizeof fault);
  gmshFinalize(&error);
}

/* Random bytes replaced: refused or read, never a crash, never an invalid mesh. */
static void damaged_files_do_not_crash(void **state) {
  (void)state;
  start();
  build_model(true, 2);
  cdem_random random = {2024};
  for (int kind = 0; kind < 4; kind++) {
    gmshOptionSetNumber("Mesh.MshFileVersion", kind < 2 ? 2.2 : 4.1, &error);
    gmshOptionSetNumber("Mesh.Binary", kind % 2, &error);
    gmshWrite(in_folder("whole.msh"), &error);
    size_t size;
    char *data = read_bytes(in_folder("whole.msh"), &size);
    for (int trial = 0; trial < 150; trial++) {
      size_t at = cdem_random_next(&random) % size;
      char old = data[at];
      data[at] = (char)cdem_random_next(&random);
      cdem_mesh mesh = {0};
      memset(&fault, 0, sizeof fault);
      cdem_status status = cdem_read_mesh(write_bytes("bad.msh", data, size), &mesh, NULL, &fault);
      assert_true(status == CDEM_OK || status == CDEM_INPUT);
      if (status == CDEM_OK)
        assert_int_equal(cdem_mesh_check(&mesh, NULL), CDEM_OK);
      cdem_mesh_release(&mesh);
      data[at] = old;
    }
    free(data);
  }
  memset(&fault, 0, sizeof fault);
  gmshFinalize(&error);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(type_table_agrees_with_gmsh),
      cmocka_unit_test(all_kinds_of_file_agree_with_gmsh),
      cmocka_unit_test(other_byte_order),
      cmocka_unit_test(cut_files_are_refused),
      cmocka_unit_test(damaged_files_do_not_crash),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
