/* What the tests of room io share: a scratch folder, whole files, a comma locale, and a small
 * network written by hand with every form of spring set. */
#ifndef CDEM_TESTS_IO_SUPPORT_H
#define CDEM_TESTS_IO_SUPPORT_H

#include "io/io.h"
#include "support/comma.h"

#include <dirent.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* A whole file with a zero behind it; NULL when there is none. */
static inline char *read_whole(const char *path, size_t *bytes) {
  FILE *file = fopen(path, "rb");
  if (file == NULL)
    return NULL;
  size_t used = 0, room = 1 << 16;
  char *text = malloc(room);
  for (size_t got; (got = fread(text + used, 1, room - 1 - used, file)) > 0;) {
    used += got;
    if (used == room - 1)
      text = realloc(text, room *= 2);
  }
  fclose(file);
  text[used] = '\0';
  if (bytes != NULL)
    *bytes = used;
  return text;
}

static inline void write_whole(const char *path, const char *text) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_true(fputs(text, file) >= 0);
  assert_int_equal(fclose(file), 0);
}

/* Number of entries in the scratch folder: leftovers are failures. */
static inline int count_files(const char *folder) {
  DIR *list = opendir(folder);
  int count = 0;
  for (struct dirent *entry; (entry = readdir(list)) != NULL;)
    count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
  closedir(list);
  return count;
}

/* Runs `body` in a child where no file may grow beyond `limit` bytes; returns what it returned, 255
 * when it died by a signal. */
static inline int with_file_limit(rlim_t limit, int (*body)(const void *), const void *argument) {
  int result = 0;
  fflush(NULL);
  pid_t child = fork();
  if (child == 0) {
    struct rlimit before, bound;
    getrlimit(RLIMIT_FSIZE, &before);
    bound = (struct rlimit){limit, before.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &bound);
    result = body(argument);
    setrlimit(RLIMIT_FSIZE, &before); /* counts of covered lines are written at the exit */
    exit(result);
  }
  waitpid(child, &result, 0);
  return WIFEXITED(result) ? WEXITSTATUS(result) : 255;
}

/* ---- a network by hand ---- */

enum { HAND_NODES = 8, HAND_PAIRS = 28 };

typedef struct {
  cdem_mesh mesh;
  cdem_model model;
  cdem_model_kind kind;
  cdem_material material;
  int32_t cell;
  uint8_t kind_of;
  uint16_t material_of;
  cdem_pair pair[HAND_PAIRS];
  int rows; /* of all pairs */
} hand_network;

/* Any direction and its dual; what the numbers are does not matter to a writer, except that no two
 * are alike and none is short in decimal. */
static inline void hand_row(cdem_random *random, int size, int spring, int couples_to,
                            cdem_spring_row *row) {
  *row = (cdem_spring_row){.spring = (int8_t)spring, .couples_to = (int8_t)couples_to};
  row->stiffness = cdem_random_uniform(random, -1.0, 1.0) * 1e9;
  row->coupling = couples_to > 0 ? cdem_random_uniform(random, -1.0, 1.0) * 1e7 : 0.0;
  for (int c = 0; c < size; c++) {
    row->dir[c] = cdem_random_uniform(random, -1.0, 1.0);
    row->dual[c] = cdem_random_uniform(random, -1.0, 1.0);
  }
}

/* A set of the form number `which` modulo the forms of springs.h. */
static inline void hand_set(cdem_random *random, int size, int which, cdem_spring_set *set) {
  static const int couples[CDEM_FORM_COUNT][4] = {
      [CDEM_FORM_JORDAN2] = {0, 3, 0, 0},
      [CDEM_FORM_JORDAN3] = {2, 3, 0, 0},
      [CDEM_FORM_COMPLEX] = {0, 3, 2, 0},
  };
  *set = (cdem_spring_set){.size = (uint8_t)size, .rows = (uint8_t)size};
  set->form = (uint8_t)(size == 3 ? which % CDEM_FORM_COUNT : which % 2 * CDEM_FORM_COMPLEX);
  set->cond = set->form == CDEM_FORM_FRAME ? NAN : cdem_random_uniform(random, 1.0, 20.0);
  for (int r = 0; r < size; r++)
    hand_row(random, size, r + 1, size == 3 ? couples[set->form][r] : which % 2 * (2 - r),
             &set->row[r]);
  if (set->form == CDEM_FORM_FRAME) {
    set->rows = 4;
    hand_row(random, size, 4, 0, &set->row[3]);
  }
  if (set->form == CDEM_FORM_JORDAN3) { /* the extra row of a second coupling */
    set->rows = 4;
    set->row[3] = set->row[0];
    set->row[3].stiffness = 0.0;
    set->row[3].couples_to = 3;
    set->row[3].coupling = cdem_random_uniform(random, -1.0, 1.0) * 1e7;
  }
}

