#include "base/suggest.h"

#include <stddef.h>
#include <string.h>

enum { LONGEST = 63 };

static char lower(char c) {
  return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static int least(int a, int b) {
  return a < b ? a : b;
}

/* Restricted edit distance (no substring is edited twice) by three rolling rows. */
static int distance(const char *a, int m, const char *b, int n) {
  int row[3][LONGEST + 1];
  for (int j = 0; j <= n; j++)
    row[0][j] = j;
  for (int i = 1; i <= m; i++) {
    int *now = row[i % 3], *above = row[(i + 2) % 3], *before = row[(i + 1) % 3];
    now[0] = i;
    for (int j = 1; j <= n; j++) {
      int change = lower(a[i - 1]) != lower(b[j - 1]);
      now[j] = least(above[j - 1] + change, least(above[j], now[j - 1]) + 1);
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
          lower(a[i - 2]) == lower(b[j - 1]))
        now[j] = least(now[j], before[j - 2] + 1);
    }
  }
  return row[m % 3][n];
}

const char *cdem_suggest(const char *word, const char *const *candidates, int count) {
  const char *nearest = NULL;
  int best = LONGEST + 1;
  size_t length = strlen(word);
  if (length > LONGEST)
    return NULL;
  for (int i = 0; i < count; i++) {
    size_t other = candidates[i] != NULL ? strlen(candidates[i]) : LONGEST + 1;
    if (other > LONGEST)
      continue;
    int longer = (int)(length > other ? length : other);
    int d = distance(word, (int)length, candidates[i], (int)other);
    if (d <= (longer + 2) / 3 && d < longer && d < best) {
      best = d;
      nearest = candidates[i];
    }
  }
  return nearest;
}
