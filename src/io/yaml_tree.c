#include "io/yaml_tree.h"

#include "base/caret.h"
#include "base/suggest.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

enum {
  MAX_BYTES = 16 << 20, /* an input file written by hand is far below */
  MAX_DEPTH = 16,
  MAX_SHOWN = 5 /* errors whose text is kept */
};

/* ---- errors ---- */

static void add_error(cdem_yaml *yaml, const cdem_yaml_node *at, const char *message) {
  yaml->errors++;
  if (yaml->errors > MAX_SHOWN)
    return;
  char *out = yaml->report.message;
  size_t used = strlen(out), room = sizeof yaml->report.message - used;
  char text[CDEM_FAULT_LENGTH];
  const char *line_end = used > 0 ? "\n" : "";
  int length;
  if (at->origin > 0)
    length = snprintf(text, sizeof text, "%soverride '%.200s': %s", line_end,
                      yaml->override[at->origin - 1], message);
  else
    length = snprintf(text, sizeof text, "%s%s:%d:%d: %s", line_end, yaml->path, at->line,
                      at->column, message);
  if (length < 0 || (size_t)length >= sizeof text)
    length = sizeof text - 1;
  if (at->origin == 0)
    cdem_caret_put(yaml->source, at->line, at->column, at->width, text + length,
                   sizeof text - (size_t)length);
  if (strlen(text) < room || used == 0)
    snprintf(out + used, room, "%s", text);
}

void cdem_yaml_error(cdem_yaml *yaml, const cdem_yaml_node *at, const char *format, ...) {
  char message[CDEM_FAULT_LENGTH / 2];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  add_error(yaml, at, message);
}

void cdem_yaml_override_error(cdem_yaml *yaml, int index, const char *format, ...) {
  char message[CDEM_FAULT_LENGTH / 2];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  add_error(yaml, &(cdem_yaml_node){.origin = index + 1}, message);
}

void cdem_yaml_unknown(cdem_yaml *yaml, const cdem_yaml_node *at, const char *what,
                       const char *const *candidates, int count) {
  const char *near = cdem_suggest(at->text, candidates, count);
  if (near != NULL)
    cdem_yaml_error(yaml, at, "unknown %s '%s'; did you mean '%s'?", what, at->text, near);
  else
    cdem_yaml_error(yaml, at, "unknown %s '%s'", what, at->text);
}

cdem_status cdem_yaml_finish(const cdem_yaml *yaml, cdem_fault *fault) {
  CDEM_REQUIRE(!yaml->lacks_memory, fault, CDEM_MEMORY, "out of memory while reading '%s'",
               yaml->path);
  if (yaml->errors == 0)
    return CDEM_OK;
  char more[48] = "";
  if (yaml->errors > MAX_SHOWN)
    snprintf(more, sizeof more, "\nand %d more errors", yaml->errors - MAX_SHOWN);
  return cdem_fail(fault, CDEM_INPUT, "%.*s%s", (int)(CDEM_FAULT_LENGTH - sizeof more),
                   yaml->report.message, more);
}

/* ---- the tree ---- */

const char *cdem_yaml_kind_name(cdem_yaml_kind kind) {
  static const char *const names[] = {"a text", "a list", "a map"};
  return names[kind];
}

const cdem_yaml_node *cdem_yaml_find(const cdem_yaml *yaml, const cdem_yaml_node *map,
                                     const char *key) {
  if (map->kind == CDEM_YAML_MAP)
    CDEM_YAML_EACH(yaml, map, name, value)
  if (name->kind == CDEM_YAML_SCALAR && strcmp(name->text, key) == 0)
    return value;
  return NULL;
}

static cdem_status add_node(cdem_yaml *yaml, cdem_yaml_kind kind, const yaml_event_t *event,
                            int32_t *id, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&yaml->node, &yaml->capacity, yaml->nodes + 1, sizeof *yaml->node, fault));
  cdem_yaml_node node = {.kind = kind, .width = 1, .child = -1, .next = -1, .origin = yaml->origin};
  node.line = (int)event->start_mark.line + 1;
  node.column = (int)event->start_mark.column + 1;
  if (event->start_mark.line == event->end_mark.line)
    node.width = (int)(event->end_mark.column - event->start_mark.column);
  if (kind == CDEM_YAML_SCALAR) {
    node.text = cdem_copy_text((const char *)event->data.scalar.value, fault);
    if (node.text == NULL)
      return CDEM_MEMORY;
  }
  *id = (int32_t)yaml->nodes;
  yaml->node[yaml->nodes++] = node;
  return CDEM_OK;
}

