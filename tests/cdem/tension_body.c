/* Bodies without tension: laws that hold for every first-order element, distorted and turned. */
#include "cdem/body.h"
#include "cdem/body_store.h"
#include "cdem/body_support.h"

/* Every element, then every plane Cosserat element again with cubic moduli. */
#define EACH_ELEMENT(element)                                                                      \
  for (int id_ = 0; id_ < 2 * CDEM_ELEMENT_COUNT; id_++)                                           \
    for (const cdem_element *element = element_of(id_); element != NULL; element = NULL)

static const cdem_element *element_of(int index) {
  const cdem_element *element = cdem_element_get((cdem_element_id)(index % CDEM_ELEMENT_COUNT));
  bool again = index >= CDEM_ELEMENT_COUNT && element->formulation != CDEM_PLANE_COSSERAT;
  return first_order(element) && !again ? element : NULL;
}

static const double shift[3] = {0.3, -2.0, 0.7};
static const double angles[] = {0.0, 0.3, 1.5707963267948966, 3.0, 40.0};
enum { ANGLES = sizeof angles / sizeof *angles };

/* The specimen of element_of(index). */
static void make(int index, const recipe *how, specimen *s) {
  specimen_make(element_of(index), how, s);
  if (index < CDEM_ELEMENT_COUNT)
    return;
  cdem_body_release(&s->body);
  cdem_model_release(&s->model);
  s->material.model = CDEM_COSSERAT_CUBIC;
  const double moduli[5] = {60e9, 20e9, 9e9, 4e9, 3e8};
  memcpy(s->material.parameter, moduli, sizeof moduli);
  specimen_build(how, s);
}

/* A motion in which all cases occur: random, on a strain from pressure to tension along x. */
static void mixed(const specimen *s, double size, uint64_t seed, double *v) {
  int dofs = s->body.dofs;
  shake(s, 0.3 * size, seed, v);
  for (int32_t n = 0; n < s->body.nodes; n++) {
    const double *x = s->mesh.xyz + 3 * (int64_t)n;
    v[(int64_t)n * dofs] += size * (2.0 * x[0] * x[0] - 2.0 * x[0]);
    v[(int64_t)n * dofs + 1] += size * (x[0] - 0.8) * x[1];
  }
}

/* How many cells have opened in no, some, all directions. */
static void count_cases(const specimen *s, const double *u, int count[3]) {
  for (int32_t cell = 0; cell < s->model.cells; cell++) {
    cdem_body_element element;
    double mean[CDEM_BODY_NODES][3], strain = 0.0, size = 0.0;
    cdem_body_element_at(&s->body, u, cell, &element);
    cdem_body_mean_gradients(&s->model, cell, mean);
    for (int v = 0; v < 6; v++)
      size = fmax(size, fabs(element.opening[v]));
    double h[9] = {0};
    for (int a = 0; a < element.record.kind->nodes; a++)
      for (int i = 0; i < s->model.dimension; i++)
        for (int k = 0; k < s->model.dimension; k++)
          h[3 * i + k] += element.d[a][i] * mean[a][k];
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++)
        strain = fmax(strain, fabs(h[3 * i + k] + h[3 * k + i]));
    count[size == 0.0 ? 0 : strain > 1e-12 ? 1 : 2]++;
  }
}

/* The kernels add to the forces of the springs, the reference takes the opening out of the
 * displacements: two derivations of one force. */
static void fast_is_reference(void **state) {
  (void)state;
  EACH_ELEMENT(element) for (int linear = 0; linear < 2; linear++) {
    specimen s;
    int count[3] = {0};
    make(id_, &(recipe){.count = 5, .distortion = 0.2, .no_tension = true, .linear = linear}, &s);
    double *v = new_vector(s.size), *u = new_vector(s.size), *f = new_vector(s.size);
    double *g = new_vector(s.size);
    mixed(&s, 0.05, 3, v);
    count_cases(&s, v, count);
    assert_true(count[0] > 0 && count[1] > 0 && count[2] > 0);
    for (int a = 0; a < (linear ? 1 : ANGLES); a++) {
      turn_all(&s, v, angles[a], shift, u);
      cdem_body_forces(&s.body, u, f);
      cdem_body_forces_reference(&s.body, u, g);
      check_below(difference(f, g, s.size), 2e-13 * largest(g, s.size));
    }
    free(v), free(u), free(f), free(g);
    specimen_release(&s);
  }
}

