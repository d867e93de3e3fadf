#include "io/grains_scene.h"

#include "base/version.h"

#include <inttypes.h>
#include <math.h>

double cdem_scene_mass(const cdem_scene *scene, int64_t grain) {
  const cdem_grains *grains = &scene->grains;
  double solid = cdem_grain_solid(grains->dim, grains->radius[grain]);
  return scene->material[grains->material[grain]].density * solid *
         (grains->dim == 2 ? scene->thickness : 1.0);
}

bool cdem_scene_has_law(const cdem_scene *scene, const char *name) {
  return scene->dem != NULL && cdem_dem_options_of(scene->dem)->law == cdem_law_find(name);
}

/* The law is asked for stiffness and dashpots of contacts with m = 0 and with m = 1/k. */
void cdem_scene_contact_of(const cdem_scene *scene, int a, int b, cdem_scene_contact *contact) {
  const cdem_dem_options *model = cdem_dem_options_of(scene->dem);
  const cdem_contact_input *input = &model->contact[a * model->materials + b];
  cdem_contact_model made;
  cdem_fault fault = {0};
  *contact = (cdem_scene_contact){0};
  /* the solver was made of the same numbers */
  if (cdem_contact_model_init(scene->grains.dim, model->law, model->rolling, model->twisting, input,
                              &model->material[a], &model->material[b], &made, &fault) != CDEM_OK)
    return;
  const cdem_law_parameters *numbers = &made.parameters[0];
  double friction = input->value[CDEM_LAW_friction], dashpot[2];
  double rescaling = input->value[CDEM_LAW_rescaling];
  model->law->stiffness(numbers, 1.0, 0.0, 1.0, &contact->normal, &contact->shear,
                        contact->constant);
  model->law->stiffness(numbers, 1.0, 1.0 / contact->normal, 1.0, &contact->normal, &contact->shear,
                        dashpot);
  for (int i = 0; i < 2; i++)
    contact->critical[i] = dashpot[i] - contact->constant[i];
  contact->friction = isnan(friction) ? 0.0 : friction;
  contact->rescaled = isnan(rescaling) || rescaling != 0.0;
}

bool cdem_scene_has_dashpots(const cdem_scene *scene) {
  for (int a = 0; a < scene->materials; a++)
    for (int b = a; b < scene->materials; b++) {
      cdem_scene_contact c;
      cdem_scene_contact_of(scene, a, b, &c);
      for (int i = 0; i < 2; i++)
        if (c.constant[i] > 0.0 || c.critical[i] > 0.0)
          return true;
    }
  return false;
}

void cdem_scene_put_name(FILE *stream, const char *name, char quote) {
  if (quote != '\0')
    fputc(quote, stream);
  for (const unsigned char *c = (const unsigned char *)name; *c != '\0'; c++) {
    if (quote != '\0' && (*c == (unsigned char)quote || *c == '\\'))
      fputc('\\', stream);
    fputc(*c < ' ' ? '?' : *c, stream);
  }
  if (quote != '\0')
    fputc(quote, stream);
}

void cdem_scene_put_head(const cdem_scene *scene, const char *program, const char *lost,
                         FILE *stream) {
  fprintf(stream, "# %" PRId64 " %s for %s, by cdem %s; SI units\n", scene->grains.grains,
          scene->grains.dim == 2 ? "discs" : "spheres", program, cdem_version());
  if (lost[0] != '\0')
    fprintf(stream, "# NOT here: %s\n", lost);
}
