/* Abaqus and CalculiX input decks: nodes, elements and element sets; steps, materials and output
 * requests are passed over.
 *
 * Blocks may come in any order, so the deck is walked three times: nodes, elements, sets. Keywords
 * that would change or make nodes and elements (*INCLUDE, *NGEN, *SYSTEM ...) are refused, because
 * passing over them would give another mesh than the deck means. */
#include "io/mesh_build.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- element types ---- */

typedef struct {
  const char *name;
  cdem_shape shape;
  bool reduced;
  const int8_t *order; /* place in the deck of our node i, NULL: the same */
} inp_type;

/* Abaqus numbers mid nodes face by face: bottom, top, uprights; gmsh by the lower corner. */
static const int8_t tet10_order[] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
static const int8_t hex20_order[] = {0,  1, 2,  3,  4,  5,  6,  7,  8,  11,
                                     16, 9, 17, 10, 18, 19, 12, 15, 13, 14};

static const inp_type types[] = {
    {"T3D2", CDEM_SHAPE_LINE2, false, NULL},
    {"T3D3", CDEM_SHAPE_LINE3, false, NULL},
    {"CPS3", CDEM_SHAPE_TRI3, false, NULL},
    {"CPE3", CDEM_SHAPE_TRI3, false, NULL},
    {"CPS4", CDEM_SHAPE_QUAD4, false, NULL},
    {"CPE4", CDEM_SHAPE_QUAD4, false, NULL},
    {"CPS6", CDEM_SHAPE_TRI6, false, NULL},
    {"CPE6", CDEM_SHAPE_TRI6, false, NULL},
    {"CPS8", CDEM_SHAPE_QUAD8, false, NULL},
    {"CPE8", CDEM_SHAPE_QUAD8, false, NULL},
    {"C3D4", CDEM_SHAPE_TET4, false, NULL},
    {"C3D5", CDEM_SHAPE_PYR5, false, NULL},
    {"C3D6", CDEM_SHAPE_WEDGE6, false, NULL},
    {"C3D8", CDEM_SHAPE_HEX8, false, NULL},
    {"C3D10", CDEM_SHAPE_TET10, false, tet10_order},
    {"C3D20", CDEM_SHAPE_HEX20, false, hex20_order},
    {"CPS4R", CDEM_SHAPE_QUAD4, true, NULL},
    {"CPE4R", CDEM_SHAPE_QUAD4, true, NULL},
    {"CPS8R", CDEM_SHAPE_QUAD8, true, NULL},
    {"CPE8R", CDEM_SHAPE_QUAD8, true, NULL},
    {"C3D8R", CDEM_SHAPE_HEX8, true, NULL},
    {"C3D20R", CDEM_SHAPE_HEX20, true, hex20_order},
};
enum { TYPES = sizeof types / sizeof types[0] };

/* ---- lines, keywords, words ---- */

typedef enum { NODES, ELEMENTS, SETS, PASSES } inp_pass;

typedef struct {
  cdem_text *text; /* `line` is the line of the keyword or data line in hand */
  cdem_mesh_builder *builder;
  const char *next; /* the line after the one in hand */
  int64_t next_line;
  const char *from, *to; /* the line in hand, without blanks around it */
  int parts;
  bool warned[TYPES], plane_stress;
} inp_reader;

static void trim(const char **from, const char **to) {
  while (*from < *to && isspace((unsigned char)**from))
    (*from)++;
  while (*to > *from && isspace((unsigned char)(*to)[-1]))
    (*to)--;
}

/* Next line that is neither empty nor a comment. */
static bool next_line(inp_reader *reader) {
  while (reader->next < reader->text->end) {
    reader->from = reader->next;
    reader->to = memchr(reader->from, '\n', (size_t)(reader->text->end - reader->from));
    if (reader->to == NULL)
      reader->to = reader->text->end;
    reader->next = reader->to < reader->text->end ? reader->to + 1 : reader->to;
    reader->text->line = reader->next_line++;
    trim(&reader->from, &reader->to);
    if (reader->from < reader->to &&
        !(reader->from[0] == '*' && reader->to - reader->from > 1 && reader->from[1] == '*'))
      return true;
  }
  return false;
}

/* Next line of the block in hand; at a keyword the line is given back. */
static bool next_data(inp_reader *reader) {
  const char *next = reader->next;
  int64_t line = reader->next_line, current = reader->text->line;
  if (next_line(reader) && *reader->from != '*')
    return true;
  reader->next = next;
  reader->next_line = line;
  reader->text->line = current;
  return false;
}

