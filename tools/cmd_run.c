/* cdem run CASE.yaml [-o DIR]: one run, from a case to a folder of results. */
#include "base/version.h"
#include "command.h"
#include "io/run_files.h"
#include "run/run.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  OPTION_RESUME = 256,
  OPTION_SET,
  OPTION_THREADS,
  OPTION_NO_FIGURES,
  OPTION_NO_FRAMES,
  OPTION_JSON,
  OPTION_CHECK,
  MOST_PATH = 3800 /* leaves room for the names in the folder */
};

static const struct argp_option option_table[] = {
    {"output", 'o', "DIR", 0, "folder of the results (the case's name + \"-run\")", 0},
    {"resume", OPTION_RESUME, "DIR", 0, "continue the run in DIR from its checkpoint", 0},
    {"set", OPTION_SET, "KEY=VALUE", 0, "replace a value of the case: --set mesh.parameters.h=0.01",
     0},
    {"threads", OPTION_THREADS, "N", 0,
     "threads (default: as many as the size of the problem is worth); results do not depend on it",
     0},
    {"check", OPTION_CHECK, NULL, 0, "read and build everything, run nothing", 0},
    {"no-figures", OPTION_NO_FIGURES, NULL, 0, "draw no figures", 0},
    {"no-frames", OPTION_NO_FRAMES, NULL, 0, "write no .pvd and .vtu frames", 0},
    {"json", OPTION_JSON, NULL, 0, "print summary.json in place of the table", 0},
    {"quiet", 'q', NULL, 0, "no talk and no progress on stderr, no table", 0},
    {0},
};

typedef struct {
  const char *path, *folder, *resume;
  command_overrides set;
  int threads;
  bool check, no_figures, no_frames, json;
} settings;

static const char *folder_name(const char *option, const char *text) {
  if (text[0] == '\0' || strlen(text) > MOST_PATH)
    command_usage("%s '%.40s': the name of a folder is wanted, of 1 to %d letters", option, text,
                  MOST_PATH);
  return text;
}

static error_t parse(int key, char *text, struct argp_state *state) {
  settings *s = state->input;
  switch (key) {
  case 'o':
    s->folder = folder_name("-o", text);
    return 0;
  case OPTION_RESUME:
    s->resume = folder_name("--resume", text);
    return 0;
  case OPTION_SET:
    command_override(&s->set, text);
    return 0;
  case OPTION_THREADS:
    s->threads = (int)command_integer("--threads", text, 1, 1024);
    return 0;
  case OPTION_CHECK:
    s->check = true;
    return 0;
  case OPTION_NO_FIGURES:
    s->no_figures = true;
    return 0;
  case OPTION_NO_FRAMES:
    s->no_frames = true;
    return 0;
  case OPTION_JSON:
    s->json = true;
    return 0;
  case 'q':
    command_quiet = true;
    return 0;
  case ARGP_KEY_ARG:
    if (s->path != NULL)
      command_usage("one case at a time: '%s' and '%s'", s->path, text);
    s->path = text;
    return 0;
  }
  return ARGP_ERR_UNKNOWN;
}

static void check_settings(const settings *s) {
  if (s->path == NULL && s->resume == NULL)
    command_usage("a case is wanted (.yaml), or --resume DIR");
  if (s->resume == NULL)
    return;
  if (s->path != NULL)
    command_usage("--resume takes the case of its folder; leave '%s' out", s->path);
  if (s->folder != NULL)
    command_usage("--resume writes into its own folder; leave -o out");
  if (s->set.count > 0 || s->check)
    command_usage("a run that is continued keeps its case: no --set and no --check");
}

/* "cases/beam.yaml" -> "beam-run", in the current folder. */
static void default_folder(const char *path, char folder[4096]) {
  const char *slash = strrchr(path, '/'), *name = slash != NULL ? slash + 1 : path;
  const char *dot = strrchr(name, '.');
  int length = dot != NULL && dot != name ? (int)(dot - name) : (int)strlen(name);
  snprintf(folder, 4096, "%.*s-run", length, name);
}

/* gmsh can end or crash the program while it reads a mesh; the guard turns that into a message. */
static bool report(void *context, const char *what, int64_t done, int64_t total) {
  const cdem_progress *progress = command_progress();
  command_guard(strcmp(what, "reading the mesh") == 0 ? context : NULL);
  return progress->report(progress->context, what, done, total);
}

/* ---- what is said at the end ---- */

static void print_body(const cdem_run_summary *r) {
  printf("  size          %lld elements (%lld distinct), %lld nodes, %lld unknowns\n",
         (long long)r->elements, (long long)r->distinct, (long long)r->nodes,
         (long long)r->unknowns);
  printf("  blocks        %lld, %lld faces between them\n", (long long)r->blocks,
         (long long)r->interfaces);
}

static void print_sizes(const cdem_run_summary *r) {
  if (r->fine > 0) {
    printf("  fine region   %lld grains, %lld interface grains, %d steps a step\n",
           (long long)r->fine, (long long)r->interface_grains, r->cycles);
    if (r->elements > 0)
      print_body(r);
  }
  if (r->grains > 0) {
    printf("  size          %lld grains, %lld contacts, %lld walls", (long long)r->grains,
           (long long)r->contacts, (long long)r->walls);
    printf(r->bonds > 0 ? ", %lld bonds\n" : "\n", (long long)r->bonds);
    return;
  }
  print_body(r);
}

