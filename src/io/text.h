/* Private to io: numbers as text, fast and in the C locale whatever the process's locale is.
 *
 * Each function writes at `at` and returns the place behind; only cdem_put_text ends with a zero. A
 * real number takes at most CDEM_REAL_WIDTH bytes and is exactly what printf's %.17g gives in the C
 * locale; NaN and infinities become "nan", "inf", "-inf".
 */
#ifndef CDEM_IO_TEXT_H
#define CDEM_IO_TEXT_H

#include <locale.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { CDEM_REAL_WIDTH = 26, CDEM_INTEGER_WIDTH = 21 };

char *cdem_put_real(char *at, double value);
char *cdem_put_integer(char *at, int64_t value);

static inline char *cdem_put_text(char *at, const char *text) {
  return stpcpy(at, text);
}

/* `before`, the number, `after`. */
void cdem_stream_real(FILE *stream, const char *before, double value, const char *after);

/* Does `path` end with one of the endings parted by spaces? In small or capital letters. */
bool cdem_ends_with_one_of(const char *path, const char *endings);

/* The number at the start of `text` in C notation, *end behind it (= text when there is none). */
double cdem_get_real(const char *text, char **end);

/* What others print or read in between (printf, gmsh, UDUNITS) is in the C locale, in this thread.
 * Where there is no memory for a locale, it stays the process's. */
typedef struct {
  locale_t c, before;
} cdem_c_locale;
cdem_c_locale cdem_c_locale_enter(void);
void cdem_c_locale_leave(cdem_c_locale locale);

#endif
