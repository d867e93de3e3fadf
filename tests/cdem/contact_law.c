/* Contact: laws of pairs, taking over from interfaces, the step's limit, and bad input. */
#include "cdem/contact_support.h"

/* Two squares (or cubes) with a face pair between them, as after a break. */
static void make_pair(scene *s, int dim) {
  scene_box box[2] = {{{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, 0}, {{1, 1, 1}, {1, 1, 1}, {0, 0, 1}, 0}};
  if (dim == 2)
    box[1].origin[1] = 1.0;
  scene_make(s, dim, 2, box);
  cdem_blocks *b = &s->blocks;
  free(b->pair_facet);
  b->pair_facet = calloc(2, sizeof *b->pair_facet);
  b->pairs = 1;
  cdem_face_pair *p = b->pair;
  *p = (cdem_face_pair){.cell = {0, 1}, .joint = -1};
  for (int32_t f = 0; f < b->facets; f++) {
    double area[3], share[4];
    cdem_facet *facet = &b->facet[f];
    cdem_facet_area(facet, b->mesh.xyz, 1.0, area, share);
    int side = facet->cell;
    if (area[dim - 1] * (side == 0 ? 1.0 : -1.0) < 0.5)
      continue;
    facet->pair = 0;
    b->pair_facet[side] = f;
    p->corners = facet->corners;
    if (side == 0)
      memcpy(p->node[0], facet->node, sizeof facet->node);
    for (int k = 0; k < facet->corners && side == 1; k++)
      for (int j = 0; j < facet->corners; j++) {
        double d = 0.0;
        for (int i = 0; i < 3; i++)
          d += fabs(b->mesh.xyz[3 * p->node[0][j] + i] - b->mesh.xyz[3 * facet->node[k] + i]);
        if (d < 1e-9)
          p->node[1][j] = facet->node[k];
      }
  }
}

/* The pair's springs, pressed by `overlap` and sheared by `shear`, are gone; contact of the same
 * stiffness gives the same force, at once and on every node. */
static void taking_over_does_not_jump(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    scene s;
    cdem_fault fault = {0};
    double g = 1e-5, shear = 4e-6, corners = dim == 2 ? 2 : 4, force[4][3] = {{0.0}};
    cdem_contact_law law = {.kn = 1e10, .kt = 4e9, .friction = 0.7};
    make_pair(&s, dim);
    cdem_contact_options o = {.blocks = &s.blocks,
                              .dofs = dim,
                              .thickness = 1.0,
                              .law = law,
                              .mass = s.mass,
                              .threads = 1};
    check_ok(cdem_contact_init(&o, &s.contact, &fault));
    for (int32_t f = 0; f < s.blocks.facets; f++)
      if (s.blocks.facet[f].pair < 0)
        cdem_contact_activate(&s.contact, f);
    double by[3] = {0.0};
    by[dim - 1] = -g;
    by[0] = shear;
    scene_move(&s, 1, by);
    scene_forces(&s, 0.0); /* bonded still: nothing touches */
    assert_int_equal(scene_totals(&s).contacts, 0);
    for (int k = 0; k < corners; k++) {
      force[k][0] = -law.kt * shear / corners;
      force[k][dim - 1] = law.kn * g / corners;
    }
    cdem_contact_hand_over(&s.contact, 0, (const double(*)[3])force);
    scene_forces(&s, 0.0);
    for (int k = 0; k < corners; k++)
      for (int i = 0; i < dim; i++)
        /* the corner has slipped by 4e-6 of the face, which is how the nodes share */
        check_near(s.force[s.blocks.pair[0].node[1][k] * dim + i], force[k][i], 0.0,
                   2e-5 * law.kn * g);
    double stored = 0.5 * (law.kn * g * g + law.kt * shear * shear);
    check_near(scene_totals(&s).stored, stored, 2e-5, 0.0);
    check_below(fabs(scene_totals(&s).friction) + fabs(scene_totals(&s).damping), 1e-9 * stored);
    /* and goes on from there: twice the shear, up to friction */
    scene_move(&s, 1, (double[3]){shear, 0.0, 0.0});
    double f[3];
    scene_forces(&s, 0.0);
    scene_resultant(&s, 1, f);
    check_near(f[0], -2.0 * law.kt * shear, 2e-5, 0.0);
    /* without a known force the history starts from nothing */
    scene_release(&s);
    make_pair(&s, dim);
    o.blocks = &s.blocks;
    o.mass = s.mass;
    check_ok(cdem_contact_init(&o, &s.contact, &fault));
    cdem_contact_hand_over(&s.contact, 0, NULL);
    scene_move(&s, 1, by);
    scene_forces(&s, 0.0);
    scene_resultant(&s, 1, f);
    check_near(f[dim - 1], law.kn * g, 2e-5, 0.0);
    check_below(fabs(f[0]), 1e-9 * law.kn * g);
    scene_release(&s);
  }
}

