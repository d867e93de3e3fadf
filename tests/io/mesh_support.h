/* For the tests of the mesh readers: a folder of their own, files from texts, comparisons. */
#ifndef CDEM_TESTS_IO_MESH_SUPPORT_H
#define CDEM_TESTS_IO_MESH_SUPPORT_H

#include "io/io.h"
#include "support/sanitizers.h"
#include "support/test.h"

#include <dirent.h>
#include <unistd.h>

static cdem_fault fault;
static char folder[64];

__attribute__((unused)) static int make_folder(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "/tmp/cdem-mesh-XXXXXX");
  return mkdtemp(folder) == NULL;
}

__attribute__((unused)) static int remove_folder(void **state) {
  (void)state;
  DIR *list = opendir(folder);
  char path[512];
  for (struct dirent *entry; list != NULL && (entry = readdir(list)) != NULL;) {
    snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    unlink(path);
  }
  if (list != NULL)
    closedir(list);
  rmdir(folder);
  return 0;
}

/* The path of a file in the folder; four answers can be in use at a time. */
__attribute__((unused)) static const char *in_folder(const char *name) {
  static char path[4][128];
  static int turn;
  turn = (turn + 1) % 4;
  snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
  return path[turn];
}

__attribute__((unused)) static const char *write_bytes(const char *name, const void *data,
                                                       size_t size) {
  const char *path = in_folder(name);
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(data, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
  return path;
}

__attribute__((unused)) static const char *write_text(const char *name, const char *text) {
  return write_bytes(name, text, strlen(text));
}

/* The text with the first occurrence of `old` replaced, which must be there. Free with free(). */
__attribute__((unused)) static char *replaced(const char *text, const char *old, const char *with) {
  const char *at = strstr(text, old);
  if (at == NULL)
    fail_msg("'%s' is not in the text", old);
  char *out = malloc(strlen(text) + strlen(with) + 1);
  sprintf(out, "%.*s%s%s", (int)(at - text), text, with, at + strlen(old));
  return out;
}

__attribute__((unused)) static char *read_bytes(const char *path, size_t *size) {
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  fseek(file, 0, SEEK_END);
  *size = (size_t)ftell(file);
  rewind(file);
  char *data = malloc(*size + 1);
  assert_int_equal(fread(data, 1, *size, file), *size);
  data[*size] = '\0';
  fclose(file);
  return data;
}

/* Warnings go here. */
typedef struct {
  int count;
  char last[CDEM_FAULT_LENGTH];
} heard;

__attribute__((unused)) static void hear(void *context, const char *message) {
  heard *to = context;
  to->count++;
  snprintf(to->last, sizeof to->last, "%s", message);
}

__attribute__((unused)) static cdem_mesh read_mesh(const char *path) {
  cdem_mesh mesh = {0};
  check_ok(cdem_read_mesh(path, &mesh, NULL, &fault));
  assert_string_equal(mesh.source, path);
  return mesh;
}

/* The mesh cannot be read, says `text`, and the output is empty. */
__attribute__((unused)) static void check_unreadable(const char *path, cdem_status status,
                                                     const char *text) {
  cdem_mesh mesh = {0};
  check_fails(cdem_read_mesh(path, &mesh, NULL, &fault), status, text);
  assert_null(mesh.xyz);
  assert_int_equal(mesh.nodes, 0);
}

__attribute__((unused)) static int count_shape(const cdem_mesh *mesh, cdem_shape shape) {
  int count = 0;
  for (int32_t c = 0; c < mesh->cells; c++)
    count += mesh->cell_shape[c] == shape;
  return count;
}

/* Volume (area) behind the corner faces, each cut around the mean of its corners. */
__attribute__((unused)) static double cell_measure(const cdem_mesh *mesh, int32_t cell) {
  const cdem_shape_info *info = cdem_shape_get((cdem_shape)mesh->cell_shape[cell]);
  const int32_t *node = cdem_mesh_cell(mesh, cell);
  double sum = 0;
  for (int f = 0; f < info->faces; f++) {
    int corners = info->face_corners[f];
    double m[9] = {0};
    for (int c = 0; c < corners; c++)
      for (int i = 0; i < 3; i++)
        m[i] += mesh->xyz[3 * node[info->face[f][c]] + i] / corners;
    for (int c = 0; c < corners; c++) {
      const double *a = mesh->xyz + 3 * node[info->face[f][c]];
      const double *b = mesh->xyz + 3 * node[info->face[f][(c + 1) % corners]];
      memcpy(m + 3, a, 3 * sizeof *m);
      memcpy(m + 6, b, 3 * sizeof *m);
      if (info->dimension == 3)
        sum += cdem_det3(m) / 6;
      else
        sum += 0.5 * ((a[0] - m[0]) * (b[1] - m[1]) - (a[1] - m[1]) * (b[0] - m[0]));
    }
  }
  return sum;
}

/* Sum over the cells of a group, all positive. */
__attribute__((unused)) static double group_measure(const cdem_mesh *mesh, const char *name) {
  const cdem_group *group = cdem_mesh_find_group(mesh, name);
  assert_non_null(group);
  double sum = 0;
  for (int32_t i = 0; i < group->cells; i++) {
    double own = cell_measure(mesh, group->cell[i]);
    assert_true(own > 0);
    sum += own;
  }
  return sum;
}

/* Mid nodes lie within `distance` of the middle of the edge that the shape table gives them. */
__attribute__((unused)) static void check_mid_nodes(const cdem_mesh *mesh, double distance) {
  for (int32_t c = 0; c < mesh->cells; c++) {
    const cdem_shape_info *info = cdem_shape_get((cdem_shape)mesh->cell_shape[c]);
    const int32_t *node = cdem_mesh_cell(mesh, c);
    for (int e = 0; e < info->edges && info->edge[e][2] >= 0; e++)
      for (int i = 0; i < 3; i++)
        check_near(mesh->xyz[3 * node[info->edge[e][2]] + i],
                   (mesh->xyz[3 * node[info->edge[e][0]] + i] +
                    mesh->xyz[3 * node[info->edge[e][1]] + i]) /
                       2,
                   0, distance);
  }
}

#endif
