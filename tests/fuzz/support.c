#include "fuzz/fuzz.h"
#include "io/run_files.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <udunits2.h>
#include <unistd.h>

_Noreturn void fuzz_finding(const char *file, int line, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  fprintf(stderr, "%s:%d: ", file, line);
  vfprintf(stderr, format, arguments);
  fputc('\n', stderr);
  va_end(arguments);
  abort();
}

static char place[] = "/dev/shm/cdem-fuzz-XXXXXX", other_place[] = "/tmp/cdem-fuzz-XXXXXX";
static const char *made;

static void remove_file(void) {
  unlink(made);
}

/* HDF5 asks for the real path, which a nameless file in memory has not. */
const char *fuzz_file(const void *data, size_t size) {
  static int descriptor = -1;
  if (made == NULL) {
    made = place;
    descriptor = mkstemp(place);
    if (descriptor < 0) {
      made = other_place;
      descriptor = mkstemp(other_place);
    }
    atexit(remove_file);
  }
  fuzz_require(descriptor >= 0 && ftruncate(descriptor, 0) == 0 &&
                   pwrite(descriptor, data, size, 0) == (ssize_t)size,
               "no file for %zu bytes", size);
  return made;
}

char *fuzz_text(const uint8_t *data, size_t size) {
  char *text = malloc(size + 1);
  fuzz_require(text != NULL, "no memory for %zu bytes", size);
  if (size > 0)
    memcpy(text, data, size);
  text[size] = '\0';
  return text;
}

bool fuzz_is_read(cdem_status status, cdem_fault *fault) {
  if (getenv("FUZZ_SAY") != NULL)
    fprintf(stderr, "%d %s\n", (int)status, fault->message);
  fuzz_require(status == CDEM_OK || status == CDEM_INPUT, "status %d: %s", (int)status,
               fault->message);
  fuzz_require(status == CDEM_OK || (fault->status == status && fault->message[0] != '\0'),
               "a failure without a message");
  memset(fault, 0, sizeof *fault);
  return status == CDEM_OK;
}

/* ---- meshes ---- */

static void use_mesh(const cdem_mesh *mesh) {
  cdem_fault fault = {0};
  cdem_state state = {0};
  cdem_mesh again;
  fuzz_require(cdem_mesh_check(mesh, &fault) == CDEM_OK, "accepted, but %s", fault.message);
  fuzz_require(cdem_mesh_to_state(mesh, "mesh", &state, &fault) == CDEM_OK &&
                   cdem_mesh_from_state(&state, "mesh", &again, &fault) == CDEM_OK,
               "not through a state: %s", fault.message);
  fuzz_require(again.nodes == mesh->nodes && again.cells == mesh->cells &&
                   again.groups == mesh->groups,
               "another mesh out of a state");
  cdem_mesh_release(&again);
  cdem_state_release(&state);
}

void fuzz_mesh(const uint8_t *data, size_t size,
               cdem_status (*read)(cdem_text *text, cdem_mesh_builder *builder,
                                   cdem_fault *fault)) {
  cdem_fault fault = {0};
  cdem_text text;
  cdem_mesh mesh = {0};
  cdem_mesh_builder builder = {0};
  fuzz_require(cdem_text_open(fuzz_file(data, size), &text, &fault) == CDEM_OK, "%s",
               fault.message);
  cdem_status status = read(&text, &builder, &fault);
  cdem_text_release(&text);
  if (status == CDEM_OK)
    status = cdem_builder_finish(&builder, &mesh, &fault);
  cdem_builder_release(&builder);
  if (fuzz_is_read(status, &fault))
    use_mesh(&mesh);
  cdem_mesh_release(&mesh);
}

/* ---- speed ---- */

#ifdef CDEM_FUZZ
/* Reading the database of units takes a thousand times as long as a case. The linker puts these in
 * the place of the two (--wrap), so that one process reads it once. */
ut_system *__real_ut_read_xml(const char *path);
ut_system *__wrap_ut_read_xml(const char *path);
void __wrap_ut_free_system(ut_system *system);

ut_system *__wrap_ut_read_xml(const char *path) {
  static ut_system *kept;
  if (kept == NULL)
    kept = __real_ut_read_xml(path);
  return kept;
}

void __wrap_ut_free_system(ut_system *system) {
  (void)system;
}
#endif
