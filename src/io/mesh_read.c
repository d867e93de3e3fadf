#include "io/mesh_build.h"

#include <string.h>
#include <strings.h>

typedef enum { MSH, INP, GEOMETRY, FORMATS } mesh_format;

static const struct {
  const char *ending;
  mesh_format format;
} endings[] = {
    {".msh", MSH}, {".geo", GEOMETRY}, {".step", GEOMETRY}, {".stp", GEOMETRY}, {".inp", INP}};
enum { ENDINGS = sizeof endings / sizeof endings[0] };

static mesh_format format_of(const char *path) {
  const char *dot = strrchr(path, '.');
  for (int i = 0; dot != NULL && i < ENDINGS; i++)
    if (strcasecmp(dot, endings[i].ending) == 0)
      return endings[i].format;
  return FORMATS;
}

static cdem_status read_text(const char *path, mesh_format format, cdem_mesh_builder *builder,
                             cdem_fault *fault) {
  cdem_text text;
  CDEM_TRY(cdem_text_open(path, &text, fault));
  cdem_status status;
  if (format == MSH)
    status = cdem_read_msh(&text, builder, fault);
  else if (format == INP)
    status = cdem_read_inp(&text, builder, fault);
  else /* gmsh opens the file itself, but does not say when it cannot */
    status = text.size > 0 ? CDEM_OK : cdem_fail(fault, CDEM_INPUT, "the file is empty");
  cdem_text_release(&text);
  if (status == CDEM_OK && format == GEOMETRY)
    status = cdem_read_geometry(path, builder, fault);
  return status;
}

cdem_status cdem_read_mesh(const char *path, cdem_mesh *mesh, const cdem_warnings *warnings,
                           cdem_fault *fault) {
  cdem_mesh built = {0};
  cdem_mesh_builder builder = {.warnings = warnings};
  mesh_format format = format_of(path);
  cdem_status status =
      format != FORMATS
          ? read_text(path, format, &builder, fault)
          : cdem_fail(fault, CDEM_INPUT,
                      "its ending is none of .msh .geo .step .stp .inp, which tell the format");
  if (status == CDEM_OK)
    status = cdem_builder_finish(&builder, &built, fault);
  cdem_builder_release(&builder);
  if (status == CDEM_OK && (built.source = cdem_copy_text(path, fault)) == NULL)
    status = CDEM_MEMORY;
  if (status == CDEM_OK) {
    *mesh = built;
    return CDEM_OK;
  }
  cdem_mesh_release(&built);
  cdem_fault_prefix(fault, "cannot read '%s'", path);
  *mesh = (cdem_mesh){0};
  return status;
}
