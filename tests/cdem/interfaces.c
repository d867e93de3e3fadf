/* Room cdem: interfaces between the cells of cut grids. */
#include "cdem/interfaces_support.h"

static const struct {
  cdem_shape shape;
  int count[3], dofs;
} grids[] = {{CDEM_SHAPE_QUAD4, {3, 2, 0}, 2}, {CDEM_SHAPE_TRI3, {2, 2, 0}, 3},
             {CDEM_SHAPE_TET4, {1, 1, 2}, 3},  {CDEM_SHAPE_HEX8, {2, 2, 2}, 3},
             {CDEM_SHAPE_PYR5, {1, 1, 1}, 3},  {CDEM_SHAPE_WEDGE6, {1, 2, 1}, 3}};
enum { GRIDS = 6 };

/* Turned rigidly by a large angle, no point feels a force. */
static void rigid_motion_is_free(void **state) {
  (void)state;
  for (int g = 0; g < GRIDS; g++) {
    specimen s;
    build(&s, grids[g].shape, grids[g].count, 0.2, grids[g].dofs, &strong, 1);
    const double axis[3] = {s.blocks.dimension == 3 ? 0.7 : 0, s.blocks.dimension == 3 ? -1 : 0, 2};
    displace(&s, axis, 0, 1);
    evaluate(&s);
    for (int64_t i = 0; i < s.unknowns; i++)
      check_below(fabs(s.force[i]), 3e6 * 1e-14); /* rounding of u of a few metres */
    drop(&s);
  }
}

/* Elastic points: the force is the gradient of the energy at any rotation, relative displacement
 * and warping; so that forces and moments add to nothing, exactly. */
static void force_is_the_gradient(void **state) {
  (void)state;
  for (int g = 0; g < GRIDS; g++) {
    specimen s;
    build(&s, grids[g].shape, grids[g].count, 0.2, grids[g].dofs, &strong, 1);
    int dimension = s.blocks.dimension, dofs = s.dofs;
    const double axis[3] = {0, dimension == 3 ? 0.4 : 0, 1};
    displace(&s, axis, 0.05, 5);
    evaluate(&s);
    double force[MOST], sum[3] = {0}, moment[3] = {0}, scale = 0;
    memcpy(force, s.force, sizeof force);
    for (int32_t n = 0; n < s.blocks.mesh.nodes; n++) {
      double x[3] = {0}, f[3] = {0}, m[3];
      for (int i = 0; i < dimension; i++) {
        x[i] = s.blocks.mesh.xyz[3 * n + i] + s.u[n * dofs + i];
        f[i] = force[n * dofs + i];
        scale = fmax(scale, fabs(f[i]));
      }
      cdem_cross3(x, f, m);
      for (int i = 0; i < 3; i++) {
        sum[i] += f[i];
        moment[i] += m[i];
      }
      if (dofs > dimension)
        assert_true(force[n * dofs + dimension] == 0); /* Cosserat rotations are not coupled */
    }
    for (int i = 0; i < 3; i++) {
      check_below(fabs(sum[i]), 1e-12 * scale);
      check_below(fabs(moment[i]), 1e-12 * scale);
    }
    const double h = 1e-5;
    for (int64_t i = 0; i < s.unknowns; i += 7) {
      double at = s.u[i], energy[2];
      for (int side = 0; side < 2; side++) {
        s.u[i] = at + (side ? h : -h);
        evaluate(&s);
        energy[side] = totals_of(&s).stored;
      }
      s.u[i] = at;
      /* Central differences: h^2 of the third derivative, about stiffness/size. */
      check_near((energy[0] - energy[1]) / (2 * h), force[i], 0, 1e-6 * scale);
    }
    drop(&s);
  }
}