/* Takes the next word of the line, parted by commas or blanks, from *at on; false at the end. An
 * empty place between two commas is an empty word; a comma that ends the line is none. */
static bool next_word(const inp_reader *reader, const char **at, const char **word, int *length) {
  const char *p = *at;
  while (p < reader->to && isspace((unsigned char)*p))
    p++;
  if (p >= reader->to)
    return false;
  *word = p;
  while (p < reader->to && *p != ',' && !isspace((unsigned char)*p))
    p++;
  *length = (int)(p - *word < 200 ? p - *word : 200);
  while (p < reader->to && isspace((unsigned char)*p))
    p++;
  *at = p < reader->to && *p == ',' ? p + 1 : p;
  return true;
}

static bool ends_with_comma(const inp_reader *reader) {
  return reader->to > reader->from && reader->to[-1] == ',';
}

static cdem_status whole_word(const inp_reader *reader, const char *word, int length,
                              const char *what, int64_t *value, cdem_fault *fault) {
  if (!cdem_parse_whole(word, length, value))
    return cdem_text_fail(reader->text, fault, "%s '%.*s' is not a whole number", what, length,
                          word);
  return CDEM_OK;
}

enum { NAME_LENGTH = 128 };

/* A keyword line, several when it ends with a comma: "*ELEMENT, TYPE=C3D8, ELSET=beam". */
typedef struct {
  char name[NAME_LENGTH];       /* "ELEMENT": upper case, one blank between words */
  char type[NAME_LENGTH];       /* values of the parameters that matter, "" when absent */
  char set[NAME_LENGTH];        /* ELSET */
  bool generate, foreign_input; /* GENERATE; INPUT=FILE */
  bool system;                  /* SYSTEM=C or S: coordinates that are not Cartesian */
} inp_keyword;

/* Copies a name, without quotation marks, cut at the end. */
static void copy_name(const char *from, const char *to, char name[NAME_LENGTH]) {
  trim(&from, &to);
  if (to - from >= 2 && *from == '"' && to[-1] == '"') {
    from++;
    to--;
  }
  size_t length = (size_t)(to - from) < NAME_LENGTH ? (size_t)(to - from) : NAME_LENGTH - 1;
  memcpy(name, from, length);
  name[length] = '\0';
}

static void read_parameter(const char *from, const char *to, inp_keyword *keyword) {
  const char *equals = memchr(from, '=', (size_t)(to - from));
  char name[NAME_LENGTH], value[NAME_LENGTH] = "";
  copy_name(from, equals != NULL ? equals : to, name);
  if (equals != NULL)
    copy_name(equals + 1, to, value);
  if (strcasecmp(name, "TYPE") == 0)
    memcpy(keyword->type, value, sizeof value);
  else if (strcasecmp(name, "ELSET") == 0)
    memcpy(keyword->set, value, sizeof value);
  else if (strcasecmp(name, "GENERATE") == 0)
    keyword->generate = true;
  else if (strcasecmp(name, "INPUT") == 0)
    keyword->foreign_input = true;
  else if (strcasecmp(name, "SYSTEM") == 0)
    keyword->system = strcasecmp(value, "R") != 0;
}

/* "  * Element " and "*element" are one keyword. */
static void read_keyword_name(const char *from, const char *to, char name[NAME_LENGTH]) {
  size_t used = 0;
  trim(&from, &to);
  for (; from < to && used + 1 < NAME_LENGTH; from++)
    if (!isspace((unsigned char)*from))
      name[used++] = (char)toupper((unsigned char)*from);
    else if (used > 0 && name[used - 1] != ' ')
      name[used++] = ' ';
  name[used] = '\0';
}

static void read_keyword(inp_reader *reader, inp_keyword *keyword) {
  *keyword = (inp_keyword){0};
  const char *from = reader->from + 1;
  for (bool more = true, first = true; more; first = false) {
    const char *comma = memchr(from, ',', (size_t)(reader->to - from));
    const char *to = comma != NULL ? comma : reader->to;
    if (first)
      read_keyword_name(from, to, keyword->name);
    else
      read_parameter(from, to, keyword);
    from = comma != NULL ? comma + 1 : reader->to;
    more = comma != NULL;
    if (more && from == reader->to) { /* the keyword goes on in the next line */
      int64_t line = reader->text->line;
      more = next_data(reader);
      reader->text->line = line;
      from = reader->from;
    }
  }
}

