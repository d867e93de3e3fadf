/* From the options to everything that never changes: checks, masses, blocks. */
#include "base/quaternion.h"
#include "fdem/solver_store.h"

#include <stdlib.h>
#include <string.h>

static const double unit_ball = 4.18879020478639098;

/* ---- checks ---- */

static cdem_status check_motion(const cdem_fdem_grains *grains, int64_t g, cdem_fault *fault) {
  double speed = grains->velocity != NULL ? cdem_norm3(grains->velocity + 3 * g) : 0.0;
  double spin = grains->spin != NULL ? cdem_norm3(grains->spin + 3 * g) : 0.0, turn = 1.0;
  if (grains->orientation != NULL) {
    const double *q = grains->orientation + 4 * g;
    turn = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  }
  CDEM_REQUIRE(!isnan(speed) && !isnan(spin), fault, CDEM_INPUT,
               "grain %lld starts with a velocity or a spin that is no number", (long long)g);
  CDEM_REQUIRE(turn > 0.0 && isfinite(turn), fault, CDEM_INPUT,
               "grain %lld has a quaternion of square %g; it must be of unit length", (long long)g,
               turn);
  return CDEM_OK;
}

static cdem_status check_grain(const cdem_fdem_options *o, int64_t g, cdem_fault *fault) {
  const cdem_fdem_grains *grains = &o->grains;
  int32_t shape = grains->shape != NULL ? grains->shape[g] : 0;
  int32_t material = grains->material != NULL ? grains->material[g] : 0;
  double radius = grains->radius[g];
  CDEM_REQUIRE(radius > 0.0 && isfinite(radius), fault, CDEM_INPUT,
               "grain %lld has the radius %g m; it must be positive", (long long)g, radius);
  CDEM_REQUIRE(isfinite(cdem_norm3(grains->xyz + 3 * g)), fault, CDEM_INPUT,
               "grain %lld stands at a place that is not finite", (long long)g);
  CDEM_REQUIRE(shape >= 0 && shape < o->shapes, fault, CDEM_INPUT,
               "grain %lld has the shape %d of %d", (long long)g, shape, o->shapes);
  CDEM_REQUIRE(material >= 0 && material < o->materials && o->density[material] > 0.0, fault,
               CDEM_INPUT, "grain %lld is of a material without density", (long long)g);
  return check_motion(grains, g, fault);
}

static cdem_status check_law(const cdem_fdem_contact_law *law, cdem_fault *fault) {
  CDEM_REQUIRE(law->penalty > 0.0 && isfinite(law->penalty), fault, CDEM_INPUT,
               "the penalty stiffness of a contact is %g N/m^3; it must be positive", law->penalty);
  CDEM_REQUIRE(law->shear_ratio >= 0.0 && law->friction >= 0.0 && law->damping_ratio >= 0.0, fault,
               CDEM_INPUT,
               "a contact has the shear ratio %g, friction %g and damping ratio %g; none may be "
               "negative",
               law->shear_ratio, law->friction, law->damping_ratio);
  return CDEM_OK;
}

cdem_status cdem_fdem_check(const cdem_fdem_options *o, cdem_fault *fault) {
  CDEM_REQUIRE(o->grains.grains > 0 && o->grains.grains < INT32_MAX, fault, CDEM_INPUT,
               "%lld deformable grains; at least one is needed", (long long)o->grains.grains);
  for (int64_t g = 0; g < o->grains.grains; g++)
    CDEM_TRY(check_grain(o, g, fault));
  for (int i = 0; i < o->materials * o->materials; i++)
    CDEM_TRY(check_law(o->law + i, fault));
  for (int w = 0; w < o->walls; w++) {
    CDEM_TRY(cdem_wall_check(3, o->wall + w, fault));
    CDEM_REQUIRE(o->wall[w].shape != CDEM_WALL_MESH, fault, CDEM_INPUT,
                 "wall '%s' is a mesh; deformable grains know planes, plates and cylinders",
                 o->wall[w].name);
    CDEM_REQUIRE(o->wall[w].material < o->materials, fault, CDEM_INPUT,
                 "wall '%s' is of material %d of %d", cdem_wall_name(o->wall + w),
                 o->wall[w].material, o->materials);
  }
  CDEM_REQUIRE(o->mass_damping >= 0.0 && o->damping_ratio >= 0.0, fault, CDEM_INPUT,
               "mass damping %g 1/s and damping ratio %g of grains must not be negative",
               o->mass_damping, o->damping_ratio);
  CDEM_REQUIRE(o->step >= 0.0 && isfinite(o->step), fault, CDEM_INPUT,
               "the step is %g s; it must be positive (0: automatic)", o->step);
  CDEM_REQUIRE(o->safety >= 0.0 && o->safety <= 1.0, fault, CDEM_INPUT,
               "the safety of the step is %g; it must be above 0 and at most 1", o->safety);
  return CDEM_OK;
}