/* Two cubes apart by `jump`, taken along in steps. */
static void part(specimen *s, const double from[3], const double to[3], int steps, double *work) {
  const cdem_face_pair *pair = &s->blocks.pair[0];
  double before[3] = {0}, last[3] = {from[0], from[1], from[2]};
  for (int i = 0; i <= steps; i++) {
    double now[3], force[3] = {0};
    for (int k = 0; k < 3; k++)
      now[k] = from[k] + (to[k] - from[k]) * i / steps;
    memset(s->u, 0, sizeof s->u);
    for (int32_t n = 0; n < s->blocks.mesh.nodes; n++)
      for (int k = 0; k < s->dofs && k < s->blocks.dimension; k++)
        s->u[n * s->dofs + k] =
            s->blocks.node_block[n] == s->blocks.block[pair->cell[1]] ? now[k] : 0;
    evaluate(s);
    for (int32_t n = 0; n < s->blocks.mesh.nodes; n++)
      for (int k = 0; k < s->blocks.dimension; k++)
        if (s->blocks.node_block[n] == s->blocks.block[pair->cell[1]])
          force[k] += s->force[n * s->dofs + k];
    for (int k = 0; k < 3; k++) {
      *work -= i > 0 ? (force[k] + before[k]) / 2 * (now[k] - last[k]) : 0;
      before[k] = force[k];
      last[k] = now[k];
    }
  }
}

/* One square metre pulled apart takes G_I, sheared G_II; then it is free, and handed over. */
static void one_face_takes_its_energy(void **state) {
  (void)state;
  for (int mode = 0; mode < 2; mode++)
    for (int dimension = 2; dimension < 4; dimension++) {
      specimen s;
      build(&s, dimension == 3 ? CDEM_SHAPE_HEX8 : CDEM_SHAPE_QUAD4,
            dimension == 3 ? two : two_plane, 0, dimension, &soft, 1);
      double area = dimension == 3 ? 1 : 0.5, work = 0, none[3] = {0}, to[3] = {0}, force[4][3];
      to[mode] = 4e-5;
      part(&s, none, to, 50, &work);
      cdem_interfaces_totals totals = totals_of(&s);
      check_near(totals.fracture, area * (mode == 0 ? 10 : 50), 1e-12, 0);
      assert_int_equal(totals.points, dimension == 3 ? 4 : 2);
      assert_int_equal(mode == 0 ? totals.tension_failed : totals.shear_failed, totals.points);
      assert_int_equal(totals.cracks, 1);
      check_near(totals.cracked_area, area, 1e-14, 0);
      assert_false(s.interfaces.released[0]);
      assert_false(cdem_interfaces_last_force(&s.interfaces, 0, force));
      int64_t version = s.interfaces.version;
      double far[3] = {mode == 0 ? 0.06 : -1e-8, mode == 0 ? 0 : 0.06, 0};
      double close[3] = {mode == 0 ? 4e-5 : -1e-8, mode == 0 ? 0 : 4e-5, 0};
      part(&s, close, far, 40, &work);
      assert_true(s.interfaces.released[0]);
      assert_int_equal(s.interfaces.version, version + 1);
      assert_true(cdem_interfaces_last_force(&s.interfaces, 0, force));
      double total[3] = {0};
      for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++)
          total[i] += force[k][i];
      /* Side 1 is at larger x: pressed by kn 1e-8 along +x, rubbed back along y. */
      check_near(total[0], mode == 0 ? 0 : area * 1e5, 1e-9, 0);
      check_near(total[1], mode == 0 ? 0 : -area * 0.3e5, 1e-9, 0);
      evaluate(&s); /* after the release nothing pulls */
      for (int64_t i = 0; i < s.unknowns; i++)
        assert_true(s.force[i] == 0);
      cdem_interface_fields fields;
      check_ok(cdem_interfaces_fields(&s.interfaces, s.u, &fields, &fault));
      assert_int_equal(fields.points, totals.points);
      assert_int_equal(fields.open[0], mode == 0);
      check_near(mode == 0 ? fields.opening[1] : fields.slip[1], 0.06, 1e-6, 0);
      check_near(fields.damage[0], 1, 0, 0);
      cdem_interface_fields_release(&fields);
      drop(&s);
    }
}

