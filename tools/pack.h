/* cdem pack: settings, work and what is said at the end. */
#ifndef CDEM_TOOLS_PACK_H
#define CDEM_TOOLS_PACK_H

#include "command.h"
#include "dem/packing.h"

enum { PACK_OUTPUTS = 4 };

typedef struct {
  const cdem_packing *packing;
  cdem_packing_options options;
  cdem_compaction compaction;
  const char *output[PACK_OUTPUTS], *material, *table;
  int outputs;
  bool has_box, has_sizes, has_least, has_most, has_exponent, has_spread, has_radius;
  bool compact, json;
} pack_settings;

/* pack_options.c: one option; false when it is none of its own. */
bool pack_parse(pack_settings *settings, int key, const char *text);
extern const struct argp_option pack_option_table[];
/* What goes together and what does not; ends the program where it must. */
void pack_check(pack_settings *settings);

/* pack_report.c */
typedef struct {
  cdem_grains grains;
  cdem_compacted compacted;
  cdem_packing_contacts contacts;
} pack_result;
/* To stdout, as lines or one JSON object. */
void pack_print(const pack_settings *settings, const pack_result *result);

#endif
