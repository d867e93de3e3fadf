/* The assembled network as a LAMMPS data file of atom style bond, with the lines of input to use
 * it.
 *
 * A bond of style harmonic has E = K (r - r0)^2. Two kinds make what a pair of line form is
 * (springs_pairs.h), S = along n n^T + across (I - n n^T):
 *  - K = (along - across) / 2 with r0 the pair's length: to first order (along - across) n n^T.
 *  - K = across / 2 with r0 = 0: its force, across (x_j - x_i), is linear, the same in every
 *    direction, and does not vanish at the start. The forces of the start are balanced by constant
 *    ones, a per-atom property `balance` of the data file that fix addforce applies.
 * Nothing else of LAMMPS carries what is left over (docs/formats.md).
 *
 * Stiffness and length are rounded to 46 bits, so that equal springs of a regular mesh share one
 * bond type. */
#include "io/output.h"
#include "io/springs_pairs.h"
#include "io/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

typedef struct {
  int32_t position[2];
  double stiffness, rest; /* K and r0 of LAMMPS */
} bond;

typedef struct {
  int64_t bonds, types;
  bond *bond;      /* [bonds] by stiffness and rest length */
  double *balance; /* [nodes * dofs] constant force, N */
  bool balanced;   /* any of them */
} bond_list;

static double rounded(double value) {
  int exponent;
  double part = frexp(value, &exponent);
  return ldexp(nearbyint(ldexp(part, 46)), exponent - 46);
}

static bool is_same_type(const bond *a, const bond *b) {
  return a->stiffness == b->stiffness && a->rest == b->rest;
}

static int by_type(const void *left, const void *right) {
  const bond *a = left, *b = right;
  if (a->rest != b->rest)
    return a->rest < b->rest ? -1 : 1;
  if (a->stiffness != b->stiffness)
    return a->stiffness < b->stiffness ? -1 : 1;
  for (int i = 0; i < 2; i++)
    if (a->position[i] != b->position[i])
      return a->position[i] < b->position[i] ? -1 : 1;
  return 0;
}

/* Bonds of no stiffness are left out. */
static void add_bond(bond_list *list, const cdem_line_pair *pair, double stiffness, double rest) {
  if (stiffness != 0.0)
    list->bond[list->bonds++] =
        (bond){{pair->position[0], pair->position[1]}, rounded(stiffness), rounded(rest)};
}

static void add_pair(bond_list *list, const cdem_line_pair *pair, int dofs) {
  add_bond(list, pair, 0.5 * (pair->along - pair->across), pair->length);
  add_bond(list, pair, 0.5 * pair->across, 0.0);
  double across = 2.0 * rounded(0.5 * pair->across);
  list->balanced = list->balanced || across != 0.0;
  for (int c = 0; c < dofs; c++) {
    double pull = across * pair->length * pair->direction[c];
    list->balance[(int64_t)pair->position[0] * dofs + c] -= pull;
    list->balance[(int64_t)pair->position[1] * dofs + c] += pull;
  }
}

static cdem_status make_bonds(const cdem_matrix_writer *matrix, const cdem_line_pairs *pairs,
                              bond_list *list, cdem_fault *fault) {
  int dofs = matrix->sparse.dofs;
  CDEM_NEW(list->bond, 2 * pairs->pairs, fault);
  CDEM_NEW(list->balance, (int64_t)matrix->sparse.nodes * dofs, fault);
  for (int64_t i = 0; i < pairs->pairs; i++)
    add_pair(list, &pairs->pair[i], dofs);
  if (list->bonds > 0)
    qsort(list->bond, (size_t)list->bonds, sizeof *list->bond, by_type);
  for (int64_t i = 0; i < list->bonds; i++)
    list->types += i == 0 || !is_same_type(&list->bond[i], &list->bond[i - 1]);
  CDEM_REQUIRE(list->bonds <= INT32_MAX, fault, CDEM_INPUT,
               "cannot write '%s': %" PRId64 " bonds are more than LAMMPS counts, %d; write a part "
               "of the mesh (--group)",
               cdem_output_name(matrix->output), list->bonds, INT32_MAX);
  return CDEM_OK;
}