/* Peak of the face: sigma_t A; then half way down the slope the fields say so. */
static void peak_is_the_strength(void **state) {
  (void)state;
  specimen s;
  build(&s, CDEM_SHAPE_HEX8, two, 0, 3, &soft, 1);
  double none[3] = {0}, peak[3] = {1e-7, 0, 0}, half[3] = {1.005e-5, 0, 0}, work = 0, pull = 0;
  part(&s, none, peak, 10, &work);
  for (int k = 0; k < 4; k++)
    pull += s.force[s.blocks.pair[0].node[0][k] * 3];
  check_near(pull, 1e6, 1e-12, 0);
  check_near(totals_of(&s).stored, 1e6 * 1e-7 / 2, 1e-12, 0);
  part(&s, peak, half, 10, &work);
  cdem_interface_fields fields;
  check_ok(cdem_interfaces_fields(&s.interfaces, s.u, &fields, &fault));
  for (int i = 0; i < 4; i++) {
    assert_int_equal(fields.state[i], CDEM_INTERFACE_SOFTENING);
    assert_int_equal(fields.corner[i], i);
    assert_int_equal(fields.open[i], 0);
    check_near(-fields.normal_traction[i], 0.5e6, 1e-12, 0); /* D = 1e-5 of 2e-5 */
    check_near(fields.opening[i], 1.005e-5, 1e-14, 0);
  }
  cdem_interfaces_totals totals = totals_of(&s);
  assert_int_equal(totals.softening, 4);
  check_near(totals.stored + totals.fracture, work, 1e-12, 0); /* kink on a step's end */
  cdem_interface_fields_release(&fields);
  drop(&s);
}

/* The same bits for 1, 2 and 4 threads through failure and release. */
static void threads_do_not_matter(void **state) {
  (void)state;
  static double kept[MOST];
  cdem_interfaces_totals first = {0};
  for (int threads = 1; threads <= 4; threads *= 2) {
    specimen s;
    build(&s, CDEM_SHAPE_HEX8, (int[3]){5, 5, 5}, 0.1, 3, &soft, threads);
    for (int i = 1; i <= 6; i++) {
      displace(&s, (double[3]){0, 0, 0.1 * i}, i < 5 ? 4e-6 * i : 0.05, (uint64_t)(7 + i % 2));
      evaluate(&s);
    }
    cdem_interfaces_totals totals = totals_of(&s);
    assert_true(totals.cracks > 0 && s.interfaces.version > 0);
    if (threads == 1) {
      memcpy(kept, s.force, sizeof kept);
      first = totals;
    }
    assert_memory_equal(kept, s.force, (size_t)s.unknowns * sizeof *kept);
    assert_memory_equal(&first, &totals, sizeof totals);
    drop(&s);
  }
}

/* Four squares around one node. Nothing is reached under small stress; when the vertical face of
 * the lower squares goes, its outer points come in loaded, the middle node still holds together
 * around the other three faces. When one more goes, the four copies are two and two. */