/* ---- nodes ---- */

static cdem_status read_node(inp_reader *reader, cdem_fault *fault) {
  const char *at = reader->from, *word;
  int length, count = 0;
  int64_t tag = 0;
  double value, xyz[3] = {0};
  for (; next_word(reader, &at, &word, &length); count++) {
    if (count == 0) {
      CDEM_TRY(whole_word(reader, word, length, "node number", &tag, fault));
      continue;
    }
    /* Behind the coordinates Abaqus allows a normal; an empty coordinate is 0. */
    value = 0;
    if (length > 0 && !cdem_parse_real(word, length, reader->text->locale, &value))
      return cdem_text_fail(reader->text, fault, "node %" PRId64 ": '%.*s' is not a number", tag,
                            length, word);
    if (count <= 3)
      xyz[count - 1] = value;
  }
  if (count < 2)
    return cdem_text_fail(reader->text, fault, "node %" PRId64 " has no coordinates", tag);
  return cdem_text_prefix(reader->text, fault,
                          cdem_builder_add_node(reader->builder, tag, xyz, fault));
}

static cdem_status read_nodes(inp_reader *reader, const inp_keyword *keyword, cdem_fault *fault) {
  if (keyword->foreign_input)
    return cdem_text_fail(
        reader->text, fault,
        "*NODE with INPUT= takes nodes from another file; put them into the deck");
  if (keyword->system)
    return cdem_text_fail(reader->text, fault,
                          "*NODE with SYSTEM= gives coordinates that are not Cartesian; convert "
                          "them");
  while (next_data(reader))
    CDEM_TRY(read_node(reader, fault));
  return CDEM_OK;
}

/* ---- elements ---- */

static cdem_status find_type(inp_reader *reader, const inp_keyword *keyword, const inp_type **type,
                             cdem_fault *fault) {
  for (int i = 0; i < TYPES; i++) {
    if (strcasecmp(types[i].name, keyword->type) != 0)
      continue;
    *type = &types[i];
    if (types[i].reduced && !reader->warned[i])
      cdem_builder_warn(reader->builder,
                        "line %" PRId64 ": elements of type %s (reduced integration) are taken "
                        "with full integration, as %.*s",
                        reader->text->line, types[i].name, (int)strlen(types[i].name) - 1,
                        types[i].name);
    reader->warned[i] |= types[i].reduced;
    reader->plane_stress |= strncmp(types[i].name, "CPS", 3) == 0;
    return CDEM_OK;
  }
  if (strcasecmp(keyword->type, "C3D8I") == 0)
    return cdem_text_fail(reader->text, fault,
                          "elements of type C3D8I have incompatible modes, which are no springs "
                          "between nodes; use C3D8 or C3D20");
  if (keyword->type[0] == '\0')
    return cdem_text_fail(reader->text, fault, "*ELEMENT has no TYPE");
  return cdem_text_fail(reader->text, fault,
                        "elements of type '%s' are not known; known are CPS and CPE 3 4 6 8, C3D "
                        "4 5 6 8 10 20",
                        keyword->type);
}

/* Whether the next data line has exactly `wanted` words: decks for CalculiX leave the comma out at
 * the end of a line that goes on. */
static bool next_line_completes(const inp_reader *reader, int wanted) {
  inp_reader ahead = *reader;
  int64_t line = reader->text->line;
  bool completes = false;
  if (next_data(&ahead)) {
    const char *at = ahead.from, *word;
    int length, count = 0;
    while (next_word(&ahead, &at, &word, &length))
      count++;
    completes = count == wanted;
  }
  reader->text->line = line;
  return completes;
}

/* Reads number and nodes, over as many lines as they take; the line in hand stays the first. */
static cdem_status read_element_words(inp_reader *reader, const inp_type *type, int64_t *tag,
                                      int64_t *node, cdem_fault *fault) {
  int wanted = cdem_shape_get(type->shape)->nodes + 1, count = 0;
  int64_t line = reader->text->line;
  for (;;) {
    const char *at = reader->from, *word;
    int length;
    for (; next_word(reader, &at, &word, &length); count++) {
      int64_t value;
      CDEM_TRY(whole_word(reader, word, length, count == 0 ? "element number" : "node number",
                          &value, fault));
      if (count == 0)
        *tag = value;
      else if (count < wanted)
        node[count - 1] = value;
    }
    bool goes_on =
        count < wanted && (ends_with_comma(reader) || next_line_completes(reader, wanted - count));
    if (!goes_on || !next_data(reader))
      break;
  }
  reader->text->line = line;
  if (count != wanted)
    return cdem_text_fail(reader->text, fault, "element %" PRId64 " has %d nodes, %s needs %d%s",
                          *tag, count - 1, type->name, wanted - 1,
                          count < wanted ? " (a line that goes on ends with a comma)" : "");
  return CDEM_OK;
}

