#include "rebuild_read.h"

#include "support/test.h"

#include <hdf5.h>
#include <inttypes.h>
#include <string.h>

static const char solid_header[] =
    "element,kind,node_i,node_j,class,form,spring,stiffness,couples_to,coupling,"
    "dir_x,dir_y,dir_z,dual_x,dual_y,dual_z,cond";
static const char cosserat_header[] = ",dir_rz,dual_rz,length";
enum { MAX_FIELDS = 20 };

static void *allocate(size_t count, size_t size) {
  void *p = calloc(count > 0 ? count : 1, size);
  assert_non_null(p);
  return p;
}

static FILE *open_text(const char *path) {
  FILE *file = fopen(path, "r");
  if (file == NULL)
    fail_msg("cannot open '%s'", path);
  return file;
}

/* One line of a CSV file: its fields and where it is from. */
typedef struct csv_line {
  const char *path;
  int number, fields;
  char *field[MAX_FIELDS], *name[MAX_FIELDS];
} csv_line;

static int split(char *line, char *field[MAX_FIELDS]) {
  int count = 0;
  for (char *at = line; at != NULL && count < MAX_FIELDS; count++) {
    field[count] = at;
    at = strchr(at, ',');
    if (at != NULL)
      *at++ = '\0';
  }
  return count;
}

static const char *text_of(const csv_line *line, const char *name) {
  for (int f = 0; f < line->fields; f++)
    if (strcmp(line->name[f], name) == 0)
      return line->field[f];
  fail_msg("%s has no column '%s'", line->path, name);
  return "";
}

/* Empty fields are NaN. 17 significant digits: the text is what %.17g makes of its own value. */
static double number_of(const csv_line *line, const char *name) {
  const char *text = text_of(line, name);
  if (*text == '\0')
    return NAN;
  char *end, again[40];
  double value = strtod(text, &end);
  snprintf(again, sizeof again, "%.17g", value);
  if (*end != '\0' || !isfinite(value) || strcmp(again, text) != 0)
    fail_msg("%s:%d: %s is '%s', not a number of 17 digits", line->path, line->number, name, text);
  return value;
}

static int64_t integer_of(const csv_line *line, const char *name, bool may_be_empty) {
  const char *text = text_of(line, name);
  char *end;
  long long value = strtoll(text, &end, 10);
  if (*end != '\0' || (end == text && !may_be_empty))
    fail_msg("%s:%d: %s is '%s', not an integer", line->path, line->number, name, text);
  return value;
}

static void copy_word(const csv_line *line, const char *name, char *word, size_t size) {
  const char *text = text_of(line, name);
  if (*text == '\0' || strlen(text) >= size)
    fail_msg("%s:%d: %s is '%s'", line->path, line->number, name, text);
  memcpy(word, text, strlen(text) + 1);
}

/* Components that the element has not are empty, the others are not. */
static int vector_of(const csv_line *line, const char *stem, bool cosserat, double vector[3]) {
  static const char *const end[] = {"_x", "_y", "_z", "_rz"};
  double part[4] = {0, 0, 0, NAN};
  for (int c = 0; c < (cosserat ? 4 : 3); c++) {
    char name[16];
    snprintf(name, sizeof name, "%s%s", stem, end[c]);
    part[c] = number_of(line, name);
  }
  int width = isnan(part[2]) && !cosserat ? 2 : 3;
  if (isnan(part[0]) || isnan(part[1]) || (cosserat && (!isnan(part[2]) || isnan(part[3]))))
    fail_msg("%s:%d: a component of %s is empty that must not be, or the other way round",
             line->path, line->number, stem);
  vector[0] = part[0];
  vector[1] = part[1];
  vector[2] = cosserat ? part[3] : width == 3 ? part[2] : 0;
  return width;
}