/* ---- memory ---- */

/* Members first .. end of one template, in blocks. */
static void cut(cdem_fdem_store *s, int shape, int64_t first, int64_t end) {
  int64_t size = (end - first + CDEM_FDEM_BLOCKS - 1) / CDEM_FDEM_BLOCKS;
  size = size < CDEM_FDEM_BLOCK_LEAST ? CDEM_FDEM_BLOCK_LEAST : size;
  size = size > CDEM_FDEM_BLOCK_MOST ? CDEM_FDEM_BLOCK_MOST : size;
  for (int64_t m = first; m < end; m += size)
    s->block[s->blocks++] = (cdem_fdem_block){
        .shape = shape, .first = (int32_t)m, .count = (int32_t)(end - m < size ? end - m : size)};
}

/* Members by template, and where their nodes and amplitudes begin. */
static cdem_status order(cdem_fdem_store *s, cdem_fault *fault) {
  int64_t members = 0, most_blocks = s->grains / CDEM_FDEM_BLOCK_LEAST + s->options.shapes;
  CDEM_NEW(s->first, s->grains + 1, fault);
  CDEM_NEW(s->mode, s->grains, fault);
  CDEM_NEW(s->member, s->grains, fault);
  CDEM_NEW(s->block, most_blocks, fault);
  for (int64_t g = 0; g < s->grains; g++)
    s->first[g + 1] = s->first[g] + s->options.shape[s->shape[g]].surface.nodes;
  s->nodes = s->first[s->grains];
  for (int t = 0; t < s->options.shapes; t++) {
    int64_t begin = members;
    for (int64_t g = 0; g < s->grains; g++)
      if (s->shape[g] == t) {
        s->member[members++] = (int32_t)g;
        s->mode[g] = s->amplitudes;
        s->amplitudes += s->options.shape[t].modes;
      }
    cut(s, t, begin, members);
  }
  return CDEM_OK;
}

static cdem_status allocate(cdem_fdem_store *s, cdem_fault *fault) {
  CDEM_NEW(s->surface, s->grains, fault);
  CDEM_NEW(s->radius, s->grains, fault);
  CDEM_NEW(s->mass, s->grains, fault);
  CDEM_NEW(s->inertia, 9 * s->grains, fault);
  CDEM_NEW(s->spins, 9 * s->grains, fault);
  CDEM_NEW(s->area, s->nodes, fault);
  CDEM_NEW(s->node_mass, s->nodes, fault);
  CDEM_NEW(s->start, 3 * s->grains, fault);
  CDEM_NEW(s->center, 3 * s->grains, fault);
  CDEM_NEW(s->quaternion, 4 * s->grains, fault);
  CDEM_NEW(s->turn, 9 * s->grains, fault);
  CDEM_NEW(s->q, s->amplitudes, fault);
  CDEM_NEW(s->rate, s->amplitudes, fault);
  CDEM_NEW(s->place, 3 * s->nodes, fault);
  CDEM_NEW(s->now, 3 * s->nodes, fault);
  CDEM_NEW(s->before, 3 * s->nodes, fault);
  CDEM_NEW(s->force, 3 * s->nodes, fault);
  CDEM_NEW(s->stiff, s->grains, fault);
  CDEM_NEW(s->velocity, 3 * s->grains, fault);
  CDEM_NEW(s->momentum, 3 * s->grains, fault);
  CDEM_NEW(s->part, s->blocks, fault);
  CDEM_NEW(s->wall, s->options.walls, fault);
  CDEM_NEW(s->wall_force, 3 * (int64_t)s->options.walls, fault);
  CDEM_NEW(s->wall_stiff, s->options.walls, fault);
  return CDEM_OK;
}

