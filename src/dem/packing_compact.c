/* Compaction: the solver presses grains, chunk of steps by chunk of steps; between chunks pressure
 * is measured and the strain rate chosen anew. Lengths are in mean radii, times in those of the
 * grains' stiffness: nothing here has a length, time or mass of its own, and who gives a fraction
 * alone gets a clock that scales with the grains. */
#include "dem/dem.h"
#include "dem/packing.h"

#include <stdlib.h>
#include <string.h>

enum {
  CHUNK = 25,          /* steps between looks: a tenth of the time in which pressure builds up */
  MOST_CHUNKS = 80000, /* two million steps */
  RESTS = 4,           /* looks in a row at which something must hold */
  FAST = 100           /* times the rate of the inertial number, while there is no pressure */
};
#define UNLOADED 1e-4 /* of the pressure at which overlaps are `soft` radii */
#define QUICK    0.1  /* inertial number that is never passed */
#define ALPHA    0.5  /* local damping */
/* Overlaps in radii that are small, and those of a packing that is jammed: in a box, and in a
 * cylinder, where count and height are given and overlaps are what is left over. */
static const double soft[2] = {1e-3, 2e-2}, jammed[2] = {1e-2, 1e-1};
#define LOOSE 0.3 /* solid fraction at which grains are put into a cylinder */

typedef struct {
  const cdem_packing_options *options;
  const cdem_compaction *compaction;
  int dim;
  double low[3], high[3];
  double solid, radius; /* all grains; mean, m */
  double soft;          /* overlap in radii at the pressure `reference` */
  double thickness;     /* of discs, m; 3-D: 1 */
  double reference;     /* Pa */
  double least_rate;    /* 1/s: by the inertial number */
  double most_rate;     /* 1/s: while there is no pressure */
  double goal;          /* fraction, 0: by pressure */
  int first, ways;      /* axes first .. first + ways - 1 shrink */
  cdem_grain_material material[2];
  cdem_contact_input contact[4];
  cdem_wall wall[6];
  int walls, wall_axis[6]; /* -1: stays */
  double speed[6];         /* of the walls; what their series and those of the cell point to */
  double rate[3], zero;
  cdem_series moves[6][3], still[3];
  cdem_cell cell;
  bool periodic;
  cdem_dem dem;
  cdem_compacted now;
} press;

/* ---- setting up ---- */

static cdem_series varying(double *value, double *time) {
  return (cdem_series){.kind = CDEM_SERIES_TABLE, .points = 1, .time = time, .value = value};
}

static double kept(double value, double otherwise) {
  return value != 0.0 ? value : otherwise;
}

static cdem_status check_target(const cdem_packing_options *o, const cdem_compaction *c,
                                cdem_fault *fault) {
  CDEM_REQUIRE(
      (c->fraction > 0.0) + (c->pressure > 0.0) + (c->height > 0.0) == 1, fault, CDEM_INPUT,
      "compaction needs one target: a solid fraction (%g), a pressure (%g Pa) or the height "
      "of a cylinder (%g m)",
      c->fraction, c->pressure, c->height);
  CDEM_REQUIRE(!o->cylinder || c->pressure == 0.0, fault, CDEM_INPUT,
               "compaction in a cylinder needs its height or a solid fraction, not a pressure");
  CDEM_REQUIRE(o->cylinder || c->height == 0.0, fault, CDEM_INPUT,
               "compaction to a height is for a cylinder; a box takes a solid fraction or a "
               "pressure");
  CDEM_REQUIRE(!o->cylinder || !c->periodic[2], fault, CDEM_INPUT,
               "compaction presses a cylinder by a plate; it cannot be periodic along its axis");
  double height = o->high[2] - o->low[2];
  CDEM_REQUIRE(c->height < height || c->height == 0.0, fault, CDEM_INPUT,
               "compaction: the cylinder is %g m high before it begins, not more than the %g m "
               "wanted",
               height, c->height);
  return CDEM_OK;
}

