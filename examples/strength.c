/* A case, run for a series of values of one of its keys: how strength depends on friction, say.
 *
 *   cc strength.c $(pkg-config --cflags --libs cdem) -o strength
 *   ./strength /usr/share/cdem/cases/compression.yaml 'interfaces[0].friction' out 0 0.15 0.3
 *
 * Each run goes to a folder of its own, out-1, out-2, ...; a line a run is printed with the key
 * results of the case. Values may have units ("2 MPa"). Progress goes to stderr where that is a
 * terminal. Exit codes are those of cdem: 2 wrong usage, 3 a case that cannot be, ...
 */
#include <libcdem.h>
#include <stdio.h>
#include <unistd.h>

enum { FIRST_VALUE = 4 };

static bool show(void *context, const char *what, int64_t done, int64_t total) {
  if (total > 0 && isatty(STDERR_FILENO))
    fprintf(stderr, "\r%s: %s %3d %% \033[K", (const char *)context, what,
            (int)(100 * done / total));
  return true;
}

static void warn(void *context, const char *message) {
  fprintf(stderr, "warning: %s: %s\n", (const char *)context, message);
}

static void print_results(const libcdem_run *run, const char *key, const char *value, bool first) {
  if (first) {
    printf("%s", key);
    for (int64_t i = 0; i < libcdem_run_results(run); i++) {
      const libcdem_result *result = libcdem_run_result(run, i);
      printf("\t%s%s%s", result->name, result->unit[0] != '\0' ? ", " : "", result->unit);
    }
    printf("\n");
  }
  printf("%s", value);
  for (int64_t i = 0; i < libcdem_run_results(run); i++)
    printf("\t%.6g", libcdem_run_result(run, i)->value);
  printf("\n");
  fflush(stdout);
}

static libcdem_status run_one(char **argv, int i, libcdem_fault *fault) {
  char assignment[512], folder[4096];
  const libcdem_listener listener = {argv[i], show, warn};
  libcdem_run *run = NULL;
  snprintf(assignment, sizeof assignment, "%s=%s", argv[2], argv[i]);
  snprintf(folder, sizeof folder, "%s-%d", argv[3], i - FIRST_VALUE + 1);
  libcdem_status status = libcdem_run_create(argv[1], &run, fault);
  if (status == LIBCDEM_OK)
    status = libcdem_run_set(run, assignment, fault);
  if (status == LIBCDEM_OK)
    status = libcdem_run_choose(run, LIBCDEM_RUN_FRAMES, 0, fault);
  if (status == LIBCDEM_OK)
    status = libcdem_run_choose(run, LIBCDEM_RUN_FIGURES, 0, fault);
  if (status == LIBCDEM_OK)
    status = libcdem_run_start(run, folder, &listener, fault);
  if (isatty(STDERR_FILENO))
    fprintf(stderr, "\r\033[K");
  if (status == LIBCDEM_OK)
    print_results(run, argv[2], argv[i], i == FIRST_VALUE);
  libcdem_run_destroy(&run);
  return status;
}

int main(int argc, char **argv) {
  if (argc <= FIRST_VALUE) {
    fprintf(stderr, "usage: %s CASE.yaml KEY FOLDER VALUE...\n", argv[0]);
    return LIBCDEM_USAGE;
  }
  for (int i = FIRST_VALUE; i < argc; i++) {
    libcdem_fault fault = {0};
    libcdem_status status = run_one(argv, i, &fault);
    if (status != LIBCDEM_OK) {
      fprintf(stderr, "error: %s = %s: %s\n", argv[2], argv[i], fault.message);
      return (int)status;
    }
  }
  return 0;
}
