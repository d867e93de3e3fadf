/* Frames as VTK XML: a .vtu a frame, and a .pvd a data set that lists them with their times.
 *
 * Arrays go to the file as they lie in memory. The .pvd is made anew with each frame; a broken run
 * leaves it whole, and a resumed one reads it back to know the frames before. */
#include "io/output.h"
#include "io/run_files.h"
#include "io/text.h"
#include "io/vtk_file.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { NAME = 64, FILE_NAME = 2 * NAME + 32 };

typedef struct {
  int64_t index;
  double time;
} entry;

typedef struct {
  char name[NAME];
  int64_t entries, capacity;
  entry *entry; /* ascending in index */
} data_set;

struct cdem_frame_writer {
  char *folder;
  int64_t sets, capacity;
  data_set *set;
};

/* ---- names ---- */

static bool is_name(const char *name) {
  size_t length = strlen(name);
  for (const char *c = name; *c != '\0'; c++)
    if (!isalnum((unsigned char)*c) && *c != '_' && *c != '-')
      return false;
  return length > 0 && length < NAME;
}

/* The .vtu, seen from the folder of the run. */
static void file_name(const char *set, int64_t index, char name[FILE_NAME]) {
  snprintf(name, FILE_NAME, "%s/%s-%06" PRId64 ".vtu", set, set, index);
}

static char *path_of(const cdem_frame_writer *writer, const char *name, const char *ending,
                     cdem_fault *fault) {
  char whole[FILE_NAME];
  snprintf(whole, sizeof whole, "%s%s", name, ending);
  return cdem_join_path(writer->folder, whole, fault);
}

/* ---- one frame ---- */

static const struct {
  const char *name;
  int bytes;
} types[] = {
    [CDEM_FIELD_REAL] = {"Float64", 8},
    [CDEM_FIELD_INT32] = {"Int32", 4},
    [CDEM_FIELD_UINT8] = {"UInt8", 1},
};

static cdem_status check_frame(const cdem_frame *frame, cdem_fault *fault) {
  CDEM_REQUIRE(is_name(frame->set), fault, CDEM_USAGE,
               "'%s' cannot be the name of a data set; use up to %d letters, digits, _ and -",
               frame->set, NAME - 1);
  CDEM_REQUIRE(frame->index >= 0, fault, CDEM_USAGE,
               "frame %" PRId64 " of the data set '%s': frames are counted from 0", frame->index,
               frame->set);
  for (int64_t c = 0; c < frame->cells; c++) {
    CDEM_REQUIRE(frame->offset[0] == 0 && frame->offset[c] <= frame->offset[c + 1], fault,
                 CDEM_USAGE, "cell %" PRId64 " of the data set '%s' ends before it begins", c,
                 frame->set);
    for (int64_t n = frame->offset[c]; n < frame->offset[c + 1]; n++)
      CDEM_REQUIRE(frame->node[n] >= 0 && frame->node[n] < frame->points, fault, CDEM_USAGE,
                   "cell %" PRId64 " of the data set '%s' names point %" PRId32
                   ", but there are %" PRId64 " points",
                   c, frame->set, frame->node[n], frame->points);
  }
  return CDEM_OK;
}

static cdem_vtk_array array_of(const cdem_frame *frame, const cdem_field *field) {
  int64_t tuples = field->on_cells ? frame->cells : frame->points;
  return (cdem_vtk_array){types[field->type].name, field->name, field->unit, field->components,
                          (uint64_t)(tuples * field->components * types[field->type].bytes)};
}

static void put_facts(FILE *stream, const cdem_frame *frame) {
  char time[CDEM_REAL_WIDTH + 1];
  *cdem_put_real(time, frame->time) = '\0';
  fprintf(stream,
          "    <FieldData>\n    <DataArray type=\"Float64\" Name=\"TimeValue\" "
          "NumberOfTuples=\"1\" format=\"ascii\">%s</DataArray>\n",
          time);
  for (int f = 0; f < frame->fields; f++) {
    const cdem_field *field = &frame->field[f];
    char name[2 * NAME];
    snprintf(name, sizeof name, "%s names", field->name);
    if (field->states > 0 && field->state != NULL)
      cdem_vtk_texts(stream, name, field->state, field->states);
  }
  fputs("    </FieldData>\n", stream);
}

