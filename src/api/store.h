/* Private to api: what stands behind the handles, and how failures and listeners cross over. */
#ifndef CDEM_API_STORE_H
#define CDEM_API_STORE_H

#include "api/libcdem.h"
#include "io/io.h"

struct libcdem_mesh {
  cdem_mesh mesh;
};

/* Writes what a call has recorded to the caller's fault and returns the status in his numbers. */
libcdem_status cdem_api_end(cdem_status status, const cdem_fault *from, libcdem_fault *to);

/* CDEM_USAGE unless there is something behind the pointer. */
cdem_status cdem_api_want(const void *pointer, const char *what, cdem_fault *fault);

/* A listener as the library's own. */
typedef struct {
  cdem_progress own;
  const cdem_progress *progress; /* NULL: nobody listens */
  cdem_warnings warnings;
} cdem_api_ears;
void cdem_api_listen(const libcdem_listener *listener, cdem_api_ears *ears);

/* Dense springs in both directions. */
void cdem_api_springs(const cdem_spring_set *from, libcdem_springs *to);

/* GSL's own answer to an error is to end the process. */
void cdem_api_quiet_gsl(void);

#endif
