/* "Did you mean": the known name nearest to a mistyped one. */
#ifndef CDEM_BASE_SUGGEST_H
#define CDEM_BASE_SUGGEST_H

/* The candidate with the smallest Damerau-Levenshtein distance (insertions, deletions, changed and
 * swapped neighbouring letters; case is ignored) to `word`; the first one among equals. NULL when
 * none is near: more than one change for every three letters, counted in the longer word. Names
 * longer than 63 bytes are never near. candidates [count], NULL entries are passed over. */
const char *cdem_suggest(const char *word, const char *const *candidates, int count);

#endif