/* The lines of input stand in comments, so that they cannot be parted from their data. */
static void put_head(const cdem_matrix_writer *matrix, const cdem_line_pairs *pairs,
                     const bond_list *list, FILE *stream) {
  cdem_line_pairs_put_head(matrix, "LAMMPS", stream);
  fprintf(stream,
          "# Atoms are nodes, their ids the tags of the mesh. Masses are no part of a spring\n"
          "# network: all are 1 kg. Small strains and rotations, as those of the network.\n"
          "# Bonds of rest length 0 are the stiffness across; fix addforce balances their pull.\n"
          "# Input: sed -n 's/^#> //p' THIS_FILE > net.in; lmp -in net.in -var data THIS_FILE\n"
          "#> units        si\n"
          "#> dimension    %d\n"
          "#> boundary     m m %s\n"
          "#> atom_style   bond\n"
          "#> bond_style   harmonic\n"
          "#> special_bonds lj/coul 0 1 1\n",
          matrix->sparse.dofs, matrix->sparse.dofs == 2 ? "p" : "m");
  cdem_stream_real(stream, "#> comm_modify  cutoff ", 2.0 * pairs->longest, "\n");
  if (list->balanced)
    fputs("#> fix          balance all property/atom d_bx d_by d_bz\n"
          "#> read_data    ${data} fix balance NULL Balance\n"
          "#> compute      balance all property/atom d_bx d_by d_bz\n"
          "#> variable     bx atom c_balance[1]\n"
          "#> variable     by atom c_balance[2]\n"
          "#> variable     bz atom c_balance[3]\n"
          "#> fix          pull all addforce v_bx v_by v_bz\n",
          stream);
  else
    fputs("#> read_data    ${data}\n", stream);
  cdem_stream_real(stream, "#> timestep     ", cdem_line_pairs_step(pairs), "\n");
  fputs("#> fix          move all nve\n", stream);
  if (matrix->sparse.dofs == 2)
    fputs("#> fix          plane all enforce2d\n", stream);
}

/* "TAG 1 1 X Y Z", the places of all nodes. */
static void put_atoms(const cdem_matrix_writer *matrix, FILE *stream) {
  const cdem_mesh *mesh = matrix->model->mesh;
  fputs("\nMasses\n\n1 1\n\nAtoms # bond\n\n", stream);
  for (int32_t p = 0; p < matrix->sparse.nodes; p++) {
    const double *x = mesh->xyz + 3 * (int64_t)matrix->sparse.node[p];
    fprintf(stream, "%" PRId64 " 1 1", mesh->node_tag[matrix->sparse.node[p]]);
    for (int c = 0; c < 3; c++)
      cdem_stream_real(stream, " ", c < matrix->sparse.dofs ? x[c] : 0.0, c == 2 ? "\n" : "");
  }
}

static void put_box(const cdem_matrix_writer *matrix, double margin, FILE *stream) {
  const cdem_mesh *mesh = matrix->model->mesh;
  for (int c = 0; c < 3; c++) {
    double low = INFINITY, high = -INFINITY;
    for (int32_t p = 0; p < matrix->sparse.nodes && c < matrix->sparse.dofs; p++) {
      double x = mesh->xyz[3 * (int64_t)matrix->sparse.node[p] + c];
      low = fmin(low, x);
      high = fmax(high, x);
    }
    if (c == matrix->sparse.dofs)
      low = high = 0.0;
    cdem_stream_real(stream, "", low - margin, " ");
    cdem_stream_real(stream, "", high + margin, "");
    fprintf(stream, " %clo %chi\n", 'x' + c, 'x' + c);
  }
}

