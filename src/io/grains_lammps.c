/* Grains as a LAMMPS data file of atom style sphere, with the lines of input to run them.
 *
 * Laws, all of pair_style granular with limit_damping (no pull), which has the velocity of the half
 * step before as ours has:
 *  - linear: hooke and linear_history. A dashpot c is `damping velocity`; one of z sqrt(m k) is
 *    `damping tsuji`, whose number is a restitution e that LAMMPS turns into z by a polynomial of
 *    Tsuji, Tanaka & Ishida (1992): the root of it for our z is written, which may lie beyond 0
 * to 1.
 *  - hertz: hertz with k = 4/3 E*, mindlin_rescale/force or mindlin/force with 8 G*. LAMMPS' Tsuji
 *    dashpot has sqrt(m 4/3 E* a), ours sqrt(m 2 E* a): z grows by sqrt(3/2).
 *  The shear dashpot is a multiple of the normal one there.
 *
 * Materials are atom types, counted from 1; driven grains have types of their own behind them. The
 * density of a disc is that of a sphere of its mass, because LAMMPS reads spheres. */
#include "io/grains_scene.h"
#include "io/output.h"
#include "io/text.h"

#include <inttypes.h>
#include <math.h>

/* z of LAMMPS' dashpot of Tsuji, from its number e. */
static double tsuji(double e) {
  static const double c[] = {4.8218, -18.022, 27.467, -22.348, 11.087, -4.2783, 1.2728};
  double z = 0.0;
  for (int i = 0; i < 7; i++)
    z = z * e + c[i];
  return z;
}