static void tied_faces_let_go(void **state) {
  (void)state;
  cdem_interface_law tied = soft;
  tied.insertion = CDEM_INSERTION_TIED;
  specimen s;
  build(&s, CDEM_SHAPE_QUAD4, (int[3]){2, 2, 0}, 0, 2, &tied, 1);
  double stress[6 * 32] = {0}; /* four cells first, then the sides */
  assert_true(s.blocks.mesh.cells <= 32);
  assert_true(cdem_interfaces_any_tied(&s.interfaces));
  assert_int_equal(s.interfaces.ties.clusters, 5); /* four mid-sides of two, the middle of four */
  assert_int_equal(s.interfaces.ties.start[5], 12);
  assert_int_equal(cdem_interfaces_insert(&s.interfaces, s.u, stress), 0);
  for (int c = 0; c < 4; c++)
    stress[6 * c] = c < 2 ? 1.02e6 : 0.5e6; /* xx; cells 0 1 below, 2 3 above */
  assert_int_equal(cdem_interfaces_insert(&s.interfaces, s.u, stress), 1);
  assert_int_equal(s.interfaces.ties.clusters, 4);
  assert_int_equal(s.interfaces.ties.start[4], 10);
  assert_int_equal(s.interfaces.ties.version, 1);
  evaluate(&s);
  /* Half of the edge's area, at the strength, on the two outer nodes only. */
  int32_t p = 0;
  while (s.blocks.pair[p].cell[0] != 0 || s.blocks.pair[p].cell[1] != 1)
    p++;
  for (int k = 0; k < 2; k++) {
    const int32_t *node[2] = {s.blocks.pair[p].node[0], s.blocks.pair[p].node[1]};
    bool outer = s.blocks.mesh.xyz[3 * node[0][k] + 1] == 0;
    check_near(s.force[2 * node[0][k]], outer ? 1e6 * 0.25 : 0, 1e-12, 0);
    check_near(s.force[2 * node[1][k]], outer ? -1e6 * 0.25 : 0, 1e-12, 0);
  }
  check_near(totals_of(&s).stored, 0, 0, 1e-15);
  stress[6 * 2] = stress[6 * 3] = 2e6;
  assert_int_equal(cdem_interfaces_insert(&s.interfaces, s.u, stress), 1);
  assert_int_equal(s.interfaces.ties.clusters, 4); /* left and right mid-sides, and two halves */
  assert_int_equal(s.interfaces.ties.start[4], 8);
  evaluate(&s);
  double pull = 0;
  for (int32_t n = 0; n < s.blocks.mesh.nodes; n++)
    pull += fabs(s.force[2 * n]) / 2;
  check_near(pull, 1e6 * 2 * 0.5, 1e-12, 0); /* both edges, all points at the strength */
  assert_true(cdem_interfaces_any_tied(&s.interfaces));
  stress[1] = stress[7] = stress[13] = stress[19] = 1e6;
  assert_int_equal(cdem_interfaces_insert(&s.interfaces, s.u, stress), 2);
  assert_int_equal(s.interfaces.ties.clusters, 0);
  assert_false(cdem_interfaces_any_tied(&s.interfaces));
  drop(&s);
}

/* Shear on a face under pressure: compression strengthens it, and the sign is that of side 1. */
static void tied_face_comes_in_sheared(void **state) {
  (void)state;
  cdem_interface_law tied = soft;
  tied.insertion = CDEM_INSERTION_TIED;
  specimen s;
  build(&s, CDEM_SHAPE_HEX8, two, 0, 3, &tied, 1);
  double stress[6 * 64] = {0};
  for (int c = 0; c < 2; c++) {
    stress[6 * c] = -2e6;
    stress[6 * c + 5] = 3.5e6; /* xy */
  }
  assert_int_equal(cdem_interfaces_insert(&s.interfaces, s.u, stress), 0); /* 3 + 0.3 * 2 MPa */
  stress[5] = stress[11] = 3.7e6;
  assert_int_equal(cdem_interfaces_insert(&s.interfaces, s.u, stress), 1);
  evaluate(&s);
  double on[3] = {0};
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 3; i++)
      on[i] += s.force[3 * s.blocks.pair[0].node[1][k] + i];
  check_near(on[0], 2e6, 1e-12, 0); /* side 1, at larger x, is pressed along +x */
  check_near(on[1], -3.6e6, 1e-12, 0);
  check_near(on[2], 0, 0, 1e-6);
  double none[3] = {0}, to[3] = {0, 4e-5, 0}, work = 0;
  part(&s, none, to, 200, &work);
  cdem_interfaces_totals totals = totals_of(&s);
  check_near(totals.fracture, 50, 1e-12, 0);
  /* The trapezoid misses the end of the slope within a step: slope step^2/8. */
  check_near(totals.fracture + totals.friction + totals.stored, work, 0,
             3e6 / (1e-4 / 3) * 2e-7 * 2e-7 / 8);
  drop(&s);
}