static cdem_status check(const cdem_packing_options *o, const cdem_compaction *c,
                         const cdem_grains *grains, cdem_fault *fault) {
  CDEM_TRY(cdem_grains_check(grains, fault));
  CDEM_REQUIRE(grains->dim == o->dim, fault, CDEM_INPUT,
               "the grains are of dimension %d, their box of %d", grains->dim, o->dim);
  CDEM_TRY(check_target(o, c, fault));
  const double number[10] = {c->fraction, c->pressure, c->stiffness, c->friction,  c->restitution,
                             c->inertial, c->density,  c->tolerance, c->thickness, c->height};
  const char *const name[10] = {"fraction",    "pressure",        "stiffness", "friction",
                                "restitution", "inertial number", "density",   "tolerance",
                                "thickness",   "height"};
  for (int i = 0; i < 10; i++)
    CDEM_REQUIRE(number[i] >= 0.0 && isfinite(number[i]), fault, CDEM_INPUT,
                 "compaction: the %s is %g; it must not be negative", name[i], number[i]);
  CDEM_REQUIRE(c->restitution <= 1.0, fault, CDEM_INPUT,
               "compaction: the restitution is %g; it is at most 1", c->restitution);
  CDEM_REQUIRE(c->fraction < 1.0, fault, CDEM_INPUT,
               "compaction: the solid fraction is %g; it must lie between 0 and 1", c->fraction);
  double start = cdem_grains_solid(grains) / cdem_packing_room(o);
  CDEM_REQUIRE(c->fraction == 0.0 || start < c->fraction, fault, CDEM_INPUT,
               "compaction: the grains fill %.4f of their box before it begins, more than the %.4f "
               "wanted",
               start, c->fraction);
  double height = o->high[2] - o->low[2];
  double end = c->height > 0.0 ? start * (height / c->height) : 0.0;
  CDEM_REQUIRE(end < 1.0, fault, CDEM_INPUT,
               "compaction: the grains would fill %.4f of the cylinder at a height of %g m; take "
               "fewer, smaller ones or a higher one",
               end, c->height);
  return CDEM_OK;
}

/* A mean contact force F = p d^2 (discs: p d times the thickness) makes an overlap of e r where the
 * stiffness is F/(e r). */
static void choose_scales(press *p, const cdem_grains *grains) {
  const cdem_compaction *c = p->compaction;
  double sum = 0.0, density = kept(c->density, 2600.0);
  for (int64_t i = 0; i < grains->grains; i++)
    sum += grains->radius[i];
  p->radius = sum / (double)grains->grains;
  p->solid = cdem_grains_solid(grains);
  p->thickness = p->dim == 2 ? kept(c->thickness, 1.0) : 1.0;
  double per = (p->dim == 3 ? 4.0 * p->radius : 2.0 * p->thickness) / p->soft;
  double stiffness = c->stiffness;
  /* Without a pressure any stiffness does; the mean mass per second squared ties it to the grains.
   */
  if (stiffness == 0.0)
    stiffness = c->pressure > 0.0 ? per * c->pressure
                                  : density * p->solid * p->thickness / (double)grains->grains;
  p->reference = stiffness / per;
  double pressure = c->pressure > 0.0 ? c->pressure : p->reference;
  double inertial = kept(c->inertial, 1e-3), rate = sqrt(pressure / density) / (2.0 * p->radius);
  p->least_rate = inertial * rate;
  p->most_rate = fmax(inertial, fmin(FAST * inertial, QUICK)) * rate;
  for (int m = 0; m < 2; m++)
    p->material[m] = (cdem_grain_material){.density = density, .young = NAN, .poisson = NAN};
  strcpy(p->material[0].name, "grains");
  strcpy(p->material[1].name, "walls");
  for (int k = 0; k < 4; k++) {
    for (int key = 0; key < CDEM_LAW_KEYS; key++)
      p->contact[k].value[key] = NAN;
    p->contact[k].value[CDEM_LAW_normal_stiffness] = stiffness;
    p->contact[k].value[CDEM_LAW_friction] = k == 0 ? c->friction : 0.0;
    p->contact[k].value[CDEM_LAW_restitution] = kept(c->restitution, 0.5);
  }
}

static void set_walls(press *p) {
  static const char *const name[6] = {"x0", "x1", "y0", "y1", "z0", "z1"};
  for (int c = 0; c < p->dim; c++)
    for (int side = 0; side < 2 && !p->compaction->periodic[c]; side++) {
      if (p->options->cylinder && c < 2)
        continue;
      int w = p->walls++;
      cdem_wall *wall = &p->wall[w];
      *wall = (cdem_wall){.name = name[2 * c + side], .shape = CDEM_WALL_PLANE, .material = 1};
      wall->center[c] = side == 0 ? p->low[c] : p->high[c];
      wall->normal[c] = side == 0 ? 1.0 : -1.0;
      p->wall_axis[w] = side == 0 ? -1 : c;
      if (side == 1)
        p->moves[w][c] = varying(&p->speed[w], &p->zero);
    }
  if (!p->options->cylinder)
    return;
  p->wall_axis[p->walls] = -1;
  p->wall[p->walls++] = (cdem_wall){
      .name = "cylinder",
      .shape = CDEM_WALL_CYLINDER,
      .material = 1,
      .center = {0.5 * (p->low[0] + p->high[0]), 0.5 * (p->low[1] + p->high[1]), p->low[2]},
      .axis = {0.0, 0.0, 1.0},
      .radius = 0.5 * fmin(p->high[0] - p->low[0], p->high[1] - p->low[1])};
}

