/* The elastic body: laws that hold for every first-order element. */
#include "cdem/body.h"

#include "cdem/body_store.h"
#include "cdem/body_support.h"

#include <omp.h>

#define EACH_ELEMENT(element)                                                                      \
  for (int id_ = 0; id_ < CDEM_ELEMENT_COUNT; id_++)                                               \
    for (const cdem_element *element = cdem_element_get((cdem_element_id)id_);                     \
         element != NULL && first_order(element); element = NULL)

/* Angles from none to a half turn and beyond. */
static const double angles[] = {0.0, 0.3, 1.5, 3.0, 3.14159265358979, 5.0, 40.0};
enum { ANGLES = sizeof angles / sizeof *angles };

static const double shift[3] = {0.3, -2.0, 0.7};

/* The kernels against plain loops: strains up to 10 %, any turn. Rounding of a rotation is 1e-16 of
 * the places, of a force 1e-15 of what full strain would give: 1e-13 of the forces here. */
static void fast_is_reference(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    specimen s;
    specimen_make(element, &(recipe){.count = 3, .distortion = 0.2}, &s);
    double *v = new_vector(s.size), *u = new_vector(s.size), *f = new_vector(s.size);
    double *g = new_vector(s.size);
    shake(&s, 0.02, 3, v);
    for (int a = 0; a < ANGLES; a++) {
      turn_all(&s, v, angles[a], shift, u);
      cdem_body_forces(&s.body, u, f);
      cdem_body_forces_reference(&s.body, u, g);
      check_below(difference(f, g, s.size), 1e-13 * largest(g, s.size));
      assert_int_equal(s.body.inverted, -1);
    }
    free(v), free(u), free(f), free(g);
    specimen_release(&s);
  }
}

/* U(u + t w) for one t. */
static double energy_along(const specimen *s, const double *u, const double *w, double t,
                           double *room) {
  for (int64_t i = 0; i < s->size; i++)
    room[i] = u[i] + t * w[i];
  return cdem_body_energy(&s->body, room, NULL);
}

/* -dU/dx by differences of fourth order; the step leaves 1e-9 of them. */
static void force_is_the_gradient(void **state) {
  (void)state;
  EACH_ELEMENT(element) for (int linear = 0; linear < 2; linear++) {
    specimen s;
    specimen_make(element, &(recipe){.count = 2, .distortion = 0.2, .linear = linear}, &s);
    double *v = new_vector(s.size), *u = new_vector(s.size), *f = new_vector(s.size);
    double *w = new_vector(s.size), *room = new_vector(s.size);
    shake(&s, 0.05, 5, v);
    turn_all(&s, v, linear ? 0.0 : 1.1, shift, u);
    cdem_body_forces(&s.body, u, f);
    for (uint64_t seed = 0; seed < 4; seed++) {
      shake(&s, 1.0, 11 + seed, w);
      double h = 1e-4, power = 0.0;
      for (int64_t i = 0; i < s.size; i++)
        power -= f[i] * w[i];
      double near = energy_along(&s, u, w, h, room) - energy_along(&s, u, w, -h, room);
      double far = energy_along(&s, u, w, 2 * h, room) - energy_along(&s, u, w, -2 * h, room);
      check_near((8.0 * near - far) / (12.0 * h), power, 1e-7, 0.0);
    }
    free(v), free(u), free(f), free(w), free(room);
    specimen_release(&s);
  }
}

/* Sum and moment of the forces of a body, and what they are small against. */
static void resultants(const specimen *s, const double *u, const double *f, double force[3],
                       double moment[3], double *scale) {
  int dofs = s->body.dofs, moving = s->model.dimension;
  memset(force, 0, 3 * sizeof *force);
  memset(moment, 0, 3 * sizeof *moment);
  *scale = 0.0;
  for (int32_t n = 0; n < s->body.nodes; n++) {
    double x[3] = {0}, here[3] = {0}, part[3];
    for (int c = 0; c < moving; c++) {
      x[c] = s->mesh.xyz[3 * (int64_t)n + c] + u[(int64_t)n * dofs + c];
      here[c] = f[(int64_t)n * dofs + c];
    }
    cdem_cross3(x, here, part);
    for (int c = 0; c < 3; c++) {
      force[c] += here[c];
      moment[c] += part[c];
    }
    if (dofs > moving)
      moment[2] += f[(int64_t)n * dofs + 2];
    *scale += cdem_norm3(here) * (1.0 + cdem_norm3(x));
  }
}