/* Largest eigenvalue of M^-1 K by power iteration on the forces (unit masses, small motion). */
static double largest(specimen *s, const double *mass) {
  double norm = 1, x[MOST];
  cdem_random random = {5};
  for (int64_t i = 0; i < s->unknowns; i++)
    x[i] = cdem_random_uniform(&random, -1, 1);
  for (int step = 0; step < 300; step++) {
    for (int64_t i = 0; i < s->unknowns; i++)
      s->u[i] = 1e-9 * x[i];
    evaluate(s);
    double sum = 0;
    for (int64_t i = 0; i < s->unknowns; i++) {
      x[i] = -s->force[i] * 1e9 / mass[i];
      sum += x[i] * x[i];
    }
    norm = sqrt(sum);
    for (int64_t i = 0; i < s->unknowns; i++)
      x[i] /= norm;
  }
  return norm;
}

static void frequency_is_bounded(void **state) {
  (void)state;
  for (int g = 0; g < GRIDS; g++) {
    if (grids[g].dofs > 2 && cdem_shape_get(grids[g].shape)->dimension == 2)
      continue;
    specimen s;
    double mass[MOST];
    build(&s, grids[g].shape, grids[g].count, 0.1, grids[g].dofs, &strong, 1);
    for (int64_t i = 0; i < s.unknowns; i++)
      mass[i] = 1 + (double)(i / s.dofs % 3);
    double bound = cdem_interfaces_frequency2(&s.interfaces, mass), found = largest(&s, mass);
    assert_true(found <= bound);
    assert_true(bound < 3 * found); /* and not useless */
    assert_true(cdem_interfaces_open_frequency2(&s.interfaces, mass, 0.0) == bound); /* all are */
    double rows[MOST] = {0};
    cdem_interfaces_row_sums(&s.interfaces, rows);
    for (int32_t n = 0; n < s.blocks.mesh.nodes; n++)
      assert_true(rows[n] <= bound * mass[n * s.dofs] * (1 + 1e-14));
    drop(&s);
  }
  /* One face of 1 m^2 between unit masses: 2 kn A/4 exactly. */
  specimen s;
  double mass[48];
  for (int i = 0; i < 48; i++)
    mass[i] = 1;
  build(&s, CDEM_SHAPE_HEX8, two, 0, 3, &strong, 1);
  check_near(cdem_interfaces_frequency2(&s.interfaces, mass), 2 * 3e6 / 4, 1e-14, 0);
  drop(&s);
  cdem_interface_law tied = strong;
  tied.insertion = CDEM_INSERTION_TIED;
  build(&s, CDEM_SHAPE_HEX8, two, 0, 3, &tied, 1);
  assert_true(cdem_interfaces_frequency2(&s.interfaces, mass) == 0);
  /* ... and what they will have been once the face is open, or contact in its place. */
  check_near(cdem_interfaces_open_frequency2(&s.interfaces, mass, 0.0), 2 * 3e6 / 4, 1e-14, 0);
  check_near(cdem_interfaces_open_frequency2(&s.interfaces, mass, 5e6), 2 * 5e6 / 4, 1e-14, 0);
  drop(&s);
}

typedef struct {
  int32_t nodes;
  int dimension;
  const double *u;
  double *force;
} product;

static void multiply(void *context, int32_t a, int32_t b, const double *block) {
  product *p = context;
  for (int i = 0; i < p->dimension; i++)
    for (int j = 0; j < p->dimension; j++)
      p->force[a * p->dimension + i] -= block[p->dimension * i + j] * p->u[b * p->dimension + j];
}

/* The blocks for the static solution are the linear part of the forces. */
static void stiffness_is_the_linear_part(void **state) {
  (void)state;
  const int which[] = {0, 2, 3};
  for (int w = 0; w < 3; w++) {
    int g = which[w];
    specimen s;
    build(&s, grids[g].shape, grids[g].count, 0.1, grids[g].dofs, &strong, 1);
    displace(&s, (double[3]){0}, 1e-7, 9);
    evaluate(&s);
    double force[MOST] = {0}, scale = 0;
    cdem_interfaces_stiffness(&s.interfaces, multiply,
                              &(product){s.blocks.mesh.nodes, s.dofs, s.u, force});
    for (int64_t i = 0; i < s.unknowns; i++)
      scale = fmax(scale, fabs(force[i]));
    for (int64_t i = 0; i < s.unknowns; i++)
      check_near(s.force[i], force[i], 0, 3e-6 * scale); /* second order: noise/size, a few faces */
    drop(&s);
  }
}

