/* Private to room io: what the mesh readers share.
 *
 * A reader walks its file once and hands nodes, elements and group members to a builder, which
 * turns tags into ids on the spot, so that an error is found while the reader still knows the line.
 * cdem_builder_finish drops what no one needs (point cells outside groups, unused nodes), names
 * the groups and gives the mesh away.
 */
#ifndef CDEM_IO_MESH_BUILD_H
#define CDEM_IO_MESH_BUILD_H

#include "io/io.h"

#include <locale.h>

/* ---- tags ---- */

/* From tags to ids 0, 1, 2 ... in the order of adding. Costs no memory while tags count upwards
 * without gaps, which most files do; a hash table from the first exception on. */
typedef struct {
  int64_t first, count;
  int64_t slots; /* 0: still counting upwards */
  int64_t *tag;  /* [slots] */
  int32_t *id;   /* [slots] 1 + id, 0: free */
} cdem_tag_map;

/* *fresh: false when the tag is already there. */
cdem_status cdem_tag_map_add(cdem_tag_map *map, int64_t tag, bool *fresh, cdem_fault *fault);
/* -1 when there is none. */
int32_t cdem_tag_map_find(const cdem_tag_map *map, int64_t tag);
void cdem_tag_map_release(cdem_tag_map *map);

/* ---- gmsh's element types ---- */

typedef struct {
  int type;         /* gmsh's number */
  cdem_shape shape; /* CDEM_SHAPE_COUNT: not one of ours */
  int dimension, nodes;
  const char *name;
  const char *remedy; /* for a type that is not ours */
} cdem_gmsh_type;

/* NULL for a number gmsh does not document. */
const cdem_gmsh_type *cdem_gmsh_type_find(int64_t type);

/* ---- builder ---- */

typedef struct {
  char *name; /* NULL: an unnamed physical group */
  int dimension;
  int64_t number; /* of the physical group */
  int64_t cells;
  int32_t *cell;
  int64_t capacity;
} cdem_build_group;

/* First element, of a dimension, whose type is not ours. */
typedef struct {
  const cdem_gmsh_type *type;
  int64_t tag, count;
  char where[48]; /* "line 12: " */
} cdem_build_stranger;

typedef struct {
  const cdem_warnings *warnings;
  cdem_mesh mesh;
  cdem_tag_map node, cell;
  int64_t groups, group_capacity;
  cdem_build_group *group;
  cdem_build_stranger stranger[4]; /* by dimension */
  int32_t *same_as; /* [cells] id of the cell to merge into, or NULL: nothing to merge */
} cdem_mesh_builder;

void cdem_builder_release(cdem_mesh_builder *builder);

/* Messages are without the place: the caller prefixes it. */
cdem_status cdem_builder_add_node(cdem_mesh_builder *builder, int64_t tag, const double xyz[3],
                                  cdem_fault *fault);
/* The same in two steps, for files that list tags first; nodes are placed in the order of claiming.
 */
cdem_status cdem_builder_claim_node(cdem_mesh_builder *builder, int64_t tag, cdem_fault *fault);
cdem_status cdem_builder_place_node(cdem_mesh_builder *builder, int64_t tag, const double xyz[3],
                                    cdem_fault *fault);
/* node_tag [nodes of the shape]; the id of the new cell is mesh.cells - 1. */
cdem_status cdem_builder_add_cell(cdem_mesh_builder *builder, cdem_shape shape, int64_t tag,
                                  const int64_t *node_tag, cdem_fault *fault);
/* An element of a type that is not ours; where: "line 12: " or "". */
void cdem_builder_add_stranger(cdem_mesh_builder *builder, const cdem_gmsh_type *type, int64_t tag,
                               const char *where);

/* Index of the physical group (dimension, number), made when new. */
cdem_status cdem_builder_physical(cdem_mesh_builder *builder, int dimension, int64_t number,
                                  int64_t *index, cdem_fault *fault);
/* Index of the group called `name` (letter case does not count), made when new. */
cdem_status cdem_builder_named(cdem_mesh_builder *builder, const char *name, int64_t *index,
                               cdem_fault *fault);
/* Appends cells first .. first + count - 1. */
cdem_status cdem_builder_add_members(cdem_mesh_builder *builder, int64_t index, int32_t first,
                                     int64_t count, cdem_fault *fault);
/* Says something to the caller's callback, if there is one. */
void cdem_builder_warn(const cdem_mesh_builder *builder, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Gives the mesh away: *mesh receives it (without source); the builder is then empty but must still
 * be released. */
cdem_status cdem_builder_finish(cdem_mesh_builder *builder, cdem_mesh *mesh, cdem_fault *fault);

/* ---- files as text ---- */

/* The whole file in memory, with a 0 behind it, and a place in it. */
typedef struct {
  char *data;
  int64_t size;
  const char *at, *end;
  int64_t line;        /* of `at`, from 1 */
  const char *section; /* for messages: what is being read */
  locale_t locale;     /* "C": numbers have a decimal point whatever the process's locale is */
  bool binary;         /* msh: data of the sections is binary */
  bool regular;        /* the file can be read a second time */
  bool swapped;        /* and of the other byte order */
} cdem_text;

/* CDEM_FILE when it cannot be read. */
cdem_status cdem_text_open(const char *path, cdem_text *text, cdem_fault *fault);
void cdem_text_release(cdem_text *text);

/* CDEM_INPUT with "line N: " (binary data: "byte N: ") before the message. */
cdem_status cdem_text_fail(const cdem_text *text, cdem_fault *fault, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The same place as text, "line N: ". */
void cdem_text_where(const cdem_text *text, char where[48]);
/* Puts the place before a message of the builder. */
cdem_status cdem_text_prefix(const cdem_text *text, cdem_fault *fault, cdem_status status);

/* Numbers: `length` characters at `from`, all of them. False when they are no such number; NaN and
 * infinity are read (the builder refuses them by name). */
bool cdem_parse_whole(const char *from, int64_t length, int64_t *value);
bool cdem_parse_real(const char *from, int64_t length, locale_t locale, double *value);

/* ---- readers by format ---- */

cdem_status cdem_read_msh(cdem_text *text, cdem_mesh_builder *builder, cdem_fault *fault);
cdem_status cdem_read_inp(cdem_text *text, cdem_mesh_builder *builder, cdem_fault *fault);
/* .geo, .step, .stp, .stl */
cdem_status cdem_read_geometry(const char *path, cdem_mesh_builder *builder, cdem_fault *fault);

#endif
