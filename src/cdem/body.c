/* Building the elastic body: kinds, masses, templates, batches, gather lists. */
#include "cdem/body.h"

#include "cdem/body_store.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static cdem_status check_order(const cdem_model *model, cdem_fault *fault) {
  for (int32_t i = 0; i < model->cells; i++) {
    const cdem_element *element = cdem_model_element(model, i);
    const cdem_shape_info *shape = cdem_shape_get(element->shape);
    CDEM_REQUIRE(shape->nodes == shape->corners, fault, CDEM_INPUT,
                 "element %" PRId64 " (%s) is of second order: a body that moves takes first-order "
                 "elements only; mesh the volume with order 1",
                 model->mesh->cell_tag[model->cell[i]], element->name);
  }
  return CDEM_OK;
}

static cdem_status check_materials(const cdem_model *model, const cdem_body_options *options,
                                   cdem_fault *fault) {
  for (int32_t i = 0; i < model->cells; i++) {
    int m = model->material[i];
    double density = options->density[m];
    CDEM_REQUIRE(density > 0.0 && isfinite(density), fault, CDEM_INPUT,
                 "density of material '%s' = %g kg/m^3 is out of range: it must be positive",
                 model->materials_of[m].name, density);
    if (model->formulation != CDEM_PLANE_COSSERAT || options->micro_inertia == NULL)
      continue;
    double inertia = options->micro_inertia[m];
    CDEM_REQUIRE(inertia > 0.0 && isfinite(inertia), fault, CDEM_INPUT,
                 "micro-inertia of material '%s' = %g m^2 is out of range: it must be positive",
                 model->materials_of[m].name, inertia);
  }
  return CDEM_OK;
}

static cdem_status copy_materials(const cdem_model *model, const cdem_body_options *options,
                                  cdem_body_store *store, cdem_fault *fault) {
  CDEM_BODY_NEW(store, store->density, model->materials, fault);
  CDEM_BODY_NEW(store, store->micro_inertia, model->materials, fault);
  for (int m = 0; m < model->materials; m++) {
    store->density[m] = options->density[m];
    store->micro_inertia[m] = options->micro_inertia != NULL
                                  ? options->micro_inertia[m]
                                  : cdem_material_micro_inertia(&model->materials_of[m]);
  }
  CDEM_BODY_NEW(store, store->law, model->materials, fault);
  for (int32_t i = 0; i < model->cells; i++) {
    int m = model->material[i];
    if (store->law[m].strain[0][0] == 0.0) /* not yet built */
      CDEM_TRY(cdem_body_law_build(model, m, &store->law[m], fault));
  }
  return CDEM_OK;
}

static cdem_status make_kinds(const cdem_model *model, cdem_body_store *store, cdem_fault *fault) {
  CDEM_BODY_NEW(store, store->kind, model->kinds, fault);
  store->kinds = model->kinds;
  for (int k = 0; k < model->kinds; k++) {
    const cdem_model_kind *from = &model->kinds_of[k];
    const cdem_element *element = from->tabulation.element;
    cdem_body_kind *kind = &store->kind[k];
    kind->formulation = model->formulation;
    kind->dimension = model->dimension;
    kind->dofs = model->dofs;
    kind->nodes = cdem_element_nodes(element);
    kind->pairs = cdem_element_pairs(element);
    kind->place = kind->dimension * kind->dimension;
    kind->spring = kind->place + kind->dimension * (kind->nodes - 1);
    kind->record = kind->spring + kind->dofs * kind->dofs * kind->pairs;
    double centre[3] = {0};
    for (int a = 0; a < kind->nodes; a++)
      for (int c = 0; c < 3; c++)
        centre[c] += element->reference[a][c] / kind->nodes;
    element->shape_functions(centre, kind->shape, kind->derivative);
    for (int p = 0; p < kind->pairs; p++)
      kind->class_[p] = (uint8_t)(from->class_[p] - CDEM_CLASS_EDGE);
  }
  return CDEM_OK;
}

/* Row sums of the consistent mass: density times the integrals of the shape functions. */
static cdem_status make_masses(const cdem_model *model, cdem_body *body, cdem_fault *fault) {
  enum { CHUNK = 65536 };
  cdem_body_store *store = body->store;
  double *share;
  CDEM_BODY_NEW(store, store->volume, body->nodes, fault);
  CDEM_NEW(body->mass, (int64_t)body->nodes * body->dofs, fault);
  CDEM_NEW(share, (int64_t)CHUNK * CDEM_BODY_NODES, fault);
  for (int32_t first = 0; first < model->cells; first += CHUNK) {
    int32_t last = model->cells - first < CHUNK ? model->cells : first + CHUNK;
#pragma omp parallel for schedule(static)                                                          \
    num_threads(body->threads) if (last - first > CDEM_BODY_TILE)
    for (int32_t i = first; i < last; i++)
      cdem_body_shares(model, i, share + (int64_t)CDEM_BODY_NODES * (i - first));
    for (int32_t i = first; i < last; i++) {
      const int32_t *node = cdem_mesh_cell(model->mesh, model->cell[i]);
      const cdem_body_kind *kind = &store->kind[model->kind[i]];
      for (int a = 0; a < kind->nodes; a++) {
        double volume = share[CDEM_BODY_NODES * (i - first) + a];
        double mass = store->density[model->material[i]] * volume;
        store->volume[node[a]] += volume;
        for (int c = 0; c < kind->dofs; c++)
          body->mass[(int64_t)node[a] * kind->dofs + c] +=
              c < kind->dimension ? mass : mass * store->micro_inertia[model->material[i]];
      }
    }
  }
  free(share);
  return CDEM_OK;
}

