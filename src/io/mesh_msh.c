/* gmsh's own mesh files, MSH 2.2 and 4.1, ASCII and binary (gmsh manual, "MSH file format").
 *
 * Why not through gmsh: it reads a file whose last section is cut off, a coordinate that is not a
 * number and a tag used twice without a word, keeps what it has read when it meets an error, gives
 * no line numbers, and hangs the groups of a 2.2 file on its entities, where the file gives each
 * element its own. A test reads the same files through gmsh and compares.
 *
 * One parser serves both encodings: `next_int`, `next_size` and `next_real` take a word of text or
 * so many bytes. Counts are checked against what the file can hold before anything is allocated. */
#include "io/mesh_msh.h"

#include <ctype.h>
#include <inttypes.h>
#include <string.h>

/* ---- words and numbers ---- */

static void skip_space(cdem_text *text) {
  for (; text->at < text->end && isspace((unsigned char)*text->at); text->at++)
    text->line += *text->at == '\n';
}

/* The next word, which must not be a section's end; its length. */
static cdem_status next_word(cdem_text *text, const char **word, int *length, cdem_fault *fault) {
  skip_space(text);
  *word = text->at;
  const char *end = text->at;
  while (end < text->end && !isspace((unsigned char)*end))
    end++;
  if (end == text->at)
    return cdem_text_fail(text, fault, "the file ends inside %s; it is not complete",
                          text->section);
  *length = end - text->at > 60 ? 60 : (int)(end - text->at);
  text->at = end;
  return CDEM_OK;
}

static cdem_status need_bytes(const cdem_text *text, int64_t bytes, cdem_fault *fault) {
  if (text->end - text->at < bytes)
    return cdem_text_fail(text, fault, "the file ends inside %s; it is not complete",
                          text->section);
  return CDEM_OK;
}

/* "$EndNodes" where a number should be deserves better than "not a number". */
static cdem_status bad_word(const cdem_text *text, const char *word, int length, const char *wanted,
                            cdem_fault *fault) {
  if (*word == '$')
    return cdem_text_fail(text, fault, "%.*s comes before all entries announced by %s", length,
                          word, text->section);
  return cdem_text_fail(text, fault, "'%.*s' in %s is not a %s", length, word, text->section,
                        wanted);
}

static cdem_status next_whole(cdem_text *text, int64_t *value, cdem_fault *fault) {
  const char *word;
  int length;
  CDEM_TRY(next_word(text, &word, &length, fault));
  if (!cdem_parse_whole(word, text->at - word, value))
    return bad_word(text, word, length, "whole number", fault);
  return CDEM_OK;
}

cdem_status cdem_msh_int(cdem_text *text, int64_t *value, cdem_fault *fault) {
  if (!text->binary)
    return next_whole(text, value, fault);
  uint32_t raw;
  CDEM_TRY(need_bytes(text, sizeof raw, fault));
  memcpy(&raw, text->at, sizeof raw);
  text->at += sizeof raw;
  *value = (int32_t)(text->swapped ? __builtin_bswap32(raw) : raw);
  return CDEM_OK;
}

cdem_status cdem_msh_size(cdem_text *text, int64_t *value, cdem_fault *fault) {
  if (!text->binary)
    return next_whole(text, value, fault);
  uint64_t raw;
  CDEM_TRY(need_bytes(text, sizeof raw, fault));
  memcpy(&raw, text->at, sizeof raw);
  text->at += sizeof raw;
  *value = (int64_t)(text->swapped ? __builtin_bswap64(raw) : raw);
  return CDEM_OK;
}

cdem_status cdem_msh_real(cdem_text *text, double *value, cdem_fault *fault) {
  if (text->binary) {
    uint64_t raw;
    CDEM_TRY(need_bytes(text, sizeof raw, fault));
    memcpy(&raw, text->at, sizeof raw);
    text->at += sizeof raw;
    raw = text->swapped ? __builtin_bswap64(raw) : raw;
    memcpy(value, &raw, sizeof raw);
    return CDEM_OK;
  }
  const char *word;
  int length;
  CDEM_TRY(next_word(text, &word, &length, fault));
  if (!cdem_parse_real(word, text->at - word, text->locale, value))
    return bad_word(text, word, length, "number", fault);
  return CDEM_OK;
}

cdem_status cdem_msh_count(cdem_text *text, int64_t least, int64_t *count, cdem_fault *fault) {
  CDEM_TRY(cdem_msh_size(text, count, fault));
  return cdem_msh_check_count(text, *count, least, fault);
}

cdem_status cdem_msh_check_count(const cdem_text *text, int64_t count, int64_t least,
                                 cdem_fault *fault) {
  if (count < 0 || count > (text->end - text->at) / least)
    return cdem_text_fail(text, fault,
                          "%s announces %" PRId64 " entries, but only %" PRId64
                          " bytes follow; the file is not complete",
                          text->section, count, (int64_t)(text->end - text->at));
  return CDEM_OK;
}