static void read_row(const csv_line *line, rebuild_rows *rows) {
  rebuild_row *row = &rows->row[rows->count];
  row->element = integer_of(line, "element", false);
  row->node_i = integer_of(line, "node_i", false);
  row->node_j = integer_of(line, "node_j", false);
  copy_word(line, "kind", row->kind, sizeof row->kind);
  copy_word(line, "class", row->class, sizeof row->class);
  copy_word(line, "form", row->form, sizeof row->form);
  row->spring = (int)integer_of(line, "spring", false);
  row->stiffness = number_of(line, "stiffness");
  row->couples_to = (int)integer_of(line, "couples_to", true);
  row->coupling = number_of(line, "coupling");
  row->cond = number_of(line, "cond");
  row->length = rows->cosserat ? number_of(line, "length") : NAN;
  if (isnan(row->stiffness) || (row->couples_to == 0) != isnan(row->coupling) ||
      (*text_of(line, "couples_to") == '\0') != isnan(row->coupling) ||
      (rows->cosserat && isnan(row->length)))
    fail_msg("%s:%d: an empty stiffness or length, or one of couples_to and coupling without the "
             "other",
             line->path, line->number);
  if (row->couples_to == 0)
    row->coupling = 0;
  int width = vector_of(line, "dir", rows->cosserat, row->dir);
  if (vector_of(line, "dual", rows->cosserat, row->dual) != width ||
      (rows->count > 0 && width != rows->width))
    fail_msg("%s:%d: %d components, other rows differ", line->path, line->number, width);
  rows->width = width;
  rows->count++;
}

void rebuild_read_csv(const char *path, rebuild_rows *rows) {
  FILE *file = open_text(path);
  char text[1024], header[1024];
  csv_line line = {.path = path, .number = 1};
  *rows = (rebuild_rows){0};
  if (fgets(header, sizeof header, file) == NULL)
    fail_msg("%s is empty", path);
  header[strcspn(header, "\n")] = '\0';
  size_t solid = strlen(solid_header);
  if (strncmp(header, solid_header, solid) != 0 ||
      (header[solid] != '\0' && strcmp(header + solid, cosserat_header) != 0))
    fail_msg("%s has the header '%s'", path, header);
  rows->cosserat = header[solid] != '\0';
  int columns = split(header, line.name), capacity = 0;
  while (fgets(text, sizeof text, file) != NULL) {
    line.number++;
    text[strcspn(text, "\n")] = '\0';
    line.fields = split(text, line.field);
    if (line.fields != columns)
      fail_msg("%s:%d: %d fields, %d expected", path, line.number, line.fields, columns);
    if (rows->count == capacity) {
      capacity = 2 * capacity + 64;
      rows->row = realloc(rows->row, (size_t)capacity * sizeof *rows->row);
      assert_non_null(rows->row);
    }
    read_row(&line, rows);
  }
  fclose(file);
}

void rebuild_rows_release(rebuild_rows *rows) {
  free(rows->row);
  *rows = (rebuild_rows){0};
}

/* HDF5. */

/* A data set of `count` numbers, whatever its integer or real type in the file. */
static void *read_set(hid_t file, const char *name, hid_t type, hsize_t count) {
  hid_t set = H5Dopen(file, name, H5P_DEFAULT);
  if (set < 0)
    fail_msg("no data set '%s'", name);
  hid_t space = H5Dget_space(set);
  if (H5Sget_simple_extent_npoints(space) != (hssize_t)count)
    fail_msg("'%s' holds %lld numbers, %llu expected", name,
             (long long)H5Sget_simple_extent_npoints(space), (unsigned long long)count);
  void *data = allocate(count, 8);
  assert_true(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  H5Sclose(space);
  H5Dclose(set);
  return data;
}

static hsize_t length_of_set(hid_t file, const char *name) {
  hid_t set = H5Dopen(file, name, H5P_DEFAULT);
  assert_true(set >= 0);
  hid_t space = H5Dget_space(set);
  hsize_t size[2] = {0};
  assert_true(H5Sget_simple_extent_dims(space, size, NULL) >= 1);
  H5Sclose(space);
  H5Dclose(set);
  return size[0];
}

static double read_attribute(hid_t file, const char *name) {
  hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
  assert_true(attribute >= 0);
  double value = NAN;
  assert_true(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0);
  H5Aclose(attribute);
  return value;
}

/* The word that integer `code` of /springs/NAME stands for. */
static void read_word(hid_t file, const char *name, int code, char *word, size_t size) {
  char path[32];
  snprintf(path, sizeof path, "/springs/%s", name);
  hid_t set = H5Dopen(file, path, H5P_DEFAULT), attribute = H5Aopen(set, "names", H5P_DEFAULT);
  assert_true(set >= 0 && attribute >= 0);
  hid_t space = H5Aget_space(attribute), type = H5Aget_type(attribute);
  assert_true(H5Tis_variable_str(type) > 0);
  hssize_t count = H5Sget_simple_extent_npoints(space);
  char **names = allocate((size_t)count, sizeof *names);
  if (code < 0 || code >= count || H5Aread(attribute, type, names) < 0)
    fail_msg("'%s' has no name for %d", path, code);
  snprintf(word, size, "%s", names[code]);
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, names);
  free(names);
  H5Tclose(type);
  H5Sclose(space);
  H5Aclose(attribute);
  H5Dclose(set);
}

