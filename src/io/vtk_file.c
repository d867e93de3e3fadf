#include "io/vtk_file.h"

#include <inttypes.h>

const char *cdem_vtk_byte_order(void) {
  return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? "LittleEndian" : "BigEndian";
}

void cdem_xml_text(FILE *stream, const char *text) {
  for (const char *c = text; *c != '\0'; c++)
    if (*c == '&')
      fputs("&amp;", stream);
    else if (*c == '<')
      fputs("&lt;", stream);
    else if (*c == '"')
      fputs("&quot;", stream);
    else
      fputc((unsigned char)*c < ' ' ? ' ' : *c, stream);
}

void cdem_vtk_begin(FILE *stream, const char *kind) {
  fprintf(stream,
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"%s\" "
          "header_type=\"UInt64\">\n  <%s>\n",
          kind, cdem_vtk_byte_order(), kind);
}

void cdem_vtk_announce(cdem_vtk_header *header, const cdem_vtk_array *array) {
  fprintf(header->stream, "        <DataArray type=\"%s\" Name=\"", array->type);
  cdem_xml_text(header->stream, array->name);
  fprintf(header->stream, "\" NumberOfComponents=\"%d\"", array->components);
  /* VTK passes over attributes that it does not know. */
  if (array->unit != NULL && array->unit[0] != '\0') {
    fputs(" Unit=\"", header->stream);
    cdem_xml_text(header->stream, array->unit);
    fputc('"', header->stream);
  }
  fprintf(header->stream, " format=\"appended\" offset=\"%" PRIu64 "\"/>\n", header->offset);
  header->offset += sizeof(uint64_t) + array->bytes;
}

/* VTK writes texts as the codes of their letters, each text ended by 0. */
void cdem_vtk_texts(FILE *stream, const char *name, const char *const *text, int count) {
  fputs("    <Array type=\"String\" Name=\"", stream);
  cdem_xml_text(stream, name);
  fprintf(stream, "\" NumberOfTuples=\"%d\" format=\"ascii\">\n     ", count);
  for (int i = 0; i < count; i++) {
    for (const char *c = text[i]; *c != '\0'; c++)
      fprintf(stream, " %d", (unsigned char)*c);
    fputs(" 0", stream);
  }
  fputs("\n    </Array>\n", stream);
}

void cdem_vtk_begin_data(FILE *stream, const char *kind) {
  fprintf(stream, "  </%s>\n  <AppendedData encoding=\"raw\">\n   _", kind);
}

cdem_status cdem_vtk_put(cdem_output *output, const void *data, uint64_t bytes, cdem_fault *fault) {
  CDEM_TRY(cdem_output_write(output, &bytes, sizeof bytes, fault));
  return data != NULL ? cdem_output_write(output, data, (size_t)bytes, fault) : CDEM_OK;
}

void cdem_vtk_end(FILE *stream) {
  fputs("\n  </AppendedData>\n</VTKFile>\n", stream);
}
