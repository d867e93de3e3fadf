/* Private to io: the frame of a VTK XML file.
 *
 * VTK's file format: a header in XML that announces each array with its place, then the arrays as
 * raw bytes in the same order, each behind its length as UInt64. A writer calls, in this order,
 * begin; texts and announcements between tags of its own; begin_data; put for each array announced;
 * end. */
#ifndef CDEM_IO_VTK_FILE_H
#define CDEM_IO_VTK_FILE_H

#include "io/io.h"

typedef struct {
  FILE *stream;
  uint64_t offset; /* of the next array, from the underscore */
} cdem_vtk_header;

typedef struct {
  const char *type; /* "Float64" */
  const char *name;
  const char *unit; /* NULL or "": none */
  int components;
  uint64_t bytes; /* of all values */
} cdem_vtk_array;

/* kind: "UnstructuredGrid", "PolyData". */
void cdem_vtk_begin(FILE *stream, const char *kind);
void cdem_vtk_announce(cdem_vtk_header *header, const cdem_vtk_array *array);
/* A field of texts, in the header itself. */
void cdem_vtk_texts(FILE *stream, const char *name, const char *const *text, int count);
void cdem_vtk_begin_data(FILE *stream, const char *kind);
/* The length, and the bytes where data is not NULL (otherwise the caller writes them). */
cdem_status cdem_vtk_put(cdem_output *output, const void *data, uint64_t bytes, cdem_fault *fault);
void cdem_vtk_end(FILE *stream);

/* A text within an XML attribute. */
void cdem_xml_text(FILE *stream, const char *text);

/* "LittleEndian" or "BigEndian", of this machine. */
const char *cdem_vtk_byte_order(void);

#endif