static void put_types(const bond_list *list, FILE *stream) {
  int64_t type = 0;
  fputs("\nBond Coeffs # harmonic\n\n", stream);
  for (int64_t i = 0; i < list->bonds; i++) {
    const bond *b = &list->bond[i];
    if (i > 0 && is_same_type(b, b - 1))
      continue;
    fprintf(stream, "%" PRId64, ++type);
    cdem_stream_real(stream, " ", b->stiffness, "");
    cdem_stream_real(stream, " ", b->rest, "\n");
  }
}

static void put_bonds(const cdem_matrix_writer *matrix, const bond_list *list, FILE *stream) {
  const int64_t *tag = matrix->model->mesh->node_tag;
  const int32_t *node = matrix->sparse.node;
  int64_t type = 0;
  fputs("\nBonds\n\n", stream);
  for (int64_t i = 0; i < list->bonds; i++) {
    const bond *b = &list->bond[i];
    type += i == 0 || !is_same_type(b, b - 1);
    fprintf(stream, "%" PRId64 " %" PRId64 " %" PRId64 " %" PRId64 "\n", i + 1, type,
            tag[node[b->position[0]]], tag[node[b->position[1]]]);
  }
}

static void put_balance(const cdem_matrix_writer *matrix, const bond_list *list, FILE *stream) {
  int dofs = matrix->sparse.dofs;
  fputs("\nBalance\n\n", stream);
  for (int32_t p = 0; p < matrix->sparse.nodes; p++) {
    fprintf(stream, "%" PRId64, matrix->model->mesh->node_tag[matrix->sparse.node[p]]);
    for (int c = 0; c < 3; c++)
      cdem_stream_real(stream, " ", c < dofs ? list->balance[(int64_t)p * dofs + c] : 0.0,
                       c == 2 ? "\n" : "");
  }
}

static void put_file(const cdem_matrix_writer *matrix, const cdem_line_pairs *pairs,
                     const bond_list *list, FILE *stream) {
  put_head(matrix, pairs, list, stream);
  fprintf(stream, "\n%" PRId32 " atoms\n1 atom types\n%" PRId64 " bonds\n%" PRId64 " bond types\n",
          matrix->sparse.nodes, list->bonds, list->types);
  put_box(matrix, pairs->longest > 0.0 ? pairs->longest : 1.0, stream);
  put_atoms(matrix, stream);
  if (list->bonds > 0) {
    put_types(list, stream);
    put_bonds(matrix, list, stream);
  }
  if (list->balanced)
    put_balance(matrix, list, stream);
}

static cdem_status put_lammps(cdem_matrix_writer *matrix, cdem_fault *fault) {
  cdem_line_pairs pairs = {0};
  bond_list list = {0};
  cdem_status status = cdem_matrix_check_tags(matrix, "LAMMPS", fault);
  if (status == CDEM_OK)
    status = cdem_line_pairs_init(matrix, false, &pairs, fault);
  if (status == CDEM_OK)
    status = make_bonds(matrix, &pairs, &list, fault);
  if (status == CDEM_OK)
    put_file(matrix, &pairs, &list, cdem_output_stream(matrix->output));
  free(list.bond);
  free(list.balance);
  cdem_line_pairs_release(&pairs);
  return status;
}

static cdem_status open_lammps(const char *path, const cdem_model *model,
                               cdem_springs_writer **writer, cdem_fault *fault) {
  *writer = NULL;
  CDEM_TRY(cdem_matrix_refuse_cosserat(
      path, model,
      "LAMMPS has no bond between displacements and rotations, which a Cosserat network needs",
      fault));
  return cdem_matrix_writer_open(path, model, put_lammps, writer, fault);
}

const cdem_springs_format cdem_springs_lammps = {
    "lammps", ".data .lammps", "LAMMPS data file of harmonic bonds, the assembled network",
    open_lammps, true};