cdem_status cdem_msh_text_count(cdem_text *text, int64_t least, int64_t *count, cdem_fault *fault) {
  CDEM_TRY(next_whole(text, count, fault));
  if (text->binary && text->at < text->end && *text->at == '\r')
    text->at++;
  if (text->binary && text->at < text->end && *text->at == '\n')
    text->at++;
  return cdem_msh_check_count(text, *count, least, fault);
}

/* ---- small sections ---- */

static cdem_status read_format(cdem_text *text, int *version, cdem_fault *fault) {
  const char *word;
  int length;
  int64_t binary, size;
  CDEM_TRY(next_word(text, &word, &length, fault));
  bool is22 = length == 3 && memcmp(word, "2.2", 3) == 0;
  bool is41 = length == 3 && memcmp(word, "4.1", 3) == 0;
  if (!is22 && !is41)
    return cdem_text_fail(text, fault,
                          "MSH version %.*s is not read, only 2.2 and 4.1; convert the file with "
                          "`gmsh OLD.msh -save -format msh41 -o NEW.msh`",
                          length, word);
  *version = is22 ? 2 : 4;
  CDEM_TRY(next_whole(text, &binary, fault));
  CDEM_TRY(next_whole(text, &size, fault));
  if ((binary != 0 && binary != 1) || size != 8)
    return cdem_text_fail(
        text, fault, "the file type %" PRId64 " and data size %" PRId64 " must be 0 or 1, and 8",
        binary, size);
  if (binary == 0)
    return CDEM_OK;
  text->at += text->at < text->end && *text->at == '\r';
  text->at += text->at < text->end && *text->at == '\n';
  text->binary = true;
  int64_t one;
  CDEM_TRY(cdem_msh_int(text, &one, fault));
  text->swapped = one == 0x01000000;
  if (one != 1 && !text->swapped)
    return cdem_text_fail(text, fault, "the binary file does not start with the number 1");
  return CDEM_OK;
}

/* dim number "name", in text in binary files too. */
static cdem_status read_physical_name(cdem_text *text, cdem_mesh_builder *builder,
                                      cdem_fault *fault) {
  int64_t dimension, number, index;
  CDEM_TRY(next_whole(text, &dimension, fault));
  CDEM_TRY(next_whole(text, &number, fault));
  skip_space(text);
  const char *from = text->at + 1;
  const char *to = text->at < text->end && *text->at == '"'
                       ? memchr(from, '"', (size_t)(text->end - from))
                       : NULL;
  if (dimension < 0 || dimension > 3 || to == NULL || memchr(from, '\n', (size_t)(to - from)))
    return cdem_text_fail(text, fault,
                          "a physical name is a dimension (0 to 3), a number and a name in "
                          "quotation marks");
  text->at = to + 1;
  CDEM_TRY(cdem_builder_physical(builder, (int)dimension, number, &index, fault));
  if (builder->group[index].name != NULL)
    return cdem_text_fail(text, fault,
                          "physical group %" PRId64 " of dimension %" PRId64 " is named twice",
                          number, dimension);
  char *name = cdem_allocate(to - from + 1, 1, fault);
  if (name == NULL)
    return CDEM_MEMORY;
  memcpy(name, from, (size_t)(to - from));
  builder->group[index].name = name;
  return CDEM_OK;
}

static cdem_status read_physical_names(cdem_text *text, cdem_mesh_builder *builder,
                                       cdem_fault *fault) {
  int64_t count;
  CDEM_TRY(next_whole(text, &count, fault));
  for (int64_t i = 0; i < count; i++)
    CDEM_TRY(read_physical_name(text, builder, fault));
  return CDEM_OK;
}

/* ---- sections ---- */

/* The rest of a section that carries nothing for us ($NodeData, $Periodic ...): to its end mark. */
static cdem_status skip_section(cdem_text *text, const char *name, int length, cdem_fault *fault) {
  char mark[80];
  int size = snprintf(mark, sizeof mark, "$End%.*s", length, name);
  const char *end = memmem(text->at, (size_t)(text->end - text->at), mark, (size_t)size);
  if (end == NULL)
    return cdem_text_fail(text, fault, "section $%.*s is not closed by %s", length, name, mark);
  for (; text->at < end; text->at++)
    text->line += *text->at == '\n';
  return CDEM_OK;
}