static double energy_along(const specimen *s, const double *u, const double *w, double t,
                           double *room) {
  for (int64_t i = 0; i < s->size; i++)
    room[i] = u[i] + t * w[i];
  return cdem_body_energy(&s->body, room, NULL);
}

/* -dU/dx by differences. Few elements change their case within the step; those leave its size. */
static void force_is_the_gradient(void **state) {
  (void)state;
  EACH_ELEMENT(element) for (int linear = 0; linear < 2; linear++) {
    specimen s;
    make(id_, &(recipe){.count = 3, .distortion = 0.2, .no_tension = true, .linear = linear}, &s);
    double *v = new_vector(s.size), *u = new_vector(s.size), *f = new_vector(s.size);
    double *w = new_vector(s.size), *room = new_vector(s.size);
    mixed(&s, 0.1, 5, v);
    turn_all(&s, v, linear ? 0.0 : 1.1, shift, u);
    cdem_body_forces(&s.body, u, f);
    for (uint64_t seed = 0; seed < 4; seed++) {
      shake(&s, 1.0, 11 + seed, w);
      double h = 1e-6, power = 0.0, scale = 0.0;
      for (int64_t i = 0; i < s.size; i++) {
        power -= f[i] * w[i];
        scale += fabs(f[i] * w[i]);
      }
      double near = energy_along(&s, u, w, h, room) - energy_along(&s, u, w, -h, room);
      double far = energy_along(&s, u, w, 2 * h, room) - energy_along(&s, u, w, -2 * h, room);
      check_near((8.0 * near - far) / (12.0 * h), power, 0.0, 1e-8 * scale);
    }
    free(v), free(u), free(f), free(w), free(room);
    specimen_release(&s);
  }
}

/* A rigid motion turns the forces and keeps the energy; forces have neither resultant nor moment;
 * the energy is never negative, nor above that with tension. */
static void frame_indifferent_and_balanced(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    specimen s, elastic;
    make(id_, &(recipe){.count = 3, .distortion = 0.2, .no_tension = true}, &s);
    make(id_, &(recipe){.count = 3, .distortion = 0.2}, &elastic);
    int dofs = s.body.dofs, moving = s.model.dimension;
    double *v = new_vector(s.size), *u = new_vector(s.size), *f = new_vector(s.size);
    double *g = new_vector(s.size);
    mixed(&s, 0.05, 21, v);
    cdem_body_forces(&s.body, v, f);
    double energy = cdem_body_energy(&s.body, v, NULL), scale = largest(f, s.size);
    assert_true(energy > 0.0 && energy < 0.9 * cdem_body_energy(&elastic.body, v, NULL));
    for (int a = 0; a < ANGLES; a++) {
      double r[9], sum[3] = {0}, moment[3] = {0};
      rotation_about(moving, angles[a], r);
      turn_all(&s, v, angles[a], shift, u);
      cdem_body_forces(&s.body, u, g);
      for (int32_t n = 0; n < s.body.nodes; n++) {
        const double *here = g + (int64_t)n * dofs;
        double x[3] = {0}, force[3] = {0}, part[3];
        for (int i = 0; i < moving; i++) {
          double turned = 0.0;
          for (int k = 0; k < moving; k++)
            turned += r[3 * i + k] * f[(int64_t)n * dofs + k];
          check_near(here[i], turned, 0.0, 1e-12 * scale);
          x[i] = s.mesh.xyz[3 * (int64_t)n + i] + u[(int64_t)n * dofs + i];
          force[i] = here[i];
          sum[i] += here[i];
        }
        cdem_cross3(x, force, part);
        for (int i = 0; i < 3; i++)
          moment[i] += part[i] + (dofs > moving && i == 2 ? here[2] : 0.0);
      }
      check_below(cdem_norm3(sum), 1e-11 * scale);
      check_below(cdem_norm3(moment), 1e-11 * scale);
      check_near(cdem_body_energy(&s.body, u, NULL), energy, 1e-11, 0.0);
    }
    free(v), free(u), free(f), free(g);
    specimen_release(&s);
    specimen_release(&elastic);
  }
}

/* Of all even openings of an element the one that is taken leaves its springs the least energy:
 * that of a linear body whose motion has another one, b, taken out is no less. (It would be less
 * for the strain at the centre of a distorted solid in place of its mean.) */
