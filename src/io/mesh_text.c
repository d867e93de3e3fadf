/* Mesh files as text in memory: places for messages, and strict numbers. */
#include "io/mesh_build.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static cdem_status load(FILE *file, cdem_text *text, cdem_fault *fault) {
  struct stat facts;
  CDEM_REQUIRE(fstat(fileno(file), &facts) == 0, fault, CDEM_FILE, "%s", strerror(errno));
  CDEM_REQUIRE(!S_ISDIR(facts.st_mode), fault, CDEM_FILE, "it is a directory");
  int64_t capacity = 0;
  text->regular = S_ISREG(facts.st_mode);
  /* One byte more than the file, so that its end is met without growing; pipes have no size. */
  int64_t room = text->regular ? (int64_t)facts.st_size + 2 : 1 << 16;
  do {
    CDEM_TRY(cdem_grow(&text->data, &capacity, room, 1, fault));
    text->size +=
        (int64_t)fread(text->data + text->size, 1, (size_t)(capacity - 1 - text->size), file);
    room = capacity + 1;
  } while (text->size == capacity - 1 && !feof(file) && !ferror(file));
  CDEM_REQUIRE(!ferror(file), fault, CDEM_FILE, "%s", strerror(errno));
  text->data[text->size] = '\0';
  return CDEM_OK;
}

cdem_status cdem_text_open(const char *path, cdem_text *text, cdem_fault *fault) {
  *text = (cdem_text){.line = 1, .section = "the file"};
  text->locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  CDEM_REQUIRE(text->locale != (locale_t)0, fault, CDEM_MEMORY, "out of memory: no C locale");
  FILE *file = fopen(path, "rb");
  cdem_status status =
      file != NULL ? load(file, text, fault) : cdem_fail(fault, CDEM_FILE, "%s", strerror(errno));
  if (file != NULL)
    fclose(file);
  if (status != CDEM_OK)
    cdem_text_release(text);
  text->at = text->data;
  text->end = text->data != NULL ? text->data + text->size : NULL;
  return status;
}

void cdem_text_release(cdem_text *text) {
  free(text->data);
  if (text->locale != (locale_t)0)
    freelocale(text->locale);
  *text = (cdem_text){0};
}

void cdem_text_where(const cdem_text *text, char where[48]) {
  if (text->binary)
    snprintf(where, 48, "byte %" PRId64 ": ", (int64_t)(text->at - text->data));
  else
    snprintf(where, 48, "line %" PRId64 ": ", text->line);
}

cdem_status cdem_text_fail(const cdem_text *text, cdem_fault *fault, const char *format, ...) {
  char message[CDEM_FAULT_LENGTH], where[48];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  cdem_text_where(text, where);
  return cdem_fail(fault, CDEM_INPUT, "%s%s", where, message);
}

cdem_status cdem_text_prefix(const cdem_text *text, cdem_fault *fault, cdem_status status) {
  if (status != CDEM_INPUT)
    return status;
  char where[48];
  cdem_text_where(text, where);
  where[strlen(where) - 2] = '\0'; /* the prefix brings its own colon */
  cdem_fault_prefix(fault, "%s", where);
  return status;
}

bool cdem_parse_whole(const char *from, int64_t length, int64_t *value) {
  bool negative = length > 0 && *from == '-';
  int64_t i = length > 0 && (*from == '-' || *from == '+') ? 1 : 0, whole = 0;
  if (i == length)
    return false;
  for (; i < length; i++)
    if (!isdigit((unsigned char)from[i]) || __builtin_mul_overflow(whole, 10, &whole) ||
        __builtin_sub_overflow(whole, from[i] - '0', &whole))
      return false;
  /* Summed downwards, because INT64_MIN has no positive counterpart. */
  if (!negative && whole == INT64_MIN)
    return false;
  *value = negative ? whole : -whole;
  return true;
}

/* strtod takes more than a mesh file may hold: hexadecimal numbers, "nan(7)". */
bool cdem_parse_real(const char *from, int64_t length, locale_t locale, double *value) {
  char copy[64];
  if (length <= 0 || length >= (int64_t)sizeof copy)
    return false;
  bool number = true;
  for (int64_t i = 0; i < length; i++) {
    copy[i] = from[i] == 'd' || from[i] == 'D' ? 'e' : from[i]; /* Fortran writes 1.0D+03 */
    number &= isdigit((unsigned char)copy[i]) || strchr("+-.eE", copy[i]) != NULL;
  }
  copy[length] = '\0';
  const char *word = copy + (copy[0] == '-' || copy[0] == '+');
  if (!number && strcasecmp(word, "nan") != 0 && strncasecmp(word, "inf", 3) != 0)
    return false;
  char *end;
  *value = strtod_l(copy, &end, locale);
  return *end == '\0';
}
