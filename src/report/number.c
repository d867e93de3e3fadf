/* Numbers, units, sizes and times as text. */
#include "report/number.h"

#include "run/axis.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char minus[] = "\xe2\x88\x92";

/* A digit or a minus sign, raised. */
static const char *raised(char c) {
  static const char *const digit[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  return c == '-' ? "⁻" : digit[c - '0'];
}

const char *cdem_report_power(int exponent, char out[CDEM_REPORT_NUMBER]) {
  char plain[16];
  snprintf(plain, sizeof plain, "%d", exponent);
  char *at = stpcpy(out, "10");
  for (const char *c = plain; *c != '\0'; c++)
    at = stpcpy(at, raised(*c));
  return out;
}

const char *cdem_report_number(double value, int digits, char out[CDEM_REPORT_NUMBER]) {
  char plain[48], power[CDEM_REPORT_NUMBER];
  if (isnan(value))
    return strcpy(out, "–");
  if (isinf(value)) {
    snprintf(out, CDEM_REPORT_NUMBER, "%s∞", value < 0.0 ? minus : "");
    return out;
  }
  snprintf(plain, sizeof plain, "%.*g", digits, value);
  char *comma = strchr(plain, ','); /* some locales */
  if (comma != NULL)
    *comma = '.';
  char *e = strchr(plain, 'e');
  if (e != NULL)
    *e = '\0';
  const char *size = plain[0] == '-' ? plain + 1 : plain;
  const char *sign = plain[0] == '-' && value != 0.0 ? minus : "";
  if (e == NULL)
    snprintf(out, CDEM_REPORT_NUMBER, "%s%s", sign, size);
  else
    snprintf(out, CDEM_REPORT_NUMBER, "%s%s × %s", sign, size,
             cdem_report_power(atoi(e + 1), power));
  return out;
}

const char *cdem_report_unit(const char *unit, char out[CDEM_REPORT_NUMBER]) {
  char *at = out;
  for (const char *c = unit; *c != '\0' && at + 4 < out + CDEM_REPORT_NUMBER; c++) {
    bool behind = c > unit &&
                  (isalpha((unsigned char)c[-1]) || isdigit((unsigned char)c[-1]) || c[-1] == '-');
    bool first = c > unit && !isalpha((unsigned char)unit[0]); /* the 1 of "1/s" */
    bool power = isdigit((unsigned char)*c) || (*c == '-' && isdigit((unsigned char)c[1]));
    if (power && behind && !(first && c == unit + 1))
      at = stpcpy(at, raised(*c));
    else
      *at++ = *c == '.' ? ' ' : *c;
  }
  *at = '\0';
  return out;
}

const char *cdem_report_quantity(double value, int digits, const char *unit,
                                 char out[CDEM_REPORT_NUMBER]) {
  char number[CDEM_REPORT_NUMBER], pretty[CDEM_REPORT_NUMBER];
  if (isnan(value))
    return strcpy(out, "–");
  const cdem_run_axis axis = cdem_run_axis_for(unit, fabs(value));
  double short_value = axis.factor * value;
  bool fits = fabs(short_value) >= 1e-3 && fabs(short_value) < 1e6; /* else no prefix helps */
  cdem_report_number(fits ? short_value : value, digits, number);
  cdem_report_unit(fits ? axis.unit : unit, pretty);
  snprintf(out, CDEM_REPORT_NUMBER, "%.60s%s%.30s", number, pretty[0] != '\0' ? "\u00a0" : "",
           pretty);
  return out;
}

const char *cdem_report_size(int64_t bytes, char out[CDEM_REPORT_NUMBER]) {
  static const char *const unit[] = {"bytes", "kB", "MB", "GB", "TB"};
  char number[CDEM_REPORT_NUMBER];
  double size = (double)bytes;
  int k = 0;
  for (; size >= 999.5 && k < 4; k++)
    size /= 1000.0;
  snprintf(out, CDEM_REPORT_NUMBER, "%s %s",
           cdem_report_number(size, size >= 99.5 || k == 0 ? 3 : 2, number),
           bytes == 1 ? "byte" : unit[k]);
  return out;
}

const char *cdem_report_date(int64_t seconds, char out[CDEM_REPORT_NUMBER]) {
  time_t at = (time_t)seconds;
  struct tm parts;
  if (gmtime_r(&at, &parts) == NULL ||
      strftime(out, CDEM_REPORT_NUMBER, "%Y-%m-%d %H:%M UTC", &parts) == 0)
    strcpy(out, "–");
  return out;
}

const char *cdem_report_duration(double seconds, char out[CDEM_REPORT_NUMBER]) {
  if (!(seconds >= 60.0))
    return cdem_report_quantity(seconds, 3, "s", out);
  if (seconds > 1e15)
    return cdem_report_number(seconds, 3, out);
  int64_t all = (int64_t)llround(seconds), minutes = all / 60;
  if (minutes < 60)
    snprintf(out, CDEM_REPORT_NUMBER, "%d min %d s", (int)minutes, (int)(all % 60));
  else
    snprintf(out, CDEM_REPORT_NUMBER, "%lld h %d min", (long long)(minutes / 60),
             (int)(minutes % 60));
  return out;
}
