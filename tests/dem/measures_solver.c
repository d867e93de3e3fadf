/* Measures of what the solver does: columns at rest, walls, balances; frames and pictures of it. */
#include "dem/frames.h"
#include "dem/pictures.h"
#include "dem/surface.h"
#include "measures_support.h"
#include "results/map.h"

static const cdem_grain_material stone = {"stone", 2600, NAN, NAN};

static cdem_contact_input contact(double friction) {
  cdem_contact_input input;
  for (int k = 0; k < CDEM_LAW_KEYS; k++)
    input.value[k] = NAN;
  input.value[CDEM_LAW_normal_stiffness] = 1e6;
  input.value[CDEM_LAW_shear_stiffness] = 5e5;
  input.value[CDEM_LAW_friction] = friction;
  input.value[CDEM_LAW_restitution] = 0.5;
  return input;
}

/* Discs in a box of three walls, settled under gravity with mass damping. */
typedef struct {
  cdem_grains grains;
  cdem_wall wall[3];
  cdem_contact_input input;
  cdem_dem_options options;
  cdem_dem dem;
} box;

enum { ACROSS = 6, HIGH = 12, DISCS = ACROSS * HIGH };
static const double radius = 0.05, width = 0.6;

/* jump 1: ids row by row; another: in no order of place, contacts are seen from either side. */
static void fill(box *b, int64_t steps, int jump) {
  cdem_fault fault = {0};
  cdem_random random = {2};
  *b = (box){.grains = {.dim = 2}, .input = contact(0.3)};
  for (int k = 0; k < DISCS; k++) {
    int at = k * jump % DISCS;
    const double xyz[3] = {radius * (1 + 2 * (at % ACROSS)) * 0.999 + 3e-4,
                           radius * (1 + 2.02 * (at - at % ACROSS) / ACROSS), 0};
    double r = radius * cdem_random_uniform(&random, 0.9, 0.999);
    check_ok(cdem_grains_add(&b->grains, xyz, r, &fault));
  }
  const double normal[3][3] = {{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}};
  static const char *const names[3] = {"floor", "left", "right"};
  for (int w = 0; w < 3; w++) {
    b->wall[w] = (cdem_wall){.name = names[w], .shape = CDEM_WALL_PLANE};
    memcpy(b->wall[w].normal, normal[w], sizeof normal[w]);
  }
  b->wall[2].center[0] = width;
  b->options = (cdem_dem_options){.grains = &b->grains,
                                  .thickness = 0.5,
                                  .materials = 1,
                                  .material = &stone,
                                  .law = cdem_law_find("linear"),
                                  .contact = &b->input,
                                  .walls = 3,
                                  .wall = b->wall,
                                  .gravity = {0, -9.81, 0},
                                  .mass_damping = 20,
                                  .threads = 1};
  assert_non_null(b->options.law);
  check_ok(cdem_dem_init(&b->options, &b->dem, &fault));
  check_ok(cdem_dem_steps(&b->dem, steps, &fault));
}

static void empty(box *b) {
  cdem_dem_release(&b->dem);
  cdem_grains_release(&b->grains);
}

/* Whichever grain a contact is seen from, its point is in both. */
static void points_of_contacts_are_in_both_grains(void **unused) {
  (void)unused;
  box b;
  fill(&b, 6000, 35);
  cdem_fault fault = {0};
  cdem_snapshot s;
  check_ok(cdem_snapshot_take(&b.dem, &s, &fault));
  assert_true(s.contacts > DISCS / 2);
  for (int64_t k = 0; k < s.contacts; k++) {
    const cdem_dem_contact *c = &s.contact[k];
    for (int side = 0; side < (c->b >= 0 ? 2 : 1); side++) {
      int64_t i = side == 0 ? c->a : c->b;
      double arm[3];
      for (int d = 0; d < 3; d++)
        arm[d] = c->point[d] - s.xyz[3 * i + d];
      assert_true(cdem_norm3(arm) < s.radius[i]);
      assert_true((side == 0 ? 1 : -1) * cdem_dot3(arm, c->normal) > 0.9 * s.radius[i]);
    }
  }
  cdem_snapshot_release(&s);
  empty(&b);
}