static cdem_status scratch(cdem_fdem_store *s, cdem_fault *fault) {
  int64_t rows = 0, modes = 0;
  for (int t = 0; t < s->options.shapes; t++) {
    const cdem_template *shape = s->options.shape + t;
    rows = 3 * shape->surface.nodes > rows ? 3 * (int64_t)shape->surface.nodes : rows;
    modes = shape->modes > modes ? shape->modes : modes;
  }
  CDEM_NEW(s->work, s->threads, fault);
  for (int t = 0; t < s->threads; t++) {
    CDEM_NEW(s->work[t].skin, CDEM_FDEM_BLOCK_MOST * rows, fault);
    CDEM_NEW(s->work[t].load, CDEM_FDEM_BLOCK_MOST * modes, fault);
  }
  return CDEM_OK;
}

/* ---- what never changes ---- */

static void fill_grain(cdem_fdem_store *s, int64_t g) {
  const cdem_template *t = cdem_fdem_template(s, g);
  double r = s->radius[g] = s->options.grains.radius[g];
  double density = s->options.density[s->material[g]], volume = r * r * r;
  s->surface[g] = &t->surface;
  s->mass[g] = density * unit_ball * volume;
  for (int k = 0; k < 9; k++)
    s->inertia[9 * g + k] = density * volume * r * r * t->inertia[k];
  cdem_inverse3(s->inertia + 9 * g, s->spins + 9 * g);
  for (int64_t i = s->first[g]; i < s->first[g + 1]; i++) {
    s->area[i] = r * r * t->surface.area[i - s->first[g]];
    s->node_mass[i] = density * volume * t->mass[i - s->first[g]];
  }
}

/* Orientation, and the velocities, as they are given. */
static void start_grain(cdem_fdem_store *s, int64_t g) {
  const cdem_fdem_grains *grains = &s->options.grains;
  double *q = s->quaternion + 4 * g, norm = 0.0, spin[3] = {0.0, 0.0, 0.0}, body[3], turned[3];
  q[0] = 1.0;
  if (grains->orientation != NULL)
    memcpy(q, grains->orientation + 4 * g, 4 * sizeof *q);
  for (int k = 0; k < 4; k++)
    norm += q[k] * q[k];
  for (int k = 0; k < 4; k++)
    q[k] /= sqrt(norm);
  double *turn = s->turn + 9 * g;
  cdem_quaternion_matrix(q, turn);
  for (int c = 0; c < 3; c++) {
    s->start[3 * g + c] = s->center[3 * g + c] = grains->xyz[3 * g + c];
    s->velocity[3 * g + c] = grains->velocity != NULL ? grains->velocity[3 * g + c] : 0.0;
    spin[c] = grains->spin != NULL ? grains->spin[3 * g + c] : 0.0;
  }
  for (int i = 0; i < 3; i++)
    body[i] = turn[i] * spin[0] + turn[3 + i] * spin[1] + turn[6 + i] * spin[2];
  for (int i = 0; i < 3; i++)
    turned[i] = cdem_dot3(s->inertia + 9 * g + 3 * i, body);
  for (int i = 0; i < 3; i++)
    s->momentum[3 * g + i] = cdem_dot3(turn + 3 * i, turned);
}

cdem_status cdem_fdem_setup(cdem_fdem_store *s, cdem_fault *fault) {
  const cdem_fdem_grains *grains = &s->options.grains;
  CDEM_NEW(s->shape, s->grains, fault);
  CDEM_NEW(s->material, s->grains, fault);
  for (int64_t g = 0; g < s->grains; g++) {
    s->shape[g] = grains->shape != NULL ? grains->shape[g] : 0;
    s->material[g] = grains->material != NULL ? grains->material[g] : 0;
  }
  CDEM_TRY(order(s, fault));
  CDEM_TRY(allocate(s, fault));
  CDEM_TRY(scratch(s, fault));
  for (int64_t g = 0; g < s->grains; g++) {
    fill_grain(s, g);
    start_grain(s, g);
  }
  for (int w = 0; w < s->options.walls; w++)
    CDEM_TRY(cdem_wall_body_init(s->wall + w, 3, s->options.wall + w, NULL, fault));
  return CDEM_OK;
}
