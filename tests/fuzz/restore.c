/* Runs that go on from a state that was changed: the first byte chooses a small case, the others
 * are changes of the state it had after a few steps, 12 bytes each:
 *
 *     array, what is done to it, element (2 bytes), number (8 bytes)
 *
 * The state is refused, or the run goes on: steps, a row, a frame and a state, or a numerical
 * failure with its message.
 */
#include "fuzz/fuzz.h"
#include "io/run_files.h"
#include "run/history.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHANGE = 12, MOST_CHANGES = 8, BEFORE = 30, STEPS = 3 };

#define DISCS                                                                                      \
  "  materials: {sand: {density: 2000 kg/m3}}\n"                                                   \
  "  packing: {kind: cubic, low: [0, 0], high: [60 mm, 40 mm], radius: 10 mm}\n"                   \
  "contacts: [{normal_stiffness: 1e6 N/m, shear_ratio: 0.5, friction: 0.4, restitution: 0.5}]\n"

static const char *const texts[] = {
    /* Bricks that part and hit each other and a plate. */
    "end: 2 ms\ngravity: [0, -10]\n"
    "mesh: {shape: quad4, count: [2, 2], size: [1 m, 1 m]}\n"
    "materials: {rock: {young: 10 GPa, poisson: 0.2, density: 2700 kg/m3}}\n"
    "blocks: {breakable: body}\n"
    "interfaces: [{stiffness_factor: 4, tension: 1 Pa, cohesion: 1 Pa, friction: 0.1}]\n"
    "contact: {friction: 0.5, damping: 0.1}\n"
    "supports: [{group: y0, displacement: {x: 0, y: 0}}, {group: y1, velocity: {x: 1 m/s, y: -0.1 "
    "m/s}}]\n"
    "plates: {press: {point: [0.5, 1], normal: [0, -1], velocity: {y: -0.2 m/s}, friction: 0.2}}\n"
    "probes: {tip: {group: x1, quantity: displacement, component: x}}\n",
    /* Bonded discs in a box. */
    "end: 0.1 s\ngravity: [0, -10]\n"
    "grains:\n"
    "  dimension: 2\n" DISCS "walls:\n"
    "  floor: {shape: plane, center: [0, 0], normal: [0, 1]}\n"
    "  lid: {shape: plate, center: [30 mm, 40 mm], normal: [0, -1], half_size: [30 mm], velocity: "
    "{y: -0.1 m/s}}\n"
    "bonds: [{gap: 0.01, normal_stiffness: 1e6 N/m, shear_stiffness: 5e5 N/m, tension: 10 N, "
    "cohesion: 10 N}]\n"
    "probes: {falling: {quantity: velocity, component: y}}\n",
    /* Discs in a periodic cell that is pressed together. */
    "end: 0.1 s\n"
    "grains:\n"
    "  dimension: 2\n" DISCS
    "cell: {rate: {yy: -1 1/s}, stress: {xx: 1 kPa}, servo_rate: 10 1/s}\n",
    /* Balls in a membrane. */
    "safety: 0.5\n"
    "grains:\n"
    "  dimension: 3\n"
    "  law: penalty\n"
    "  packing: {kind: loose, cylinder: yes, low: [-0.1, -0.1, 0], high: [0.1, 0.1, 0.2], radius: "
    "40 mm, count: 8, seed: 3}\n"
    "  materials: {rock: {density: 2650}}\n"
    "  most_overlap: 0.4\n"
    "contacts: [{penalty_stiffness: 1e10, friction: 0.3, damping_ratio: 0.2}]\n"
    "triaxial: {pressure: 0.9 MPa, strain: 0.15}\n",
    /* Balls that deform. */
    "end: 0.4 ms\n"
    "grains:\n"
    "  dimension: 3\n"
    "  law: penalty\n"
    "  deformable: {shape: cubesphere, refinement: 1}\n"
    "  packing: {kind: loose, low: [0, 0, 0], high: [0.1, 0.1, 0.1], radius: 20 mm, count: 2}\n"
    "  materials: {rock: {density: 2650 kg/m3, young: 40 GPa, poisson: 0.2}}\n"
    "contacts: [{penalty_stiffness: 1e11 N/m3, friction: 0.3, damping_ratio: 0.2}]\n"
    "walls: {lid: {shape: plane, normal: [0, 0, -1], center: [0, 0, 0.1], velocity: {z: -50 "
    "m/s}}}\n",
    /* Discs in a medium. */
    "end: 6 ms\nstep: 50 us\n"
    "mesh: {shape: quad4, count: [3, 2], size: [3 m, 2 m], origin: [-1.5 m, -2 m]}\n"
    "materials: {soil: {model: cosserat-lattice, normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 "
    "N/m, rolling_stiffness: 3000 N m, radius: 0.15 m, density: 2042 kg/m3}}\n"
    "supports: [{group: y0, displacement: {x: 0, y: 0, rotation: 0}}]\n"
    "grains:\n"
    "  dimension: 2\n"
    "  packing: {kind: square, low: [-1.5, -2], high: [1.5, 0], radius: 0.15 m, centres_inside: "
    "yes}\n"
    "  materials: {disc: {density: 2600 kg/m3}}\n"
    "contacts: [{normal_stiffness: 2.5e8 N/m, shear_stiffness: 5e7 N/m, friction: 0.5, "
    "normal_dashpot: 0}]\n"
    "walls: {press: {shape: plate, center: [0, 0], normal: [0, -1], half_size: [0.5 m], velocity: "
    "{y: -1 m/s}}}\n"
    "coupling: {regions: [{low: [-0.5, -1], high: [0.5, 0.1]}], rotation: scaled, cycles: 5}\n",
};
enum { CASES = sizeof texts / sizeof texts[0] };

