/* The springs of a mesh. The model inside is built by the first function that needs it, so that
 * whatever it is told before costs nothing. */
#include "api/store.h"
#include "network/certificate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MODE_ROWS = 30000 }; /* zero modes are counted up to this many rows, as the program does */

struct libcdem_model {
  const cdem_mesh *mesh;
  cdem_material material;
  cdem_material_file file;
  bool has_material, has_file, built;
  cdem_section section;
  cdem_model model;
  libcdem_certificate certificate;
};

_Static_assert((int)LIBCDEM_EDGE == (int)CDEM_CLASS_EDGE &&
                   (int)LIBCDEM_FACE == (int)CDEM_CLASS_FACE &&
                   (int)LIBCDEM_BODY == (int)CDEM_CLASS_BODY,
               "classes are counted alike inside and outside");

const char *libcdem_class_name(libcdem_class kind) {
  return kind <= LIBCDEM_BODY ? cdem_class_name((cdem_class)kind) : "";
}

static cdem_status create(const libcdem_mesh *mesh, libcdem_model **model, cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(mesh, "a mesh", fault));
  CDEM_TRY(cdem_api_want(model, "a place for the model", fault));
  CDEM_NEW(*model, 1, fault);
  (*model)->mesh = &mesh->mesh;
  (*model)->section = (cdem_section){CDEM_PLANE_STRAIN, 1.0};
  return CDEM_OK;
}

libcdem_status libcdem_model_create(const libcdem_mesh *mesh, libcdem_model **model,
                                    libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(create(mesh, model, &own), &own, fault);
}

/* What was built no longer holds. */
static void forget(libcdem_model *model) {
  cdem_model_release(&model->model);
  model->built = false;
}

static void drop_materials(libcdem_model *model) {
  forget(model);
  cdem_material_file_release(&model->file);
  model->has_file = model->has_material = false;
}

void libcdem_model_destroy(libcdem_model **model) {
  if (model == NULL || *model == NULL)
    return;
  drop_materials(*model);
  free(*model);
  *model = NULL;
}

static cdem_status set_material(libcdem_model *model, const char *kind, int parameters,
                                const double *parameter, cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(model, "a model", fault));
  CDEM_TRY(cdem_api_want(kind, "the kind of the material", fault));
  CDEM_TRY(cdem_api_want(parameter, "the parameters of the material", fault));
  cdem_material material = {.name = "material", .model = cdem_material_model_find(kind)};
  CDEM_REQUIRE(material.model != CDEM_MATERIAL_MODEL_COUNT, fault, CDEM_USAGE,
               "there is no material '%.40s'; `cdem list materials` shows them", kind);
  const cdem_material_model_info *info = cdem_material_model_get(material.model);
  CDEM_REQUIRE(parameters >= 0 && parameters <= info->keys, fault, CDEM_USAGE,
               "%d parameters for a material '%s', which has %d", parameters, kind, info->keys);
  for (int k = 0; k < info->keys; k++) {
    CDEM_REQUIRE(k < parameters || info->key[k].optional, fault, CDEM_USAGE,
                 "the material '%s' needs '%s', its parameter %d", kind, info->key[k].key, k + 1);
    material.parameter[k] = k < parameters ? parameter[k] : info->key[k].fallback;
  }
  drop_materials(model);
  model->material = material;
  model->has_material = true;
  return CDEM_OK;
}

libcdem_status libcdem_model_material(libcdem_model *model, const char *kind, int parameters,
                                      const double *parameter, libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(set_material(model, kind, parameters, parameter, &own), &own, fault);
}

static cdem_status read_materials(libcdem_model *model, const char *path, cdem_fault *fault) {
  cdem_material_file file = {0};
  CDEM_TRY(cdem_api_want(model, "a model", fault));
  CDEM_TRY(cdem_api_want(path, "the path of a material file", fault));
  CDEM_TRY(cdem_read_materials(path, &file, fault));
  drop_materials(model);
  model->file = file;
  model->has_file = true;
  return CDEM_OK;
}

libcdem_status libcdem_model_read_materials(libcdem_model *model, const char *path,
                                            libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(read_materials(model, path, &own), &own, fault);
}

static cdem_status set_plane(libcdem_model *model, bool stress, double thickness,
                             cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(model, "a model", fault));
  CDEM_REQUIRE(thickness > 0.0 && isfinite(thickness), fault, CDEM_USAGE,
               "thickness %g m: a length above 0 is wanted", thickness);
  forget(model);
  model->section = (cdem_section){stress ? CDEM_PLANE_STRESS : CDEM_PLANE_STRAIN, thickness};
  return CDEM_OK;
}

libcdem_status libcdem_model_plane(libcdem_model *model, bool stress, double thickness,
                                   libcdem_fault *fault) {
  cdem_fault own = {0};
  return cdem_api_end(set_plane(model, stress, thickness, &own), &own, fault);
}

static cdem_status build(libcdem_model *model, cdem_fault *fault) {
  CDEM_TRY(cdem_api_want(model, "a model", fault));
  if (model->built)
    return CDEM_OK;
  CDEM_REQUIRE(model->has_file || model->has_material, fault, CDEM_USAGE,
               "the model has no material yet");
  cdem_model_options options = {.mesh = model->mesh,
                                .materials = 1,
                                .material = &model->material,
                                .default_material = -1,
                                .section = model->section};
  if (model->has_file) {
    options.materials = model->file.materials;
    options.material = model->file.material;
    options.assignments = model->file.assignments;
    options.assigned_group = (const char *const *)model->file.group;
    options.assigned_material = model->file.material_of;
    options.default_material = model->file.default_material;
  }
  cdem_api_quiet_gsl();
  CDEM_TRY(cdem_mesh_check(model->mesh, fault));
  CDEM_TRY(cdem_model_init(&options, &model->model, fault));
  model->built = true;
  return CDEM_OK;
}