static void set_cell(press *p) {
  for (int c = 0; c < 3; c++) {
    p->cell.periodic[c] = c < p->dim && p->compaction->periodic[c];
    p->periodic |= p->cell.periodic[c];
    p->cell.corner[c] = p->low[c];
    p->cell.h[4 * c] = p->high[c] - p->low[c];
    if (p->cell.periodic[c])
      p->cell.rate[4 * c] = varying(&p->rate[c], &p->zero);
  }
}

/* ---- where it stands ---- */

static double room(const press *p) {
  cdem_packing_options box = {.dim = p->dim, .cylinder = p->options->cylinder};
  memcpy(box.low, p->low, sizeof box.low);
  memcpy(box.high, p->high, sizeof box.high);
  return cdem_packing_room(&box);
}

static void update_box(press *p) {
  if (p->periodic) {
    const cdem_cell *cell = cdem_dem_cell(&p->dem);
    for (int c = 0; c < p->dim; c++)
      if (cell->periodic[c])
        p->high[c] = p->low[c] + cell->h[4 * c];
  }
  for (int w = 0; w < p->walls; w++) {
    cdem_dem_wall now;
    if (p->wall_axis[w] < 0)
      continue;
    cdem_dem_wall_now(&p->dem, w, &now);
    p->high[p->wall_axis[w]] = now.center[p->wall_axis[w]];
  }
  p->now.fraction = p->solid / room(p);
}

/* Unbalanced force of the grains over the force of the contacts, means of both: in a dense cylinder
 * the largest of many thousand grains, which moves to another cage, says nothing of the rest. */
static cdem_status mean_unbalanced(press *p, double contacts, cdem_fault *fault) {
  double *force, sum = 0.0;
  CDEM_NEW(force, 3 * p->dem.grains, fault);
  cdem_dem_look(&p->dem, &(cdem_dem_view){.force = force});
  for (int64_t i = 0; i < p->dem.grains; i++)
    sum += cdem_norm3(force + 3 * i);
  free(force);
  p->now.unbalanced = contacts > 0.0 ? sum / (double)p->dem.grains / contacts : 0.0;
  return CDEM_OK;
}

/* Pressure by the virial of all contacts, walls among them: sum of -F_A . branch over dim V. */
static cdem_status look(press *p, bool whole, cdem_fault *fault) {
  int64_t contacts;
  cdem_dem_contact *contact;
  double virial = 0.0, force = 0.0;
  update_box(p);
  CDEM_TRY(cdem_dem_contacts(&p->dem, &contacts, &contact, fault));
  const double *radius = cdem_dem_radius(&p->dem);
  p->now.most_overlap = 0.0;
  for (int64_t k = 0; k < contacts; k++) {
    const cdem_dem_contact *at = &contact[k];
    double smaller = at->b < 0 ? radius[at->a] : fmin(radius[at->a], radius[at->b]);
    virial -= cdem_dot3(at->force, at->branch);
    force += cdem_norm3(at->force);
    p->now.most_overlap = fmax(p->now.most_overlap, at->overlap / smaller);
  }
  p->now.pressure = virial / (p->dim * room(p) * p->thickness);
  free(contact);
  p->now.unbalanced = cdem_dem_unbalanced(&p->dem);
  if (p->options->cylinder)
    CDEM_TRY(mean_unbalanced(p, contacts > 0 ? force / (double)contacts : 0.0, fault));
  return whole ? cdem_progress_report(p->compaction->progress, "compacting, steps", p->dem.steps, 0,
                                      fault)
               : CDEM_OK;
}

/* Contacts a grain that has any: grains that rattle in their cage do not carry. */
static cdem_status count_contacts(press *p, cdem_fault *fault) {
  int32_t *count;
  int64_t sum = 0, carrying = 0;
  CDEM_NEW(count, p->dem.grains, fault);
  cdem_dem_look(&p->dem, &(cdem_dem_view){.contacts = count});
  for (int64_t i = 0; i < p->dem.grains; i++) {
    sum += count[i];
    carrying += count[i] > 0;
  }
  free(count);
  p->now.coordination = carrying > 0 ? (double)sum / (double)carrying : 0.0;
  return CDEM_OK;
}

