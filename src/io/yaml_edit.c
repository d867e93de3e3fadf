/* Changing a YAML tree and writing it as text. */
#include "io/yaml_tree.h"

#include <stdlib.h>
#include <string.h>
#include <yaml.h>

cdem_status cdem_yaml_new(cdem_yaml *yaml, cdem_yaml_kind kind, const char *text, int32_t like,
                          int origin, int32_t *id, cdem_fault *fault) {
  CDEM_TRY(cdem_grow(&yaml->node, &yaml->capacity, yaml->nodes + 1, sizeof *yaml->node, fault));
  cdem_yaml_node node = {.kind = kind, .child = -1, .next = -1, .origin = origin};
  node.line = yaml->node[like].line;
  node.column = yaml->node[like].column;
  node.width = yaml->node[like].width;
  if (kind == CDEM_YAML_SCALAR) {
    node.text = cdem_copy_text(text, fault);
    if (node.text == NULL)
      return CDEM_MEMORY;
  }
  *id = (int32_t)yaml->nodes;
  yaml->node[yaml->nodes++] = node;
  return CDEM_OK;
}

void cdem_yaml_append(cdem_yaml *yaml, int32_t parent, int32_t child) {
  int32_t *link = &yaml->node[parent].child;
  while (*link >= 0)
    link = &yaml->node[*link].next;
  *link = child;
  yaml->node[parent].children++;
}

void cdem_yaml_replace(cdem_yaml *yaml, int32_t parent, int32_t position, int32_t child) {
  int32_t *link = &yaml->node[parent].child;
  for (int32_t i = 0; i < position; i++)
    link = &yaml->node[*link].next;
  yaml->node[child].next = yaml->node[*link].next;
  *link = child;
}

/* ---- text ---- */

typedef struct {
  yaml_emitter_t emitter;
  char *text;
  int64_t used, capacity;
} writing;

static int take_text(void *context, unsigned char *data, size_t bytes) {
  writing *w = context;
  if (cdem_grow(&w->text, &w->capacity, w->used + (int64_t)bytes + 1, 1, NULL) != CDEM_OK)
    return 0;
  memcpy(w->text + w->used, data, bytes);
  w->used += (int64_t)bytes;
  w->text[w->used] = '\0';
  return 1;
}

/* A list of scalars, and whatever stands in a list, goes on one line. */
static bool is_flat(const cdem_yaml *yaml, const cdem_yaml_node *node) {
  for (const cdem_yaml_node *c = cdem_yaml_child(yaml, node); c != NULL;
       c = cdem_yaml_next(yaml, c))
    if (c->kind != CDEM_YAML_SCALAR &&
        (node->kind == CDEM_YAML_MAP || c->kind == CDEM_YAML_MAP || !is_flat(yaml, c)))
      return false;
  return true;
}

static bool put_node(writing *w, const cdem_yaml *yaml, const cdem_yaml_node *node, bool flow) {
  yaml_event_t event;
  flow = flow || (node->kind == CDEM_YAML_LIST && is_flat(yaml, node));
  if (node->kind == CDEM_YAML_SCALAR)
    return yaml_scalar_event_initialize(&event, NULL, NULL, (yaml_char_t *)node->text,
                                        (int)strlen(node->text), 1, 1, YAML_ANY_SCALAR_STYLE) &&
           yaml_emitter_emit(&w->emitter, &event);
  bool map = node->kind == CDEM_YAML_MAP;
  int made =
      map ? yaml_mapping_start_event_initialize(
                &event, NULL, NULL, 1, flow ? YAML_FLOW_MAPPING_STYLE : YAML_BLOCK_MAPPING_STYLE)
          : yaml_sequence_start_event_initialize(
                &event, NULL, NULL, 1, flow ? YAML_FLOW_SEQUENCE_STYLE : YAML_BLOCK_SEQUENCE_STYLE);
  if (!made || !yaml_emitter_emit(&w->emitter, &event))
    return false;
  for (const cdem_yaml_node *c = cdem_yaml_child(yaml, node); c != NULL;
       c = cdem_yaml_next(yaml, c))
    if (!put_node(w, yaml, c, flow))
      return false;
  made =
      map ? yaml_mapping_end_event_initialize(&event) : yaml_sequence_end_event_initialize(&event);
  return made && yaml_emitter_emit(&w->emitter, &event);
}

static bool put_document(writing *w, const cdem_yaml *yaml) {
  yaml_event_t event;
  return yaml_stream_start_event_initialize(&event, YAML_UTF8_ENCODING) &&
         yaml_emitter_emit(&w->emitter, &event) &&
         yaml_document_start_event_initialize(&event, NULL, NULL, NULL, 1) &&
         yaml_emitter_emit(&w->emitter, &event) && put_node(w, yaml, cdem_yaml_root(yaml), false) &&
         yaml_document_end_event_initialize(&event, 1) && yaml_emitter_emit(&w->emitter, &event) &&
         yaml_stream_end_event_initialize(&event) && yaml_emitter_emit(&w->emitter, &event);
}

cdem_status cdem_yaml_text(const cdem_yaml *yaml, char **text, cdem_fault *fault) {
  writing w = {.text = NULL};
  CDEM_REQUIRE(yaml_emitter_initialize(&w.emitter), fault, CDEM_MEMORY,
               "out of memory while writing '%s' anew", yaml->path);
  yaml_emitter_set_output(&w.emitter, take_text, &w);
  yaml_emitter_set_unicode(&w.emitter, 1);
  yaml_emitter_set_width(&w.emitter, -1);
  bool done = put_document(&w, yaml);
  yaml_emitter_delete(&w.emitter);
  if (done) {
    *text = w.text;
    return CDEM_OK;
  }
  free(w.text);
  return cdem_fail(fault, CDEM_MEMORY, "out of memory while writing '%s' anew", yaml->path);
}
