/* Text that grows; escaping for HTML, links and sh; base64; gnuplot's markup. */
#include "report/text.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cdem_report_text_release(cdem_report_text *to) {
  free(to->text);
  *to = (cdem_report_text){0};
}

/* Room for so many bytes and the zero behind them; NULL after a failure. */
static char *more(cdem_report_text *to, int64_t bytes) {
  if (to->status == CDEM_OK)
    to->status = cdem_grow(&to->text, &to->capacity, to->used + bytes + 1, 1, to->fault);
  return to->status == CDEM_OK ? to->text + to->used : NULL;
}

static void add(cdem_report_text *to, const char *bytes, size_t count) {
  char *at = more(to, (int64_t)count);
  if (at == NULL)
    return;
  memcpy(at, bytes, count);
  to->used += (int64_t)count;
  to->text[to->used] = '\0';
}

void cdem_report_raw(cdem_report_text *to, const char *markup) {
  add(to, markup, strlen(markup));
}

void cdem_report_format(cdem_report_text *to, const char *format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  cdem_report_raw(to, text);
}

/* ---- HTML ---- */

/* Bytes of the UTF-8 character at `text`; 0: none (RFC 3629: no overlong forms, no surrogates). */
static size_t character(const char *text) {
  const unsigned char *c = (const unsigned char *)text;
  if (c[0] < 0x80)
    return 1;
  size_t length = c[0] >= 0xc2 && c[0] < 0xe0   ? 2
                  : c[0] >= 0xe0 && c[0] < 0xf0 ? 3
                  : c[0] >= 0xf0 && c[0] < 0xf5 ? 4
                                                : 0;
  for (size_t i = 1; i < length; i++)
    if ((c[i] & 0xc0) != 0x80)
      return 0;
  bool wrong = (c[0] == 0xe0 && c[1] < 0xa0) || (c[0] == 0xed && c[1] >= 0xa0) ||
               (c[0] == 0xf0 && c[1] < 0x90) || (c[0] == 0xf4 && c[1] >= 0x90);
  bool no_character = c[0] == 0xef && c[1] == 0xbf && c[2] >= 0xbe; /* U+FFFE, U+FFFF */
  return wrong || no_character ? 0 : length;
}

/* One character, escaped; returns its bytes. */
static size_t add_character(cdem_report_text *to, const char *c) {
  static const char special[] = "&<>\"'";
  static const char *const instead[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  const char *found = strchr(special, *c);
  size_t length = character(c);
  if (found != NULL)
    cdem_report_raw(to, instead[found - special]);
  else if (length == 0)
    cdem_report_raw(to, "\xef\xbf\xbd");
  else if (length == 1 && iscntrl((unsigned char)*c) && *c != '\n' && *c != '\t')
    cdem_report_raw(to, " ");
  else
    add(to, c, length);
  return length > 0 ? length : 1;
}

void cdem_report_escaped(cdem_report_text *to, const char *text) {
  while (*text != '\0')
    text += add_character(to, text);
}

void cdem_report_words(cdem_report_text *to, const char *name) {
  while (*name != '\0')
    name += add_character(to, *name == '_' ? " " : name);
}

void cdem_report_prose(cdem_report_text *to, const char *text) {
  bool code = false;
  while (*text != '\0')
    if (*text == '`' && (code || strchr(text + 1, '`') != NULL)) {
      code = !code;
      cdem_report_raw(to, code ? "<code>" : "</code>");
      text++;
    } else {
      text += add_character(to, text);
    }
}

void cdem_report_link(cdem_report_text *to, const char *path) {
  if (strchr(path, ':') != NULL && path[0] != '/' && path[0] != '.')
    cdem_report_raw(to, "./");
  for (const char *c = path; *c != '\0'; c++)
    if (((unsigned char)*c < 0x80 && isalnum((unsigned char)*c)) || strchr("-._~/", *c) != NULL)
      add(to, c, 1);
    else
      cdem_report_format(to, "%%%02X", (unsigned)(unsigned char)*c);
}

void cdem_report_base64(cdem_report_text *to, const unsigned char *data, int64_t bytes) {
  static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  char *at = more(to, (bytes + 2) / 3 * 4);
  if (at == NULL)
    return;
  for (int64_t i = 0; i < bytes; i += 3) {
    int64_t left = bytes - i;
    unsigned word = (unsigned)data[i] << 16 | (left > 1 ? (unsigned)data[i + 1] << 8 : 0u) |
                    (left > 2 ? data[i + 2] : 0u);
    *at++ = digit[word >> 18];
    *at++ = digit[word >> 12 & 63];
    *at++ = left > 1 ? digit[word >> 6 & 63] : '=';
    *at++ = left > 2 ? digit[word & 63] : '=';
  }
  *at = '\0';
  to->used = at - to->text;
}

/* ---- gnuplot's markup ---- */

/* What follows _ or ^: a character or {several}; returns the place behind. */
static const char *add_group(cdem_report_text *to, const char *at) {
  if (*at != '{')
    return *at != '\0' ? at + add_character(to, at) : at;
  for (at++; *at != '\0' && *at != '}';)
    at += add_character(to, at);
  return at + (*at == '}');
}

/* before: where it begins. In SVG a shift holds for all that follows, so that it is taken back. */
static void shift(cdem_report_text *to, bool low, bool before, cdem_report_place place) {
  static const char *const html[2][2] = {{"</sup>", "</sub>"}, {"<sup>", "<sub>"}};
  if (place == CDEM_REPORT_IN_HTML)
    cdem_report_raw(to, html[before][low]);
  else if (place == CDEM_REPORT_IN_SVG && before)
    cdem_report_format(to, "<tspan font-size=\"75%%\" dy=\"%s\">", low ? "3" : "-5");
  else if (place == CDEM_REPORT_IN_SVG)
    cdem_report_format(to, "</tspan><tspan dy=\"%s\">&#8203;</tspan>", low ? "-3" : "5");
}

void cdem_report_label(cdem_report_text *to, const char *label, cdem_report_place place) {
  while (*label != '\0') {
    if (*label == '\\' && label[1] != '\0') {
      label += 1 + add_character(to, label + 1);
    } else if (*label == '_' || *label == '^') {
      bool low = *label == '_';
      shift(to, low, true, place);
      label = add_group(to, label + 1);
      shift(to, low, false, place);
    } else {
      label += add_character(to, label);
    }
  }
}

/* ---- sh ---- */

void cdem_report_argument(cdem_report_text *to, const char *argument) {
  static const char safe[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._/+=:,@%";
  if (argument[0] != '\0' && argument[strspn(argument, safe)] == '\0') {
    cdem_report_escaped(to, argument);
    return;
  }
  cdem_report_raw(to, "&#39;");
  for (; *argument != '\0';)
    if (*argument == '\'') {
      cdem_report_raw(to, "&#39;\\&#39;&#39;");
      argument++;
    } else {
      argument += add_character(to, argument);
    }
  cdem_report_raw(to, "&#39;");
}