/* Anchors, aliases and tags make a text mean something else than it says. */
static void refuse_magic(cdem_yaml *yaml, const yaml_event_t *event) {
  const cdem_yaml_node here = {.line = (int)event->start_mark.line + 1,
                               .column = (int)event->start_mark.column + 1,
                               .width = 1,
                               .origin = yaml->origin};
  const yaml_char_t *anchor = NULL, *tag = NULL;
  switch (event->type) {
  case YAML_ALIAS_EVENT:
    cdem_yaml_error(yaml, &here, "aliases are not allowed; write the value again");
    return;
  case YAML_SCALAR_EVENT:
    anchor = event->data.scalar.anchor, tag = event->data.scalar.tag;
    if (strlen((const char *)event->data.scalar.value) != event->data.scalar.length)
      cdem_yaml_error(yaml, &here, "a text with a zero byte in it is not allowed");
    break;
  case YAML_SEQUENCE_START_EVENT:
    anchor = event->data.sequence_start.anchor, tag = event->data.sequence_start.tag;
    break;
  case YAML_MAPPING_START_EVENT:
    anchor = event->data.mapping_start.anchor, tag = event->data.mapping_start.tag;
    break;
  default:
    return;
  }
  if (anchor != NULL)
    cdem_yaml_error(yaml, &here, "anchors are not allowed; write the value where it is needed");
  if (tag != NULL)
    cdem_yaml_error(yaml, &here, "tags are not allowed; write the value without '!'");
}

/* Keys must be words, each at most once. */
static void check_keys(cdem_yaml *yaml, int32_t map) {
  CDEM_YAML_EACH(yaml, &yaml->node[map], key, value) {
    if (key->kind != CDEM_YAML_SCALAR) {
      cdem_yaml_error(yaml, key, "a key must be a word, not %s", cdem_yaml_kind_name(key->kind));
      continue;
    }
    CDEM_YAML_EACH(yaml, &yaml->node[map], earlier, ignored) {
      if (earlier == key)
        break;
      if (earlier->kind == CDEM_YAML_SCALAR && strcmp(earlier->text, key->text) == 0) {
        cdem_yaml_error(yaml, key, "key '%s' was given already in line %d", key->text,
                        earlier->line);
        break;
      }
      (void)ignored;
    }
    (void)value;
  }
}

static cdem_status next_event(cdem_yaml *yaml, yaml_parser_t *parser, yaml_event_t *event,
                              cdem_fault *fault) {
  if (yaml_parser_parse(parser, event))
    return CDEM_OK;
  CDEM_REQUIRE(parser->error != YAML_MEMORY_ERROR, fault, CDEM_MEMORY,
               "out of memory while reading '%s'", yaml->path);
  /* A reader error has no mark, only a byte. */
  const yaml_mark_t mark = parser->problem_mark;
  const cdem_yaml_node here = {.line = (int)mark.line + 1,
                               .column = (int)mark.column + 1,
                               .width = 1,
                               .origin = yaml->origin};
  add_error(yaml, &here, parser->problem != NULL ? parser->problem : "is not YAML");
  return cdem_yaml_finish(yaml, fault);
}

/* Where a node goes while the tree grows. */
typedef struct {
  int32_t parent[MAX_DEPTH], last[MAX_DEPTH];
  int depth;
} yaml_place;

static void attach(cdem_yaml *yaml, yaml_place *place, int32_t id) {
  if (place->depth == 0)
    return;
  int32_t parent = place->parent[place->depth - 1], last = place->last[place->depth - 1];
  if (last < 0)
    yaml->node[parent].child = id;
  else
    yaml->node[last].next = id;
  yaml->node[parent].children++;
  place->last[place->depth - 1] = id;
}

/* One event into the tree. An alias becomes an empty text: it has been reported. */
static cdem_status take_event(cdem_yaml *yaml, yaml_place *place, const yaml_event_t *event,
                              cdem_fault *fault) {
  static const yaml_event_t nothing = {.data.scalar.value = (yaml_char_t *)""};
  int32_t id = -1;
  refuse_magic(yaml, event);
  if (event->type == YAML_MAPPING_END_EVENT)
    check_keys(yaml, place->parent[place->depth - 1]);
  if (event->type == YAML_MAPPING_END_EVENT || event->type == YAML_SEQUENCE_END_EVENT) {
    place->depth--;
  } else if (event->type == YAML_SCALAR_EVENT || event->type == YAML_ALIAS_EVENT) {
    yaml_event_t scalar = *event;
    if (event->type == YAML_ALIAS_EVENT)
      scalar.data = nothing.data;
    CDEM_TRY(add_node(yaml, CDEM_YAML_SCALAR, &scalar, &id, fault));
    attach(yaml, place, id);
  } else if (event->type == YAML_MAPPING_START_EVENT || event->type == YAML_SEQUENCE_START_EVENT) {
    bool map = event->type == YAML_MAPPING_START_EVENT;
    CDEM_TRY(add_node(yaml, map ? CDEM_YAML_MAP : CDEM_YAML_LIST, event, &id, fault));
    yaml->node[id].width = 1;
    yaml->node[id].braces = map && event->data.mapping_start.style == YAML_FLOW_MAPPING_STYLE;
    attach(yaml, place, id);
    if (place->depth == MAX_DEPTH) {
      cdem_yaml_error(yaml, &yaml->node[id], "is nested deeper than %d levels", MAX_DEPTH);
      return cdem_yaml_finish(yaml, fault);
    }
    place->parent[place->depth] = id;
    place->last[place->depth++] = -1;
  }
  return CDEM_OK;
}

