/* Reads what `cdem springs` writes, strictly by docs/formats.md; anything else fails the test. */
#ifndef CDEM_TESTS_CLI_REBUILD_READ_H
#define CDEM_TESTS_CLI_REBUILD_READ_H

#include <stdbool.h>
#include <stdint.h>

/* One term of a spring tensor. The third component is z, or rz of a plane Cosserat element. */
typedef struct rebuild_row {
  int64_t element, node_i, node_j;
  char kind[24], class[8], form[12];
  int spring, couples_to; /* 0: an empty couples_to */
  double stiffness, coupling;
  double dir[3], dual[3];
  double cond; /* NaN: empty */
  double length;
} rebuild_row;

typedef struct rebuild_rows {
  int count, width; /* width: components of dir and dual */
  bool cosserat;
  rebuild_row *row;
} rebuild_rows;

typedef struct rebuild_matrix {
  int nodes, size;
  int64_t *tag;  /* [nodes] in the order of the rows */
  double *value; /* [size][size] */
} rebuild_matrix;

void rebuild_read_csv(const char *path, rebuild_rows *rows);

/* The pairs of /springs and the further rows of /extra. */
void rebuild_read_hdf5(const char *path, rebuild_rows *rows);

void rebuild_rows_release(rebuild_rows *rows);

/* A symmetric coordinate file; every entry of the lower triangle at most once. */
void rebuild_read_mtx(const char *path, rebuild_matrix *matrix);
void rebuild_matrix_release(rebuild_matrix *matrix);

#endif