static void no_net_force_or_moment(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    specimen s;
    specimen_make(element, &(recipe){.count = 3, .distortion = 0.2}, &s);
    double *v = new_vector(s.size), *u = new_vector(s.size), *f = new_vector(s.size);
    shake(&s, 0.05, 9, v);
    for (int a = 0; a < ANGLES; a++) {
      double force[3], moment[3], scale;
      turn_all(&s, v, angles[a], shift, u);
      cdem_body_forces(&s.body, u, f);
      resultants(&s, u, f, force, moment, &scale);
      check_below(cdem_norm3(force), 1e-13 * scale);
      check_below(cdem_norm3(moment), 1e-13 * scale);
    }
    free(v), free(u), free(f);
    specimen_release(&s);
  }
}

/* A rigid motion of any size turns the forces and keeps the energy. */
static void frame_indifferent(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    specimen s;
    specimen_make(element, &(recipe){.count = 2, .distortion = 0.2}, &s);
    int dofs = s.body.dofs, moving = s.model.dimension;
    double *v = new_vector(s.size), *u = new_vector(s.size), *f = new_vector(s.size);
    double *g = new_vector(s.size);
    shake(&s, 0.02, 21, v);
    cdem_body_forces(&s.body, v, f);
    double energy = cdem_body_energy(&s.body, v, NULL);
    for (int a = 0; a < ANGLES; a++) {
      double r[9], turned[3], scale = largest(f, s.size);
      rotation_about(moving, angles[a], r);
      turn_all(&s, v, angles[a], shift, u);
      cdem_body_forces(&s.body, u, g);
      for (int32_t n = 0; n < s.body.nodes; n++)
        for (int i = 0; i < dofs; i++) {
          turned[i] = i < moving ? 0.0 : f[(int64_t)n * dofs + i];
          for (int k = 0; k < moving && i < moving; k++)
            turned[i] += r[3 * i + k] * f[(int64_t)n * dofs + k];
          check_near(g[(int64_t)n * dofs + i], turned[i], 0.0, 3e-13 * scale);
        }
      check_near(cdem_body_energy(&s.body, u, NULL), energy, 1e-12, 0.0);
    }
    free(v), free(u), free(f), free(g);
    specimen_release(&s);
  }
}

/* Turned alone, a body feels nothing: at 1e-12 of E L (thickness 0.7). */
static void rigid_motion_is_free(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    specimen s;
    specimen_make(element, &(recipe){.count = 3}, &s);
    double *v = new_vector(s.size), *u = new_vector(s.size), *f = new_vector(s.size);
    for (int a = 0; a < ANGLES + 1; a++) {
      turn_all(&s, v, a < ANGLES ? angles[a] : acos(0.0), shift, u);
      cdem_body_forces(&s.body, u, f);
      check_below(largest(f, s.size), 1e-12 * 40e9 / 3.0);
    }
    free(v), free(u), free(f);
    specimen_release(&s);
  }
}

/* f = -K u for small u, K from the rows of the spring sets through the one assembler. Central
 * differences leave 1e-14 of curvature at this size, for small motions keep their digits. */
static void linearisation_is_the_network(void **state) {
  (void)state;
  EACH_ELEMENT(element) for (int linear = 0; linear < 2; linear++) {
    cdem_fault fault = {0};
    specimen s;
    specimen_make(element, &(recipe){.count = 3, .distortion = 0.2, .linear = linear}, &s);
    cdem_sparse k = {0};
    check_ok(cdem_body_stiffness(&s.body, &k, &fault));
    double *u = new_vector(s.size), *f = new_vector(s.size), *g = new_vector(s.size);
    double *ku = new_vector(s.size);
    shake(&s, 1e-7, 17, u);
    cdem_body_forces(&s.body, u, f);
    cdem_sparse_multiply(&k, u, ku);
    for (int64_t i = 0; i < s.size; i++)
      u[i] = -u[i];
    cdem_body_forces(&s.body, u, g);
    for (int64_t i = 0; i < s.size; i++)
      f[i] = 0.5 * (f[i] - g[i]) + ku[i];
    assert_int_equal(k.nodes, s.body.nodes);
    check_below(largest(f, s.size), 1e-12 * largest(ku, s.size));
    cdem_sparse_release(&k);
    free(u), free(f), free(g), free(ku);
    specimen_release(&s);
  }
}

/* Masses add up to rho V and are positive; Cosserat inertia is mass times the length squared. */
static void mass_is_density_times_volume(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    specimen s;
    specimen_make(element, &(recipe){.count = 3, .distortion = 0.25}, &s);
    bool solid = s.model.dimension == 3;
    double sum[3] = {0}, volume = solid ? 1.3 * 1.0 * 0.9 : 1.3 * 1.0 * 0.7;
    double length = cdem_material_length(&s.material);
    for (int64_t i = 0; i < s.size; i++) {
      assert_true(s.body.mass[i] > 0.0);
      sum[i % s.body.dofs] += s.body.mass[i];
    }
    for (int c = 0; c < s.body.dofs; c++)
      check_near(sum[c], 2700.0 * volume * (c < s.model.dimension ? 1.0 : length * length), 1e-13,
                 0.0);
    specimen_release(&s);
  }
}