static void no_opening_is_better(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    specimen s, elastic;
    recipe how = {.count = 2, .distortion = 0.25, .linear = true};
    make(id_, &how, &elastic);
    how.no_tension = true;
    make(id_, &how, &s);
    int dofs = s.body.dofs, moving = s.model.dimension;
    double *u = new_vector(s.size), *v = new_vector(s.size);
    double least[64 * CDEM_CLASSES], other[64 * CDEM_CLASSES];
    assert_true(s.model.cells <= 64);
    mixed(&s, 1e-2, 4, u);
    cdem_body_cell_fields(&s.body, u, &(cdem_body_fields){.energy = least});
    cdem_random random = {9};
    for (int32_t cell = 0; cell < s.model.cells; cell++) {
      cdem_body_element at;
      cdem_body_element_at(&s.body, u, cell, &at);
      const double *a = at.opening;
      const double own[9] = {a[0],     a[5] / 2, a[4] / 2, a[5] / 2, a[1],
                             a[3] / 2, a[4] / 2, a[3] / 2, a[2]};
      for (int k = 0; k < 20; k++) {
        double n[3], keep = k == 0 ? 1.0 : cdem_random_uniform(&random, 0.9, 1.1);
        double size = k == 0 ? 0.0 : 1e-5 * pow(10.0, k % 4);
        for (int i = 0; i < 3; i++)
          n[i] = i < moving ? cdem_random_uniform(&random, -1.0, 1.0) : 0.0;
        for (int64_t i = 0; i < s.size; i++) {
          const double *x = s.mesh.xyz + 3 * (i / dofs);
          int c = (int)(i % dofs);
          v[i] = u[i];
          if (c < moving)
            v[i] -= keep * cdem_dot3(own + 3 * c, x) + size * n[c] * cdem_dot3(n, x);
        }
        cdem_body_cell_fields(&elastic.body, v, &(cdem_body_fields){.energy = other});
        double mine = 0.0, its = 0.0;
        for (int c = 0; c < CDEM_CLASSES; c++) {
          mine += least[CDEM_CLASSES * cell + c];
          its += other[CDEM_CLASSES * cell + c];
        }
        if (k == 0)
          check_near(its, mine, 1e-9, 1e-12 * 40e9 * 1e-4);
        assert_true(its >= mine - 1e-12 * (fabs(its) + 40e9 * 1e-4));
      }
    }
    free(u), free(v);
    specimen_release(&s);
    specimen_release(&elastic);
  }
}

/* u = e x, all nodes. */
static void strain_all(const specimen *s, double xx, double yy, double zz, double *u) {
  const double e[3] = {xx, yy, zz};
  for (int64_t i = 0; i < s->size; i++)
    u[i] = i % s->body.dofs < s->model.dimension
               ? e[i % s->body.dofs] * s->mesh.xyz[3 * (i / s->body.dofs) + i % s->body.dofs]
               : 0.0;
}

/* A bar pressed, pulled and pressed again: the linear body to the bit, nothing, and the first
 * forces again, for there is no history. */
static void pressed_then_pulled(void **state) {
  (void)state;
  EACH_ELEMENT(element) for (int plane = 0; plane < 2; plane++) {
    specimen s, elastic;
    recipe how = {.count = 3, .distortion = 0.2, .plane = (cdem_plane)plane};
    make(id_, &how, &elastic);
    how.no_tension = true;
    make(id_, &how, &s);
    double *u = new_vector(s.size), *f = new_vector(s.size), *g = new_vector(s.size);
    strain_all(&s, -1e-3, -1e-4, -2e-4, u);
    cdem_body_forces(&s.body, u, f);
    cdem_body_forces(&elastic.body, u, g);
    assert_memory_equal(f, g, (size_t)s.size * sizeof *f);
    double energy = cdem_body_energy(&elastic.body, u, NULL), full = largest(g, s.size);
    assert_true(cdem_body_energy(&s.body, u, NULL) == energy);
    strain_all(&s, 1e-3, 0.0, 0.0, u);
    cdem_body_forces(&s.body, u, f);
    check_below(largest(f, s.size), 1e-12 * full);
    check_near(cdem_body_energy(&s.body, u, NULL), 0.0, 0.0, 1e-12 * energy);
    strain_all(&s, -1e-3, -1e-4, -2e-4, u);
    cdem_body_forces(&s.body, u, f);
    assert_memory_equal(f, g, (size_t)s.size * sizeof *f);
    free(u), free(f), free(g);
    specimen_release(&s);
    specimen_release(&elastic);
  }
}

/* Fields of an even strain that is wide open along x: y keeps the modulus of the sheet, all three
 * ways to the stress say so, and classes of springs add up to the energy. */