static void pairs_of_colours_have_their_law(void **state) {
  (void)state;
  scene s;
  scene_box box[3] = {
      {{3, 1}, {3, 1}, {0, 0}, 0}, {{1, 1}, {1, 1}, {0, 1}, 0}, {{1, 1}, {1, 1}, {2, 1}, 0}};
  cdem_contact_law laws[1] = {{.kn = 3e9}};
  int16_t colour[5] = {0, 0, 0, 1, 2}, of[9] = {-1, 0, -1, 0, -1, -1, -1, -1, -1};
  double g = 1e-4, f[3];
  scene_make(&s, 2, 3, box);
  cdem_contact_options o = {.law = {.kn = 1e9},
                            .laws = 1,
                            .pair_law = laws,
                            .law_of = of,
                            .colours = 3,
                            .colour = colour,
                            .threads = 1};
  scene_start_with(&s, &o);
  scene_move(&s, 1, (double[3]){0, -g, 0});
  scene_move(&s, 2, (double[3]){0, -g, 0});
  scene_forces(&s, 0.0);
  scene_resultant(&s, 1, f);
  check_near(f[1], 3e9 * g, 1e-9, 0.0);
  scene_resultant(&s, 2, f);
  check_near(f[1], 1e9 * g, 1e-9, 0.0);
  scene_release(&s);
}

/* The bound is above the true value, found by powers of M^-1 K with K from differences of forces,
 * and not far above. */
static void frequency_is_a_bound(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    scene s;
    scene_box box[2] = {{{3, 2, 2}, {1, 1, 1}, {0, 0, 0}, 0},
                        {{2, 3, 2}, {1, 1, 1}, {0.1, 0.2, 1}, 0}};
    if (dim == 2)
      box[1].origin[1] = 1.0;
    cdem_contact_law law = {.kn = 1e9, .kt = 5e8, .friction = 1e6};
    scene_make(&s, dim, 2, box);
    scene_start(&s, &law);
    double by[3] = {0.0}, *u0, *f0, *x, norm = 0.0;
    int32_t n = s.blocks.mesh.nodes * dim;
    by[dim - 1] = -1e-3;
    scene_move(&s, 1, by);
    scene_forces(&s, 0.0);
    u0 = calloc((size_t)n, sizeof *u0);
    f0 = calloc((size_t)n, sizeof *f0);
    x = calloc((size_t)n, sizeof *x);
    memcpy(u0, s.u, (size_t)n * sizeof *u0);
    memcpy(f0, s.force, (size_t)n * sizeof *f0);
    double bound = cdem_contact_frequency2(&s.contact);
    for (int32_t i = 0; i < n; i++)
      x[i] = sin(1.0 + 7.0 * i);
    for (int step = 0; step < 200; step++) {
      norm = 0.0;
      for (int32_t i = 0; i < n; i++)
        norm += x[i] * x[i];
      norm = sqrt(norm);
      for (int32_t i = 0; i < n; i++)
        s.u[i] = u0[i] + 1e-7 * x[i] / norm;
      scene_forces(&s, 0.0);
      for (int32_t i = 0; i < n; i++)
        x[i] = -(s.force[i] - f0[i]) / (1e-7 * s.mass[i]);
    }
    assert_true(bound >= norm * 0.999 && bound <= 4.0 * norm);
    free(u0);
    free(f0);
    free(x);
    scene_release(&s);
  }
}