/* 1, 2 and 4 threads: the same bits, over several tiles. */
static void threads_change_nothing(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    double *f[3], energy[3];
    specimen s;
    for (int t = 0; t < 3; t++) {
      int32_t count = cdem_element_dimension(element) == 3 ? 10 : 40;
      specimen_make(element, &(recipe){.count = count, .distortion = 0.2, .threads = 1 << t}, &s);
      assert_true(s.body.store->tiles > 1);
      double *u = new_vector(s.size);
      f[t] = new_vector(s.size);
      shake(&s, 1e-3, 8, u);
      cdem_body_forces(&s.body, u, f[t]);
      energy[t] = cdem_body_energy(&s.body, u, NULL);
      assert_memory_equal(f[0], f[t], (size_t)s.size * sizeof(double));
      assert_memory_equal(&energy[0], &energy[t], sizeof(double));
      free(u);
      specimen_release(&s);
    }
    for (int t = 0; t < 3; t++)
      free(f[t]);
  }
}

/* Vectors of 8, 4 and 2 doubles agree; products are fused or not, and that is all. */
static void widths_agree(void **state) {
  (void)state;
  const cdem_body_kernels *two = cdem_body_kernels_of_width(2);
  assert_non_null(two);
  EACH_ELEMENT(element) for (int separate = 0; separate < 2; separate++) {
    specimen s;
    specimen_make(element, &(recipe){.count = 3, .separate = separate}, &s);
    const cdem_body_store *store = s.body.store;
    double *v = new_vector(s.size), *u = new_vector(s.size), f[192], g[192], p[24], q[24], b[8];
    shake(&s, 0.02, 2, v);
    turn_all(&s, v, 2.0, shift, u);
    for (int width = 4; width <= 8; width *= 2) {
      const cdem_body_kernels *kernels = cdem_body_kernels_of_width(width);
      for (int64_t n = 0; kernels != NULL && n < store->batches; n++) {
        const cdem_body_batch *batch = &store->batch[n];
        const cdem_body_kind *kind = &store->kind[batch->kind];
        cdem_body_task task = {.kind = kind,
                               .record = store->data + batch->record,
                               .id = store->id + (int64_t)batch->id * CDEM_LANES,
                               .u = u,
                               .shared = batch->shared,
                               .last_node = batch->last_node};
        two->forces(&task, f, b);
        kernels->forces(&task, g, b);
        int64_t size = (int64_t)kind->nodes * kind->dofs * CDEM_LANES;
        check_below(difference(f, g, size), 1e-13 * largest(f, size));
        two->energies(&task, p);
        kernels->energies(&task, q);
        check_below(difference(p, q, 24), 1e-13 * largest(p, 24));
      }
    }
    free(v), free(u);
    specimen_release(&s);
  }
}

/* A regular body shares templates and feels the same forces as one that does not. */
static void sharing_changes_nothing(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    specimen shared, own;
    specimen_make(element, &(recipe){.count = 6}, &shared);
    specimen_make(element, &(recipe){.count = 6, .separate = true}, &own);
    assert_true(shared.body.distinct <= 12);
    assert_int_equal(own.body.distinct, own.model.cells);
    double *u = new_vector(own.size), *f = new_vector(own.size), *g = new_vector(own.size);
    shake(&own, 1e-3, 4, u);
    cdem_body_forces(&shared.body, u, f);
    cdem_body_forces(&own.body, u, g);
    check_below(difference(f, g, own.size), 1e-12 * largest(g, own.size));
    if (element->shape != CDEM_SHAPE_PYR5) /* six pyramids of a brick: rests stay by themselves */
      assert_true(cdem_body_memory(&shared.body) < cdem_body_memory(&own.body));
    free(u), free(f), free(g);
    specimen_release(&shared);
    specimen_release(&own);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fast_is_reference),
      cmocka_unit_test(force_is_the_gradient),
      cmocka_unit_test(no_net_force_or_moment),
      cmocka_unit_test(frame_indifferent),
      cmocka_unit_test(rigid_motion_is_free),
      cmocka_unit_test(linearisation_is_the_network),
      cmocka_unit_test(mass_is_density_times_volume),
      cmocka_unit_test(threads_change_nothing),
      cmocka_unit_test(widths_agree),
      cmocka_unit_test(sharing_changes_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