/* Columns of /springs or /extra, one entry a spring. */
typedef struct spring_columns {
  double *stiffness, *coupling, *dir[3], *dual[3];
  int *couples_to;
} spring_columns;

static void read_columns(hid_t file, const char *group, const rebuild_rows *shape, hsize_t count,
                         spring_columns *columns) {
  const char *end[3] = {"x", "y", shape->cosserat ? "rz" : "z"};
  char name[32];
  *columns = (spring_columns){0};
  snprintf(name, sizeof name, "/%s/stiffness", group);
  columns->stiffness = read_set(file, name, H5T_NATIVE_DOUBLE, count);
  snprintf(name, sizeof name, "/%s/coupling", group);
  columns->coupling = read_set(file, name, H5T_NATIVE_DOUBLE, count);
  snprintf(name, sizeof name, "/%s/couples_to", group);
  columns->couples_to = read_set(file, name, H5T_NATIVE_INT, count);
  for (int c = 0; c < shape->width; c++) {
    snprintf(name, sizeof name, "/%s/dir_%s", group, end[c]);
    columns->dir[c] = read_set(file, name, H5T_NATIVE_DOUBLE, count);
    snprintf(name, sizeof name, "/%s/dual_%s", group, end[c]);
    columns->dual[c] = read_set(file, name, H5T_NATIVE_DOUBLE, count);
  }
}

static void release_columns(spring_columns *columns) {
  free(columns->stiffness);
  free(columns->coupling);
  free(columns->couples_to);
  for (int c = 0; c < 3; c++) {
    free(columns->dir[c]);
    free(columns->dual[c]);
  }
}

static void add_spring(const spring_columns *columns, hsize_t entry, const rebuild_row *pair,
                       int spring, rebuild_rows *rows) {
  rebuild_row *row = &rows->row[rows->count++];
  *row = *pair;
  row->spring = spring;
  row->stiffness = columns->stiffness[entry];
  row->couples_to = columns->couples_to[entry];
  row->coupling = row->couples_to > 0 ? columns->coupling[entry] : 0;
  for (int c = 0; c < rows->width; c++) {
    row->dir[c] = columns->dir[c][entry];
    row->dual[c] = columns->dual[c][entry];
  }
}

/* What is said once a pair. */
static rebuild_row *read_pairs(hid_t file, const rebuild_rows *rows, hsize_t pairs) {
  int64_t *element = read_set(file, "/springs/element", H5T_NATIVE_INT64, pairs);
  int64_t *node_i = read_set(file, "/springs/node_i", H5T_NATIVE_INT64, pairs);
  int64_t *node_j = read_set(file, "/springs/node_j", H5T_NATIVE_INT64, pairs);
  int *kind = read_set(file, "/springs/kind", H5T_NATIVE_INT, pairs);
  int *class = read_set(file, "/springs/class", H5T_NATIVE_INT, pairs);
  int *form = read_set(file, "/springs/form", H5T_NATIVE_INT, pairs);
  double *cond = read_set(file, "/springs/cond", H5T_NATIVE_DOUBLE, pairs);
  double length = rows->cosserat ? read_attribute(file, "length") : NAN;
  rebuild_row *pair = allocate(pairs, sizeof *pair);
  for (hsize_t p = 0; p < pairs; p++) {
    pair[p] = (rebuild_row){.element = element[p],
                            .node_i = node_i[p],
                            .node_j = node_j[p],
                            .cond = cond[p],
                            .length = length};
    read_word(file, "kind", kind[p], pair[p].kind, sizeof pair[p].kind);
    read_word(file, "class", class[p], pair[p].class, sizeof pair[p].class);
    read_word(file, "form", form[p], pair[p].form, sizeof pair[p].form);
  }
  void *all[] = {element, node_i, node_j, kind, class, form, cond};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++)
    free(all[k]);
  return pair;
}

