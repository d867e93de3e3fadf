/* Geometry files (.geo, .step, .stp), meshed by gmsh through its C interface, and surfaces (.stl),
 * whose triangles gmsh only joins at their corners.
 *
 * What gmsh needs to be told: General.AbortOnError = 0, or a meshing error ends the process;
 * General.Terminal = 0; no configuration files of the user (third argument of gmshInitialize). It
 * returns 0 from most calls that fail, so its log is read for lines that start with "Error". It
 * sets LC_NUMERIC for the whole process, which is put back. It is one process-wide session: not for
 * two threads at a time, nor while the caller has a session of its own. */
#include "io/mesh_build.h"

#include <gmshc.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* ---- the log ---- */

typedef struct {
  char **line;
  size_t lines;
} gmsh_log;

static gmsh_log take_log(void) {
  gmsh_log log = {0};
  int error = 0;
  gmshLoggerGet(&log.line, &log.lines, &error);
  return log;
}

static void release_log(gmsh_log *log) {
  for (size_t i = 0; i < log->lines; i++)
    gmshFree(log->line[i]);
  gmshFree(log->line);
}

/* gmsh ends some messages with a blank. */
static const char *trimmed(char *line) {
  for (size_t length = strlen(line); length > 0 && line[length - 1] == ' ';)
    line[--length] = '\0';
  return line;
}

/* gmsh's first error as ours; `what` says what was being done, `failed` that a call itself said so.
 * Copies the whole log: called once a step, not once an entity. */
static cdem_status judge_log(const char *what, int failed, cdem_fault *fault) {
  gmsh_log log = take_log();
  cdem_status status = CDEM_OK;
  for (size_t i = 0; i < log.lines && status == CDEM_OK; i++)
    if (strncmp(log.line[i], "Error: ", 7) == 0)
      status = cdem_fail(fault, CDEM_INPUT, "gmsh, %s: %s", what, trimmed(log.line[i] + 7));
  if (status == CDEM_OK && failed != 0)
    status = cdem_fail(fault, CDEM_INPUT, "gmsh failed %s and gave no reason", what);
  release_log(&log);
  return status;
}

static cdem_status judge_call(const char *what, int failed, cdem_fault *fault) {
  return failed == 0 ? CDEM_OK
                     : cdem_fail(fault, CDEM_INPUT, "gmsh cannot list the %s of the mesh", what);
}

/* Passes gmsh's warnings on: the first few in full. */
static void pass_warnings(const cdem_mesh_builder *builder) {
  enum { SHOWN = 5 };
  gmsh_log log = take_log();
  int warnings = 0;
  for (size_t i = 0; i < log.lines; i++)
    if (strncmp(log.line[i], "Warning: ", 9) == 0 && ++warnings <= SHOWN)
      cdem_builder_warn(builder, "gmsh: %s", trimmed(log.line[i] + 9));
  if (warnings > SHOWN)
    cdem_builder_warn(builder, "gmsh: %d more warnings", warnings - SHOWN);
  release_log(&log);
}

/* ---- from gmsh's model to the builder ---- */

static cdem_status take_nodes(cdem_mesh_builder *builder, cdem_fault *fault) {
  size_t *tag = NULL, tags = 0, coordinates = 0, parameters = 0;
  double *xyz = NULL, *parameter = NULL;
  int error = 0;
  gmshModelMeshGetNodes(&tag, &tags, &xyz, &coordinates, &parameter, &parameters, -1, -1, 0, 0,
                        &error);
  cdem_status status = judge_call("nodes", error, fault);
  if (status == CDEM_OK)
    status = cdem_mesh_reserve(&builder->mesh, (int64_t)tags, 0, 0, fault);
  for (size_t i = 0; i < tags && status == CDEM_OK; i++)
    status = cdem_builder_add_node(builder, (int64_t)tag[i], xyz + 3 * i, fault);
  gmshFree(tag);
  gmshFree(xyz);
  gmshFree(parameter);
  return status;
}

