#include "base/caret.h"

#include <stdio.h>
#include <string.h>

enum { SHOWN_WIDTH = 72 };

void cdem_caret_put(const char *text, int line, int column, int width, char *out, size_t room) {
  const char *begin = text;
  if (room > 0)
    *out = '\0';
  for (int l = 1; l < line && begin != NULL; l++) {
    begin = strchr(begin, '\n');
    begin = begin != NULL ? begin + 1 : NULL;
  }
  if (begin == NULL || line < 1 || room < 2 * SHOWN_WIDTH + 16)
    return;
  int skipped = 0; /* characters, not bytes */
  while (column - skipped > SHOWN_WIDTH / 2 && *begin != '\0' && *begin != '\n') {
    begin++;
    while ((*begin & 0xc0) == 0x80)
      begin++;
    skipped++;
  }
  size_t length = strcspn(begin, "\r\n");
  length = length > SHOWN_WIDTH ? SHOWN_WIDTH : length;
  while (length > 0 && (begin[length] & 0xc0) == 0x80) /* no letter is cut */
    length--;
  int before = column - skipped - 1 < SHOWN_WIDTH ? column - skipped - 1 : SHOWN_WIDTH;
  int used =
      snprintf(out, room, "\n  %.*s\n  %*s^", (int)length, begin, before > 0 ? before : 0, "");
  for (char *c = out + 3; *c != '\0' && *c != '\n'; c++)
    if ((unsigned char)*c < ' ' || *c == 0x7f) /* a tab; or what a terminal would obey */
      *c = ' ';
  for (int i = 1; i < width && column - skipped + i <= SHOWN_WIDTH; i++)
    out[used++] = '~';
  out[used] = '\0';
}
