/* Clusters of contact nodes, and their pairs, where both are known. */
#include "dem/clusters.h"

#include "support/test.h"

#include <stdlib.h>

static cdem_fault fault;

enum { MOST = 64 };
typedef struct {
  double xyz[MOST][3], force[MOST][3];
  int32_t owner[MOST], partner[MOST], cluster[MOST];
  cdem_contact_points points;
  int64_t clusters;
} nodes;

static void put(nodes *n, int owner, int partner, double x, double y, double fx) {
  int64_t i = n->points.points++;
  n->xyz[i][0] = x;
  n->xyz[i][1] = y;
  n->force[i][0] = fx;
  n->owner[i] = owner;
  n->partner[i] = partner;
}

static void find(nodes *n, bool known, double reach) {
  n->points.xyz = &n->xyz[0][0];
  n->points.force = &n->force[0][0];
  n->points.owner = n->owner;
  n->points.partner = known ? n->partner : NULL;
  check_ok(cdem_clusters_find(&n->points, reach, n->cluster, &n->clusters, &fault));
}

static cdem_cluster_contacts match(const nodes *n, cdem_cluster_pairing pairing) {
  cdem_cluster_contacts c;
  check_ok(cdem_clusters_match(&n->points, n->cluster, n->clusters, &pairing, &c, &fault));
  return c;
}

/* Grain 0: a chain of three nodes a reach apart (density-connected though its ends are not
 * neighbours), one node alone, one without force; a node of grain 1 in the middle of the chain. */
static void chains_are_one_and_noise_is_its_own(void **state) {
  (void)state;
  nodes n = {0};
  put(&n, 0, 1, 2.0, 0.0, 1.0);
  put(&n, 0, 1, 0.0, 0.0, 1.0);
  put(&n, 1, 0, 1.0, 0.1, 1.0);
  put(&n, 0, 1, 1.0, 0.0, 1.0);
  put(&n, 0, 1, 1.5, 0.0, 0.0);
  put(&n, 0, 1, 5.0, 0.0, 1.0);
  find(&n, false, 1.0);
  assert_int_equal(n.clusters, 3);
  static const int32_t wanted[] = {0, 0, 1, 0, -1, 2};
  assert_memory_equal(n.cluster, wanted, sizeof wanted);
  find(&n, false, 0.99);
  assert_int_equal(n.clusters, 5);
  find(&n, false, 0x1p-3);
  assert_int_equal(n.clusters, 5); /* the node without force never counts */
}

/* Two contacts of one grain that are near each other: parted only by who knows the partners. */
static void partners_part_what_is_near(void **state) {
  (void)state;
  nodes n = {0};
  put(&n, 0, 1, 0.0, 0.0, -1.0);
  put(&n, 0, 2, 0.5, 0.0, -2.0);
  find(&n, false, 1.0);
  assert_int_equal(n.clusters, 1);
  find(&n, true, 1.0);
  assert_int_equal(n.clusters, 2);
}

/* 0 left of 1, two nodes against one; 1 on a plate; 2 touches 0 with one side only. */
static nodes three_grains(void) {
  nodes n = {0};
  put(&n, 0, 1, 1.0, -0.1, -1.0);
  put(&n, 0, 1, 1.0, 0.3, -3.0);
  put(&n, 1, 0, 0.9, 0.1, 5.0);
  put(&n, 1, -3, 3.0, 0.0, -7.0);
  put(&n, 2, 0, -1.0, 0.0, -2.0);
  return n;
}