/* A title may hold what a terminal would obey. */
static void print_line(const char *text) {
  for (; *text != '\0'; text++)
    putchar(iscntrl((unsigned char)*text) ? ' ' : *text);
  putchar('\n');
}

static void print_check(const cdem_run_summary *r) {
  print_sizes(r);
  if (r->step > 0.0)
    printf("  step          %.4g s, limited by %s\n", r->step, r->limiter);
}

static void print_keys(const cdem_table *keys) {
  if (keys->rows > 0)
    printf("  %-24s %14s %-6s %14s %12s\n", "result", "value", "unit", "reference", "difference");
  for (int64_t r = 0; r < keys->rows; r++) {
    const cdem_value *value = cdem_table_at(keys, r, 1), *reference = cdem_table_at(keys, r, 3),
                     *off = cdem_table_at(keys, r, 4);
    printf("  %-24s %14.6g %-6s", cdem_table_at(keys, r, 0)->text,
           value->absent ? NAN : value->real, cdem_table_at(keys, r, 2)->text);
    if (!reference->absent) {
      printf(" %14.6g", reference->real);
      if (reference->real != 0.0)
        printf(" %+10.3f %%", 100.0 * off->real);
      else
        printf(" %12.3g", off->real);
    }
    printf("\n");
  }
}

static void print_summary(const cdem_run_summary *r, const char *folder) {
  if (r->title != NULL)
    print_line(r->title);
  print_sizes(r);
  if (r->steps > 0) {
    bool grains = r->grains > 0;
    double cycles = grains && r->cycles > 0 ? r->cycles : 1.0;
    double work = (double)r->steps * cycles * (double)(grains ? r->grains : r->elements);
    printf("  steps         %lld of %.4g s (limited by %s), to t = %.6g s\n", (long long)r->steps,
           r->step, r->limiter, r->time);
    printf("  wall time     %.3g s, %.3g %s-steps/s\n", r->wall,
           r->wall > 0.0 ? work / r->wall : 0.0, grains ? "grain" : "element");
    printf("  energy error  %.2e\n", r->energy_error);
  } else {
    printf("  wall time     %.3g s\n", r->wall);
  }
  print_keys(&r->keys);
  printf("  results in    %s\n", folder);
  printf("  one page      cdem report %s\n", folder);
}

static int print_json(const char *folder) {
  char path[4200], *text = NULL;
  cdem_fault fault = {0};
  snprintf(path, sizeof path, "%s/summary.json", folder);
  if (cdem_read_text(path, &text, &fault) != CDEM_OK)
    return command_fail(&fault);
  fputs(text, stdout);
  free(text);
  return 0;
}

static int finish(const settings *s, const cdem_run_summary *summary, const char *folder) {
  int code = 0;
  if (s->check)
    print_check(summary);
  else if (s->json)
    code = print_json(folder);
  else if (!command_quiet)
    print_summary(summary, folder);
  if (code != 0 || summary->failed == 0)
    return code;
  fflush(stdout);
  command_say("%d of %d key results are off by more than their tolerance", summary->failed,
              summary->results);
  return cdem_status_exit_code(CDEM_CHECK);
}

int cmd_run(int argc, char **argv) {
  static const struct argp argp = {
      option_table,
      parse,
      "CASE.yaml",
      "Runs a case: CDEM with blocks, breakable interfaces and contact, or DEM of grains.\v"
      "`cdem help case` explains the case file. Ctrl-C writes a checkpoint; `cdem run --resume "
      "DIR` "
      "goes on from it to the same bits. Exit code 1 when a key result with a tolerance is off.",
      NULL,
      NULL,
      NULL};
  settings s = {0};
  command_parse(&argp, argc, argv, &s);
  check_settings(&s);
  char folder[4096];
  if (s.resume != NULL || s.folder != NULL)
    snprintf(folder, sizeof folder, "%s", s.resume != NULL ? s.resume : s.folder);
  else
    default_folder(s.path, folder);
  const cdem_progress progress = {.context = (void *)s.path, .report = report};
  const cdem_warnings warnings = command_warnings();
  const cdem_run_options options = {.path = s.path,
                                    .folder = folder,
                                    .resume = s.resume != NULL,
                                    .check = s.check,
                                    .overrides = s.set.count,
                                    .override = s.set.text,
                                    .threads = s.threads,
                                    .figures = !s.no_figures,
                                    .frames = !s.no_frames,
                                    .version = cdem_version(),
                                    .commit = cdem_version_commit(),
                                    .build = cdem_version_build(),
                                    .progress = &progress,
                                    .warnings = &warnings};
  cdem_run_summary summary = {0};
  cdem_fault fault = {0};
  command_catch_interrupt();
  cdem_status status = cdem_run(&options, &summary, &fault);
  command_guard(NULL);
  command_progress_end();
  int code = status == CDEM_OK ? finish(&s, &summary, folder) : command_fail(&fault);
  cdem_run_summary_release(&summary);
  return code;
}
