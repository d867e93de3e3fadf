/* From mesh to springs: hexahedra per second, step by step, in one run.
 *
 *   bench_pipeline [HEXAHEDRA] [FOLDER]     default 1000000 and /tmp
 *
 * Prints for all-different hexahedra
 *   - the steps on one core: stiffness blocks, then the 28 decompositions, beside LAPACKE_dgeev on
 * each block;
 *   - the whole stream on 1, 2, ... cores without output: time, speed-up;
 *   - the whole stream to HDF5 on all cores: bytes written, rate, beside the rate at which the same
 * bytes are written by plain fwrite in the same run (the bound of the disk and the page cache);
 *   - the memory of the process before and after (the stream needs the mesh and a chunk a core).
 */
#include "io/io.h"

#include <lapacke.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double peak_gigabytes(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return (double)usage.ru_maxrss / 1048576.0;
}

static void stop_on(cdem_status status, const cdem_fault *fault) {
  if (status == CDEM_OK)
    return;
  fprintf(stderr, "error: %s\n", fault->message);
  exit(cdem_status_exit_code(status));
}

static int by_size(const void *a, const void *b) {
  double left = *(const double *)a, right = *(const double *)b;
  return (left > right) - (left < right);
}

static double median(double *value, int count) {
  qsort(value, (size_t)count, sizeof *value, by_size);
  return value[count / 2];
}

/* ---- steps on one core ---- */

enum { BATCHES = 64, ROUNDS = 5, PAIRS = 28, BLOCKS = BATCHES * PAIRS * CDEM_LANES };

typedef struct {
  double *x, *moment, *block;
  cdem_spring_set *set;
} lanes;

static void gather_batches(const cdem_model *model, double *x) {
  for (int b = 0; b < BATCHES; b++)
    for (int lane = 0; lane < CDEM_LANES; lane++) {
      double xyz[CDEM_SHAPE_MAX_NODES][3];
      cdem_model_coordinates(model, (b * CDEM_LANES + lane) % model->cells, xyz);
      for (int a = 0; a < 8; a++)
        for (int c = 0; c < 3; c++)
          x[((b * 8 + a) * 3 + c) * CDEM_LANES + lane] = xyz[a][c];
    }
}

static double time_stiffness(const cdem_model *model, lanes *l) {
  const cdem_contraction *law[CDEM_LANES];
  double least[CDEM_LANES], seconds[ROUNDS];
  for (int lane = 0; lane < CDEM_LANES; lane++)
    law[lane] = &model->contraction[0];
  for (int r = 0; r < ROUNDS; r++) {
    double start = now();
    for (int repeat = 0; repeat < 20; repeat++)
      for (int b = 0; b < BATCHES; b++) {
        cdem_moments_kernel(&model->kinds_of[0].tabulation, l->x + (int64_t)b * 24 * CDEM_LANES,
                            l->moment, least);
        cdem_blocks_kernel(PAIRS, law, l->moment, l->block + (int64_t)b * PAIRS * 9 * CDEM_LANES);
      }
    seconds[r] = (now() - start) / 20.0 / (BATCHES * CDEM_LANES);
  }
  return median(seconds, ROUNDS);
}

static double time_fast(lanes *l) {
  cdem_fault fault = {0};
  double seconds[ROUNDS];
  for (int r = 0; r < ROUNDS; r++) {
    double start = now();
    for (int repeat = 0; repeat < 5; repeat++)
      for (int b = 0; b < BATCHES; b++)
        stop_on(cdem_springs_from_blocks(l->block + (int64_t)b * PAIRS * 9 * CDEM_LANES,
                                         PAIRS * CDEM_LANES, 3, NULL, l->set, &fault),
                &fault);
    seconds[r] = (now() - start) / 5.0 / (BATCHES * CDEM_LANES);
  }
  return median(seconds, ROUNDS);
}

/* The straightforward way: eigenvalues and vectors of every block by LAPACK, then the inverse of
 * the vectors. */
static double time_lapack(const lanes *l) {
  double start = now(), keep = 0.0;
  for (int64_t i = 0; i < BLOCKS; i++) {
    double s[9], re[3], im[3], p[9];
    lapack_int pivot[3];
    for (int e = 0; e < 9; e++)
      s[e] = l->block[(i / CDEM_LANES * 9 + e) * CDEM_LANES + i % CDEM_LANES];
    LAPACKE_dgeev(LAPACK_ROW_MAJOR, 'N', 'V', 3, s, 3, re, im, NULL, 3, p, 3);
    LAPACKE_dgetrf(LAPACK_ROW_MAJOR, 3, 3, p, 3, pivot);
    LAPACKE_dgetri(LAPACK_ROW_MAJOR, 3, p, 3, pivot);
    keep += p[0] + re[0];
  }
  if (keep == 0.12345)
    printf("\n"); /* the compiler must not drop the work */
  return (now() - start) / (BATCHES * CDEM_LANES);
}

