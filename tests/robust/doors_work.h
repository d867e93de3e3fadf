/* Doors behind which is work: packings, certificates, studies, checks. */
#ifndef CDEM_TESTS_ROBUST_DOORS_WORK_H
#define CDEM_TESTS_ROBUST_DOORS_WORK_H

#include "dem/packing.h"
#include "network/certificate.h"
#include "network/deplete.h"
#include "robust/doors_write.h"
#include "verify/specimen.h"
#include "verify/verify.h"

/* What a door of this file has found out, in bits. */
static uint64_t findings;

static uint64_t found_result(const door *d) {
  (void)d;
  return findings;
}

/* ---- packings ---- */

static cdem_grains packed;

static cdem_packing_options packing_options(bool lattice) {
  return (cdem_packing_options){.dim = 2,
                                .high = {0.2, 0.2, 0.2},
                                .sizes = {.kind = lattice ? CDEM_SIZES_EQUAL : CDEM_SIZES_UNIFORM,
                                          .radius = 0.02,
                                          .least = 0.015,
                                          .most = 0.02},
                                .count = lattice ? 0 : 12,
                                .seed = 3};
}

static cdem_status pack(const door *d, cdem_fault *fault) {
  const cdem_packing *packing = cdem_packing_find(d->text);
  cdem_packing_options options = packing_options(packing->lattice);
  cdem_packing_contacts contacts;
  const bool periodic[3] = {false};
  if (!packing->loose)
    options.count = 0;
  CDEM_TRY(cdem_packing_make(packing, &options, &packed, fault));
  cdem_status status =
      cdem_packing_look(&packed, options.low, options.high, periodic, 1e-6, &contacts, fault);
  if (status != CDEM_OK)
    cdem_grains_release(&packed);
  return status;
}

/* Grains are as they were when pressing them fails. */
static cdem_status pack_and_press(const door *d, cdem_fault *fault) {
  (void)d;
  const cdem_packing_options options = packing_options(false);
  const cdem_compaction compaction = {
      .pressure = 2000.0, .inertial = 1e-1, .tolerance = 0.1, .threads = 1};
  cdem_compacted compacted;
  CDEM_TRY(cdem_packing_make(cdem_packing_find("loose"), &options, &packed, fault));
  uint64_t loose = fold_grains(sum_start, &packed);
  cdem_status status = cdem_packing_compact(&options, &compaction, &packed, &compacted, fault);
  if (status != CDEM_OK) {
    assert_true(fold_grains(sum_start, &packed) == loose);
    cdem_grains_release(&packed);
  }
  return status;
}

static uint64_t pack_result(const door *d) {
  (void)d;
  uint64_t sum = fold_grains(sum_start, &packed);
  cdem_grains_release(&packed);
  return sum;
}

static void pack_failed(const door *d) {
  (void)d;
  assert_true(packed.xyz == NULL && packed.radius == NULL);
}

static const door_kind packing = {NULL, pack, pack_result, pack_failed, NULL, false};
static const door_kind compaction = {NULL, pack_and_press, pack_result, pack_failed, NULL, false};

/* ---- networks ---- */

static cdem_status certify_model(const cdem_model *model, cdem_fault *fault) {
  const cdem_convert_options options = {.threads = 1};
  cdem_certifier *certifier = NULL;
  cdem_certificate certificate = {0};
  CDEM_TRY(cdem_certifier_create(model, &certifier, fault));
  cdem_pair_sink sink = cdem_certifier_sink(certifier);
  cdem_status status = cdem_network_convert(model, &options, &sink, 1, fault);
  if (status == CDEM_OK)
    status = cdem_certifier_finish(certifier, 1000, NULL, &certificate, fault);
  cdem_certifier_destroy(&certifier);
  if (status == CDEM_OK)
    assert_true(cdem_certificate_holds(&certificate));
  findings = fold(sum_start, &certificate.rebuild.value, sizeof(double));
  return status;
}

static cdem_status deplete_model(const cdem_model *model, cdem_fault *fault) {
  const cdem_convert_options options = {.threads = 1};
  const cdem_removal removal = {.text = "1-2", .node = {1, 2}, .class_ = -1, .form = -1};
  const cdem_depletion_options out = {1, &removal, 1000};
  cdem_depletion depletion = {0};
  cdem_status status = cdem_network_deplete(model, &options, &out, &depletion, fault);
  findings = fold(sum_start, &depletion.lowest, sizeof(double));
  return status;
}

static cdem_status network_work(const door *d, cdem_fault *fault) {
  cdem_mesh mesh = {0};
  cdem_model model = {0};
  cdem_status status = make_model(&some_rock, &model, &mesh, fault);
  if (status == CDEM_OK)
    status = strcmp(d->text, "certify") == 0 ? certify_model(&model, fault)
                                             : deplete_model(&model, fault);
  cdem_model_release(&model);
  cdem_mesh_release(&mesh);
  return status;
}

static const door_kind network = {NULL, network_work, found_result, NULL, NULL, false};

/* ---- springs against Poisson's ratio ---- */

static cdem_status study_pair(cdem_specimen_pair *pair, cdem_fault *fault) {
  const cdem_poisson_family family = cdem_specimen_family(pair);
  cdem_poisson_study study;
  cdem_poisson_row row = {0};
  CDEM_TRY(cdem_poisson_study_init(&family, &study, fault));
  for (int i = 0; i < 5; i++) {
    CDEM_TRY(cdem_poisson_follow(&study, -0.2 + 0.15 * i, &row, fault));
    findings = fold(findings, row.k, sizeof row.k);
  }
  return CDEM_OK;
}

static cdem_status study(const door *d, cdem_fault *fault) {
  const cdem_specimen_options options = {.element = cdem_element_find(d->text)};
  cdem_specimen specimen = {0};
  findings = sum_start;
  cdem_status status = cdem_specimen_init(&options, &specimen, fault);
  for (int p = 0; status == CDEM_OK && p < cdem_element_pairs(options.element); p++) {
    cdem_specimen_pair pair = cdem_specimen_pair_at(&specimen, p);
    status = study_pair(&pair, fault);
  }
  cdem_specimen_release(&specimen);
  return status;
}

static const door_kind poisson = {NULL, study, found_result, NULL, NULL, false};

/* ---- checks ---- */

static void not_skipped(void *context, const char *group, const char *name, const char *reason) {
  (void)context;
  fail_msg("%s, %s was skipped: %s", group, name, reason);
}

/* The first quick check of a group. */
static cdem_status check_group(const door *d, cdem_fault *fault) {
  const cdem_verify_group *group = cdem_verify_group_find(d->text);
  const cdem_verify_options options = {.skipped = not_skipped};
  cdem_check_list list = {0};
  int64_t done = 0;
  int first = 0;
  while (group->check[first].slow)
    first++;
  const cdem_verify_group one = {group->name, group->summary, 1, &group->check[first]};
  cdem_status status = cdem_verify_run_group(&one, &options, &done, 1, &list, fault);
  if (status == CDEM_OK)
    findings = fold(sum_start, &list.check[0].value, sizeof(double));
  cdem_check_list_release(&list);
  return status;
}

static const door_kind verification = {NULL, check_group, found_result, NULL, NULL, false};

#endif