static void fields_show_what_is_carried(void **state) {
  (void)state;
  EACH_ELEMENT(element) for (int plane = 0; plane < 2; plane++) {
    specimen s;
    make(id_,
         &(recipe){.count = 3, .distortion = 0.2, .no_tension = true, .plane = (cdem_plane)plane},
         &s);
    bool solid = s.model.dimension == 3, cubic = id_ >= CDEM_ELEMENT_COUNT;
    int64_t cells = s.model.cells;
    double *v = new_vector(s.size), *u = new_vector(s.size), *cell = new_vector(24 * cells);
    double *node = new_vector(6 * (int64_t)s.body.nodes), r[9];
    cdem_body_fields fields = {
        .stress = cell, .strain = cell + 6 * cells, .energy = cell + 12 * cells};
    strain_all(&s, 5e-3, -1e-3, 0.0, v);
    turn_all(&s, v, angles[2], shift, u);
    rotation_about(s.model.dimension, angles[2], r);
    cdem_body_cell_fields(&s.body, u, &fields);
    cdem_body_cell_stress(&s.body, u, cell + 15 * cells);
    cdem_body_node_stress(&s.body, u, node);
    double nu = 0.23, young = 40e9, across = 0.0, along;
    along = solid || plane == 0 ? -1e-3 * young / (1 - nu * nu) : -1e-3 * young;
    across = solid || plane == 0 ? nu * along : 0.0;
    if (cubic) /* uniaxial stress along an axis of (60, 20) GPa; nothing is known of z */
      along = -1e-3 * (60e9 - 400e18 / 60e9), across = 0.0;
    for (int i = 0; i < 3; i++) {
      double want = r[3 * i + 1] * r[3 * i + 1] * along + r[3 * i + 2] * r[3 * i + 2] * across;
      for (int64_t c = 0; c < cells; c++) {
        check_near(fields.stress[6 * c + i], want, 0.0, 1e-12 * 1e9);
        check_near(cell[15 * cells + 6 * c + i], want, 0.0, 1e-12 * 1e9);
      }
      for (int64_t n = 0; n < s.body.nodes; n++)
        check_near(node[6 * n + i], want, 0.0, 1e-11 * 1e9);
    }
    double by_class[CDEM_CLASSES], sums[CDEM_CLASSES] = {0};
    double whole = cdem_body_energy(&s.body, u, by_class), volume = solid ? 1.3 * 0.9 : 1.3 * 0.7;
    check_near(whole, 0.5 * volume * along * -1e-3, 1e-11, 0.0);
    for (int64_t i = 0; i < CDEM_CLASSES * cells; i++)
      sums[i % CDEM_CLASSES] += fields.energy[i];
    for (int c = 0; c < CDEM_CLASSES; c++)
      check_near(sums[c], by_class[c], 1e-11, 1e-11 * whole);
    for (int64_t c = 0; c < cells; c++) /* strain with what has opened: the trace is that of u */
      check_near(fields.strain[6 * c] + fields.strain[6 * c + 1] +
                     (solid ? fields.strain[6 * c + 2] : 0.0),
                 4e-3, 1e-10, 0.0);
    free(v), free(u), free(cell), free(node);
    specimen_release(&s);
  }
}

