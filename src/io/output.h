/* Private to io: what the writers of this room need of an output beyond io.h. */
#ifndef CDEM_IO_OUTPUT_H
#define CDEM_IO_OUTPUT_H

#include "base/base.h"
#include "io/io.h"

/* The name the user gave, for messages. */
const char *cdem_output_name(const cdem_output *output);

/* True when the output is a file of its own that can be sought in; false for pipes and devices. */
bool cdem_output_is_file(const cdem_output *output);

/* Descriptor of the file being written, for writers that bring their own buffering. */
int cdem_output_descriptor(const cdem_output *output);

/* A nameless scratch file on the target's file system (elsewhere for pipes), open for reading and
 * writing; it is gone when closed. */
cdem_status cdem_output_scratch(const cdem_output *output, FILE **scratch, cdem_fault *fault);

/* Records CDEM_FILE: "cannot write 'NAME': CAUSE; REMEDY" for an errno; CDEM_MEMORY for ENOMEM. */
cdem_status cdem_output_fail(const cdem_output *output, int error, cdem_fault *fault);

/* The same for a path that has no output. */
cdem_status cdem_write_fail(const char *path, int error, cdem_fault *fault);

/* FOLDER/NAME, newly allocated (a folder "" stands for the present one); NULL when out of memory.
 */
char *cdem_join_path(const char *folder, const char *name, cdem_fault *fault);

#endif
