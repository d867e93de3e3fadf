/* Case files: the schema as JSON Schema (draft 2020-12). A value with a unit is a number or a text
 * that begins with one; the schema does not know units. */
#include "io/case_file.h"
#include "io/case_text.h"
#include "io/io.h"

#include <math.h>
#include <string.h>

#define REAL "[-+]?([0-9]+\\\\.?[0-9]*|\\\\.[0-9]+)([eE][-+]?[0-9]+)?"

static const char definitions[] =
    "  \"$defs\": {\n"
    "    \"quantity\": {\"type\": [\"number\", \"string\"],\n"
    "      \"pattern\": \"^[ \\\\t]*" REAL "[ \\\\t]*((1/)?[^-+0-9., \\\\t].*)?$\"},\n"
    "    \"text\": {\"type\": [\"string\", \"number\"]},\n"
    "    \"texts\": {\"anyOf\": [{\"$ref\": \"#/$defs/text\"},\n"
    "      {\"type\": \"array\", \"minItems\": 1, \"items\": {\"$ref\": \"#/$defs/text\"}}]},\n"
    "    \"series\": {\"anyOf\": [{\"$ref\": \"#/$defs/quantity\"},\n"
    "      {\"type\": \"object\", \"required\": [\"table\"], \"additionalProperties\": false, "
    "\"properties\": {\n"
    "        \"table\": {\"type\": \"array\", \"minItems\": 1, \"items\": {\"type\": \"array\",\n"
    "          \"minItems\": 2, \"maxItems\": 2, \"items\": {\"$ref\": \"#/$defs/quantity\"}}}}},\n"
    "      {\"type\": \"object\", \"required\": [\"ramp\", \"over\"], \"additionalProperties\": "
    "false,\n"
    "        \"properties\": {\"ramp\": {\"$ref\": \"#/$defs/quantity\"}, \"over\": {\"$ref\": "
    "\"#/$defs/quantity\"},\n"
    "          \"from\": {\"$ref\": \"#/$defs/quantity\"}, \"start\": {\"$ref\": "
    "\"#/$defs/quantity\"}}},\n"
    "      {\"type\": \"object\", \"required\": [\"sine\", \"frequency\"], "
    "\"additionalProperties\": false,\n"
    "        \"properties\": {\"sine\": {\"$ref\": \"#/$defs/quantity\"}, \"frequency\": "
    "{\"$ref\": "
    "\"#/$defs/quantity\"},\n"
    "          \"phase\": {\"$ref\": \"#/$defs/quantity\"}, \"start\": {\"$ref\": "
    "\"#/$defs/quantity\"},\n"
    "          \"offset\": {\"$ref\": \"#/$defs/quantity\"}}},\n"
    "      {\"type\": \"object\", \"required\": [\"pulse\", \"duration\"], "
    "\"additionalProperties\": false,\n"
    "        \"properties\": {\"pulse\": {\"$ref\": \"#/$defs/quantity\"}, \"duration\": "
    "{\"$ref\": "
    "\"#/$defs/quantity\"},\n"
    "          \"start\": {\"$ref\": \"#/$defs/quantity\"}, \"offset\": {\"$ref\": "
    "\"#/$defs/quantity\"}}}]}\n"
    "  }\n";

static void put_section(FILE *stream, const cdem_case_section *section, int indent);

static void put_numbers(FILE *stream, const char *name, double value) {
  fprintf(stream, ", \"%s\": ", name);
  cdem_json_number(stream, value);
}

static void put_range(FILE *stream, const cdem_case_key *key) {
  if (key->least == key->most)
    return;
  put_numbers(stream, key->above ? "exclusiveMinimum" : "minimum", key->least);
  if (!isinf(key->most))
    put_numbers(stream, key->below ? "exclusiveMaximum" : "maximum", key->most);
}

static void put_choices(FILE *stream, const cdem_case_key *key) {
  fputs("\"enum\": [", stream);
  for (int i = 0; key->choice[i] != NULL; i++) {
    fputs(i > 0 ? ", " : "", stream);
    cdem_json_text(stream, key->choice[i]);
  }
  fputs("]", stream);
}

static void put_components(FILE *stream, const cdem_case_key *key) {
  static const char *const names[] = {"x", "y", "z", "rotation"};
  fputs("\"type\": \"object\", \"minProperties\": 1, \"additionalProperties\": false, "
        "\"properties\": {",
        stream);
  for (int c = 0; c < (key->rotates ? 4 : 3); c++)
    fprintf(stream, "%s\"%s\": {\"$ref\": \"#/$defs/series\"}", c > 0 ? ", " : "", names[c]);
  fputs("}", stream);
}

