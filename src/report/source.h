/* Private to report: a run as it was read, in memory. The page is written from it alone. */
#ifndef CDEM_REPORT_SOURCE_H
#define CDEM_REPORT_SOURCE_H

#include "cases/case.h"
#include "io/run_files.h"
#include "report/report.h"
#include "report/text.h"

typedef struct {
  char *name;          /* "pattern" */
  char *file;          /* "figures/pattern.png" */
  const char *type;    /* "image/png" */
  int64_t bytes;       /* of the file */
  unsigned char *data; /* [bytes]; NULL: too large, the page links to it */
} cdem_report_picture;

/* A data set for ParaView. */
typedef struct {
  char *file; /* "body.pvd" */
  int64_t frames, bytes;
} cdem_report_set;

typedef struct {
  const cdem_report_options *options;
  char *way;       /* from the page to the folder: "" or "../run/" */
  char *place;     /* the folder's path without slashes at its end */
  char *name;      /* its last part */
  cdem_case cases; /* of case.yaml */
  bool finished;   /* there is a summary */
  int64_t process; /* that writes to the folder; 0: none */
  cdem_summary_file summary;
  cdem_table history;            /* no rows where there is no history.csv yet */
  cdem_listing listing, figures; /* of the folder, of its pictures */
  int pictures;
  cdem_report_picture *picture; /* [pictures] without those that the page draws itself */
  int64_t sets, set_capacity;
  cdem_report_set *set; /* [sets] */
} cdem_report_source;

/* Pictures above the first, or which would make those inside exceed the second, are linked. */
enum { CDEM_REPORT_PICTURE_MOST = 4000000, CDEM_REPORT_PICTURES_MOST = 24000000 };

/* Reads everything; page: path of the page. */
cdem_status cdem_report_source_read(const cdem_report_options *options, const char *page,
                                    cdem_report_source *source, cdem_fault *fault);
/* Safe on a zeroed source. */
void cdem_report_source_release(cdem_report_source *source);

/* page.c: the whole page. made: charts, pictures and what is linked are counted. */
cdem_status cdem_report_page(const cdem_report_source *source, cdem_report_text *page,
                             cdem_report_made *made);

/* A section of the page: what stands below its heading, which has `id` as its anchor. Another one
 * is another function below and a line in page.c. */
typedef struct {
  const char *id, *title;
  bool (*there)(const cdem_report_source *source); /* NULL: always */
  void (*put)(const cdem_report_source *source, cdem_report_text *to, cdem_report_made *made);
} cdem_report_section;

void cdem_report_put_verdict(const cdem_report_source *source, cdem_report_text *to);
bool cdem_report_has_results(const cdem_report_source *source);
void cdem_report_put_results(const cdem_report_source *source, cdem_report_text *to,
                             cdem_report_made *made);
bool cdem_report_has_figures(const cdem_report_source *source);
void cdem_report_put_figures(const cdem_report_source *source, cdem_report_text *to,
                             cdem_report_made *made);
bool cdem_report_has_balances(const cdem_report_source *source);
void cdem_report_put_balances(const cdem_report_source *source, cdem_report_text *to,
                              cdem_report_made *made);
void cdem_report_put_settings(const cdem_report_source *source, cdem_report_text *to,
                              cdem_report_made *made);
void cdem_report_put_computed(const cdem_report_source *source, cdem_report_text *to,
                              cdem_report_made *made);
void cdem_report_put_repeat(const cdem_report_source *source, cdem_report_text *to,
                            cdem_report_made *made);
void cdem_report_put_files(const cdem_report_source *source, cdem_report_text *to,
                           cdem_report_made *made);
bool cdem_report_has_history(const cdem_report_source *source);
void cdem_report_put_history(const cdem_report_source *source, cdem_report_text *to,
                             cdem_report_made *made);

/* Whether the history has what a curve of the case shows. */
bool cdem_report_has_columns(const cdem_report_source *source, const cdem_case_curve *curve);

/* A column of the history as an array [rows]; NULL after a failure, which stays in `to`. */
double *cdem_report_column(const cdem_report_source *source, int column, double scale,
                           cdem_report_text *to);

/* style.c: the style sheet of the page. */
extern const char cdem_report_style[];

#endif