static cdem_status take_elements_of_type(int number, const size_t *tag, size_t tags,
                                         const size_t *node, cdem_mesh_builder *builder,
                                         cdem_fault *fault) {
  const cdem_gmsh_type *type = cdem_gmsh_type_find(number);
  CDEM_REQUIRE(type != NULL, fault, CDEM_INPUT,
               "elements of gmsh type %d are not known; set Mesh.ElementOrder = 1", number);
  for (size_t i = 0; i < tags; i++) {
    int64_t nodes[CDEM_SHAPE_MAX_NODES];
    if (type->shape == CDEM_SHAPE_COUNT) {
      cdem_builder_add_stranger(builder, type, (int64_t)tag[i], "");
      continue;
    }
    for (int k = 0; k < type->nodes; k++)
      nodes[k] = (int64_t)node[i * (size_t)type->nodes + (size_t)k];
    CDEM_TRY(cdem_builder_add_cell(builder, type->shape, (int64_t)tag[i], nodes, fault));
  }
  return CDEM_OK;
}

static void free_lists(size_t **list, size_t *length, size_t lists) {
  for (size_t i = 0; i < lists; i++)
    gmshFree(list[i]);
  gmshFree(list);
  gmshFree(length);
}

static cdem_status take_elements(int dimension, int entity, cdem_mesh_builder *builder,
                                 cdem_fault *fault) {
  int *type = NULL, error = 0;
  size_t types = 0, **tag = NULL, *tags = NULL, lists = 0, **node = NULL, *nodes = NULL;
  size_t node_lists = 0;
  gmshModelMeshGetElements(&type, &types, &tag, &tags, &lists, &node, &nodes, &node_lists,
                           dimension, entity, &error);
  cdem_status status = judge_call("elements", error, fault);
  for (size_t i = 0; i < types && status == CDEM_OK; i++)
    status = take_elements_of_type(type[i], tag[i], tags[i], node[i], builder, fault);
  gmshFree(type);
  free_lists(tag, tags, lists);
  free_lists(node, nodes, node_lists);
  return status;
}

/* Cells from `first` to the last join the physical groups of their entity. */
static cdem_status join_groups(int dimension, int entity, int32_t first, cdem_mesh_builder *builder,
                               cdem_fault *fault) {
  int *number = NULL, error = 0;
  size_t numbers = 0;
  gmshModelGetPhysicalGroupsForEntity(dimension, entity, &number, &numbers, &error);
  cdem_status status = judge_call("physical groups", error, fault);
  for (size_t i = 0; i < numbers && status == CDEM_OK; i++) {
    int64_t index, groups = builder->groups;
    status = cdem_builder_physical(builder, dimension, abs(number[i]), &index, fault);
    if (status == CDEM_OK && builder->groups > groups) {
      char *name = NULL;
      gmshModelGetPhysicalName(dimension, abs(number[i]), &name, &error);
      if (name != NULL && *name != '\0') {
        builder->group[index].name = cdem_copy_text(name, fault);
        status = builder->group[index].name != NULL ? CDEM_OK : CDEM_MEMORY;
      }
      gmshFree(name);
    }
    if (status == CDEM_OK)
      status = cdem_builder_add_members(builder, index, first, builder->mesh.cells - first, fault);
  }
  gmshFree(number);
  return status;
}

static cdem_status take_mesh(cdem_mesh_builder *builder, cdem_fault *fault) {
  CDEM_TRY(take_nodes(builder, fault));
  int *pair = NULL, error = 0;
  size_t numbers = 0;
  gmshModelGetEntities(&pair, &numbers, -1, &error);
  cdem_status status = judge_call("entities", error, fault);
  for (size_t i = 0; i + 1 < numbers && status == CDEM_OK; i += 2) {
    int32_t first = builder->mesh.cells;
    status = take_elements(pair[i], pair[i + 1], builder, fault);
    if (status == CDEM_OK)
      status = join_groups(pair[i], pair[i + 1], first, builder, fault);
  }
  gmshFree(pair);
  return status == CDEM_OK ? judge_log("listing the mesh", 0, fault) : status;
}