/* What a value may be, without the braces around. */
static void put_value(FILE *stream, const cdem_case_key *key, int indent) {
  static const char names[] = "\"propertyNames\": {\"pattern\": \"^[A-Za-z0-9_-]{1,63}$\"}";
  switch (key->kind) {
  case CDEM_KEY_NUMBER:
  case CDEM_KEY_INTEGER:
    fputs("\"$ref\": \"#/$defs/quantity\"", stream);
    put_range(stream, key);
    break;
  case CDEM_KEY_BOOLEAN:
    fputs("\"enum\": [true, false, \"yes\", \"no\", \"on\", \"off\", \"true\", \"false\"]", stream);
    break;
  case CDEM_KEY_CHOICE:
    put_choices(stream, key);
    break;
  case CDEM_KEY_VECTOR:
    fprintf(stream,
            "\"type\": \"array\", \"minItems\": %d, \"maxItems\": %d, \"items\": {\"$ref\": "
            "\"#/$defs/quantity\"",
            key->fewest, key->length);
    put_range(stream, key);
    fputs("}", stream);
    break;
  case CDEM_KEY_SERIES:
    fputs("\"$ref\": \"#/$defs/series\"", stream);
    break;
  case CDEM_KEY_COMPONENTS:
    put_components(stream, key);
    break;
  case CDEM_KEY_TEXT:
    fputs("\"$ref\": \"#/$defs/text\"", stream);
    break;
  case CDEM_KEY_TEXTS:
    fputs("\"$ref\": \"#/$defs/texts\"", stream);
    break;
  case CDEM_KEY_NUMBERS:
    fputs("\"type\": \"object\", \"additionalProperties\": {\"$ref\": \"#/$defs/quantity\"}",
          stream);
    break;
  case CDEM_KEY_SECTION:
    put_section(stream, key->section, indent);
    break;
  case CDEM_KEY_LIST:
    fputs("\"type\": \"array\", \"items\": {", stream);
    put_section(stream, key->section, indent);
    fputs("}", stream);
    break;
  case CDEM_KEY_NAMED:
    fprintf(stream, "\"type\": \"object\", %s, \"additionalProperties\": {", names);
    put_section(stream, key->section, indent);
    fputs("}", stream);
    break;
  case CDEM_KEY_MATERIAL: /* put_material_keys */
    break;
  }
}

static void put_property(FILE *stream, const cdem_case_key *key, bool first, int indent) {
  fprintf(stream, "%s%*s", first ? "\n" : ",\n", indent, "");
  cdem_json_text(stream, key->key);
  fputs(": {\"description\": ", stream);
  cdem_json_text(stream, key->help);
  fputs(", ", stream);
  put_value(stream, key, indent + 2);
  fputs("}", stream);
}

/* ---- materials: keys of all models, and which of them each model needs ---- */

typedef struct {
  FILE *stream;
  int indent;
} printing;

static bool is_of_material(const char *path, const cdem_case_key *key) {
  return strncmp(path, "materials.NAME.", 15) == 0 &&
         cdem_case_key_find(cdem_case_key_find(cdem_case_root(), "materials")->section, key->key) ==
             NULL;
}

static void put_material_key(void *context, const char *path, const cdem_case_key *key) {
  const printing *p = context;
  if (is_of_material(path, key))
    put_property(p->stream, key, strcmp(key->key, "model") == 0, p->indent);
}

static void put_material_rules(FILE *stream, int indent) {
  fprintf(stream, ",\n%*s\"allOf\": [", indent - 2, "");
  for (int m = 0; m < CDEM_MATERIAL_MODEL_COUNT; m++) {
    const cdem_material_model_info *info = cdem_material_model_get((cdem_material_model)m);
    fprintf(stream, "%s\n%*s{\"if\": {", m > 0 ? "," : "", indent, "");
    fprintf(stream, "\"properties\": {\"model\": {\"const\": \"%s\"}}", info->name);
    /* without a `model` only the first rule holds: isotropic */
    fprintf(stream, "%s}, \"then\": {\"required\": [", m > 0 ? ", \"required\": [\"model\"]" : "");
    bool first = true;
    for (int k = 0; k < info->keys; k++) {
      if (info->key[k].optional)
        continue;
      fprintf(stream, "%s\"%s\"", first ? "" : ", ", info->key[k].key);
      first = false;
    }
    fputs("]}}", stream);
  }
  fputs("]", stream);
}

/* ---- sections ---- */

static void put_object(FILE *stream, const cdem_case_section *section, int indent) {
  bool first = true, material = false;
  fputs("\"type\": \"object\", \"additionalProperties\": false", stream);
  for (int k = 0; k < section->keys; k++)
    if (section->key[k].required) {
      fprintf(stream, "%s\"%s\"", first ? ", \"required\": [" : ", ", section->key[k].key);
      first = false;
    }
  fprintf(stream, "%s,\n%*s\"properties\": {", first ? "" : "]", indent - 2, "");
  for (int k = 0; k < section->keys; k++) {
    if (section->key[k].kind == CDEM_KEY_MATERIAL) {
      printing p = {stream, indent};
      cdem_case_walk(put_material_key, &p);
      material = true;
    } else {
      put_property(stream, &section->key[k], k == 0, indent);
    }
  }
  fputs("}", stream);
  if (material)
    put_material_rules(stream, indent);
}

static void put_section(FILE *stream, const cdem_case_section *section, int indent) {
  if (section->shorthand == NULL) {
    put_object(stream, section, indent + 2);
    return;
  }
  fputs("\"anyOf\": [{", stream);
  put_value(stream, cdem_case_key_find(section, section->shorthand), indent);
  fputs("}, {", stream);
  put_object(stream, section, indent + 2);
  fputs("}]", stream);
}

cdem_status cdem_write_case_schema(FILE *stream, cdem_fault *fault) {
  fputs("{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n"
        "  \"title\": \"Case of cdem\",\n  ",
        stream);
  put_section(stream, cdem_case_root(), 2);
  fputs(",\n", stream);
  fputs(definitions, stream);
  fputs("}\n", stream);
  CDEM_REQUIRE(!ferror(stream), fault, CDEM_FILE,
               "the JSON Schema of case files could not be written; is the disk full?");
  return CDEM_OK;
}