/* The arrays of the geometry, in order. */
static void describe(const cdem_frame *frame, cdem_vtk_array array[4], const void *data[4]) {
  uint64_t cells = (uint64_t)frame->cells, nodes = cells > 0 ? (uint64_t)frame->offset[cells] : 0;
  array[0] = (cdem_vtk_array){"Float64", "Points", "m", 3, (uint64_t)frame->points * 24};
  array[1] = (cdem_vtk_array){"Int32", "connectivity", NULL, 1, nodes * 4};
  array[2] = (cdem_vtk_array){"Int64", "offsets", NULL, 1, cells * 8};
  array[3] = (cdem_vtk_array){"UInt8", "types", NULL, 1, cells};
  data[0] = frame->xyz;
  data[1] = frame->node;
  data[2] = cells > 0 ? frame->offset + 1 : NULL;
  data[3] = frame->type;
}

static void put_header(FILE *stream, const cdem_frame *frame, const cdem_vtk_array geometry[4]) {
  cdem_vtk_header header = {stream, 0};
  cdem_vtk_begin(stream, "UnstructuredGrid");
  put_facts(stream, frame);
  fprintf(stream, "    <Piece NumberOfPoints=\"%" PRId64 "\" NumberOfCells=\"%" PRId64 "\">\n",
          frame->points, frame->cells);
  fputs("      <Points>\n", stream);
  cdem_vtk_announce(&header, &geometry[0]);
  fputs("      </Points>\n      <Cells>\n", stream);
  for (int a = 1; a < 4; a++)
    cdem_vtk_announce(&header, &geometry[a]);
  fputs("      </Cells>\n", stream);
  for (int on_cells = 0; on_cells < 2; on_cells++) {
    fprintf(stream, "      <%s>\n", on_cells ? "CellData" : "PointData");
    for (int f = 0; f < frame->fields; f++)
      if (frame->field[f].on_cells == on_cells) {
        cdem_vtk_array array = array_of(frame, &frame->field[f]);
        cdem_vtk_announce(&header, &array);
      }
    fprintf(stream, "      </%s>\n", on_cells ? "CellData" : "PointData");
  }
  fputs("    </Piece>\n", stream);
  cdem_vtk_begin_data(stream, "UnstructuredGrid");
}

static cdem_status put_frame(cdem_output *output, const cdem_frame *frame, cdem_fault *fault) {
  cdem_vtk_array geometry[4];
  const void *data[4];
  describe(frame, geometry, data);
  put_header(cdem_output_stream(output), frame, geometry);
  for (int a = 0; a < 4; a++)
    CDEM_TRY(cdem_vtk_put(output, data[a], geometry[a].bytes, fault));
  for (int on_cells = 0; on_cells < 2; on_cells++)
    for (int f = 0; f < frame->fields; f++)
      if (frame->field[f].on_cells == on_cells)
        CDEM_TRY(cdem_vtk_put(output, frame->field[f].data, array_of(frame, &frame->field[f]).bytes,
                              fault));
  cdem_vtk_end(cdem_output_stream(output));
  return CDEM_OK;
}

static cdem_status write_frame(const cdem_frame_writer *writer, const cdem_frame *frame,
                               cdem_fault *fault) {
  char name[FILE_NAME];
  file_name(frame->set, frame->index, name);
  char *path = path_of(writer, name, "", fault);
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_output *output;
  cdem_status status = cdem_output_open(path, &output, fault);
  free(path);
  CDEM_TRY(status);
  status = put_frame(output, frame, fault);
  if (status == CDEM_OK)
    return cdem_output_commit(&output, fault);
  cdem_output_discard(&output);
  return status;
}

/* ---- the list of a data set ---- */

