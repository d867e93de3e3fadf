/* Case files: overrides "interfaces[0].tension=2 MPa", put into the tree before it is read. */
#include "io/case_read.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* An override being applied. */
typedef struct {
  cdem_case_reader *r;
  int index;
  const char *at;                   /* what is left of its path */
  int32_t node;                     /* where it has come to */
  const cdem_case_section *section; /* of that node; NULL: not a section */
  bool each;                        /* the node is a list or a map of names of that section */
  int32_t parent, position;         /* of the node among its parent's children */
} walking;

/* False after a failure (status) or an error in the override. */
static bool good(walking *w, cdem_status status) {
  if (status != CDEM_OK)
    w->r->status = status;
  return status == CDEM_OK;
}

/* A scalar in the place of a section that has a shorthand becomes the map it stands for. */
static bool expand_shorthand(walking *w) {
  cdem_yaml *yaml = &w->r->yaml;
  int32_t map, key, text = w->node;
  if (w->section == NULL || w->each || w->section->shorthand == NULL || w->parent < 0)
    return true;
  int origin = yaml->node[text].origin;
  if (!good(w, cdem_yaml_new(yaml, CDEM_YAML_MAP, NULL, text, origin, &map, w->r->fault)) ||
      !good(w, cdem_yaml_new(yaml, CDEM_YAML_SCALAR, w->section->shorthand, text, origin, &key,
                             w->r->fault)))
    return false;
  cdem_yaml_replace(yaml, w->parent, w->position, map);
  yaml->node[text].next = -1;
  cdem_yaml_append(yaml, map, key);
  cdem_yaml_append(yaml, map, text);
  w->node = map;
  return true;
}

/* The position of the value of a key among the children of a map; -1: not there. */
static int32_t position_of(const cdem_yaml *yaml, int32_t map, const char *key, size_t length) {
  int32_t position = 1;
  CDEM_YAML_EACH(yaml, &yaml->node[map], name, value) {
    if (name->kind == CDEM_YAML_SCALAR && strlen(name->text) == length &&
        strncmp(name->text, key, length) == 0)
      return position;
    position += 2;
    (void)value;
  }
  return -1;
}

static int32_t child_at(const cdem_yaml *yaml, int32_t parent, int32_t position) {
  int32_t child = yaml->node[parent].child;
  while (position-- > 0)
    child = yaml->node[child].next;
  return child;
}

/* Goes to child number `position`, which is made when it is the one past the last. What is made is
 * a map or a list, as the rest of the path wants it; the value replaces it at the end of the path.
 */
static bool go_to(walking *w, int32_t position) {
  cdem_yaml *yaml = &w->r->yaml;
  if (position == yaml->node[w->node].children) {
    int32_t made;
    cdem_yaml_kind kind = *w->at == '[' ? CDEM_YAML_LIST : CDEM_YAML_MAP;
    if (!good(w, cdem_yaml_new(yaml, kind, NULL, w->node, w->index + 1, &made, w->r->fault)))
      return false;
    cdem_yaml_append(yaml, w->node, made);
  }
  w->parent = w->node;
  w->position = position;
  w->node = child_at(yaml, w->node, position);
  return true;
}

static bool step_into_key(walking *w) {
  cdem_yaml *yaml = &w->r->yaml;
  size_t length = strcspn(w->at, ".[=");
  const char *key = w->at;
  if (length == 0 || length >= CDEM_CASE_PATH) {
    cdem_yaml_override_error(yaml, w->index, "a key is missing before '%.20s'", w->at);
    return false;
  }
  if (yaml->node[w->node].kind == CDEM_YAML_SCALAR && !expand_shorthand(w))
    return false;
  if (yaml->node[w->node].kind != CDEM_YAML_MAP) {
    cdem_yaml_override_error(yaml, w->index, "'%.*s' cannot be a key there: the case has %s",
                             (int)length, key, cdem_yaml_kind_name(yaml->node[w->node].kind));
    return false;
  }
  int32_t position = position_of(yaml, w->node, key, length);
  char name[CDEM_CASE_PATH] = "";
  memcpy(name, key, length);
  if (position < 0) {
    int32_t made;
    if (!good(w, cdem_yaml_new(yaml, CDEM_YAML_SCALAR, name, w->node, w->index + 1, &made,
                               w->r->fault)))
      return false;
    cdem_yaml_append(yaml, w->node, made);
    position = yaml->node[w->node].children;
  }
  w->at += length;
  if (w->each) { /* a name: the section is that of its map */
    w->each = false;
  } else {
    const cdem_case_key *found = w->section != NULL ? cdem_case_key_find(w->section, name) : NULL;
    w->section = found != NULL ? found->section : NULL;
    w->each = found != NULL && (found->kind == CDEM_KEY_NAMED || found->kind == CDEM_KEY_LIST);
  }
  return go_to(w, position);
}

static bool step_into_item(walking *w) {
  cdem_yaml *yaml = &w->r->yaml;
  char *end;
  long item = isdigit((unsigned char)w->at[1]) ? strtol(w->at + 1, &end, 10) : -1;
  if (item < 0 || item > 1000000 || *end != ']') {
    cdem_yaml_override_error(yaml, w->index, "'%.20s' does not begin with a number in brackets",
                             w->at);
    return false;
  }
  const cdem_yaml_node *node = &yaml->node[w->node];
  if (node->kind != CDEM_YAML_LIST) {
    cdem_yaml_override_error(yaml, w->index, "'[%ld]' needs a list there: the case has %s", item,
                             cdem_yaml_kind_name(node->kind));
    return false;
  }
  if (item > node->children) {
    cdem_yaml_override_error(yaml, w->index,
                             "'[%ld]' is beyond the list, which has %d entries; counting begins "
                             "at 0, and [%d] adds one",
                             item, (int)node->children, (int)node->children);
    return false;
  }
  w->at = end + 1;
  w->each = false;
  return go_to(w, (int32_t)item);
}

/* Walks to the end of the path, making what is not there. */
static bool walk_path(walking *w) {
  if (!step_into_key(w))
    return false;
  while (*w->at != '=') {
    bool done;
    if (*w->at == '[') {
      done = step_into_item(w);
    } else if (*w->at == '.') {
      w->at++;
      done = step_into_key(w);
    } else {
      cdem_yaml_override_error(&w->r->yaml, w->index, "'.' or '[' is missing before '%.20s'",
                               w->at);
      done = false;
    }
    if (!done)
      return false;
  }
  return true;
}

static void apply(cdem_case_reader *r, int index) {
  cdem_yaml *yaml = &r->yaml;
  const char *text = yaml->override[index], *equal = strchr(text, '=');
  if (equal == NULL || equal == text) {
    cdem_yaml_override_error(yaml, index, "is not of the form section.key=value");
    return;
  }
  if (cdem_yaml_root(yaml)->kind != CDEM_YAML_MAP)
    return; /* the file is no case, which will be said */
  int32_t value = -1;
  cdem_status status =
      cdem_yaml_read_override(yaml, index, (size_t)(equal + 1 - text), &value, r->fault);
  if (status != CDEM_OK) {
    r->status = status;
    return;
  }
  if (value < 0) {
    cdem_yaml_override_error(yaml, index, "has no value");
    return;
  }
  walking w = {.r = r, .index = index, .at = text, .section = cdem_case_root(), .parent = -1};
  if (walk_path(&w))
    cdem_yaml_replace(yaml, w.parent, w.position, value);
}

void cdem_case_override(cdem_case_reader *r) {
  for (int i = 0; i < r->yaml.overrides && r->status == CDEM_OK; i++)
    apply(r, i);
}
