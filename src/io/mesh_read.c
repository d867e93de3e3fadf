#include "io/mesh_build.h"
#include "io/mesh_parameters.h"

#include <inttypes.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

typedef enum { MSH, INP, GEO, STEP, STL, FORMATS } mesh_format;

static const struct {
  const char *ending;
  mesh_format format;
} endings[] = {{".msh", MSH},  {".geo", GEO}, {".step", STEP},
               {".stp", STEP}, {".stl", STL}, {".inp", INP}};
enum { ENDINGS = sizeof endings / sizeof endings[0] };

static mesh_format format_of(const char *path) {
  const char *dot = strrchr(path, '.');
  for (int i = 0; dot != NULL && i < ENDINGS; i++)
    if (strcasecmp(dot, endings[i].ending) == 0)
      return endings[i].format;
  return FORMATS;
}

/* gmsh opens geometry itself but does not say when it cannot; and Open CASCADE below it writes on
 * the terminal when a STEP file is none or is cut off (ISO 10303-21 gives its first and last line).
 */
static cdem_status check_geometry(const cdem_text *text, mesh_format format, cdem_fault *fault) {
  static const char first[] = "ISO-10303-21;", last[] = "END-ISO-10303-21;";
  CDEM_REQUIRE(text->size > 0, fault, CDEM_INPUT, "the file is empty");
  if (format != STEP)
    return CDEM_OK;
  int64_t head = text->size < 4096 ? text->size : 4096;
  CDEM_REQUIRE(memmem(text->data, (size_t)head, first, sizeof first - 1) != NULL, fault, CDEM_INPUT,
               "line 1: the file does not start with %s: it is no STEP file", first);
  CDEM_REQUIRE(memmem(text->end - head, (size_t)head, last, sizeof last - 1) != NULL, fault,
               CDEM_INPUT, "the file does not end with %s; it is not complete", last);
  return CDEM_OK;
}

/* Of a cut STL file gmsh takes what is there. A binary one says how many triangles of 50 bytes
 * follow its head of 84; one in text ends with the word "endsolid" and the solid's name. */
static cdem_status check_stl(const cdem_text *text, cdem_fault *fault) {
  static const char last[] = "endsolid";
  enum { HEAD = 84, TRIANGLE = 50, TAIL = 4096 };
  CDEM_REQUIRE(text->size > 0, fault, CDEM_INPUT, "the file is empty");
  uint32_t triangles = 0;
  if (text->size >= HEAD) {
    memcpy(&triangles, text->data + HEAD - 4, sizeof triangles); /* little-endian, as we are */
    if (text->size == HEAD + (int64_t)TRIANGLE * triangles)
      return triangles > 0 ? CDEM_OK : cdem_fail(fault, CDEM_INPUT, "it holds no triangles");
  }
  int64_t tail = text->size < TAIL ? text->size : TAIL;
  bool named = text->size > 5 && strncasecmp(text->data, "solid", 5) == 0;
  bool ends = memmem(text->end - tail, (size_t)tail, last, sizeof last - 1) != NULL;
  CDEM_REQUIRE(!named || ends, fault, CDEM_INPUT,
               "it is no complete STL file: it starts with 'solid' but does not end with '%s'",
               last);
  CDEM_REQUIRE(named, fault, CDEM_INPUT,
               "it is no complete STL file: of %" PRIu32 " triangles, its %" PRId64
               " bytes hold another number",
               triangles, text->size);
  return CDEM_OK;
}

/* MSH 4.0 was written by gmsh 4.0 only, and gmsh still reads it: such files are left to gmsh when
 * their sections are all there (a cut file it would take in part). */
static bool is_msh40(const cdem_text *text) {
  static const char format[] = "$MeshFormat", version[] = "4 ", longer[] = "4.0 ";
  int64_t head = text->size < 64 ? text->size : 64;
  const char *at = memmem(text->data, (size_t)head, format, sizeof format - 1);
  const char *line = at != NULL ? memchr(at, '\n', (size_t)(text->data + head - at)) : NULL;
  if (line == NULL || text->data + head - line < 6)
    return false;
  return strncmp(line + 1, version, sizeof version - 1) == 0 ||
         strncmp(line + 1, longer, sizeof longer - 1) == 0;
}

static cdem_status check_msh40(const cdem_text *text, cdem_fault *fault) {
  static const char *const sections[] = {"$EndNodes", "$EndElements"};
  for (int i = 0; i < 2; i++)
    CDEM_REQUIRE(memmem(text->data, (size_t)text->size, sections[i], strlen(sections[i])) != NULL,
                 fault, CDEM_INPUT, "the file is not complete: %s is missing", sections[i]);
  return CDEM_OK;
}

static cdem_status read_with(const char *path, const cdem_mesh_parameters *parameters,
                             cdem_mesh_builder *builder, cdem_fault *fault) {
  char wrapper[CDEM_WRAPPER_PATH];
  if (parameters->count == 0)
    return cdem_read_geometry(path, builder, fault);
  CDEM_TRY(cdem_mesh_parameters_wrap(parameters, path, wrapper, fault));
  cdem_status status = cdem_read_geometry(wrapper, builder, fault);
  unlink(wrapper);
  return status;
}

static cdem_status read_text(const char *path, mesh_format format,
                             const cdem_mesh_parameters *parameters, cdem_mesh_builder *builder,
                             cdem_fault *fault) {
  CDEM_REQUIRE(format == GEO || parameters->count == 0, fault, CDEM_INPUT,
               "parameter '%s' has no meaning here: only .geo files have parameters",
               parameters->name[0]);
  cdem_text text;
  CDEM_TRY(cdem_text_open(path, &text, fault));
  cdem_status status;
  bool by_gmsh =
      format == GEO || format == STEP || format == STL || (format == MSH && is_msh40(&text));
  if (by_gmsh && !text.regular)
    status = cdem_fail(fault, CDEM_INPUT,
                       "it is a pipe or a device, which gmsh cannot read; give a file");
  else if (format == MSH && by_gmsh)
    status = check_msh40(&text, fault);
  else if (format == MSH)
    status = cdem_read_msh(&text, builder, fault);
  else if (format == STL)
    status = check_stl(&text, fault);
  else if (format == INP)
    status = cdem_read_inp(&text, builder, fault);
  else
    status = check_geometry(&text, format, fault);
  if (status == CDEM_OK && parameters->count > 0)
    status = cdem_mesh_parameters_check(parameters, &text, fault);
  cdem_text_release(&text);
  if (status == CDEM_OK && by_gmsh)
    status = read_with(path, parameters, builder, fault);
  return status;
}

cdem_status cdem_read_mesh(const char *path, cdem_mesh *mesh, const cdem_warnings *warnings,
                           cdem_fault *fault) {
  return cdem_read_mesh_with(path, 0, NULL, NULL, mesh, warnings, fault);
}

cdem_status cdem_read_mesh_with(const char *path, int parameters, const char *const *name,
                                const double *value, cdem_mesh *mesh, const cdem_warnings *warnings,
                                cdem_fault *fault) {
  cdem_mesh built = {0};
  cdem_mesh_builder builder = {.warnings = warnings};
  mesh_format format = format_of(path);
  cdem_status status =
      format != FORMATS
          ? read_text(path, format, &(cdem_mesh_parameters){parameters, name, value}, &builder,
                      fault)
          : cdem_fail(
                fault, CDEM_INPUT,
                "its ending is none of .msh .geo .step .stp .inp .stl, which tell the format");
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