/* 1, 2 and 4 threads: the same bits, over several tiles. */
static void threads_change_nothing(void **state) {
  (void)state;
  EACH_ELEMENT(element) {
    double *f[3], energy[3];
    for (int t = 0; t < 3; t++) {
      specimen s;
      int32_t count = cdem_element_dimension(element) == 3 ? 10 : 30;
      make(id_, &(recipe){.count = count, .distortion = 0.2, .no_tension = true, .threads = 1 << t},
           &s);
      assert_true(s.body.store->tiles > 1);
      double *u = new_vector(s.size);
      f[t] = new_vector(s.size);
      mixed(&s, 1e-3, 8, u);
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

/* Vectors of 8, 4 and 2 doubles agree on what openings add to the forces. */
static void widths_agree(void **state) {
  (void)state;
  const cdem_body_kernels *two = cdem_body_kernels_of_width(2);
  EACH_ELEMENT(element) {
    specimen s;
    make(id_, &(recipe){.count = 3, .distortion = 0.2, .no_tension = true}, &s);
    double *v = new_vector(s.size), *u = new_vector(s.size), f[192], g[192];
    double full = 0.0, off = 0.0;
    mixed(&s, 0.02, 2, v);
    turn_all(&s, v, 2.0, shift, u);
    for (int width = 4; width <= 8; width *= 2) {
      const cdem_body_kernels *kernels = cdem_body_kernels_of_width(width);
      for (int64_t n = 0; kernels != NULL && n < s.body.store->batches; n++) {
        cdem_body_task task = cdem_body_task_of(&s.body, u, n);
        memset(f, 0, sizeof f);
        memset(g, 0, sizeof g);
        cdem_body_tension_forces(&s.body, two, &task, n, f);
        cdem_body_tension_forces(&s.body, kernels, &task, n, g);
        full = fmax(full, largest(f, 192));
        off = fmax(off, difference(f, g, 192));
      }
    }
    check_below(off, 1e-13 * full);
    free(v), free(u);
    specimen_release(&s);
  }
}

/* Only some of the cells: the others feel what they did. Batches then hold both kinds. */
static void materials_mix(void **state) {
  (void)state;
  cdem_fault fault = {0};
  EACH_ELEMENT(element) {
    specimen s;
    make(id_, &(recipe){.count = 4, .distortion = 0.2}, &s);
    int32_t half[512], count = 0;
    for (int32_t i = 0; i < s.model.cells && count < 512; i += 2)
      half[count++] = s.model.cell[i];
    check_ok(cdem_mesh_add_group(&s.mesh, "loose", s.model.dimension, count, half, &fault));
    cdem_body_release(&s.body);
    cdem_model_release(&s.model);
    const char *const loose[] = {"loose"};
    const int second[] = {1};
    const double density[2] = {2700, 2700};
    const bool no_tension[2] = {false, true};
    cdem_material material[2] = {s.material, s.material};
    cdem_model_options options = {.mesh = &s.mesh,
                                  .materials = 2,
                                  .material = material,
                                  .assignments = 1,
                                  .assigned_group = loose,
                                  .assigned_material = second,
                                  .section = {CDEM_PLANE_STRAIN, 0.7}};
    check_ok(cdem_model_init(&options, &s.model, &fault));
    cdem_body_options body = {.density = density, .no_tension = no_tension};
    check_ok(cdem_body_init(&s.model, &body, &s.body, &fault));
    assert_int_equal(s.body.tensionless, 1);
    double *u = new_vector(s.size), *f = new_vector(s.size), *g = new_vector(s.size);
    double *fields = new_vector(12 * (int64_t)s.model.cells);
    mixed(&s, 0.02, 3, u);
    cdem_body_forces(&s.body, u, f);
    cdem_body_forces_reference(&s.body, u, g);
    check_below(difference(f, g, s.size), 2e-13 * largest(g, s.size));
    cdem_body_fields slow = {.stress = fields};
    double *quick = fields + 6 * (int64_t)s.model.cells;
    cdem_body_cell_fields(&s.body, u, &slow);
    cdem_body_cell_stress(&s.body, u, quick);
    check_below(difference(fields, quick, 6 * (int64_t)s.model.cells), 1e-13 * 40e9);
    free(u), free(f), free(g), free(fields);
    specimen_release(&s);
  }
}

static void only_isotropic_moduli(void **state) {
  (void)state;
  cdem_fault fault = {0};
  specimen s;
  const bool no_tension = true;
  specimen_make(cdem_element_find("hex8"), &(recipe){.count = 1}, &s);
  cdem_body_release(&s.body);
  cdem_model_release(&s.model);
  s.material.model = CDEM_ORTHOTROPIC;
  const double moduli[9] = {1e9, 1e9, 2e9, 0.1, 0.1, 0.1, 4e8, 4e8, 4e8};
  memcpy(s.material.parameter, moduli, sizeof moduli);
  snprintf(s.material.name, sizeof s.material.name, "wood");
  specimen_build(&(recipe){.count = 1}, &s);
  cdem_body body;
  cdem_body_options options = {.density = &s.density, .no_tension = &no_tension};
  check_fails(cdem_body_init(&s.model, &options, &body, &fault), CDEM_INPUT,
              "material 'wood' is orthotropic and cannot be without tension: that law wants "
              "isotropic moduli");
  specimen_release(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fast_is_reference),
      cmocka_unit_test(force_is_the_gradient),
      cmocka_unit_test(frame_indifferent_and_balanced),
      cmocka_unit_test(no_opening_is_better),
      cmocka_unit_test(pressed_then_pulled),
      cmocka_unit_test(fields_show_what_is_carried),
      cmocka_unit_test(threads_change_nothing),
      cmocka_unit_test(widths_agree),
      cmocka_unit_test(materials_mix),
      cmocka_unit_test(only_isotropic_moduli),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
