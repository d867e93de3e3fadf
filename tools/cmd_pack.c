/* cdem pack KIND -o FILE: grains put in place. */
#include "base/suggest.h"
#include "io/grains_file.h"
#include "pack.h"

#include <stdlib.h>
#include <string.h>

static void set_kind(pack_settings *s, const char *name) {
  const char *names[16];
  int count = 0;
  if (s->packing != NULL)
    command_usage("one packing at a time: '%s' and '%s'", s->packing->name, name);
  s->packing = cdem_packing_find(name);
  if (s->packing != NULL)
    return;
  for (; count < 16 && cdem_packing_at(count) != NULL; count++)
    names[count] = cdem_packing_at(count)->name;
  const char *nearest = cdem_suggest(name, names, count);
  if (nearest != NULL)
    command_usage("there is no packing '%s'; did you mean '%s'?", name, nearest);
  command_usage("there is no packing '%s'; there are square, hexagonal, cubic, inward and loose",
                name);
}

static error_t parse(int key, char *text, struct argp_state *state) {
  pack_settings *s = state->input;
  if (pack_parse(s, key, text))
    return 0;
  if (key != ARGP_KEY_ARG)
    return ARGP_ERR_UNKNOWN;
  set_kind(s, text);
  return 0;
}

static cdem_status write_files(const pack_settings *s, pack_result *r, cdem_fault *fault) {
  const char *const name[1] = {s->material};
  cdem_grains *grains = &r->grains;
  if (s->material != NULL)
    CDEM_NEW(grains->material, grains->capacity, fault);
  for (int i = 0; i < s->outputs; i++)
    CDEM_TRY(cdem_write_grains(s->output[i], grains, s->material != NULL, name, fault));
  return CDEM_OK;
}

static cdem_status work(pack_settings *s, pack_result *r, cdem_fault *fault) {
  s->options.progress = s->compaction.progress = command_progress();
  const double *low = s->options.low, *high = s->options.high;
  if (s->compact)
    cdem_packing_make_room(&s->options, &s->compaction);
  CDEM_TRY(cdem_packing_make(s->packing, &s->options, &r->grains, fault));
  if (s->compact) {
    CDEM_TRY(cdem_packing_compact(&s->options, &s->compaction, &r->grains, &r->compacted, fault));
    low = r->compacted.low;
    high = r->compacted.high;
  }
  CDEM_TRY(
      cdem_packing_look(&r->grains, low, high, s->options.periodic, 1e-6, &r->contacts, fault));
  return write_files(s, r, fault);
}

int cmd_pack(int argc, char **argv) {
  static const struct argp argp = {
      pack_option_table,
      parse,
      "KIND",
      "Puts grains in place: square (turned by 45 degrees), hexagonal, cubic, inward (random, "
      "dense, 2-D), loose (random, no contacts; --compact presses it together).\v"
      "Lengths may have units. Same options, same bits.\n"
      "Examples:\n"
      "  cdem pack square --size 7,3.5 --radius 0.05 --centres-inside -o a.csv\n"
      "  cdem pack inward --size 7,3.5 --sizes power --least 0.02 --most 0.05 \\\n"
      "      --exponent -2.5 -o c.csv -o c.vtp\n"
      "  cdem pack loose --size 0.2,0.2,0.4 --cylinder --radius '5 mm' \\\n"
      "      --fraction 0.3 -o tube.csv\n"
      "  cdem pack loose --size 1,1,1 --periodic xyz --count 1000 --radius 0.04 \\\n"
      "      --compact --pressure '10 kPa' -o rcp.csv",
      NULL,
      NULL,
      NULL};
  pack_settings s = {.options = {.seed = 1}};
  pack_result result = {0};
  cdem_fault fault = {0};
  double *radius = NULL, *fraction = NULL;
  command_parse(&argp, argc, argv, &s);
  pack_check(&s);
  command_catch_interrupt();
  cdem_status status = CDEM_OK;
  if (s.table != NULL)
    status = cdem_read_sizes(s.table, &s.options.sizes.entries, &radius, &fraction, &fault);
  s.options.sizes.class_radius = radius;
  s.options.sizes.class_fraction = fraction;
  if (status == CDEM_OK)
    status = work(&s, &result, &fault);
  command_progress_end();
  int code = 0;
  if (status == CDEM_OK)
    pack_print(&s, &result);
  else
    code = command_fail(&fault);
  cdem_grains_release(&result.grains);
  free(radius);
  free(fraction);
  return code;
}