static cdem_status read_element(inp_reader *reader, const inp_type *type, int64_t group,
                                cdem_fault *fault) {
  int64_t tag = 0, listed[CDEM_SHAPE_MAX_NODES], node[CDEM_SHAPE_MAX_NODES];
  CDEM_TRY(read_element_words(reader, type, &tag, listed, fault));
  for (int i = 0; i < cdem_shape_get(type->shape)->nodes; i++)
    node[i] = listed[type->order != NULL ? type->order[i] : i];
  cdem_mesh_builder *builder = reader->builder;
  CDEM_TRY(cdem_text_prefix(reader->text, fault,
                            cdem_builder_add_cell(builder, type->shape, tag, node, fault)));
  return group >= 0 ? cdem_builder_add_members(builder, group, builder->mesh.cells - 1, 1, fault)
                    : CDEM_OK;
}

static cdem_status read_elements(inp_reader *reader, const inp_keyword *keyword,
                                 cdem_fault *fault) {
  const inp_type *type = NULL;
  int64_t group = -1;
  if (keyword->foreign_input)
    return cdem_text_fail(reader->text, fault,
                          "*ELEMENT with INPUT= takes elements from another file; put them into "
                          "the deck");
  CDEM_TRY(find_type(reader, keyword, &type, fault));
  if (keyword->set[0] != '\0')
    CDEM_TRY(cdem_builder_named(reader->builder, keyword->set, &group, fault));
  while (next_data(reader))
    CDEM_TRY(read_element(reader, type, group, fault));
  return CDEM_OK;
}

/* ---- element sets ---- */

static cdem_status add_element(inp_reader *reader, const char *set, int64_t group, int64_t tag,
                               cdem_fault *fault) {
  int32_t cell = cdem_tag_map_find(&reader->builder->cell, tag);
  if (cell < 0)
    return cdem_text_fail(reader->text, fault,
                          "set '%s' names element %" PRId64 ", which is not defined", set, tag);
  return cdem_builder_add_members(reader->builder, group, cell, 1, fault);
}

/* A set in a set. */
static cdem_status add_set(inp_reader *reader, const char *set, int64_t group, const char *word,
                           int length, cdem_fault *fault) {
  char name[NAME_LENGTH];
  int64_t other = 0;
  cdem_mesh_builder *builder = reader->builder;
  copy_name(word, word + length, name);
  while (other < builder->groups && strcasecmp(builder->group[other].name, name) != 0)
    other++;
  if (other == builder->groups || other == group)
    return cdem_text_fail(reader->text, fault, "set '%s' names set '%s', which is not defined%s",
                          set, name, other == group ? " yet" : "");
  for (int64_t i = 0; i < builder->group[other].cells; i++)
    CDEM_TRY(cdem_builder_add_members(builder, group, builder->group[other].cell[i], 1, fault));
  return CDEM_OK;
}

static cdem_status read_set_line(inp_reader *reader, const char *set, int64_t group,
                                 cdem_fault *fault) {
  const char *at = reader->from, *word;
  int length;
  while (next_word(reader, &at, &word, &length)) {
    int64_t tag;
    if (length == 0)
      continue;
    CDEM_TRY(cdem_parse_whole(word, length, &tag)
                 ? add_element(reader, set, group, tag, fault)
                 : add_set(reader, set, group, word, length, fault));
  }
  return CDEM_OK;
}

/* first, last, step */
static cdem_status generate_set_line(inp_reader *reader, const char *set, int64_t group,
                                     cdem_fault *fault) {
  const char *at = reader->from, *word;
  int length, count = 0;
  int64_t value[3] = {0, 0, 1};
  for (; next_word(reader, &at, &word, &length) && count < 3; count++)
    CDEM_TRY(whole_word(reader, word, length, "range of a set", &value[count], fault));
  if (count < 2 || value[2] < 1 || value[1] < value[0])
    return cdem_text_fail(reader->text, fault,
                          "GENERATE in set '%s' needs first, last and a positive step", set);
  for (int64_t tag = value[0];; tag += value[2]) {
    CDEM_TRY(add_element(reader, set, group, tag, fault));
    if (tag > value[1] - value[2]) /* before the sum can overflow */
      break;
  }
  return CDEM_OK;
}