/* One hex8, quad4 or quad4-cosserat of odd tags with all its pairs. */
static inline void hand_network_init(hand_network *hand, const char *element) {
  cdem_fault fault = {0};
  cdem_random random = {20240607};
  double xyz[HAND_NODES][3];
  int64_t tag[HAND_NODES];
  int32_t node[HAND_NODES];
  *hand = (hand_network){.kind_of = 0};
  const cdem_element *info = cdem_element_find(element);
  assert_non_null(info);
  int nodes = cdem_element_nodes(info), size = cdem_element_dofs(info);
  for (int n = 0; n < nodes; n++) {
    node[n] = n;
    tag[n] = 1000 - 7 * n;
    for (int c = 0; c < 3; c++)
      xyz[n][c] = c < cdem_element_dimension(info) ? info->reference[n][c] + 0.01 * n : 0.0;
  }
  const int64_t cell_tag = 4711;
  check_ok(cdem_mesh_add_nodes(&hand->mesh, nodes, xyz[0], tag, &fault));
  check_ok(cdem_mesh_add_cells(&hand->mesh, info->shape, 1, node, &cell_tag, &fault));
  hand->kind = (cdem_model_kind){.tabulation = {.element = info}, .cells = 1};
  hand->material = cdem_material_isotropic(4e10, 0.25);
  hand->model = (cdem_model){.mesh = &hand->mesh,
                             .formulation = info->formulation,
                             .dimension = cdem_element_dimension(info),
                             .dofs = size,
                             .section = {CDEM_PLANE_STRAIN, 0.5},
                             .length = info->formulation == CDEM_PLANE_COSSERAT ? 0.125 : 1.0,
                             .cells = 1,
                             .cell = &hand->cell,
                             .kind = &hand->kind_of,
                             .material = &hand->material_of,
                             .kinds = 1,
                             .kinds_of = &hand->kind,
                             .materials = 1,
                             .materials_of = &hand->material};
  for (int a = 0; a < nodes; a++)
    for (int b = a + 1; b < nodes; b++) {
      cdem_pair *pair = &hand->pair[hand->model.pairs];
      pair->node[0] = pair->local[0] = (uint8_t)a;
      pair->node[1] = pair->local[1] = (uint8_t)b;
      pair->class_ = (uint8_t)(cdem_shape_pair_class(info->shape, a, b) - 1);
      hand_set(&random, size, (int)hand->model.pairs, &pair->set);
      hand->rows += pair->set.rows;
      hand->model.pairs++;
    }
}

static inline void hand_network_release(hand_network *hand) {
  cdem_mesh_release(&hand->mesh);
}

/* Feeds the pairs to a writer, `each` at a time, `times` times over, as the network would. */
static inline cdem_status hand_feed(const hand_network *hand, cdem_springs_writer *writer, int each,
                                    int times, cdem_fault *fault) {
  cdem_buffer buffer = {0};
  cdem_status status = CDEM_OK;
  for (int t = 0; t < times; t++)
    for (int64_t first = 0; first < hand->model.pairs && status == CDEM_OK; first += each) {
      int64_t left = hand->model.pairs - first;
      cdem_chunk chunk = {&hand->model, left < each ? left : each, &hand->pair[first]};
      buffer.used = 0;
      if (writer->sink.encode != NULL)
        status = writer->sink.encode(writer->sink.context, &chunk, &buffer, fault);
      if (status == CDEM_OK)
        status = writer->sink.write(writer->sink.context, &chunk, &buffer, fault);
    }
  free(buffer.data);
  return status;
}

/* Open, feed, commit, destroy. */
static inline cdem_status hand_write(const hand_network *hand, const cdem_springs_format *format,
                                     const char *path, int each, int times, cdem_fault *fault) {
  cdem_springs_writer *writer = NULL;
  cdem_status status = format->open(path, &hand->model, &writer, fault);
  if (status == CDEM_OK)
    status = hand_feed(hand, writer, each, times, fault);
  if (status == CDEM_OK)
    status = writer->commit(writer, fault);
  cdem_springs_writer_destroy(&writer);
  assert_null(writer);
  return status;
}

/* Equation (1) of springs.h once more, from rows alone. */
static inline void rows_to_block(const cdem_spring_row *row, int rows, int size, double *s) {
  for (int e = 0; e < size * size; e++)
    s[e] = 0.0;
  for (int r = 0; r < rows; r++) {
    const double *other = NULL;
    for (int k = 0; k < rows && other == NULL; k++)
      if (row[r].couples_to != 0 && row[k].spring == row[r].couples_to)
        other = row[k].dual;
    for (int a = 0; a < size; a++)
      for (int b = 0; b < size; b++)
        s[a * size + b] += row[r].dir[a] * (row[r].stiffness * row[r].dual[b] +
                                            (other != NULL ? row[r].coupling * other[b] : 0.0));
  }
}

/* The rows of the hand-made network are arbitrary; decks need a symmetric matrix, so all couplings
 * and skew parts go for that format. */
static inline void hand_make_symmetric(hand_network *network) {
  for (int64_t i = 0; i < network->model.pairs; i++)
    for (int r = 0; r < network->pair[i].set.rows; r++) {
      cdem_spring_row *row = &network->pair[i].set.row[r];
      row->coupling = 0.0;
      row->couples_to = 0;
      memcpy(row->dual, row->dir, sizeof row->dual);
    }
}

#endif
