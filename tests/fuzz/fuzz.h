/* What the fuzz targets share.
 *
 * A target is one file with LLVMFuzzerTestOneInput: it gives the bytes to one reader and asserts
 * what holds whatever they are: the answer is OK, or CDEM_INPUT with a message, and what was
 * accepted can be used. libFuzzer calls it with bytes it makes up (preset `fuzz`), replay.c with
 * the kept ones (every build).
 */
#ifndef CDEM_TESTS_FUZZ_FUZZ_H
#define CDEM_TESTS_FUZZ_FUZZ_H

#include "base/base.h"
#include "io/mesh_build.h"

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The bytes as a file, in memory where there is /dev/shm: its path. One file at a time: the next
 * call replaces it. */
const char *fuzz_file(const void *data, size_t size);

/* The same bytes as a text ended by zero; free() it. */
char *fuzz_text(const uint8_t *data, size_t size);

/* A finding: says it on stderr and aborts. */
_Noreturn __attribute__((format(printf, 3, 4))) void fuzz_finding(const char *file, int line,
                                                                  const char *format, ...);
#define fuzz_require(condition, ...)                                                               \
  do {                                                                                             \
    if (!(condition))                                                                              \
      fuzz_finding(__FILE__, __LINE__, __VA_ARGS__);                                               \
  } while (0)

/* True for OK; a finding for any other answer than CDEM_INPUT with a message, because bytes of a
 * file are never the caller's mistake and never more than memory holds. Clears the fault. */
bool fuzz_is_read(cdem_status status, cdem_fault *fault);

/* The bytes through a reader of mesh files; what it accepts passes the checks of room mesh and goes
 * through a state and back. */
void fuzz_mesh(const uint8_t *data, size_t size,
               cdem_status (*read)(cdem_text *text, cdem_mesh_builder *builder, cdem_fault *fault));

#endif