static cdem_run_options options_of(int index) {
  return (cdem_run_options){.path = fuzz_file(texts[index], strlen(texts[index])),
                            .folder = "/proc/self",
                            .threads = 1,
                            .version = "fuzz",
                            .commit = "fuzz"};
}

/* ---- states ---- */

static void copy_state(const cdem_state *from, cdem_state *to) {
  cdem_fault fault = {0};
  for (int64_t i = 0; i < from->arrays; i++)
    fuzz_require(cdem_state_add_copy(to, from->array[i].name, from->array[i].type,
                                     from->array[i].count, from->array[i].data, &fault) == CDEM_OK,
                 "%s", fault.message);
}

static cdem_status save(const cdem_run_setup *setup, cdem_state *copy, cdem_fault *fault) {
  cdem_state borrowed = {0};
  cdem_status status = setup->engine->save(setup, &borrowed, fault);
  if (status == CDEM_OK)
    copy_state(&borrowed, copy);
  cdem_state_release(&borrowed);
  return status;
}

/* What the unchanged case holds after a few steps, made once. */
static const cdem_state *state_of(int index) {
  static cdem_state made[CASES];
  if (made[index].arrays > 0)
    return &made[index];
  cdem_fault fault = {0};
  cdem_run_setup setup = {0};
  const cdem_run_options options = options_of(index);
  fuzz_require(cdem_run_setup_init(&options, NULL, &setup, &fault) == CDEM_OK, "case %d: %s", index,
               fault.message);
  fuzz_require(setup.engine->advance(&setup, BEFORE, &fault) == CDEM_OK, "case %d: %s", index,
               fault.message);
  fuzz_require(save(&setup, &made[index], &fault) == CDEM_OK, "case %d: %s", index, fault.message);
  cdem_run_setup_release(&setup);
  return &made[index];
}

/* ---- changes ---- */

typedef enum { SET, SET_SPECIAL, COPY, RESIZE, REMOVE, RETYPE, CHANGES } change_kind;

static void set_real(cdem_array *array, int64_t at, const uint8_t number[8], bool special) {
  static const double specials[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e-300, -0.0, 1e10};
  double value;
  memcpy(&value, number, sizeof value);
  ((double *)array->data)[at] = special ? specials[number[0] % 8] : value;
}

