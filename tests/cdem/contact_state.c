/* Contact: the same bits for any number of threads and after an interruption. */
#include "cdem/contact_support.h"

static void shake(scene *s, cdem_random *random) {
  for (int body = 0; body < s->bodies; body++) {
    double by[3], v[3];
    for (int k = 0; k < 3; k++) {
      by[k] = cdem_random_uniform(random, -0.004, 0.004);
      v[k] = by[k] / 1e-3;
    }
    scene_move(s, body, by);
    scene_velocity(s, body, v);
  }
  status_of_heap(s, 1e-3);
}

static void threads_do_not_matter(void **state) {
  (void)state;
  scene one, many;
  make_heap(&one, 30, 3, 1);
  for (int threads = 2; threads <= 4; threads += 2) {
    cdem_random r = {5}, q = {5};
    make_heap(&many, 30, 3, threads);
    scene_release(&one);
    make_heap(&one, 30, 3, 1);
    for (int step = 0; step < 8; step++) {
      shake(&one, &r);
      shake(&many, &q);
      assert_memory_equal(one.force, many.force,
                          (size_t)one.blocks.mesh.nodes * 3 * sizeof(double));
    }
    cdem_contact_totals a = scene_totals(&one), b = scene_totals(&many);
    assert_true(a.contacts > 20 && a.friction == b.friction && a.damping == b.damping &&
                a.stored == b.stored);
    assert_true(cdem_contact_frequency2(&one.contact) == cdem_contact_frequency2(&many.contact));
    scene_release(&many);
  }
  scene_release(&one);
}

static void an_interruption_does_not_matter(void **state) {
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    scene a, b;
    cdem_fault fault = {0};
    cdem_state saved = {0};
    cdem_random r = {5};
    make_heap(&a, 30, dim, 1);
    make_heap(&b, 30, dim, 1);
    for (int step = 0; step < 6; step++)
      shake(&a, &r);
    check_ok(cdem_contact_save(&a.contact, &saved, &fault));
    check_ok(cdem_contact_restore(&b.contact, &saved, &fault));
    size_t bytes = (size_t)a.blocks.mesh.nodes * (size_t)dim * sizeof(double);
    memcpy(b.u, a.u, bytes);
    memcpy(b.v, a.v, bytes);
    assert_true(cdem_contact_frequency2(&a.contact) == cdem_contact_frequency2(&b.contact));
    cdem_random q = r;
    for (int step = 0; step < 8; step++) {
      shake(&a, &r);
      shake(&b, &q);
      assert_memory_equal(a.force, b.force, bytes);
      cdem_contact_totals x = scene_totals(&a), y = scene_totals(&b);
      assert_memory_equal(&x, &y, sizeof x);
      assert_int_equal(a.contact.version, b.contact.version);
    }
    /* a state of another case */
    scene other;
    make_heap(&other, 10, dim, 1);
    check_fails(cdem_contact_restore(&other.contact, &saved, &fault), CDEM_INPUT,
                "does not belong to this case");
    scene_release(&other);
    cdem_state_release(&saved);
    scene_release(&a);
    scene_release(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(an_interruption_does_not_matter),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
