/* Room report: a run as one page.
 *
 * What `cdem run` left in a folder becomes one HTML file that stands alone: no script, nothing from
 * the network, styles and pictures inside, readable in light and dark, on a phone and on paper.
 * Only links to the files of the run lead out of it, relative to where the page lies.
 *
 *     source.c           what is read: case, summary, history, pictures, folder
 *     page.c, page_*.c   the page as text; no file is opened there
 *     style.c            its look
 *     chart.c            curves as inline SVG
 *     number.c, text.c   numbers; escaping
 *
 * The case and its schema say which settings there are, their units, and which are defaults; the
 * summary what came out; the history the curves and the energy book. A run that has not ended has
 * no summary: its page says so and shows what is there.
 */
#ifndef CDEM_REPORT_REPORT_H
#define CDEM_REPORT_REPORT_H

#include "base/base.h"
#include "io/io.h"

typedef struct {
  const char *folder;           /* of the run */
  const char *path;             /* of the page; NULL: FOLDER/report.html; "-": standard output */
  const char *version, *commit; /* of the program that makes the page */
} cdem_report_options;

typedef struct {
  char path[4200];
  int64_t bytes;
  int charts, pictures; /* curves drawn here, pictures of the run */
  int linked;           /* pictures too large to be put inside, which are linked */
  bool finished;        /* the run has ended */
} cdem_report_made;

/* CDEM_INPUT: the folder is none of a run, or a file in it is not as a run wrote it (file, line and
 * remedy are said). CDEM_FILE: a file cannot be read, or the page cannot be written; an earlier
 * page then stays as it was. */
cdem_status cdem_report(const cdem_report_options *options, cdem_report_made *made,
                        cdem_fault *fault);

#endif