static void set_whole(cdem_array *array, int64_t at, const uint8_t number[8], bool special) {
  static const int64_t specials[] = {-1, 0, INT32_MAX, INT32_MIN, INT64_MAX, INT64_MIN, 1, 255};
  int64_t value;
  memcpy(&value, number, sizeof value);
  value = special ? specials[number[0] % 8] : value;
  if (array->type == CDEM_ARRAY_INT64)
    ((int64_t *)array->data)[at] = value;
  else if (array->type == CDEM_ARRAY_INT32)
    ((int32_t *)array->data)[at] = (int32_t)value;
  else
    ((uint8_t *)array->data)[at] = (uint8_t)value;
}

static void resize(cdem_array *array, int64_t count) {
  size_t size = cdem_array_size(array->type);
  int64_t kept = count < array->count ? count : array->count;
  void *data = cdem_allocate(count, size, NULL);
  fuzz_require(data != NULL, "no memory for %lld elements", (long long)count);
  memcpy(data, array->data, (size_t)kept * size);
  free(array->data);
  array->data = data;
  array->count = count;
}

static void retype(cdem_array *array, cdem_array_type type) {
  size_t bytes = (size_t)array->count * cdem_array_size(array->type);
  array->type = type;
  array->count = (int64_t)(bytes / cdem_array_size(type));
}

static void change(cdem_state *state, const uint8_t *how) {
  cdem_array *array = &state->array[how[0] % state->arrays];
  int64_t element = how[2] + 256 * how[3], at = array->count > 0 ? element % array->count : 0;
  size_t size = cdem_array_size(array->type);
  switch ((change_kind)(how[1] % CHANGES)) {
  case SET:
  case SET_SPECIAL:
    if (array->count > 0)
      (array->type == CDEM_ARRAY_REAL ? set_real : set_whole)(array, at, how + 4,
                                                              how[1] % CHANGES == SET_SPECIAL);
    break;
  case COPY: /* an element that exists, in another place */
    if (array->count > 0)
      memcpy((char *)array->data + (size_t)at * size,
             (char *)array->data + (size_t)(how[4] % array->count) * size, size);
    break;
  case RESIZE:
    resize(array, element);
    break;
  case REMOVE:
    array->name[0] ^= 1;
    break;
  default:
    retype(array, (cdem_array_type)(how[4] % 4));
  }
}

/* ---- going on ---- */

static cdem_status look_at(void *context, const cdem_frame *frame, cdem_fault *fault) {
  (void)fault;
  *(int64_t *)context += frame->points;
  return CDEM_OK;
}

static cdem_status go_on(cdem_run_setup *setup, cdem_fault *fault) {
  cdem_table row = {0};
  cdem_state state = {0};
  int64_t points = 0;
  const cdem_frame_sink sink = {&points, look_at};
  cdem_status status = setup->engine->advance(setup, STEPS, fault);
  if (status == CDEM_OK)
    status = cdem_run_history_init(setup, &row, fault);
  if (status == CDEM_OK)
    status = cdem_run_history_row(setup, &row, fault);
  if (status == CDEM_OK)
    status = setup->engine->frames(setup, 0, &sink, fault);
  if (status == CDEM_OK)
    status = save(setup, &state, fault);
  cdem_table_release(&row);
  cdem_state_release(&state);
  return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  if (size < 1)
    return 0;
  int index = data[0] % CASES;
  cdem_fault fault = {0};
  cdem_state state = {0};
  cdem_run_setup setup = {0};
  copy_state(state_of(index), &state);
  for (size_t k = 0; k < MOST_CHANGES && 1 + (k + 1) * CHANGE <= size; k++)
    change(&state, data + 1 + k * CHANGE);
  const cdem_run_options options = options_of(index);
  cdem_status status = cdem_run_setup_init(&options, &state, &setup, &fault);
  if (status == CDEM_OK)
    status = setup.engine->restore(&setup, &state, &fault);
  if (status == CDEM_OK)
    status = go_on(&setup, &fault);
  /* Motion may have run away already where the state was left. */
  if (status == CDEM_NUMERIC)
    status = fault.status = CDEM_INPUT;
  fuzz_is_read(status, &fault);
  cdem_run_setup_release(&setup);
  cdem_state_release(&state);
  return 0;
}