static void partners_make_pairs(void **state) {
  (void)state;
  nodes n = three_grains();
  find(&n, true, 0.5);
  assert_int_equal(n.clusters, 4);
  cdem_cluster_contacts c = match(&n, (cdem_cluster_pairing){.apart = INFINITY});
  assert_true(c.contacts == 3 && c.single == 1);
  /* both sides have springs of their own: 4 + 5; the middle is (4 (1, 0.2) + 5 (0.9, 0.1))/9 */
  assert_true(c.contact[0].a == 0 && c.contact[0].b == 1 && c.contact[0].push == 9.0);
  assert_true(c.contact[0].normal[0] == 1.0 && c.contact[0].normal[1] == 0.0);
  check_near(c.contact[0].point[0], 8.5 / 9.0, 1e-15, 0.0);
  check_near(c.contact[0].point[1], 1.3 / 9.0, 1e-14, 0.0);
  /* the force on 2 points to -x, away from 0: 0 pushes 2 to the left */
  assert_true(c.contact[1].a == 0 && c.contact[1].b == 2 && c.contact[1].push == 2.0);
  assert_true(c.contact[1].normal[0] == -1.0);
  assert_true(c.contact[2].a == 1 && c.contact[2].b == -3 && c.contact[2].push == 7.0);
  assert_true(c.contact[2].normal[0] == 1.0);
  cdem_push_statistics s;
  check_ok(cdem_push_measure(3, 3, c.contacts, c.contact, 0.0, &s, &fault));
  assert_true(s.mean[CDEM_PUSH_GRAINS] == 5.5 && s.mean[CDEM_PUSH_BOUNDARY] == 7.0);
  cdem_cluster_contacts_release(&c);
  c = match(&n, (cdem_cluster_pairing){.apart = INFINITY, .shared = true});
  assert_true(c.contact[0].push == 4.5);
  cdem_cluster_contacts_release(&c);
  c = match(&n, (cdem_cluster_pairing){.apart = 0.1}); /* 0.14 apart: no pair */
  assert_true(c.contacts == 4 && c.single == 3);
  cdem_cluster_contacts_release(&c);
}

/* As in the source: nearest with an alike force. */
static void without_partners_nearness_and_force_decide(void **state) {
  (void)state;
  nodes n = three_grains();
  find(&n, false, 0.5);
  cdem_cluster_contacts c = match(&n, (cdem_cluster_pairing){.apart = 0.5, .alike = 0.25});
  assert_true(c.contacts == 3 && c.single == 2);
  assert_true(c.contact[0].a == 0 && c.contact[0].b == 1);
  cdem_cluster_contacts_release(&c);
  c = match(&n, (cdem_cluster_pairing){.apart = 0.5, .alike = 0.1}); /* 4 and 5 are not alike */
  assert_true(c.contacts == 4 && c.single == 4 && c.contact[0].b == -1);
  cdem_cluster_contacts_release(&c);
}

/* Two grains that touch twice: each cluster goes to its nearest. */
static void two_contacts_of_one_pair(void **state) {
  (void)state;
  nodes n = {0};
  for (int k = 0; k < 2; k++) {
    put(&n, 0, 1, 1.0, 10.0 * k, -1.0 - k);
    put(&n, 1, 0, 1.0, 10.0 * (1 - k) + 0.1, 2.0 - k);
  }
  for (int known = 0; known < 2; known++) {
    find(&n, known, 1.0);
    cdem_cluster_contacts c = match(&n, (cdem_cluster_pairing){.apart = 20.0, .alike = 1.0});
    assert_true(c.contacts == 2 && c.single == 0);
    for (int k = 0; k < 2; k++)
      check_near(c.contact[k].push, c.contact[k].point[1] < 5.0 ? 2.0 : 4.0, 1e-15, 0.0);
    cdem_cluster_contacts_release(&c);
  }
}

static void refusals(void **state) {
  (void)state;
  nodes n = three_grains();
  find(&n, true, 0.5);
  check_fails(cdem_clusters_find(&n.points, 0.0, n.cluster, &n.clusters, &fault), CDEM_INPUT,
              "the neighbourhood is 0 m; it must be positive");
  cdem_cluster_contacts c;
  check_fails(cdem_clusters_match(&n.points, n.cluster, n.clusters,
                                  &(cdem_cluster_pairing){.apart = 0.0}, &c, &fault),
              CDEM_INPUT, "the largest distance is 0 m");
  n.owner[1] = -1;
  check_fails(cdem_clusters_find(&n.points, 0.5, n.cluster, &n.clusters, &fault), CDEM_INPUT,
              "node 1 belongs to grain -1");
  n.points.points = INT64_C(1) << 31; /* refused before anything is read */
  check_fails(cdem_clusters_find(&n.points, 0.5, n.cluster, &n.clusters, &fault), CDEM_INPUT,
              "2147483648 nodes; there may be 2147483647");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(chains_are_one_and_noise_is_its_own),
      cmocka_unit_test(partners_part_what_is_near),
      cmocka_unit_test(partners_make_pairs),
      cmocka_unit_test(without_partners_nearness_and_force_decide),
      cmocka_unit_test(two_contacts_of_one_pair),
      cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests_name("dem clusters", tests, NULL, NULL);
}
