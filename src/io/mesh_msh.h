/* Private to the reader of MSH files: numbers in either encoding (mesh_msh.c), and the large
 * sections by version (mesh_msh2.c, mesh_msh4.c). */
#ifndef CDEM_IO_MESH_MSH_H
#define CDEM_IO_MESH_MSH_H

#include "io/mesh_build.h"

/* The next number: a word of text, or 4 (int) or 8 bytes. Failures name place and section. */
cdem_status cdem_msh_int(cdem_text *text, int64_t *value, cdem_fault *fault);
cdem_status cdem_msh_size(cdem_text *text, int64_t *value, cdem_fault *fault);
cdem_status cdem_msh_real(cdem_text *text, double *value, cdem_fault *fault);
/* A count of entries, each of at least `least` bytes, which the rest of the file must be able to
 * hold; cdem_msh_text_count reads a count that is a line of text in binary files too. */
cdem_status cdem_msh_count(cdem_text *text, int64_t least, int64_t *count, cdem_fault *fault);
cdem_status cdem_msh_text_count(cdem_text *text, int64_t least, int64_t *count, cdem_fault *fault);
cdem_status cdem_msh_check_count(const cdem_text *text, int64_t count, int64_t least,
                                 cdem_fault *fault);

/* Physical groups of the geometric entities of version 4.1. */
typedef struct {
  int dimension;
  int64_t tag;
  int64_t first, groups; /* in cdem_msh_entities.physical */
} cdem_msh_entity;

typedef struct {
  int64_t entities, entity_capacity;
  cdem_msh_entity *entity;
  int64_t physicals, physical_capacity;
  int64_t *physical;
} cdem_msh_entities;

cdem_status cdem_msh_read_entities(cdem_text *text, cdem_msh_entities *entities, cdem_fault *fault);
void cdem_msh_entities_release(cdem_msh_entities *entities);

cdem_status cdem_msh2_read_nodes(cdem_text *text, cdem_mesh_builder *builder, cdem_fault *fault);
cdem_status cdem_msh2_read_elements(cdem_text *text, cdem_mesh_builder *builder, cdem_fault *fault);
cdem_status cdem_msh4_read_nodes(cdem_text *text, cdem_mesh_builder *builder, cdem_fault *fault);
cdem_status cdem_msh4_read_elements(cdem_text *text, const cdem_msh_entities *entities,
                                    cdem_mesh_builder *builder, cdem_fault *fault);

#endif