/* ---- pressing ---- */

/* All edges shrink at this rate from now on. */
static void set_rate(press *p, double rate) {
  for (int c = p->first; c < p->first + p->ways; c++)
    p->rate[c] = -rate;
  for (int w = 0; w < p->walls; w++) {
    int c = p->wall_axis[w];
    if (c < 0)
      continue;
    p->speed[w] = -rate * (p->high[c] - p->low[c]);
    cdem_dem_wall_move(&p->dem, w, p->moves[w], p->still);
  }
}

/* Rate that builds up this pressure within one chunk in grains that carry: overlaps of `soft`
 * radii, half as many diameters, belong to the pressure `reference`. */
static double rate_of(const press *p, double pressure) {
  return 0.5 * p->soft * pressure / (p->reference * CHUNK * p->dem.step);
}

/* (1 - part)^8: 1 while a part of the target is small, 0 where it is reached. */
static double falling(double part) {
  double far = fmax(1.0 - part, 0.0);
  for (int i = 0; i < 3; i++)
    far *= far;
  return far;
}

/* Fast while there is no pressure, at the rate of the inertial number later, and never so fast that
 * a chunk makes up for more than half of what is missing. Beyond the target the box opens again. */
static double rate_to_pressure(const press *p) {
  double target = p->compaction->pressure, missing = 1.0 - p->now.pressure / target;
  double clipped = fmin(fmax(missing, -1.0), 1.0), far = falling(1.0 - clipped);
  double most = p->least_rate + (p->most_rate - p->least_rate) * far,
         rate = 0.5 * rate_of(p, target) * clipped;
  return fmin(fmax(rate, -most), most);
}

/* Fast, slower when grains carry, and so that the last chunk ends at the fraction. A plate that
 * comes down pushes a heap of grains before it: there it counts how much they carry. */
static double rate_to_fraction(const press *p) {
  double strain = log(p->goal / p->now.fraction) / p->ways, part = p->now.pressure / p->reference;
  double most = fmin(p->most_rate, 0.5 * rate_of(p, p->reference));
  if (p->options->cylinder)
    most = fmax(p->least_rate, most * falling(part));
  else if (part > 1e-2)
    most = fmin(most, p->least_rate);
  return fmin(most, strain / (CHUNK * p->dem.step));
}

static bool is_there(const press *p) {
  double tolerance = kept(p->compaction->tolerance, 1e-2);
  bool balanced = p->now.unbalanced <= tolerance;
  if (p->goal == 0.0)
    return balanced && fabs(p->now.pressure / p->compaction->pressure - 1.0) <= tolerance;
  bool dense = fabs(p->now.fraction / p->goal - 1.0) <= 1e-9;
  return dense && (balanced || p->now.pressure <= UNLOADED * p->reference);
}

static cdem_status keep_step(press *p, cdem_fault *fault) {
  double limit;
  CDEM_TRY(cdem_dem_limit(&p->dem, &limit, NULL, fault));
  return p->dem.step > 0.8 * limit ? cdem_dem_set_step(&p->dem, 0.6 * limit, fault) : CDEM_OK;
}

static cdem_status run(press *p, cdem_fault *fault) {
  int rests = 0, jams = 0;
  CDEM_TRY(look(p, true, fault));
  for (int chunk = 0; chunk < MOST_CHUNKS; chunk++) {
    set_rate(p, p->goal > 0.0 ? rate_to_fraction(p) : rate_to_pressure(p));
    CDEM_TRY(cdem_dem_steps(&p->dem, CHUNK, fault));
    CDEM_TRY(look(p, chunk % 8 == 0, fault));
    jams = p->goal > 0.0 && p->now.pressure * p->soft > jammed[p->options->cylinder] * p->reference
               ? jams + 1
               : 0;
    CDEM_REQUIRE(
        jams < RESTS, fault, CDEM_NUMERIC,
        "the grains jam at a solid fraction of %.4f, before %.4f is reached; take less, or "
        "less friction",
        p->now.fraction, p->goal);
    rests = is_there(p) ? rests + 1 : 0;
    if (rests == RESTS)
      return CDEM_OK;
    if (chunk % 8 == 0)
      CDEM_TRY(keep_step(p, fault));
  }
  return cdem_fail(fault, CDEM_NUMERIC,
                   "the grains do not come to rest: after %lld steps the solid fraction is %.4f, "
                   "the pressure %g Pa, the unbalanced force %.2g of the mean; take a larger "
                   "tolerance",
                   (long long)p->dem.steps, p->now.fraction, p->now.pressure, p->now.unbalanced);
}