/* A joint that ends inside a block: its tip is one node, carries nothing, and the rest balances. */
static void joint_tip_is_one_node(void **state) {
  (void)state;
  cdem_mesh mesh = {0};
  check_ok(cdem_mesh_grid(
      &(cdem_mesh_grid_options){.shape = CDEM_SHAPE_QUAD4, .count = {2, 2, 0}, .size = {2, 2, 1}},
      &mesh, &fault));
  const int32_t line[] = {3, 4}; /* from the left side to the middle */
  int32_t id = mesh.cells;
  check_ok(cdem_mesh_add_cells(&mesh, CDEM_SHAPE_LINE2, 1, line, NULL, &fault));
  check_ok(cdem_mesh_add_group(&mesh, "joint", 1, 1, &id, &fault));
  const char *const joint[] = {"joint"};
  cdem_blocks blocks = {0};
  check_ok(cdem_blocks_init(
      &(cdem_blocks_options){.mesh = &mesh, .joints = 1, .joint_group = joint}, &blocks, &fault));
  assert_int_equal(blocks.mesh.nodes, 10);
  cdem_interface_law loose = {.kn = 1e9, .ks = 1e9, .friction = 0.5};
  int32_t law_of = 0;
  cdem_interfaces interfaces = {0};
  check_ok(cdem_interfaces_init(&(cdem_interfaces_options){.blocks = &blocks,
                                                           .dofs = 2,
                                                           .thickness = 1,
                                                           .laws = 1,
                                                           .law = &loose,
                                                           .law_of = &law_of,
                                                           .release = 0.05},
                                &interfaces, &fault));
  double u[20] = {0}, force[20] = {0}, sum = 0, moment = 0;
  int k = blocks.pair[0].node[0][0] == blocks.pair[0].node[1][0];
  assert_int_equal(blocks.pair[0].node[0][!k], blocks.pair[0].node[1][!k]);
  u[2 * blocks.pair[0].node[0][k] + 1] = 1e-3; /* side 0 is below: pressed up */
  u[2 * blocks.pair[0].node[0][k]] = 1e-3;
  cdem_interfaces_forces(&interfaces, u, force);
  for (int n = 0; n < 10; n++) {
    sum += fabs(force[2 * n + 1]);
    moment += (blocks.mesh.xyz[3 * n] + u[2 * n]) * force[2 * n + 1] -
              (blocks.mesh.xyz[3 * n + 1] + u[2 * n + 1]) * force[2 * n];
  }
  assert_true(sum > 1e5);
  check_below(fabs(moment), 1e-12 * sum);
  cdem_interfaces_totals totals;
  cdem_interfaces_sum(&interfaces, &totals);
  assert_int_equal(totals.points, 1);
  assert_int_equal(totals.cracks, 0); /* it never had strength to lose */
  assert_int_equal(totals.shear_failed, 1);
  cdem_interfaces_release(&interfaces);
  cdem_blocks_release(&blocks);
  cdem_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rigid_motion_is_free),         cmocka_unit_test(force_is_the_gradient),
      cmocka_unit_test(one_face_takes_its_energy),    cmocka_unit_test(peak_is_the_strength),
      cmocka_unit_test(threads_do_not_matter),        cmocka_unit_test(tied_faces_let_go),
      cmocka_unit_test(tied_face_comes_in_sheared),   cmocka_unit_test(frequency_is_bounded),
      cmocka_unit_test(stiffness_is_the_linear_part), cmocka_unit_test(joint_tip_is_one_node),

  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
