/* The line of a text that a message speaks of, with a caret under the place:
 *
 *       yuong: 40 GPa
 *       ^~~~~
 */
#ifndef CDEM_BASE_CARET_H
#define CDEM_BASE_CARET_H

#include <stddef.h>

/* Writes "\n  LINE\n  ^~~~" for the characters column .. column + width - 1 of a line (both from 1)
 * into out; a long line is shown from near the mark on. Nothing is written when the text has no
 * such line or `room` (bytes at out) could be too little; out is ended by a zero in any case. */
void cdem_caret_put(const char *text, int line, int column, int width, char *out, size_t room);

#endif