/* At rest: the stress of the whole box is what the walls push (Gauss: V s = sum over the boundary
 * and weights, each known), and the force through a level is the weight above it. */
static void columns_at_rest_carry_their_weight(void **unused) {
  (void)unused;
  box b;
  fill(&b, 12000, 1);
  check_below(cdem_dem_unbalanced(&b.dem), 1e-3);
  cdem_fault fault = {0};
  cdem_snapshot s;
  check_ok(cdem_snapshot_take(&b.dem, &s, &fault));
  double weight = 0, moment = 0, top = 0;
  for (int64_t i = 0; i < s.grains; i++) {
    weight += 9.81 * s.mass[i];
    moment += 9.81 * s.mass[i] * s.xyz[3 * i + 1];
    top = fmax(top, s.xyz[3 * i + 1] + s.radius[i]);
  }
  cdem_dem_wall now[3];
  for (int w = 0; w < 3; w++)
    cdem_dem_wall_now(&b.dem, w, &now[w]);
  double lifted = 0; /* friction of the side walls carries its part */
  for (int w = 0; w < 3; w++)
    lifted -= now[w].force[1];
  check_near(lifted, weight, 1e-3, 0);
  check_near(-now[1].force[0], now[2].force[0], 1e-3, 1e-3 * weight);
  const cdem_region whole = {{0, 0, 0}, {width, 1.1 * top, 0}};
  cdem_assembly a;
  check_ok(cdem_measure(&b.dem, &whole, &a, &fault));
  check_near(a.volume, width * 1.1 * top * 0.5, 1e-14, 0);
  /* V s_xx = sum of x t_x over the walls: the right one alone, at x = width. */
  check_near(a.stress[0] * a.volume, -width * now[2].force[0], 2e-3, 0);
  /* V s_yy = sum of y t_y - sum of y g m: floor at 0, the sides' friction at its heights. */
  double sides = 0;
  for (int64_t k = 0; k < s.contacts; k++)
    if (s.contact[k].b < -1)
      sides += s.contact[k].force[1] * s.contact[k].point[1];
  check_near(a.stress[4] * a.volume, sides - moment, 2e-3, 0);
  /* A thin layer carries the weight above it less what the sides took there. */
  for (double y = 0.25; y < 0.6; y += 0.11) {
    const cdem_region layer = {{0, y, 0}, {width, y + 1e-6, 0}};
    double above = 0;
    for (int64_t i = 0; i < s.grains; i++)
      above += s.xyz[3 * i + 1] > y ? 9.81 * s.mass[i] : 0;
    for (int64_t k = 0; k < s.contacts; k++)
      if (s.contact[k].b < -1) { /* a branch to a side may cross the layer: take its grain's side */
        above -= s.xyz[3 * s.contact[k].a + 1] > y ? s.contact[k].force[1] : 0;
      }
    check_ok(cdem_measure(&b.dem, &layer, &a, &fault));
    check_near(-a.stress[4] * width * 0.5, above, 2e-2, 0);
  }
  cdem_snapshot_release(&s);
  empty(&b);
}

/* Coarse-grained mass and momentum of a falling heap move as their balances say: central
 * differences over one step of the solver. */