/* Grains begin with the motion of the box that shrinks, so that it shrinks everywhere at once. */
static cdem_status begin(press *p, const cdem_grains *grains, cdem_fault *fault) {
  cdem_grains moving;
  CDEM_TRY(cdem_grains_copy(grains, &moving, fault));
  free(moving.material);
  free(moving.motion);
  moving.material = NULL;
  moving.motion = NULL;
  double rate = p->options->cylinder ? 0.0 : p->most_rate;
  cdem_status status = cdem_grains_complete(&moving, fault);
  if (status == CDEM_OK) {
    for (int64_t i = 0; i < moving.grains; i++)
      for (int c = 0; c < 3; c++) {
        double from = moving.xyz[3 * i + c] - p->low[c];
        bool shrinks = c >= p->first && c < p->first + p->ways;
        moving.velocity[3 * i + c] = shrinks ? -rate * from : 0.0;
        moving.spin[3 * i + c] = 0.0;
      }
    const cdem_dem_options options = {
        .grains = &moving,
        .materials = 2,
        .material = p->material,
        .law = cdem_law_find("linear"),
        .contact = p->contact,
        .walls = p->walls,
        .wall = p->wall,
        .cell = p->periodic ? &p->cell : NULL,
        .thickness = p->thickness,
        .local_damping = ALPHA,
        .safety = 0.6,
        .threads = p->compaction->threads,
    };
    status = cdem_dem_init(&options, &p->dem, fault);
  }
  cdem_grains_release(&moving);
  return status;
}

static void finish(press *p, cdem_grains *grains) {
  cdem_dem_look(&p->dem, &(cdem_dem_view){.xyz = grains->xyz});
  for (int64_t i = 0; i < 3 * grains->grains; i++) {
    if (grains->velocity != NULL)
      grains->velocity[i] = 0.0;
    if (grains->spin != NULL)
      grains->spin[i] = 0.0;
  }
  memcpy(p->now.low, p->low, sizeof p->low);
  memcpy(p->now.high, p->high, sizeof p->high);
  if (p->compaction->height > 0.0) /* to rounding it is there */
    p->now.high[2] = p->low[2] + p->compaction->height;
  p->now.steps = p->dem.steps;
}

void cdem_packing_make_room(cdem_packing_options *options, const cdem_compaction *compaction) {
  if (!options->cylinder || options->count == 0 || !(compaction->height > 0.0))
    return;
  cdem_packing_options unit = *options;
  unit.high[2] = unit.low[2] + compaction->height;
  double solid = (double)options->count * cdem_sizes_mean_solid(options->dim, &options->sizes);
  double height = solid / (LOOSE * cdem_packing_room(&unit)) * compaction->height;
  options->high[2] = options->low[2] + fmax(height, options->high[2] - options->low[2]);
}

cdem_status cdem_packing_compact(const cdem_packing_options *options,
                                 const cdem_compaction *compaction, cdem_grains *grains,
                                 cdem_compacted *compacted, cdem_fault *fault) {
  press p = {.options = options, .compaction = compaction, .dim = options->dim};
  *compacted = (cdem_compacted){0};
  CDEM_TRY(check(options, compaction, grains, fault));
  memcpy(p.low, options->low, (size_t)p.dim * sizeof *p.low);
  memcpy(p.high, options->high, (size_t)p.dim * sizeof *p.high);
  p.first = options->cylinder ? 2 : 0;
  p.ways = options->cylinder ? 1 : p.dim;
  p.soft = soft[options->cylinder];
  choose_scales(&p, grains);
  p.goal = compaction->fraction;
  if (compaction->height > 0.0)
    p.goal = p.solid / room(&p) * ((p.high[2] - p.low[2]) / compaction->height);
  set_walls(&p);
  set_cell(&p);
  cdem_status status = begin(&p, grains, fault);
  if (status == CDEM_OK)
    status = run(&p, fault);
  if (status == CDEM_OK)
    status = count_contacts(&p, fault);
  if (status == CDEM_OK) {
    finish(&p, grains);
    *compacted = p.now;
  }
  cdem_dem_release(&p.dem);
  return status;
}
