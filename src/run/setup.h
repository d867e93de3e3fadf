/* Private to run: a case on its way to a run: what every engine shares. */
#ifndef CDEM_RUN_SETUP_H
#define CDEM_RUN_SETUP_H

#include "cases/case.h"
#include "run/engine.h"

struct cdem_run_setup {
  const cdem_run_options *options;
  cdem_case cases;
  uint64_t case_sum;  /* FNV-1a of the case's text as a person wrote it */
  uint64_t kept_sum;  /* of the text in the folder, which names its files from the root on */
  uint64_t input_sum; /* of the arrays of the mesh or of the grains */
  int threads;        /* as asked, or what the size of the problem is worth */
  char limiter[64];   /* what limits the step */
  const cdem_run_engine *engine;
  void *context; /* of the engine; owned by it */
};

/* The whole way from options to a state at time zero. `checkpoint`: of a broken run (the state is
 * restored by the caller); NULL: a new run. Release at any stage. */
cdem_status cdem_run_setup_init(const cdem_run_options *options, const cdem_state *checkpoint,
                                cdem_run_setup *setup, cdem_fault *fault);
void cdem_run_setup_release(cdem_run_setup *setup);

static inline const cdem_case_values *cdem_run_values(const cdem_run_setup *setup) {
  return &setup->cases.values;
}
static inline cdem_run_now cdem_run_where(const cdem_run_setup *setup) {
  cdem_run_now now;
  setup->engine->now(setup, &now);
  return now;
}

/* "section[i].rest" or "section.name.rest" into text [96]. */
const char *cdem_run_key(char text[96], const char *section, int64_t index, const char *rest);
const char *cdem_run_named_key(char text[96], const char *section, const char *name,
                               const char *rest);
/* "walls.NAME" into text [96] where a message speaks of that wall of the case; else NULL. */
const char *cdem_run_wall_key(const cdem_run_setup *setup, const char *message, char text[96]);
/* A failure of a solver's making as one of the run: CDEM_INPUT is pointed at the key. */
cdem_status cdem_run_refused(const cdem_run_setup *setup, const char *key, cdem_status status,
                             const char *message, cdem_fault *fault);
extern const char *const cdem_run_component[4]; /* x y z rotation */

/* FNV-1a, 64 bit (Fowler, Noll, Vo): enough to tell inputs apart, no more. */
uint64_t cdem_run_checksum(uint64_t sum, const void *data, size_t bytes);
static const uint64_t CDEM_RUN_SUM_START = 0xcbf29ce484222325u;

/* Whether a wanted step is stable and `end` within reach; failures at `step` and `end`. */
cdem_status cdem_run_check_step(const cdem_run_setup *setup, double limit, cdem_fault *fault);
/* On the way: CDEM_NUMERIC where a step that the case gives is beyond the limit of now. */
cdem_status cdem_run_check_stable(const cdem_run_setup *setup, double limit, const char *limiter,
                                  cdem_fault *fault);
/* The step next below `step` of which a whole number ends at `end`. */
double cdem_run_even_step(const cdem_run_setup *setup, double step);

#endif