static cdem_status build_tree(cdem_yaml *yaml, yaml_parser_t *parser, cdem_fault *fault) {
  yaml_place place = {.depth = 0};
  int documents = 0;
  for (bool end = false; !end;) {
    yaml_event_t event;
    CDEM_TRY(next_event(yaml, parser, &event, fault));
    end = event.type == YAML_STREAM_END_EVENT;
    cdem_status status = CDEM_OK;
    if (event.type == YAML_DOCUMENT_START_EVENT && ++documents > 1) {
      const cdem_yaml_node here = {
          .line = (int)event.start_mark.line + 1, .column = 1, .width = 3, .origin = yaml->origin};
      add_error(yaml, &here, "a second document begins here; a file holds one");
      end = true;
    } else {
      status = take_event(yaml, &place, &event, fault);
    }
    yaml_event_delete(&event);
    CDEM_TRY(status);
  }
  return CDEM_OK;
}

static cdem_status parse(cdem_yaml *yaml, const char *text, size_t bytes, cdem_fault *fault) {
  yaml_parser_t parser;
  CDEM_REQUIRE(yaml_parser_initialize(&parser), fault, CDEM_MEMORY,
               "out of memory while reading '%s'", yaml->path);
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, bytes);
  cdem_status status = build_tree(yaml, &parser, fault);
  yaml_parser_delete(&parser);
  return status;
}

cdem_status cdem_yaml_read_override(cdem_yaml *yaml, int index, size_t from, int32_t *root,
                                    cdem_fault *fault) {
  const char *text = yaml->override[index] + from;
  int64_t first = yaml->nodes;
  yaml->origin = index + 1;
  cdem_status status = parse(yaml, text, strlen(text), fault);
  yaml->origin = 0;
  CDEM_TRY(status);
  *root = yaml->nodes > first ? (int32_t)first : -1;
  return CDEM_OK;
}

/* ---- the file ---- */

static cdem_status fail_read(const cdem_yaml *yaml, int error, cdem_fault *fault) {
  return cdem_fail(fault, CDEM_FILE, "cannot read '%s': %s; check the name and its permissions",
                   yaml->path, strerror(error));
}

static cdem_status read_source(cdem_yaml *yaml, cdem_fault *fault) {
  FILE *file = fopen(yaml->path, "rb");
  if (file == NULL)
    return fail_read(yaml, errno, fault);
  cdem_status status = CDEM_OK;
  for (bool end = false; !end && status == CDEM_OK;) {
    status = cdem_grow(&yaml->source, &yaml->source_capacity, yaml->bytes + 4097, 1, fault);
    if (status != CDEM_OK)
      break;
    size_t got = fread(yaml->source + yaml->bytes, 1, 4096, file);
    yaml->bytes += (int64_t)got;
    yaml->source[yaml->bytes] = '\0';
    end = got == 0;
    if (end && ferror(file))
      status = fail_read(yaml, errno, fault);
    else if (yaml->bytes > MAX_BYTES)
      status = cdem_fail(fault, CDEM_INPUT, "cannot read '%s': it is larger than %d MiB",
                         yaml->path, MAX_BYTES >> 20);
  }
  fclose(file);
  return status;
}

void cdem_yaml_release(cdem_yaml *yaml) {
  for (int64_t i = 0; i < yaml->nodes; i++)
    free(yaml->node[i].text);
  free(yaml->node);
  free(yaml->number);
  free(yaml->source);
  free(yaml->path);
  *yaml = (cdem_yaml){0};
}

/* Without the mark that some editors put first: no place counts it. */
static cdem_status read_tree(cdem_yaml *yaml, cdem_fault *fault) {
  if (strncmp(yaml->source, "\xef\xbb\xbf", 3) == 0) {
    yaml->bytes -= 3;
    memmove(yaml->source, yaml->source + 3, (size_t)yaml->bytes + 1);
  }
  CDEM_TRY(parse(yaml, yaml->source, (size_t)yaml->bytes, fault));
  CDEM_REQUIRE(yaml->nodes > 0, fault, CDEM_INPUT, "cannot read '%s': it is empty", yaml->path);
  return CDEM_OK;
}

cdem_status cdem_yaml_read(const char *path, cdem_yaml *yaml, cdem_fault *fault) {
  yaml->path = cdem_copy_text(path, fault);
  if (yaml->path == NULL)
    return CDEM_MEMORY;
  CDEM_TRY(read_source(yaml, fault));
  return read_tree(yaml, fault);
}

cdem_status cdem_yaml_read_text(const char *path, const char *text, cdem_yaml *yaml,
                                cdem_fault *fault) {
  yaml->path = cdem_copy_text(path, fault);
  yaml->source = cdem_copy_text(text, fault);
  if (yaml->path == NULL || yaml->source == NULL)
    return CDEM_MEMORY;
  yaml->bytes = (int64_t)strlen(text);
  return read_tree(yaml, fault);
}
