/* Group scaling: a scaled run is the original but for its size. */
#include "verify/scaling.h"

#include "verify/verify.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SOURCE            "Wang et al. 2024, eqs 6 to 9"
#define THEORY            "docs/theory/scaling.md, "
#define MEASURE(of, name) .kind = CDEM_CHECK_##of, .measure = cdem_scaling_measure_##name

/* A case by four choices of base ratios. */
#define BITS(what, which)                                                                          \
  {what ", h = 2: numbers that are off",                                                           \
   SOURCE,                                                                                         \
   0,                                                                                              \
   0,                                                                                              \
   MEASURE(SAME_BITS, bits),                                                                       \
   .parameter = 10 * (which)},                                                                     \
      {what ", h = 4: numbers that are off", SOURCE,      0, 0, MEASURE(SAME_BITS, bits),          \
       .parameter = 10 * (which) + 1,        .slow = true},                                        \
      {what ", h = 1/2: numbers that are off", SOURCE,      0, 0, MEASURE(SAME_BITS, bits),        \
       .parameter = 10 * (which) + 2,          .slow = true},                                      \
      {what ", length 2, time 4, density 1: numbers that are off",                                 \
       SOURCE,                                                                                     \
       0,                                                                                          \
       0,                                                                                          \
       MEASURE(SAME_BITS, bits),                                                                   \
       .parameter = 10 * (which) + 3},                                                             \
  {                                                                                                \
    what ", length 4, time 2, density 2: numbers that are off", SOURCE, 0, 0,                      \
        MEASURE(SAME_BITS, bits), .parameter = 10 * (which) + 4, .slow = true                      \
  }

static const cdem_verification checks[] = {
    {"factors of table 1, h = 3: worst relative error", "Wang et al. 2024, table 1", 0, 4e-16,
     MEASURE(PUBLISHED, ratios)},
    BITS("elastic body", CDEM_SCALING_BODY),
    BITS("blocks that break and touch", CDEM_SCALING_FRACTURE),
    BITS("blocks that break, 3-D", CDEM_SCALING_SOLID),
    BITS("spheres between walls, Mindlin", CDEM_SCALING_SPHERES),
    BITS("spheres in a cell, Hertz", CDEM_SCALING_HERTZ),
    BITS("discs, linear with rolling", CDEM_SCALING_DISCS),
    BITS("static Cosserat body", CDEM_SCALING_STATIC),
    BITS("bonded spheres, relaxed", CDEM_SCALING_BONDED),
    BITS("grains in a Cosserat medium", CDEM_SCALING_FOOTING),
    /* A lattice in a periodic cell has one stress, whatever the size of its grains, if their
       stiffness follows: kn eps d/(d (1 - eps))^2. Balanced to 1e-5. */
    {"cubic lattice pressed together: stress over the closed form", THEORY "section 5", 1, 1e-4,
     MEASURE(CLOSED_FORM, window), .parameter = 0},
    {"the same coarse-grained by 2: stress over that of the fine one", THEORY "section 5", 1, 1e-6,
     MEASURE(LAW, window), .parameter = 1},
    {"the same without the rule: stress over that of the fine one", THEORY "section 5", 0.5, 1e-6,
     MEASURE(CLOSED_FORM, window), .parameter = 2},
    {"the same with Hertz' law without the rule", THEORY "section 5", 1, 1e-6, MEASURE(LAW, window),
     .parameter = 3},
    /* The waves at its start differ, and with them when the step is chosen anew. */
    {"steps of the coarse lattice over those of the fine one", THEORY "eq. (7)", 1, 0.01,
     MEASURE(LAW, window), .parameter = 4},
    {"the same at the same rate", THEORY "eq. (7)", 0.5, 0.005, MEASURE(LAW, window),
     .parameter = 5},
    BITS("deformable grains, implicit", CDEM_SCALING_FDEM),
    BITS("deformable grains, explicit", CDEM_SCALING_EXPLICIT),
    BITS("triaxial test of spheres in a membrane", CDEM_SCALING_TRIAXIAL),
    BITS("triaxial test of deformable grains", CDEM_SCALING_DEFORMED),
    /* No power of two: rounding, which grows by collisions and cracks; so without them, or short.
     */
    {"elastic body, h = 3: difference", THEORY "section 4", 0, 1e-9, MEASURE(LAW, rounding),
     .parameter = CDEM_SCALING_BODY},
    {"static Cosserat body, h = 3: difference", THEORY "section 4", 0, 1e-9, MEASURE(LAW, rounding),
     .parameter = CDEM_SCALING_STATIC},
    {"spheres between walls, Mindlin, h = 3: difference in 30 ms", THEORY "section 4", 0, 1e-9,
     MEASURE(LAW, rounding), .parameter = CDEM_SCALING_SPHERES},
};

const cdem_verify_group cdem_verify_scaling = {
    "scaling", "exact scaling: scaled runs repeat their originals to the last bit",
    sizeof checks / sizeof checks[0], checks};

cdem_status cdem_scaling_measure_bits(int parameter, double *value, cdem_fault *fault) {
  static const cdem_ratios ratios[] = {
      {2.0, 2.0, 8.0}, {4.0, 4.0, 64.0}, {0.5, 0.5, 0.125}, {2.0, 4.0, 8.0}, {4.0, 2.0, 128.0}};
  cdem_scaling_difference d;
  CDEM_TRY(cdem_scaling_pair(cdem_scaling_text[parameter / 10], &ratios[parameter % 10], true, &d,
                             fault));
  *value = (double)d.off;
  return CDEM_OK;
}

cdem_status cdem_scaling_measure_rounding(int parameter, double *value, cdem_fault *fault) {
  const cdem_ratios ratios = cdem_ratios_of_size(3.0);
  const char *text = cdem_scaling_text[parameter];
  char shortened[4096];
  cdem_scaling_difference d;
  if (parameter == CDEM_SCALING_SPHERES) { /* its first line is its end */
    snprintf(shortened, sizeof shortened, "end: 30 ms%s", strchr(text, '\n'));
    text = shortened;
  }
  CDEM_TRY(cdem_scaling_pair(text, &ratios, false, &d, fault));
  *value = d.apart;
  return CDEM_OK;
}

/* Dimension and power of h: the rows of the source's table, then those of
 * docs/theory/scaling.md. */
cdem_status cdem_scaling_measure_ratios(int parameter, double *value, cdem_fault *fault) {
  static const struct {
    cdem_dimension dimension;
    int power;
  } rows[] = {{{1, 0, 0}, 1},   {{0, 1, 0}, 1},   {{0, 0, 1}, 3},    {{1, -2, 1}, 2},
              {{-1, -2, 1}, 0}, {{0, 0, 0}, 0},   {{-2, -2, 1}, -1}, {{0, -2, 1}, 1},
              {{1, -2, 0}, -1}, {{0, -1, 0}, -1}, {{1, -1, 0}, 0},   {{2, -2, 1}, 3},
              {{0, -1, 1}, 2},  {{2, -1, 1}, 4},  {{-1, -1, 1}, 1},  {{-3, 0, 1}, 0}};
  const cdem_ratios ratios = cdem_ratios_of_size(3.0);
  (void)parameter, (void)fault;
  *value = 0.0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    double wanted = pow(3.0, rows[i].power);
    *value = fmax(*value, fabs(cdem_ratio(&ratios, rows[i].dimension) / wanted - 1.0));
  }
  return CDEM_OK;
}