static cdem_status write_list(const cdem_frame_writer *writer, const data_set *set,
                              cdem_fault *fault) {
  char *path = path_of(writer, set->name, ".pvd", fault), name[FILE_NAME];
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_output *output;
  cdem_status status = cdem_output_open(path, &output, fault);
  free(path);
  CDEM_TRY(status);
  FILE *stream = cdem_output_stream(output);
  fprintf(stream,
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
          "byte_order=\"%s\">\n  <Collection>\n",
          cdem_vtk_byte_order());
  for (int64_t i = 0; i < set->entries; i++) {
    char time[CDEM_REAL_WIDTH + 1];
    *cdem_put_real(time, set->entry[i].time) = '\0';
    file_name(set->name, set->entry[i].index, name);
    fprintf(stream, "    <DataSet timestep=\"%s\" part=\"0\" file=\"%s\"/>\n", time, name);
  }
  fputs("  </Collection>\n</VTKFile>\n", stream);
  return cdem_output_commit(&output, fault);
}

/* Drops the entries from an index on. */
static void forget(data_set *set, int64_t from) {
  while (set->entries > 0 && set->entry[set->entries - 1].index >= from)
    set->entries--;
}

static cdem_status add_entry(data_set *set, int64_t index, double time, cdem_fault *fault) {
  forget(set, index);
  CDEM_TRY(cdem_grow(&set->entry, &set->capacity, set->entries + 1, sizeof *set->entry, fault));
  set->entry[set->entries++] = (entry){index, time};
  return CDEM_OK;
}

static cdem_status find_set(cdem_frame_writer *writer, const char *name, data_set **set,
                            cdem_fault *fault) {
  for (int64_t s = 0; s < writer->sets; s++)
    if (strcmp(writer->set[s].name, name) == 0) {
      *set = &writer->set[s];
      return CDEM_OK;
    }
  CDEM_TRY(
      cdem_grow(&writer->set, &writer->capacity, writer->sets + 1, sizeof *writer->set, fault));
  *set = &writer->set[writer->sets++];
  snprintf((*set)->name, NAME, "%s", name);
  return CDEM_OK;
}

static cdem_status take_frame(void *context, const cdem_frame *frame, cdem_fault *fault) {
  cdem_frame_writer *writer = context;
  data_set *set = NULL;
  CDEM_TRY(check_frame(frame, fault));
  CDEM_TRY(find_set(writer, frame->set, &set, fault));
  if (set->entries == 0) {
    char *folder = path_of(writer, frame->set, "", fault);
    cdem_status status = folder != NULL ? cdem_make_folder(folder, fault) : CDEM_MEMORY;
    free(folder);
    CDEM_TRY(status);
  }
  CDEM_TRY(write_frame(writer, frame, fault));
  CDEM_TRY(add_entry(set, frame->index, frame->time, fault));
  return write_list(writer, set, fault);
}

/* ---- what an earlier run left ---- */

/* Reads one line of a list; false when it is not as write_list writes it. */
static bool read_entry(const char *line, const char *set, int64_t *index, double *time) {
  const char *begin = "    <DataSet timestep=\"", *middle = "\" part=\"0\" file=\"";
  char name[FILE_NAME], *end;
  if (strncmp(line, begin, strlen(begin)) != 0)
    return false;
  *time = cdem_get_real(line + strlen(begin), &end);
  if (strncmp(end, middle, strlen(middle)) != 0)
    return false;
  const char *file = end + strlen(middle), *dash = strchr(file, '"');
  while (dash != NULL && dash > file && *dash != '-')
    dash--;
  if (dash == NULL || sscanf(dash, "-%" SCNd64, index) != 1 || *index < 0)
    return false;
  file_name(set, *index, name);
  return strncmp(file, name, strlen(name)) == 0 && file[strlen(name)] == '"';
}

/* Fills a set from the text of its list; false when the list is not ours. */
static bool read_list(const char *text, data_set *set, cdem_fault *fault) {
  double time = 0.0;
  int64_t index = 0, last = -1;
  for (const char *line = text; line != NULL && *line != '\0';) {
    if (strstr(line, "<DataSet") == line + 4) {
      if (!read_entry(line, set->name, &index, &time) || index <= last ||
          add_entry(set, index, time, fault) != CDEM_OK)
        return false;
      last = index;
    }
    line = strchr(line, '\n');
    line += line != NULL;
  }
  return set->entries > 0;
}