static void bad_input_is_named(void **state) {
  (void)state;
  scene s;
  cdem_fault fault = {0};
  cdem_contact contact;
  scene_box box[1] = {{{1, 1}, {1, 1}, {0, 0}, 0}};
  scene_make(&s, 2, 1, box);
  cdem_contact_options good = {
      .blocks = &s.blocks, .dofs = 2, .thickness = 1.0, .law = {.kn = 1e9}, .mass = s.mass};
  cdem_contact_options o = good;
  o.law.kn = 0.0;
  check_fails(cdem_contact_init(&o, &contact, &fault), CDEM_INPUT, "normal stiffness kn");
  assert_null(contact.store);
  o = good;
  o.law.kt = -1.0;
  check_fails(cdem_contact_init(&o, &contact, &fault), CDEM_INPUT, "shear stiffness kt");
  o = good;
  o.law.friction = NAN;
  check_fails(cdem_contact_init(&o, &contact, &fault), CDEM_INPUT, "friction");
  o = good;
  o.law.damping = -0.1;
  check_fails(cdem_contact_init(&o, &contact, &fault), CDEM_INPUT, "damping");
  o = good;
  o.thickness = 0.0;
  check_fails(cdem_contact_init(&o, &contact, &fault), CDEM_INPUT, "thickness");
  o = good;
  o.skin = -1.0;
  check_fails(cdem_contact_init(&o, &contact, &fault), CDEM_INPUT, "skin");
  o = good;
  o.mass = NULL;
  check_fails(cdem_contact_init(&o, &contact, &fault), CDEM_USAGE, "masses");
  int16_t of[1] = {5}, colour[1] = {3};
  o = good;
  o.law_of = of;
  o.colours = 1;
  check_fails(cdem_contact_init(&o, &contact, &fault), CDEM_USAGE, "law 5");
  of[0] = -1;
  o.colour = colour;
  check_fails(cdem_contact_init(&o, &contact, &fault), CDEM_USAGE, "colour 3");
  scene_start(&s, &good.law);
  s.u[0] = NAN;
  check_fails(cdem_contact_forces(&s.contact, s.u, s.v, 1.0, s.force, &fault), CDEM_NUMERIC,
              "no longer a number");
  scene_release(&s);
}

/* Memory that fails anywhere leaves things releasable, and a second try works. */
static void failing_memory_is_survived(void **state) {
  (void)state;
  scene s;
  cdem_fault fault = {0};
  scene_box box[2] = {{{2, 2, 1}, {1, 1, 1}, {0, 0, 0}, 0},
                      {{1, 1, 1}, {1, 1, 1}, {0, 0, 0.99}, 0}};
  scene_make(&s, 3, 2, box);
  cdem_contact_options o = {
      .blocks = &s.blocks, .dofs = 3, .law = {.kn = 1e9}, .mass = s.mass, .threads = 1};
  int failures = 0;
  for (int64_t n = 0;; n++) {
    memset(&fault, 0, sizeof fault);
    cdem_memory_fail_after(n);
    cdem_status status = cdem_contact_init(&o, &s.contact, &fault);
    bool made = status == CDEM_OK;
    for (int32_t f = 0; made && f < s.blocks.facets; f++)
      cdem_contact_activate(&s.contact, f);
    if (made)
      status = cdem_contact_forces(&s.contact, s.u, s.v, 0.0, s.force, &fault);
    cdem_memory_fail_after(-1);
    if (made && status != CDEM_OK) {
      memset(&fault, 0, sizeof fault);
      check_ok(cdem_contact_forces(&s.contact, s.u, s.v, 0.0, s.force, &fault));
    }
    if (made)
      assert_true(scene_totals(&s).contacts > 0);
    cdem_contact_release(&s.contact);
    if (status == CDEM_OK)
      break;
    assert_int_equal(status, CDEM_MEMORY);
    failures++;
  }
  assert_true(failures > 40);
  scene_release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(taking_over_does_not_jump),
      cmocka_unit_test(pairs_of_colours_have_their_law),
      cmocka_unit_test(frequency_is_a_bound),
      cmocka_unit_test(bad_input_is_named),
      cmocka_unit_test(failing_memory_is_survived),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