static cdem_status read_set(inp_reader *reader, const inp_keyword *keyword, cdem_fault *fault) {
  int64_t group;
  if (keyword->set[0] == '\0')
    return cdem_text_fail(reader->text, fault, "*ELSET has no ELSET=NAME");
  CDEM_TRY(cdem_builder_named(reader->builder, keyword->set, &group, fault));
  while (next_data(reader))
    CDEM_TRY(keyword->generate ? generate_set_line(reader, keyword->set, group, fault)
                               : read_set_line(reader, keyword->set, group, fault));
  return CDEM_OK;
}

/* ---- the deck ---- */

static const struct {
  const char *name, *remedy;
} refused[] = {
    {"INCLUDE", "put the other file's lines into the deck"},
    {"NGEN", "write the nodes out"},
    {"NFILL", "write the nodes out"},
    {"NCOPY", "write the nodes out"},
    {"NMAP", "write the nodes out"},
    {"SYSTEM", "write the nodes in global coordinates"},
    {"ELGEN", "write the elements out"},
    {"ELCOPY", "write the elements out"},
};

/* What the deck says that would be wrong to pass over. */
static cdem_status check_keyword(inp_reader *reader, const inp_keyword *keyword,
                                 cdem_fault *fault) {
  for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++)
    if (strcmp(keyword->name, refused[i].name) == 0)
      return cdem_text_fail(reader->text, fault, "*%s is not read; %s", keyword->name,
                            refused[i].remedy);
  if (strcmp(keyword->name, "PART") == 0 && ++reader->parts > 1)
    return cdem_text_fail(reader->text, fault,
                          "a second *PART; write the deck as one part, or without parts and "
                          "assembly");
  if (strcmp(keyword->name, "INSTANCE") == 0 && next_data(reader))
    return cdem_text_fail(reader->text, fault,
                          "*INSTANCE moves its part, which is not read; write the deck without "
                          "parts and assembly");
  return CDEM_OK;
}

static cdem_status walk(inp_reader *reader, inp_pass pass, cdem_fault *fault) {
  inp_keyword keyword;
  reader->next = reader->text->data;
  reader->next_line = 1;
  while (next_line(reader)) {
    if (*reader->from != '*') {
      if (reader->parts < 0)
        return cdem_text_fail(reader->text, fault,
                              "the file does not start with a keyword such as *NODE: it is no "
                              "input deck");
      continue; /* data of a keyword that is passed over */
    }
    read_keyword(reader, &keyword);
    if (reader->parts < 0)
      reader->parts = 0;
    if (pass == NODES)
      CDEM_TRY(check_keyword(reader, &keyword, fault));
    if (pass == NODES && strcmp(keyword.name, "NODE") == 0)
      CDEM_TRY(read_nodes(reader, &keyword, fault));
    else if (pass == ELEMENTS && strcmp(keyword.name, "ELEMENT") == 0)
      CDEM_TRY(read_elements(reader, &keyword, fault));
    else if (pass == SETS && strcmp(keyword.name, "ELSET") == 0)
      CDEM_TRY(read_set(reader, &keyword, fault));
  }
  return CDEM_OK;
}

cdem_status cdem_read_inp(cdem_text *text, cdem_mesh_builder *builder, cdem_fault *fault) {
  inp_reader reader = {.text = text, .builder = builder, .parts = -1};
  CDEM_REQUIRE(text->size > 0, fault, CDEM_INPUT, "the file is empty");
  for (int pass = 0; pass < PASSES; pass++) {
    CDEM_TRY(walk(&reader, (inp_pass)pass, fault));
    if (pass == ELEMENTS)
      CDEM_REQUIRE(builder->mesh.cells > 0, fault, CDEM_INPUT, "the deck has no *ELEMENT lines");
  }
  if (reader.plane_stress && cdem_mesh_dimension(&builder->mesh) == 2)
    cdem_builder_warn(builder,
                      "the deck's elements are plane stress (CPS); here --plane and --thickness "
                      "decide, not the deck's types and sections");
  return CDEM_OK;
}