/* ---- meshing ---- */

/* True when there are elements in the entity; tag -1: in any entity of the dimension. */
static bool has_elements(int dimension, int tag) {
  int *type = NULL, error = 0;
  size_t types = 0;
  gmshModelMeshGetElementTypes(&type, &types, dimension, tag, &error);
  gmshFree(type);
  return types > 0;
}

/* gmsh leaves a volume that it cannot fill empty, at times without an error. */
static cdem_status check_filled(int dimension, cdem_fault *fault) {
  static const char *const kind[4] = {"point", "curve", "surface", "volume"};
  int *pair = NULL, error = 0;
  size_t numbers = 0;
  gmshModelGetEntities(&pair, &numbers, dimension, &error);
  cdem_status status = judge_call("entities", error, fault);
  for (size_t i = 0; i + 1 < numbers && status == CDEM_OK; i += 2)
    if (!has_elements(dimension, pair[i + 1]))
      status = cdem_fail(fault, CDEM_INPUT, "gmsh, meshing: %s %d got no elements", kind[dimension],
                         pair[i + 1]);
  gmshFree(pair);
  return status;
}

static cdem_status generate(const char *path, cdem_fault *fault) {
  int error = 0;
  gmshOpen(path, &error);
  CDEM_TRY(judge_log("reading the geometry", error, fault));
  int dimension = gmshModelGetDimension(&error);
  CDEM_REQUIRE(dimension > 0, fault, CDEM_INPUT,
               "the file has no curve, surface or volume to mesh");
  double algorithm = 0;
  gmshOptionGetNumber("Mesh.Algorithm", &algorithm, &error);
  CDEM_REQUIRE((int)algorithm != 8, fault, CDEM_INPUT,
               "Mesh.Algorithm = 8 ends gmsh 4.8 with a memory fault; set Mesh.Algorithm = 6 and "
               "keep Recombine Surface");
  if (has_elements(dimension, -1)) /* the file meshed itself (`Mesh 3;`) and may have gone on */
    return CDEM_OK;
  gmshModelMeshGenerate(dimension, &error);
  CDEM_TRY(judge_log("meshing", error, fault));
  return check_filled(dimension, fault);
}

static cdem_status run_session(const char *path, cdem_mesh_builder *builder, cdem_fault *fault) {
  int error = 0;
  gmshOptionSetNumber("General.Terminal", 0, &error);
  gmshOptionSetNumber("General.AbortOnError", 0, &error);
  /* A STEP file knows its unit; gmsh would give millimetres. A .geo file is in metres as written.
   */
  gmshOptionSetString("Geometry.OCCTargetUnit", "M", &error);
  gmshLoggerStart(&error);
  cdem_status status = generate(path, fault);
  if (status == CDEM_OK) {
    pass_warnings(builder);
    status = take_mesh(builder, fault);
  }
  gmshLoggerStop(&error);
  return status;
}

cdem_status cdem_read_geometry(const char *path, cdem_mesh_builder *builder, cdem_fault *fault) {
  int error = 0;
  char *numeric = cdem_copy_text(setlocale(LC_NUMERIC, NULL), fault);
  if (numeric == NULL)
    return CDEM_MEMORY;
  locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0), before = uselocale(c);
  gmshInitialize(0, NULL, 0, &error);
  cdem_status status = error == 0 ? run_session(path, builder, fault)
                                  : cdem_fail(fault, CDEM_INPUT, "gmsh cannot be started");
  gmshFinalize(&error);
  uselocale(before);
  freelocale(c);
  setlocale(LC_NUMERIC, numeric);
  free(numeric);
  return status;
}
