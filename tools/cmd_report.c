/* cdem report RUN: one page of a run. */
#include "base/version.h"
#include "command.h"
#include "report/report.h"

#include <string.h>

static const struct argp_option option_table[] = {
    {"output", 'o', "FILE", 0, "the page, .html (RUN/report.html); - is standard output", 0},
    {"quiet", 'q', NULL, 0, "no talk on stderr", 0},
    {0},
};

typedef struct {
  const char *folder, *path;
} settings;

/* So that no file of a run is replaced by a page. */
static bool is_page(const char *path) {
  const char *slash = strrchr(path, '/'), *name = slash != NULL ? slash + 1 : path;
  const char *dot = strrchr(name, '.');
  if (strcmp(path, "-") == 0 || strncmp(path, "/dev/", 5) == 0)
    return true;
  return dot != NULL && dot != name &&
         (strcmp(dot, ".html") == 0 || strcmp(dot, ".htm") == 0 || strcmp(dot, ".xhtml") == 0);
}

static error_t parse(int key, char *text, struct argp_state *state) {
  enum { MOST_PATH = 4000 };
  settings *s = state->input;
  switch (key) {
  case 'o':
    if (!is_page(text) || strlen(text) > MOST_PATH)
      command_usage("-o '%.40s': a file NAME.html is wanted, or -", text);
    s->path = text;
    return 0;
  case 'q':
    command_quiet = true;
    return 0;
  case ARGP_KEY_ARG:
    if (s->folder != NULL)
      command_usage("one run at a time: '%s' and '%s'; `cdem compare` puts runs side by side",
                    s->folder, text);
    s->folder = text;
    return 0;
  }
  return ARGP_ERR_UNKNOWN;
}

static void say(const cdem_report_made *made) {
  if (made->linked > 0)
    command_warn("%d picture%s too large to be put into the page; %s linked", made->linked,
                 made->linked == 1 ? " is" : "s are", made->linked == 1 ? "it is" : "they are");
  if (!made->finished)
    command_warn("the run has not ended; the page says so and shows what is there");
  command_say("%s: %.2f MB, %d curve%s and %d picture%s of the run", made->path,
              1e-6 * (double)made->bytes, made->charts, made->charts == 1 ? "" : "s",
              made->pictures, made->pictures == 1 ? "" : "s");
}

int cmd_report(int argc, char **argv) {
  static const struct argp argp = {
      option_table,
      parse,
      "RUN",
      "Makes one HTML page of a run: verdict, key results, figures, balances, settings with units, "
      "how to repeat it, links to its files.\v"
      "RUN is a folder that `cdem run` has written, also one whose run has not ended. The page "
      "needs "
      "no script and nothing from the network, and links to the files of the run from where it is "
      "written to.\n"
      "Examples:\n"
      "  cdem report bar-run\n"
      "  cdem report bar-run -o pages/bar.html",
      NULL,
      NULL,
      NULL};
  settings s = {0};
  cdem_fault fault = {0};
  cdem_report_made made;
  command_parse(&argp, argc, argv, &s);
  if (s.folder == NULL)
    command_usage("the folder of a run is wanted: cdem report RUN");
  const cdem_report_options options = {.folder = s.folder,
                                       .path = s.path,
                                       .version = cdem_version(),
                                       .commit = cdem_version_commit()};
  if (cdem_report(&options, &made, &fault) != CDEM_OK)
    return command_fail(&fault);
  say(&made);
  return 0;
}