static cdem_status convert(libcdem_model *model, const cdem_pair_sink *sink,
                           const cdem_api_ears *ears, cdem_fault *fault) {
  const cdem_convert_options options = {.frame = CDEM_FRAME_BODY, .progress = ears->progress};
  return cdem_network_convert(&model->model, &options, sink, 1, fault);
}

/* ---- a visitor ---- */

typedef struct {
  const cdem_model *model;
  bool (*visit)(void *context, const libcdem_pair *pair);
  void *context;
} visitor;

static cdem_status show_pairs(void *context, const cdem_chunk *chunk, const cdem_buffer *buffer,
                              cdem_fault *fault) {
  const visitor *v = context;
  const cdem_mesh *mesh = v->model->mesh;
  (void)buffer;
  for (int64_t p = 0; p < chunk->pairs; p++) {
    const cdem_pair *from = &chunk->pair[p];
    libcdem_pair to = {.element = mesh->cell_tag[v->model->cell[from->index]],
                       .node = {mesh->node_tag[from->node[0]], mesh->node_tag[from->node[1]]},
                       .place = {from->local[0], from->local[1]},
                       .kind = (libcdem_class)from->class_};
    cdem_api_springs(&from->set, &to.springs);
    memcpy(to.block, from->block, sizeof to.block);
    CDEM_REQUIRE(v->visit(v->context, &to), fault, CDEM_INTERRUPTED, "stopped by its visitor");
  }
  return CDEM_OK;
}

libcdem_status libcdem_model_visit(libcdem_model *model,
                                   bool (*visit)(void *context, const libcdem_pair *pair),
                                   void *context, const libcdem_listener *listener,
                                   libcdem_fault *fault) {
  cdem_fault own = {0};
  cdem_api_ears ears;
  cdem_api_listen(listener, &ears);
  cdem_status status = build(model, &own);
  if (status == CDEM_OK && visit == NULL)
    status = cdem_fail(&own, CDEM_USAGE, "a visitor is wanted, not NULL");
  if (status == CDEM_OK) {
    visitor v = {&model->model, visit, context};
    const cdem_pair_sink sink = {.context = &v, .write = show_pairs};
    status = convert(model, &sink, &ears, &own);
  }
  return cdem_api_end(status, &own, fault);
}

/* ---- a file ---- */

static cdem_status write_springs(libcdem_model *model, const char *path, const cdem_api_ears *ears,
                                 cdem_fault *fault) {
  cdem_springs_writer *writer = NULL;
  CDEM_TRY(build(model, fault));
  CDEM_TRY(cdem_api_want(path, "the path of a file", fault));
  const cdem_springs_format *format = cdem_springs_format_of(path);
  CDEM_REQUIRE(format != NULL, fault, CDEM_USAGE,
               "the ending of '%.200s' names no format; `cdem list formats` shows them", path);
  CDEM_TRY(format->open(path, &model->model, &writer, fault));
  cdem_status status = convert(model, &writer->sink, ears, fault);
  if (status == CDEM_OK)
    status = writer->commit(writer, fault);
  cdem_springs_writer_destroy(&writer);
  return status;
}

libcdem_status libcdem_model_write(libcdem_model *model, const char *path,
                                   const libcdem_listener *listener, libcdem_fault *fault) {
  cdem_fault own = {0};
  cdem_api_ears ears;
  cdem_api_listen(listener, &ears);
  return cdem_api_end(write_springs(model, path, &ears, &own), &own, fault);
}

/* ---- the certificate ---- */

static cdem_status fill(libcdem_model *model, cdem_certifier *certifier, const cdem_api_ears *ears,
                        cdem_fault *fault) {
  cdem_certificate c;
  const cdem_pair_sink sink = cdem_certifier_sink(certifier);
  CDEM_TRY(convert(model, &sink, ears, fault));
  CDEM_TRY(cdem_certifier_finish(certifier, MODE_ROWS, ears->progress, &c, fault));
  model->certificate = (libcdem_certificate){.holds = cdem_certificate_holds(&c),
                                             .elements = c.elements,
                                             .pairs = c.pairs,
                                             .springs = c.springs,
                                             .rebuild = c.rebuild.value,
                                             .translation = c.translation.value,
                                             .rotation = c.has_rotation ? c.rotation.value : NAN,
                                             .assembled = c.assembled,
                                             .patch = c.patch,
                                             .rigid_modes = c.rigid_modes,
                                             .zero_modes = c.zero_modes};
  return CDEM_OK;
}

static cdem_status certify(libcdem_model *model, const cdem_api_ears *ears,
                           const libcdem_certificate **certificate, cdem_fault *fault) {
  cdem_certifier *certifier = NULL;
  CDEM_TRY(build(model, fault));
  CDEM_TRY(cdem_api_want(certificate, "a place for the certificate", fault));
  CDEM_TRY(cdem_certifier_create(&model->model, &certifier, fault));
  cdem_status status = fill(model, certifier, ears, fault);
  cdem_certifier_destroy(&certifier);
  if (status == CDEM_OK)
    *certificate = &model->certificate;
  return status;
}

libcdem_status libcdem_model_certify(libcdem_model *model, const libcdem_listener *listener,
                                     const libcdem_certificate **certificate,
                                     libcdem_fault *fault) {
  cdem_fault own = {0};
  cdem_api_ears ears;
  cdem_api_listen(listener, &ears);
  return cdem_api_end(certify(model, &ears, certificate, &own), &own, fault);
}
