/* Private to report: numbers and units as a reader wants them, whatever the locale. */
#ifndef CDEM_REPORT_NUMBER_H
#define CDEM_REPORT_NUMBER_H

#include <stdint.h>

enum { CDEM_REPORT_NUMBER = 96 }; /* bytes */

/* Up to `digits` (1 to 17) significant digits, "−2.24 × 10⁻⁵"; NaN: "–". */
const char *cdem_report_number(double value, int digits, char out[CDEM_REPORT_NUMBER]);
/* The same with its unit, by an SI prefix where that keeps it short: "30 GPa", "2650 kg/m³". */
const char *cdem_report_quantity(double value, int digits, const char *unit,
                                 char out[CDEM_REPORT_NUMBER]);
/* "m2" -> "m²", "kg m-3" -> "kg m⁻³", "N.m" -> "N m". */
const char *cdem_report_unit(const char *unit, char out[CDEM_REPORT_NUMBER]);
/* "×10⁻⁶": a power of ten as text. */
const char *cdem_report_power(int exponent, char out[CDEM_REPORT_NUMBER]);
/* "512 bytes", "1.4 MB" (10^6 bytes). */
const char *cdem_report_size(int64_t bytes, char out[CDEM_REPORT_NUMBER]);
/* "2026-11-30 19:35 UTC" of seconds since 1970. */
const char *cdem_report_date(int64_t seconds, char out[CDEM_REPORT_NUMBER]);
/* "2.73 s", "12 min 5 s", "3 h 20 min". */
const char *cdem_report_duration(double seconds, char out[CDEM_REPORT_NUMBER]);

#endif
