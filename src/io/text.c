#include "io/text.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static const char two_digits[201] = "00010203040506070809101112131415161718192021222324"
                                    "25262728293031323334353637383940414243444546474849"
                                    "50515253545556575859606162636465666768697071727374"
                                    "75767778798081828384858687888990919293949596979899";

/* All digits of n, no leading zeros; returns the place behind. */
static char *put_unsigned(char *at, uint64_t n) {
  char reversed[CDEM_INTEGER_WIDTH];
  int used = CDEM_INTEGER_WIDTH;
  while (n >= 100) {
    used -= 2;
    memcpy(reversed + used, two_digits + 2 * (n % 100), 2);
    n /= 100;
  }
  if (n >= 10) {
    used -= 2;
    memcpy(reversed + used, two_digits + 2 * n, 2);
  } else {
    reversed[--used] = (char)('0' + n);
  }
  size_t length = (size_t)(CDEM_INTEGER_WIDTH - used);
  memcpy(at, reversed + used, length);
  return at + length;
}

char *cdem_put_integer(char *at, int64_t value) {
  uint64_t size = (uint64_t)value;
  if (value < 0) {
    *at++ = '-';
    size = 0 - size;
  }
  return put_unsigned(at, size);
}

/* Powers of ten that a 64-bit significand holds exactly. */
static const long double ten[28] = {1e0L,  1e1L,  1e2L,  1e3L,  1e4L,  1e5L,  1e6L,
                                    1e7L,  1e8L,  1e9L,  1e10L, 1e11L, 1e12L, 1e13L,
                                    1e14L, 1e15L, 1e16L, 1e17L, 1e18L, 1e19L, 1e20L,
                                    1e21L, 1e22L, 1e23L, 1e24L, 1e25L, 1e26L, 1e27L};

/* x 10^power in at most two roundings; |power| <= 54. */
static long double scaled(long double x, int power) {
  int size = abs(power), first = size < 27 ? size : 27;
  x = power < 0 ? x / ten[first] : x * ten[first];
  if (size > first)
    x = power < 0 ? x / ten[size - first] : x * ten[size - first];
  return x;
}

/* The 17 digits and the decimal exponent of x > 0 when they are certain. With a 64-bit significand
 * two roundings leave a relative error below 2^-63, so a value under 10^17 < 2^57 is known to
 * 2^-6: the nearest integer is certain unless the fraction is nearer than that to a half. */
static bool digits_fast(double x, uint64_t *digits, int *exponent) {
  if (LDBL_MANT_DIG < 64)
    return false;
  int binary;
  frexp(x, &binary);
  int e = (int)floor((binary - 1) * 0.30102999566398120);
  if (e < -36 || e > 68)
    return false;
  long double value = scaled(x, 16 - e);
  if (value >= 1e17L)
    value = scaled(x, 16 - ++e);
  if (value < 1e16L + 1.0L || value > 1e17L - 1.0L)
    return false;
  uint64_t whole = (uint64_t)value;
  double fraction = (double)(value - (long double)whole);
  if (fabs(fraction - 0.5) < 0x1p-5)
    return false;
  *digits = whole + (fraction > 0.5);
  *exponent = e;
  return true;
}

/* The same by the C library. The decimal sign of the locale may be any bytes but digits. */
static void digits_exact(double x, uint64_t *digits, int *exponent) {
  char text[64];
  snprintf(text, sizeof text, "%.16e", x);
  uint64_t n = 0;
  const char *c = text;
  for (; *c != 'e'; c++)
    if (*c >= '0' && *c <= '9')
      n = 10 * n + (uint64_t)(*c - '0');
  *digits = n;
  *exponent = atoi(c + 1);
}

/* %g from digits d.dddd 10^exponent: trailing zeros go, an exponent below -4 or from 17 on is
 * written out. */
static char *put_digits(char *at, uint64_t digits, int exponent) {
  char d[CDEM_INTEGER_WIDTH];
  int used = 17;
  put_unsigned(d, digits);
  while (used > 1 && d[used - 1] == '0')
    used--;
  int whole = 1; /* digits before the point */
  if (exponent >= 0 && exponent < 17) {
    whole = exponent + 1;
  } else if (exponent < 0 && exponent >= -4) {
    cdem_put_text(at, "0.000");
    at += 1 - exponent;
    memcpy(at, d, (size_t)used);
    return at + used;
  }
  int first = whole < used ? whole : used;
  memcpy(at, d, (size_t)first);
  at += first;
  for (; first < whole; first++)
    *at++ = '0';
  if (used > whole) {
    *at++ = '.';
    memcpy(at, d + whole, (size_t)(used - whole));
    at += used - whole;
  }
  if (exponent >= -4 && exponent < 17)
    return at;
  *at++ = 'e';
  *at++ = exponent < 0 ? '-' : '+';
  exponent = abs(exponent);
  if (exponent < 10)
    *at++ = '0';
  return put_unsigned(at, (uint64_t)exponent);
}

char *cdem_put_real(char *at, double value) {
  if (isnan(value))
    return cdem_put_text(at, "nan");
  if (signbit(value)) {
    *at++ = '-';
    value = -value;
  }
  if (isinf(value))
    return cdem_put_text(at, "inf");
  if (value < 1e15 && value == floor(value))
    return put_unsigned(at, (uint64_t)value);
  uint64_t digits;
  int exponent;
  if (!digits_fast(value, &digits, &exponent))
    digits_exact(value, &digits, &exponent);
  return put_digits(at, digits, exponent);
}

double cdem_get_real(const char *text, char **end) {
  locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  double value = c != (locale_t)0 ? strtod_l(text, end, c) : strtod(text, end);
  if (c != (locale_t)0)
    freelocale(c);
  return value;
}

void cdem_stream_real(FILE *stream, const char *before, double value, const char *after) {
  char text[CDEM_REAL_WIDTH];
  fputs(before, stream);
  fwrite(text, 1, (size_t)(cdem_put_real(text, value) - text), stream);
  fputs(after, stream);
}

bool cdem_ends_with_one_of(const char *path, const char *endings) {
  size_t length = strlen(path);
  for (const char *e = endings; *e != '\0'; e += strspn(e, " ")) {
    size_t n = strcspn(e, " ");
    if (length > n && strncasecmp(path + length - n, e, n) == 0)
      return true;
    e += n;
  }
  return false;
}

cdem_c_locale cdem_c_locale_enter(void) {
  cdem_c_locale locale = {newlocale(LC_ALL_MASK, "C", (locale_t)0), (locale_t)0};
  if (locale.c != (locale_t)0)
    locale.before = uselocale(locale.c);
  return locale;
}

void cdem_c_locale_leave(cdem_c_locale locale) {
  if (locale.c == (locale_t)0)
    return;
  uselocale(locale.before);
  freelocale(locale.c);
}
