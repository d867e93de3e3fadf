/* "40 GPa" -> 4e10. The number is ours (no locale, no arithmetic), the unit is UDUNITS'. */
#include "io/io.h"
#include "io/text.h"
#include "io/units.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include <udunits2.h>

enum { LONGEST_UNIT = 95 };

static cdem_status fail_unit(const char *text, const char *unit, cdem_dimension dimension,
                             cdem_fault *fault) {
  char expected[48];
  return cdem_fail(fault, CDEM_INPUT,
                   "'%s' has an unknown unit '%s'; expected a unit such as %s, or a plain number",
                   text, unit, cdem_dimension_unit(dimension, expected));
}

/* Scale of `unit` against the SI unit of the dimension. */
static cdem_status unit_scale(ut_system *system, const char *text, const char *unit,
                              cdem_dimension dimension, double *scale, cdem_fault *fault) {
  char si_text[48];
  cdem_dimension_unit(dimension, si_text);
  /* UDUNITS reads numbers by the locale, in units ("1e3 kg") and in its database. */
  cdem_c_locale locale = cdem_c_locale_enter();
  ut_unit *from = ut_parse(system, unit, UT_UTF8), *si = ut_parse(system, si_text, UT_UTF8);
  cdem_c_locale_leave(locale);
  cdem_status status = CDEM_OK;
  double zero = 0.0;
  cv_converter *convert = NULL;
  if (from == NULL || si == NULL) {
    status = fail_unit(text, unit, dimension, fault);
  } else if (!ut_are_convertible(from, si) || (convert = ut_get_converter(from, si)) == NULL) {
    status = cdem_fail(fault, CDEM_INPUT, "'%s' has the wrong dimension; expected a unit of %s",
                       text, si_text);
  } else {
    zero = cv_convert_double(convert, 0.0);
    *scale = cv_convert_double(convert, 1.0);
    if (zero != 0.0 || !isfinite(*scale))
      status =
          cdem_fail(fault, CDEM_INPUT, "'%s' has a unit that is no multiple of %s; use one that is",
                    text, si_text);
  }
  cv_free(convert);
  ut_free(from);
  ut_free(si);
  return status;
}

static cdem_status open_system(cdem_units *units, const char *text, cdem_fault *fault) {
  if (units->system != NULL)
    return CDEM_OK;
  ut_set_error_message_handler(ut_ignore);
  cdem_c_locale locale = cdem_c_locale_enter();
  units->system = ut_read_xml(NULL);
  cdem_c_locale_leave(locale);
  CDEM_REQUIRE(units->system != NULL, fault, CDEM_FILE,
               "cannot read the unit database of UDUNITS for '%s'; install the package "
               "libudunits2-data or give plain numbers in SI units",
               text);
  return CDEM_OK;
}

void cdem_units_release(cdem_units *units) {
  if (units->system != NULL)
    ut_free_system(units->system);
  units->system = NULL;
}

cdem_status cdem_units_parse(cdem_units *units, const char *text, cdem_dimension dimension,
                             double *value, cdem_fault *fault) {
  const char *begin = text + strspn(text, " \t");
  /* strtod also takes hexadecimal numbers, "inf" and "nan": none of them is a quantity. */
  size_t sign = *begin == '-' || *begin == '+';
  char *end = (char *)(uintptr_t)begin;
  double number = NAN;
  if (isdigit((unsigned char)begin[sign]) || begin[sign] == '.')
    number = cdem_get_real(begin, &end);
  CDEM_REQUIRE(end != begin && tolower((unsigned char)begin[sign + 1]) != 'x', fault, CDEM_INPUT,
               "'%s' is not a number", text);
  CDEM_REQUIRE(isfinite(number), fault, CDEM_INPUT, "'%s' is too large for a number", text);
  end += strspn(end, " \t");
  /* "200 1/s" is a rate; "5 1/2" would be another number than it looks like. */
  bool rate = strncmp(end, "1/", 2) == 0 && isalpha((unsigned char)end[2]);
  CDEM_REQUIRE(rate || (!isdigit((unsigned char)*end) && *end != '.' && *end != ','), fault,
               CDEM_INPUT,
               "'%s' is not one number; write thousands without separators and decimals with a "
               "point",
               text);
  char unit[LONGEST_UNIT + 1]; /* without the spaces at its end, which UDUNITS refuses */
  size_t length = strlen(end);
  while (length > 0 && (end[length - 1] == ' ' || end[length - 1] == '\t'))
    length--;
  if (length > LONGEST_UNIT)
    return fail_unit(text, end, dimension, fault);
  memcpy(unit, end, length);
  unit[length] = '\0';
  if (length == 0) {
    *value = number;
    return CDEM_OK;
  }
  double scale = 1.0;
  CDEM_TRY(open_system(units, text, fault));
  CDEM_TRY(unit_scale(units->system, text, unit, dimension, &scale, fault));
  CDEM_REQUIRE(isfinite(number * scale), fault, CDEM_INPUT, "'%s' is too large for a number", text);
  *value = number * scale;
  return CDEM_OK;
}

cdem_status cdem_parse_quantity(const char *text, cdem_dimension dimension, double *value,
                                cdem_fault *fault) {
  cdem_units units = {0};
  cdem_status status = cdem_units_parse(&units, text, dimension, value, fault);
  cdem_units_release(&units);
  return status;
}