static void fields_of_a_run_are_balanced(void **unused) {
  (void)unused;
  box b;
  fill(&b, 400, 1);
  cdem_fault fault = {0};
  const double at[3] = {0.31, 0.35, 0}, h = 2e-3;
  cdem_coarse_grid point = {{at[0], at[1], 0}, {at[0], at[1], 0}, {1, 1, 1}, 0.2};
  cdem_coarse_grid around = {{at[0] - h, at[1] - h, 0}, {at[0] + h, at[1] + h, 0}, {3, 3, 1}, 0.2};
  cdem_coarse before, now, after;
  check_ok(cdem_coarse_fields(&b.dem, &point, &before, &fault));
  check_ok(cdem_dem_step(&b.dem, &fault));
  check_ok(cdem_coarse_fields(&b.dem, &around, &now, &fault));
  check_ok(cdem_dem_step(&b.dem, &fault));
  check_ok(cdem_coarse_fields(&b.dem, &point, &after, &fault));
  double dt = b.dem.step;
  double flow = (now.momentum[3 * 5] - now.momentum[3 * 3]) / (2 * h) +
                (now.momentum[3 * 7 + 1] - now.momentum[3 * 1 + 1]) / (2 * h);
  double grows = (after.density[0] - before.density[0]) / (2 * dt);
  check_near(grows, -flow, 1e-3, 1e-3 * fabs(now.momentum[3 * 4 + 1]) / 0.2);
  for (int c = 0; c < 2; c++) {
    double change = (after.momentum[c] - before.momentum[c]) / (2 * dt), push = 0, size;
    for (int d = 0; d < 2; d++) {
      const int low = d == 0 ? 3 : 1, high = d == 0 ? 5 : 7;
      push += (now.stress[9 * high + 3 * c + d] - now.stress[9 * low + 3 * c + d]) / (2 * h);
      push -= (now.momentum[3 * high + c] * now.velocity[3 * high + d] -
               now.momentum[3 * low + c] * now.velocity[3 * low + d]) /
              (2 * h);
    }
    size = fabs(push) + 9.81 * now.density[4];
    push += now.density[4] * (c == 1 ? -9.81 : 0) - 20 * now.momentum[3 * 4 + c]; /* mass damping */
    push += now.wall_force[3 * 4 + c];
    check_near(change, push, 0, 5e-3 * size);
  }
  cdem_coarse_release(&before);
  cdem_coarse_release(&now);
  cdem_coarse_release(&after);
  empty(&b);
}

/* ---- tables, counts ---- */

static void distributions_are_densities(void **unused) {
  (void)unused;
  box b;
  fill(&b, 2000, 1);
  cdem_fault fault = {0};
  cdem_table normals = {0}, profile = {0};
  check_ok(cdem_normal_distribution(&b.dem, 9, &normals, &fault));
  check_ok(cdem_solid_profile(&b.dem, 1, NULL, 11, &profile, &fault));
  double sum[2] = {0}, area = 0, solid = 0;
  for (int64_t r = 0; r < normals.rows; r++)
    sum[0] += cdem_table_at(&normals, r, 2)->real * 3.14159265358979323846 / 9;
  for (int64_t r = 0; r < profile.rows; r++)
    sum[1] += cdem_table_at(&profile, r, 2)->real;
  check_near(sum[0], 1, 1e-12, 0);
  check_near(sum[1], DISCS, 0, 0);
  double low[3], high[3];
  cdem_snapshot s;
  check_ok(cdem_snapshot_take(&b.dem, &s, &fault));
  cdem_snapshot_box(&s, low, high);
  area = (high[0] - low[0]) * (high[1] - low[1]);
  for (int64_t r = 0; r < profile.rows; r++)
    solid += cdem_table_at(&profile, r, 1)->real / 11 * area;
  check_near(solid, cdem_grains_solid(&b.grains), 1e-12, 0);
  cdem_count all, below, above;
  check_ok(cdem_count_region(&b.dem, NULL, &all, &fault));
  check_ok(cdem_count_region(&b.dem, &(cdem_region){{0, -1, 0}, {0, 0.5, 0}}, &below, &fault));
  check_ok(cdem_count_region(&b.dem, &(cdem_region){{0, 0.5, 0}, {0, 9, 0}}, &above, &fault));
  assert_int_equal(all.grains, DISCS);
  assert_int_equal(below.grains + above.grains, DISCS);
  check_near(below.mass + above.mass, all.mass, 1e-13, 0);
  check_near(below.flow[1] * 1.5 + above.flow[1] * 8.5, all.momentum[1], 1e-12, 1e-15);
  assert_true(below.high[1] < 0.5 && above.low[1] >= 0.5);
  check_fails(cdem_normal_distribution(&b.dem, 0, &normals, &fault), CDEM_USAGE, "0 bins");
  check_fails(cdem_solid_profile(&b.dem, 2, NULL, 5, &profile, &fault), CDEM_USAGE, "along axis 2");
  cdem_snapshot_release(&s);
  cdem_table_release(&normals);
  cdem_table_release(&profile);
  empty(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_of_contacts_are_in_both_grains),
      cmocka_unit_test(columns_at_rest_carry_their_weight),
      cmocka_unit_test(fields_of_a_run_are_balanced),
      cmocka_unit_test(distributions_are_densities),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