/* The e of a z >= 0: tsuji falls from e = -30 (z above 1e9) to its zero just above e = 1. */
static double tsuji_root(double z) {
  double low = -30.0, high = 1.001;
  for (int i = 0; i < 200; i++) {
    double middle = 0.5 * (low + high);
    if (tsuji(middle) > z)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

/* Can the shear dashpot be a multiple of the normal one for grains of every mass? */
static bool has_dashpots(const cdem_scene_contact *c) {
  return !(c->constant[1] > 0.0 && !(c->constant[0] > 0.0)) &&
         !(c->critical[1] > 0.0 && !(c->critical[0] > 0.0)) &&
         !(c->constant[0] > 0.0 && c->critical[0] > 0.0);
}

static const char *lacks(const cdem_scene *scene) {
  if (!cdem_scene_has_law(scene, "linear") && !cdem_scene_has_law(scene, "hertz"))
    return "the law of contact (linear and hertz are written)";
  for (int a = 0; a < scene->materials; a++)
    for (int b = a; b < scene->materials; b++) {
      cdem_scene_contact c;
      cdem_scene_contact_of(scene, a, b, &c);
      if (!has_dashpots(&c))
        return "shear dashpots that are no multiple of the normal ones";
    }
  return NULL;
}

static void put_pair(const cdem_scene *scene, const int type[2], const cdem_scene_contact *c,
                     FILE *stream) {
  bool hertz = cdem_scene_has_law(scene, "hertz"), constant = c->constant[0] > 0.0;
  double z = hertz ? sqrt(1.5) * c->critical[0] : c->critical[0];
  double ratio = 0.0;
  if (has_dashpots(c) && (constant || z > 0.0))
    ratio = constant ? c->constant[1] / c->constant[0] : c->critical[1] / c->critical[0];
  fprintf(stream, "#> pair_coeff    %d %d %s", type[0], type[1], hertz ? "hertz" : "hooke");
  cdem_stream_real(stream, " ", hertz ? 2.0 / 3.0 * c->normal : c->normal, " ");
  cdem_stream_real(stream, "", z > 0.0 ? tsuji_root(z) : c->constant[0], "");
  fprintf(stream, " damping %s tangential %s", z > 0.0 ? "tsuji" : "velocity",
          !hertz        ? "linear_history"
          : c->rescaled ? "mindlin_rescale/force"
                        : "mindlin/force");
  cdem_stream_real(stream, " ", c->shear, " ");
  cdem_stream_real(stream, "", ratio, " ");
  cdem_stream_real(stream, "", c->friction, " limit_damping\n");
}

static void put_pairs(const cdem_scene *scene, int types, FILE *stream) {
  fputs("#> pair_style    granular\n", stream);
  for (int i = 0; i < types; i++)
    for (int j = i; j < types; j++) {
      cdem_scene_contact c;
      const int type[2] = {i + 1, j + 1};
      cdem_scene_contact_of(scene, i % scene->materials, j % scene->materials, &c);
      put_pair(scene, type, &c, stream);
    }
}

static int types_of(const cdem_scene *scene) {
  for (int64_t i = 0; i < scene->grains.grains; i++)
    if (cdem_scene_is_driven(scene, i))
      return 2 * scene->materials;
  return scene->materials;
}

static void put_gravity(const double g[3], FILE *stream) {
  double size = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  if (!(size > 0.0))
    return;
  cdem_stream_real(stream, "#> fix           pull free gravity ", size, " vector");
  for (int c = 0; c < 3; c++)
    cdem_stream_real(stream, " ", g[c] / size, c == 2 ? "\n" : "");
}

/* How they push and move. */
static void put_model(const cdem_scene *scene, int types, FILE *stream) {
  int dim = scene->grains.dim;
  if (scene->dem == NULL) {
    fputs("# Put here pair_style and pair_coeff, timestep, and what else moves the grains.\n",
          stream);
    return;
  }
  if (cdem_scene_has_law(scene, "linear") || cdem_scene_has_law(scene, "hertz"))
    put_pairs(scene, types, stream);
  else
    fputs("# Put pair_style and pair_coeff here.\n", stream);
  cdem_stream_real(stream, "#> timestep      ", scene->dem->step, "\n");
  fprintf(stream, "#> group         free type <= %d\n", scene->materials);
  put_gravity(cdem_dem_options_of(scene->dem)->gravity, stream);
  fprintf(stream, "#> fix           move free nve/sphere%s\n", dim == 2 ? " disc" : "");
  if (types > scene->materials)
    fprintf(stream,
            "#> group         driven type > %d\n#> fix           drive driven nve/noforce\n",
            scene->materials);
  if (dim == 2)
    fputs("#> fix           plane all enforce2d\n", stream);
}

static const cdem_cell *cell_of(const cdem_scene *scene) {
  return scene->dem != NULL ? cdem_dem_cell(scene->dem) : NULL;
}

static bool is_periodic(const cdem_scene *scene, int c) {
  const cdem_cell *cell = cell_of(scene);
  return c >= scene->grains.dim || (cell != NULL && cell->periodic[c]);
}

static void put_head(const cdem_scene *scene, const char *lost, int types, FILE *stream) {
  double largest = 0.0;
  cdem_scene_put_head(scene, "LAMMPS", lost, stream);
  for (int64_t i = 0; i < scene->grains.grains; i++)
    largest = fmax(largest, scene->grains.radius[i]);
  fputs("# Atom types:", stream);
  for (int m = 0; m < scene->materials; m++) {
    fprintf(stream, "%s %d ", m > 0 ? "," : "", m + 1);
    cdem_scene_put_name(stream, scene->material[m].name, '\0');
  }
  fprintf(stream, "%s\n",
          types > scene->materials ? "; driven grains of each have types behind these" : "");
  if (scene->grains.dim == 2)
    fputs("# Densities are those of spheres with the masses of the discs.\n", stream);
  fprintf(stream,
          "# Input: sed -n 's/^#> //p' THIS_FILE > grains.in; lmp -in grains.in -var data "
          "THIS_FILE\n"
          "#> units         si\n#> dimension     %d\n#> atom_style    sphere\n"
          "#> boundary      %s %s %s\n#> newton        off\n#> comm_modify   vel yes\n"
          "#> read_data     ${data}\n",
          scene->grains.dim, is_periodic(scene, 0) ? "p" : "m", is_periodic(scene, 1) ? "p" : "m",
          is_periodic(scene, 2) ? "p" : "m");
  cdem_stream_real(stream, "#> neighbor      ", 0.2 * largest, " bin\n");
  fputs("#> neigh_modify  delay 0 every 1 check yes\n", stream);
  put_model(scene, types, stream);
}

static void put_box(const cdem_scene *scene, FILE *stream) {
  const cdem_cell *cell = cell_of(scene);
  double low[3], high[3], size = 0.0;
  cdem_grains_box(&scene->grains, low, high);
  for (int c = 0; c < scene->grains.dim; c++)
    size = fmax(size, high[c] - low[c]);
  for (int c = 0; c < 3; c++) {
    double from = low[c] - 0.01 * size, to = high[c] + 0.01 * size;
    if (c >= scene->grains.dim) {
      from = -0.5 * size;
      to = 0.5 * size;
    } else if (is_periodic(scene, c)) {
      from = cell->corner[c];
      to = cell->corner[c] + cell->h[4 * c];
    }
    cdem_stream_real(stream, "", from, " ");
    cdem_stream_real(stream, "", to, "");
    fprintf(stream, " %clo %chi\n", 'x' + c, 'x' + c);
  }
}

static void put_grains(const cdem_scene *scene, FILE *stream) {
  const cdem_grains *g = &scene->grains;
  fputs("\nAtoms # sphere\n\n", stream);
  for (int64_t i = 0; i < g->grains; i++) {
    int driven = cdem_scene_is_driven(scene, i) ? scene->materials : 0;
    fprintf(stream, "%" PRId64 " %d", i + 1, g->material[i] + driven + 1);
    cdem_stream_real(stream, " ", 2.0 * g->radius[i], "");
    cdem_stream_real(stream, " ", cdem_scene_mass(scene, i) / cdem_grain_solid(3, g->radius[i]),
                     "");
    for (int c = 0; c < 3; c++)
      cdem_stream_real(stream, " ", g->xyz[3 * i + c], c == 2 ? "\n" : "");
  }
  fputs("\nVelocities\n\n", stream);
  for (int64_t i = 0; i < g->grains; i++) {
    fprintf(stream, "%" PRId64, i + 1);
    for (int c = 0; c < 6; c++)
      cdem_stream_real(stream, " ", c < 3 ? g->velocity[3 * i + c] : g->spin[3 * i + c - 3],
                       c == 5 ? "\n" : "");
  }
}

/* A box of LAMMPS here has edges along the axes. */
static cdem_status check_cell(const char *path, const cdem_scene *scene, cdem_fault *fault) {
  const cdem_cell *cell = cell_of(scene);
  for (int e = 0; cell != NULL && e < 9; e++)
    CDEM_REQUIRE(e % 4 == 0 || cell->h[e] == 0.0 || !cell->periodic[e % 3], fault, CDEM_INPUT,
                 "cannot write '%s': the periodic cell leans (its edge %d has a component %c of "
                 "%.6g m); export a state before it sheared",
                 path, e % 3 + 1, 'x' + e / 3, cell->h[e]);
  return CDEM_OK;
}

static cdem_status write_lammps(const char *path, const cdem_scene *scene, const char *lost,
                                cdem_fault *fault) {
  cdem_output *output;
  CDEM_TRY(check_cell(path, scene, fault));
  CDEM_TRY(cdem_output_open(path, &output, fault));
  FILE *stream = cdem_output_stream(output);
  int types = types_of(scene);
  put_head(scene, lost, types, stream);
  fprintf(stream, "\n%" PRId64 " atoms\n%d atom types\n", scene->grains.grains, types);
  put_box(scene, stream);
  put_grains(scene, stream);
  return cdem_output_commit(&output, fault);
}

const cdem_grain_format cdem_grain_format_lammps = {
    "lammps", ".data .lammps", "LAMMPS data file of spheres or discs, with its input",
    true,     write_lammps,    lacks};