static int first_tensionless(const cdem_model *model, const bool *no_tension) {
  int first = INT_MAX;
  for (int32_t i = 0; i < model->cells && no_tension != NULL; i++)
    if (no_tension[model->material[i]] && model->material[i] < first)
      first = model->material[i];
  return first < INT_MAX ? first : -1;
}

static cdem_status make_store(const cdem_model *model, const cdem_body_options *options,
                              cdem_body *body, cdem_fault *fault) {
  cdem_body_store *store = body->store;
  int32_t *template_of;
  CDEM_TRY(copy_materials(model, options, store, fault));
  CDEM_TRY(make_kinds(model, store, fault));
  CDEM_TRY(make_masses(model, body, fault));
  CDEM_NEW(template_of, model->cells, fault);
  cdem_status status = cdem_body_congruent(model, options->separate, body->threads, template_of,
                                           &body->distinct, fault);
  if (status == CDEM_OK)
    status = cdem_body_arrange(model, template_of, store, fault);
  free(template_of);
  CDEM_TRY(status);
  CDEM_TRY(cdem_body_fill(model, body->threads, store, fault));
  CDEM_TRY(cdem_body_tension_fill(model, options->no_tension, store, fault));
  return cdem_body_link(model, body->threads, store, fault);
}

cdem_status cdem_body_init(const cdem_model *model, const cdem_body_options *options,
                           cdem_body *body, cdem_fault *fault) {
  memset(body, 0, sizeof *body);
  CDEM_TRY(check_order(model, fault));
  CDEM_TRY(check_materials(model, options, fault));
  cdem_body made = {.model = model,
                    .dofs = model->dofs,
                    .nodes = model->mesh->nodes,
                    .threads = options->threads > 0 ? options->threads : omp_get_max_threads(),
                    .linear = options->linear,
                    .tensionless = first_tensionless(model, options->no_tension),
                    .inverted = -1};
  CDEM_NEW(made.store, 1, fault);
  cdem_status status = make_store(model, options, &made, fault);
  if (status != CDEM_OK)
    cdem_body_release(&made);
  *body = made;
  return status;
}

void cdem_body_release(cdem_body *body) {
  cdem_body_store *store = body->store;
  free(body->mass);
  if (store != NULL) {
    free(store->kind);
    free(store->batch);
    free(store->cell);
    free(store->place);
    free(store->id);
    free(store->data);
    free(store->tile_batch);
    free(store->tile_node);
    free(store->target);
    free(store->entry_start);
    free(store->entry);
    free(store->joint);
    free(store->joint_start);
    free(store->partial);
    free(store->lonely_node);
    free(store->buffer);
    free(store->tile_energy);
    free(store->law);
    free(store->tension);
    free(store->mean_start);
    free(store->mean);
    free(store->volume);
    free(store->density);
    free(store->micro_inertia);
    free(store);
  }
  memset(body, 0, sizeof *body);
}

int64_t cdem_body_traffic(const cdem_body *body) {
  const cdem_body_store *store = body->store;
  int64_t entries = store->entry_start[store->tile_node[store->tiles]];
  return (store->own_doubles + store->own_means) * (int64_t)sizeof(double) +
         store->ids * CDEM_LANES * (int64_t)sizeof(int32_t) + entries * (int64_t)sizeof(uint16_t) +
         2 * (int64_t)body->nodes * body->dofs * (int64_t)sizeof(double);
}

int64_t cdem_body_memory(const cdem_body *body) {
  return body->store->bytes + (int64_t)body->nodes * body->dofs * (int64_t)sizeof(double);
}

cdem_status cdem_body_stiffness(const cdem_body *body, cdem_sparse *stiffness, cdem_fault *fault) {
  cdem_sparse made = {0};
  cdem_status status = cdem_sparse_init(body->model, &made, fault);
  if (status == CDEM_OK) {
    cdem_pair_sink sink = cdem_sparse_sink(&made);
    cdem_convert_options options = {.threads = body->threads};
    status = cdem_network_convert(body->model, &options, &sink, 1, fault);
  }
  if (status != CDEM_OK)
    cdem_sparse_release(&made);
  *stiffness = made;
  return status;
}