void rebuild_read_hdf5(const char *path, rebuild_rows *rows) {
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0)
    fail_msg("cannot open '%s'", path);
  *rows = (rebuild_rows){.width = (int)read_attribute(file, "dofs")};
  rows->cosserat = read_attribute(file, "dimension") < rows->width;
  hsize_t pairs = length_of_set(file, "/springs/element"), width = (hsize_t)rows->width;
  hsize_t further = length_of_set(file, "/extra/pair");
  rebuild_row *pair = read_pairs(file, rows, pairs);
  rows->row = allocate(pairs * width + further, sizeof *rows->row);
  spring_columns columns;
  read_columns(file, "springs", rows, pairs * width, &columns);
  for (hsize_t k = 0; k < pairs * width; k++)
    add_spring(&columns, k, &pair[k / width], (int)(k % width) + 1, rows);
  release_columns(&columns);
  int64_t *owner = read_set(file, "/extra/pair", H5T_NATIVE_INT64, further);
  int *spring = read_set(file, "/extra/spring", H5T_NATIVE_INT, further);
  read_columns(file, "extra", rows, further, &columns);
  for (hsize_t k = 0; k < further; k++) {
    assert_in_range(owner[k], 0, pairs - 1);
    add_spring(&columns, k, &pair[owner[k]], spring[k], rows);
  }
  release_columns(&columns);
  free(owner);
  free(spring);
  free(pair);
  H5Fclose(file);
}

/* Matrix Market. */

/* Comment lines; the tags of the nodes are the numbers after "tags in order:". */
static void read_tags(FILE *file, rebuild_matrix *matrix) {
  char text[1024];
  int found = -1;
  long at = ftell(file);
  while (fgets(text, sizeof text, file) != NULL && text[0] == '%') {
    if (found >= 0)
      for (char *next = text + 1, *end; found < matrix->nodes; next = end, found++) {
        long long tag = strtoll(next, &end, 10);
        if (end == next)
          break;
        matrix->tag[found] = tag;
      }
    else if (sscanf(text, "%% nodes %d, their tags in order", &matrix->nodes) == 1) {
      found = 0;
      matrix->tag = allocate((size_t)matrix->nodes, sizeof *matrix->tag);
    }
    at = ftell(file);
  }
  fseek(file, at, SEEK_SET);
  assert_int_equal(found, matrix->nodes);
}

void rebuild_read_mtx(const char *path, rebuild_matrix *matrix) {
  FILE *file = open_text(path);
  char text[128];
  *matrix = (rebuild_matrix){0};
  assert_non_null(fgets(text, sizeof text, file));
  assert_string_equal(text, "%%MatrixMarket matrix coordinate real symmetric\n");
  read_tags(file, matrix);
  int columns, row, column;
  long long entries, read = 0;
  assert_int_equal(fscanf(file, "%d %d %lld", &matrix->size, &columns, &entries), 3);
  assert_int_equal(matrix->size, columns);
  size_t size = (size_t)matrix->size;
  matrix->value = allocate(size * size, sizeof(double));
  bool *seen = allocate(size * size, sizeof *seen);
  double value;
  for (; fscanf(file, "%d %d %lf", &row, &column, &value) == 3; read++) {
    if (column < 1 || column > row || row > columns)
      fail_msg("%s: entry %d %d is not in the lower triangle", path, row, column);
    size_t i = (size_t)row - 1, j = (size_t)column - 1;
    if (seen[i * size + j])
      fail_msg("%s: entry %d %d stands twice", path, row, column);
    seen[i * size + j] = true;
    matrix->value[i * size + j] = matrix->value[j * size + i] = value;
  }
  assert_true(feof(file) && read == entries);
  free(seen);
  fclose(file);
}

void rebuild_matrix_release(rebuild_matrix *matrix) {
  free(matrix->tag);
  free(matrix->value);
  *matrix = (rebuild_matrix){0};
}