/* Files that are forgotten must not be taken for frames of the new run. */
static cdem_status forget_files(const cdem_frame_writer *writer, data_set *set, int64_t from,
                                cdem_fault *fault) {
  int64_t before = set->entries;
  forget(set, from);
  if (set->entries == before)
    return CDEM_OK;
  char name[FILE_NAME], *path;
  if (set->entries > 0)
    CDEM_TRY(write_list(writer, set, fault));
  else if ((path = path_of(writer, set->name, ".pvd", fault)) == NULL)
    return CDEM_MEMORY;
  else {
    unlink(path);
    free(path);
  }
  for (int64_t i = set->entries; i < before; i++) {
    file_name(set->name, set->entry[i].index, name);
    if ((path = path_of(writer, name, "", fault)) == NULL)
      return CDEM_MEMORY;
    unlink(path);
    free(path);
  }
  return CDEM_OK;
}

static cdem_status recall_set(cdem_frame_writer *writer, const char *file, int64_t resume_from,
                              cdem_fault *fault) {
  char name[NAME], *text = NULL;
  snprintf(name, sizeof name, "%.*s", (int)(strlen(file) - 4), file);
  char *path = path_of(writer, name, ".pvd", fault);
  if (path == NULL)
    return CDEM_MEMORY;
  cdem_status status = cdem_read_text(path, &text, NULL);
  free(path);
  if (status != CDEM_OK) /* a list of somebody else's, then */
    return status == CDEM_MEMORY ? cdem_fail(fault, status, "out of memory") : CDEM_OK;
  data_set set = {.entries = 0};
  memcpy(set.name, name, sizeof name);
  cdem_fault within = {0};
  bool ours = read_list(text, &set, &within);
  free(text);
  if (ours)
    status = forget_files(writer, &set, resume_from, fault);
  else if (within.status != CDEM_OK)
    status = cdem_fail(fault, within.status, "%s", within.message);
  data_set *place = NULL;
  if (ours && status == CDEM_OK && set.entries > 0)
    status = find_set(writer, name, &place, fault);
  if (place != NULL)
    *place = set;
  else
    free(set.entry);
  return status;
}

/* Looks through the folder for lists of ours. */
static cdem_status recall(cdem_frame_writer *writer, int64_t resume_from, cdem_fault *fault) {
  DIR *list = opendir(writer->folder[0] != '\0' ? writer->folder : ".");
  CDEM_REQUIRE(list != NULL, fault, CDEM_FILE, "cannot read the folder '%s': %s", writer->folder,
               strerror(errno));
  cdem_status status = CDEM_OK;
  for (struct dirent *item; status == CDEM_OK && (item = readdir(list)) != NULL;) {
    size_t length = strlen(item->d_name);
    if (item->d_name[0] != '.' && length > 4 && length < NAME + 4 &&
        strcmp(item->d_name + length - 4, ".pvd") == 0)
      status = recall_set(writer, item->d_name, resume_from, fault);
  }
  closedir(list);
  return status;
}

/* ---- public ---- */

cdem_status cdem_frame_writer_create(const char *folder, int64_t resume_from,
                                     cdem_frame_writer **writer, cdem_fault *fault) {
  cdem_frame_writer *w;
  *writer = NULL;
  CDEM_NEW(w, 1, fault);
  w->folder = cdem_copy_text(folder, fault);
  cdem_status status = w->folder != NULL ? cdem_make_folder(folder, fault) : CDEM_MEMORY;
  if (status == CDEM_OK)
    status = recall(w, resume_from, fault);
  if (status == CDEM_OK)
    *writer = w;
  else
    cdem_frame_writer_destroy(&w);
  return status;
}

cdem_frame_sink cdem_frame_writer_sink(cdem_frame_writer *writer) {
  return (cdem_frame_sink){writer, take_frame};
}

void cdem_frame_writer_destroy(cdem_frame_writer **writer) {
  if (writer == NULL || *writer == NULL)
    return;
  for (int64_t s = 0; s < (*writer)->sets; s++)
    free((*writer)->set[s].entry);
  free((*writer)->set);
  free((*writer)->folder);
  free(*writer);
  *writer = NULL;
}
