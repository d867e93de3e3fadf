/* Private to report: a text that grows, and what HTML asks of what is put into it.
 *
 * The first failure stays in `status`, and nothing is added after it: whoever writes a page looks
 * once, at its end. Markup is XHTML-clean (void elements closed, no named entities), so that a
 * strict XML reader takes the page.
 */
#ifndef CDEM_REPORT_TEXT_H
#define CDEM_REPORT_TEXT_H

#include "base/base.h"

typedef struct {
  char *text; /* ended by zero */
  int64_t used, capacity;
  cdem_status status;
  cdem_fault *fault;
} cdem_report_text;

void cdem_report_text_release(cdem_report_text *to);

/* Markup of our own, as it is. */
void cdem_report_raw(cdem_report_text *to, const char *markup);
/* The same with numbers and our own words in it; what others wrote goes through the next one. */
__attribute__((format(printf, 2, 3))) void cdem_report_format(cdem_report_text *to,
                                                              const char *format, ...);
/* What somebody wrote: & < > " ' as character references, so that it stands in elements and in
 * attributes alike; bytes that are no UTF-8 become U+FFFD, control characters but tab and line feed
 * spaces. */
void cdem_report_escaped(cdem_report_text *to, const char *text);
/* The same with spaces in place of underscores. */
void cdem_report_words(cdem_report_text *to, const char *name);
/* Prose of our own help: `commands` become <code>. */
void cdem_report_prose(cdem_report_text *to, const char *text);
/* A path as a relative link: bytes outside A-Z a-z 0-9 - . _ ~ / as %XX, "./" before a name that
 * has a colon. */
void cdem_report_link(cdem_report_text *to, const char *path);
/* Bytes in base64 (RFC 4648, section 4). */
void cdem_report_base64(cdem_report_text *to, const unsigned char *data, int64_t bytes);
/* A label in gnuplot's markup, k_1, k_{12}, m^2, with \_ as an underscore; the rest escaped. What
 * is lowered or raised becomes <sub> and <sup>, in SVG shifted tspans, and in an attribute plain
 * text. */
typedef enum { CDEM_REPORT_IN_HTML, CDEM_REPORT_IN_SVG, CDEM_REPORT_IN_WORDS } cdem_report_place;
void cdem_report_label(cdem_report_text *to, const char *label, cdem_report_place place);
/* An argument of a command for sh: as it is where that is safe, else in single quotes. */
void cdem_report_argument(cdem_report_text *to, const char *argument);

#endif