static cdem_status close_section(cdem_text *text, const char *name, cdem_fault *fault) {
  const char *word;
  int length;
  char mark[80];
  int size = snprintf(mark, sizeof mark, "$End%s", name + 1);
  skip_space(text);
  if (text->at == text->end)
    return cdem_text_fail(text, fault, "the file ends where %s should stand; it is not complete",
                          mark);
  CDEM_TRY(next_word(text, &word, &length, fault));
  if (length != size || memcmp(word, mark, (size_t)size) != 0)
    return cdem_text_fail(text, fault, "'%.*s' stands where %s should: more entries than announced",
                          length, word, mark);
  return CDEM_OK;
}

typedef enum { FORMAT, NAMES, ENTITIES, NODES, ELEMENTS, PARTITIONED, OTHER } section;
static const char *const section_name[OTHER] = {
    "$MeshFormat", "$PhysicalNames", "$Entities", "$Nodes", "$Elements", "$PartitionedEntities"};

typedef struct {
  cdem_text *text;
  cdem_mesh_builder *builder;
  int version; /* 0: $MeshFormat is still to come */
  bool done[OTHER];
  cdem_msh_entities entities;
} msh_reader;

static cdem_status read_body(msh_reader *reader, section which, cdem_fault *fault) {
  cdem_text *text = reader->text;
  switch (which) {
  case FORMAT:
    return read_format(text, &reader->version, fault);
  case NAMES:
    return read_physical_names(text, reader->builder, fault);
  case ENTITIES:
    return cdem_msh_read_entities(text, &reader->entities, fault);
  case NODES:
    return reader->version == 2 ? cdem_msh2_read_nodes(text, reader->builder, fault)
                                : cdem_msh4_read_nodes(text, reader->builder, fault);
  case ELEMENTS:
    return reader->version == 2
               ? cdem_msh2_read_elements(text, reader->builder, fault)
               : cdem_msh4_read_elements(text, &reader->entities, reader->builder, fault);
  default:
    return CDEM_OK; /* refused before */
  }
}

/* To the line after "$Nodes", where binary data may start at once. */
static void end_line(cdem_text *text) {
  text->at += text->at < text->end && *text->at == '\r';
  if (text->at < text->end && *text->at == '\n') {
    text->at++;
    text->line++;
  }
}

static cdem_status read_section(msh_reader *reader, const char *name, int length,
                                cdem_fault *fault) {
  cdem_text *text = reader->text;
  int which = 0;
  while (which < OTHER && ((int)strlen(section_name[which]) != length + 1 ||
                           memcmp(section_name[which] + 1, name, (size_t)length) != 0))
    which++;
  if (which != FORMAT && which != OTHER && reader->version == 0)
    return cdem_text_fail(text, fault, "$%.*s comes before $MeshFormat", length, name);
  if (which == OTHER) {
    CDEM_TRY(skip_section(text, name, length, fault));
    const char *mark;
    return next_word(text, &mark, &length, fault);
  }
  if (reader->done[which])
    return cdem_text_fail(text, fault, "a second section %s", section_name[which]);
  if (which == ELEMENTS && !reader->done[NODES])
    return cdem_text_fail(text, fault, "$Elements comes before $Nodes");
  if (which == PARTITIONED)
    return cdem_text_fail(text, fault,
                          "the mesh is partitioned, which is not read; save it without partitions "
                          "(gmsh: Mesh > Unpartition)");
  end_line(text);
  text->section = section_name[which];
  CDEM_TRY(read_body(reader, (section)which, fault));
  reader->done[which] = true;
  return close_section(text, section_name[which], fault);
}

static cdem_status read_sections(msh_reader *reader, cdem_fault *fault) {
  cdem_text *text = reader->text;
  if (text->size == 0)
    return cdem_fail(fault, CDEM_INPUT, "the file is empty");
  for (skip_space(text); text->at < text->end; skip_space(text)) {
    const char *word;
    int length;
    CDEM_TRY(next_word(text, &word, &length, fault));
    if (reader->version == 0 && (*word != '$' || strncmp(word, "$NOD", 4) == 0))
      return cdem_text_fail(text, fault,
                            "the file does not start with $MeshFormat: it is no MSH file of "
                            "version 2.2 or 4.1");
    if (*word != '$' || length < 2)
      return cdem_text_fail(
          text, fault, "'%.*s' stands where a section such as $Nodes should start", length, word);
    CDEM_TRY(read_section(reader, word + 1, length - 1, fault));
  }
  for (int which = NODES; which <= ELEMENTS; which++)
    if (!reader->done[which])
      return cdem_fail(fault, CDEM_INPUT, "the file has no section %s; it is not complete",
                       section_name[which]);
  return CDEM_OK;
}

cdem_status cdem_read_msh(cdem_text *text, cdem_mesh_builder *builder, cdem_fault *fault) {
  msh_reader reader = {.text = text, .builder = builder};
  cdem_status status = read_sections(&reader, fault);
  cdem_msh_entities_release(&reader.entities);
  return status;
}