static void bench_steps(const cdem_model *model) {
  lanes l = {.x = cdem_allocate((int64_t)BATCHES * 24 * CDEM_LANES, sizeof(double), NULL),
             .moment = cdem_allocate((int64_t)PAIRS * 9 * CDEM_LANES, sizeof(double), NULL),
             .block = cdem_allocate((int64_t)BLOCKS * 9, sizeof(double), NULL),
             .set = cdem_allocate((int64_t)PAIRS * CDEM_LANES, sizeof(cdem_spring_set), NULL)};
  gather_batches(model, l.x);
  double stiffness = time_stiffness(model, &l), fast = time_fast(&l), lapack = time_lapack(&l);
  printf("one core, per hexahedron                  microseconds  hexahedra/s\n");
  printf("  stiffness, 28 blocks                    %12.2f %12.0f\n", 1e6 * stiffness,
         1.0 / stiffness);
  printf("  28 decompositions, fast path            %12.2f %12.0f\n", 1e6 * fast, 1.0 / fast);
  printf(
      "  28 decompositions, LAPACKE_dgeev + inverse %9.2f %12.0f   fast path: %.0f times as fast\n",
      1e6 * lapack, 1.0 / lapack, lapack / fast);
  free(l.x);
  free(l.moment);
  free(l.block);
  free(l.set);
}

/* ---- the whole stream ---- */

static cdem_status count(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                         cdem_fault *fault) {
  (void)buffer, (void)fault;
  *(int64_t *)context += chunk->pairs;
  return CDEM_OK;
}

static void bench_stream(const cdem_model *model) {
  cdem_fault fault = {0};
  double one = 0.0;
  printf("\nwhole stream, no output                   threads  seconds  hexahedra/s  speed-up\n");
  for (int threads = 1; threads <= omp_get_num_procs(); threads *= 2) {
    int64_t pairs = 0;
    cdem_pair_sink sink = {.context = &pairs, .write = count};
    cdem_convert_options options = {.frame = CDEM_FRAME_BODY, .threads = threads};
    double start = now();
    stop_on(cdem_network_convert(model, &options, &sink, 1, &fault), &fault);
    double seconds = now() - start;
    one = threads == 1 ? seconds : one;
    printf("  %38s  %7d %8.2f %12.0f %9.2f\n", "", threads, seconds, model->cells / seconds,
           one / seconds);
  }
}

/* Seconds to write `bytes` of the same kind of data with plain fwrite. */
static double time_plain_write(const char *path, int64_t bytes) {
  enum { BLOCK = 1 << 22 };
  char *block = cdem_allocate(BLOCK, 1, NULL);
  memset(block, 'x', BLOCK);
  FILE *stream = fopen(path, "wb");
  double start = now();
  for (int64_t done = 0; stream != NULL && done < bytes; done += BLOCK)
    if (fwrite(block, 1, BLOCK, stream) != BLOCK)
      break;
  if (stream != NULL)
    fclose(stream);
  double seconds = now() - start;
  unlink(path);
  free(block);
  return seconds;
}

static void bench_hdf5(const cdem_model *model, const char *folder) {
  cdem_fault fault = {0};
  char path[4096];
  snprintf(path, sizeof path, "%s/bench-%d.h5", folder, (int)getpid());
  cdem_springs_writer *writer = NULL;
  double before = peak_gigabytes(), start = now();
  stop_on(cdem_springs_format_find("h5")->open(path, model, &writer, &fault), &fault);
  cdem_convert_options options = {.frame = CDEM_FRAME_BODY};
  stop_on(cdem_network_convert(model, &options, &writer->sink, 1, &fault), &fault);
  stop_on(writer->commit(writer, &fault), &fault);
  double seconds = now() - start;
  cdem_springs_writer_destroy(&writer);
  struct stat file;
  int64_t bytes = stat(path, &file) == 0 ? file.st_size : 0;
  unlink(path);
  double plain = time_plain_write(path, bytes);
  printf("\nwhole stream to HDF5, %d threads           %8.2f s  %.0f hexahedra/s  %.2f GB  %.2f "
         "GB/s\n",
         omp_get_max_threads(), seconds, model->cells / seconds, 1e-9 * (double)bytes,
         1e-9 * (double)bytes / seconds);
  printf("  plain fwrite of as many bytes           %8.2f s  %.2f GB/s; the stream takes %.2f "
         "times as long\n",
         plain, 1e-9 * (double)bytes / plain, seconds / plain);
  printf("  peak memory                             %8.2f GB with the mesh, %.2f GB after the "
         "stream\n",
         before, peak_gigabytes());
}

int main(int argc, char **argv) {
  int64_t hexahedra = argc > 1 ? atoll(argv[1]) : 1000000;
  const char *folder = argc > 2 ? argv[2] : "/tmp";
  int32_t side = (int32_t)lround(cbrt((double)hexahedra));
  cdem_fault fault = {0};
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_mesh_grid_options grid = {.shape = CDEM_SHAPE_HEX8,
                                 .count = {side, side, side},
                                 .size = {1, 1, 1},
                                 .distortion = 0.2,
                                 .seed = 1};
  cdem_material rock = cdem_material_isotropic(40e9, 0.3);
  cdem_model_options body = {
      .mesh = &mesh, .materials = 1, .material = &rock, .section = {CDEM_PLANE_STRAIN, 1.0}};
  double start = now();
  stop_on(cdem_mesh_grid(&grid, &mesh, &fault), &fault);
  double made = now();
  stop_on(cdem_model_init(&body, &model, &fault), &fault);
  printf(
      "%d all-different hexahedra, %lld pairs; grid %.2f s, model with validity check %.2f s\n\n",
      (int)model.cells, (long long)model.pairs, made - start, now() - made);
  bench_steps(&model);
  bench_stream(&model);
  bench_hdf5(&model, folder);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
  return 0;
}
