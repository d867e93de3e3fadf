/* What cdem pack says at the end. */
#include "pack.h"

#include <math.h>

typedef struct {
  double least, most, fraction;
  double low[3], high[3];
} numbers;

static numbers numbers_of(const pack_settings *s, const pack_result *r) {
  numbers n = {.least = INFINITY};
  cdem_packing_options box = s->options;
  for (int64_t i = 0; i < r->grains.grains; i++) {
    n.least = fmin(n.least, r->grains.radius[i]);
    n.most = fmax(n.most, r->grains.radius[i]);
  }
  for (int c = 0; c < s->options.dim; c++) {
    n.low[c] = box.low[c] = s->compact ? r->compacted.low[c] : s->options.low[c];
    n.high[c] = box.high[c] = s->compact ? r->compacted.high[c] : s->options.high[c];
  }
  n.fraction = cdem_grains_solid(&r->grains) / cdem_packing_room(&box);
  return n;
}

static void print_point(const double at[3], int dim) {
  for (int c = 0; c < dim; c++)
    printf(c > 0 ? ", %.6g" : "(%.6g", at[c]);
  printf(")");
}

static void print_lines(const pack_settings *s, const pack_result *r, const numbers *n) {
  int dim = s->options.dim;
  printf("%s, %lld %s\n", s->packing->name, (long long)r->grains.grains,
         dim == 2 ? "discs" : "spheres");
  if (n->least == n->most)
    printf("  radius        %.6g m\n", n->least);
  else
    printf("  radius        %.6g to %.6g m\n", n->least, n->most);
  printf("  box           ");
  print_point(n->low, dim);
  printf(" to ");
  print_point(n->high, dim);
  printf(" m\n  fraction      %.6g of the %s\n", n->fraction,
         s->options.cylinder ? "cylinder" : "box");
  /* Rounding of a lattice or an inward packing is no overlap. */
  if (r->contacts.overlap > 1e-9)
    printf("  overlap       %.3g radii at most (grains %lld and %lld)\n", r->contacts.overlap,
           (long long)r->contacts.pair[0], (long long)r->contacts.pair[1]);
  else
    printf("  overlap       none\n");
  printf("  neighbours    %.4g a grain\n", r->contacts.coordination);
  if (s->compact)
    printf("  pressure      %.6g Pa, unbalanced force %.2g of the mean, %lld steps\n",
           r->compacted.pressure, r->compacted.unbalanced, (long long)r->compacted.steps);
  for (int i = 0; i < s->outputs; i++)
    printf("  written to    %s\n", s->output[i]);
}

static void put_json(const char *key, double value) {
  printf(",\n  \"%s\": ", key);
  cdem_json_number(stdout, value);
}

static void put_json_point(const char *key, const double at[3], int dim) {
  printf(",\n  \"%s\": [", key);
  for (int c = 0; c < dim; c++) {
    printf(c > 0 ? ", " : "");
    cdem_json_number(stdout, at[c]);
  }
  printf("]");
}

static void print_json(const pack_settings *s, const pack_result *r, const numbers *n) {
  int dim = s->options.dim;
  printf("{\n  \"kind\": \"%s\",\n  \"dimension\": %d,\n  \"grains\": %lld,\n  \"seed\": %llu",
         s->packing->name, dim, (long long)r->grains.grains, (unsigned long long)s->options.seed);
  put_json("radius_least", n->least);
  put_json("radius_most", n->most);
  put_json_point("low", n->low, dim);
  put_json_point("high", n->high, dim);
  put_json("fraction", n->fraction);
  put_json("overlap", r->contacts.overlap);
  put_json("coordination", r->contacts.coordination);
  if (s->compact) {
    put_json("pressure", r->compacted.pressure);
    put_json("unbalanced", r->compacted.unbalanced);
    printf(",\n  \"steps\": %lld", (long long)r->compacted.steps);
  }
  printf(",\n  \"files\": [");
  for (int i = 0; i < s->outputs; i++) {
    printf(i > 0 ? ", " : "");
    cdem_json_text(stdout, s->output[i]);
  }
  printf("]\n}\n");
}

void pack_print(const pack_settings *settings, const pack_result *result) {
  numbers n = numbers_of(settings, result);
  if (settings->json)
    print_json(settings, result, &n);
  else if (!command_quiet)
    print_lines(settings, result, &n);
}
