/* Grains as a Python script for YADE.
 *
 * Law: linear without dashpots is Law2_ScGeom_FrictPhys_CundallStrack, with stiffness and friction
 * by pairs of materials. Dashpots and the other laws have no twin there that holds for all masses.
 * Velocities are those of half a step before, as YADE's integrator keeps them and ours does.
 * Masses and moments of inertia are set one by one, because YADE's bodies are spheres of their own
 * density also where discs are meant. */
#include "io/grains_scene.h"
#include "io/output.h"
#include "io/text.h"

#include <inttypes.h>
#include <stdlib.h>

static const char *lacks(const cdem_scene *scene) {
  if (!cdem_scene_has_law(scene, "linear"))
    return "the law of contact (linear is written)";
  return cdem_scene_has_dashpots(scene) ? "the dashpots of contacts" : NULL;
}

static const char bodies[] =
    "matter = [O.materials.append(FrictMat(young=1e9, poisson=0.3, frictionAngle=0, density=rho, "
    "label=name))\n"
    "          for name, rho in materials]\n"
    "body = []  # ids, in the order of grains\n"
    "for x, r, m, kind, driven, v, w in grains:\n"
    "    body.append(O.bodies.append(sphere(x, radius=r, material=O.materials[matter[kind]])))\n"
    "    state = O.bodies[body[-1]].state\n"
    "    state.mass = m\n"
    "    state.inertia = Vector3(1, 1, 1) * share * m * r**2\n"
    "    state.vel, state.angVel = v, w\n"
    "    state.angMom = state.inertia[2] * Vector3(w)\n"
    "    state.blockedDOFs = 'xyzXYZ' if driven else blocked\n";

static const char engines[] =
    "O.engines = [\n"
    "    ForceResetter(),\n"
    "    InsertionSortCollider([Bo1_Sphere_Aabb()]),\n"
    "    InteractionLoop(\n"
    "        [Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=False)],\n"
    "        [Ip2_FrictMat_FrictMat_FrictPhys(\n"
    "            kn=MatchMaker(matches=[(matter[a], matter[b], c[0]) for (a, b), c in "
    "contacts.items()]),\n"
    "            ks=MatchMaker(matches=[(matter[a], matter[b], c[1]) for (a, b), c in "
    "contacts.items()]),\n"
    "            frictAngle=MatchMaker(matches=[(matter[a], matter[b], atan(c[2])) for (a, b), c "
    "in contacts.items()]))],\n"
    "        [Law2_ScGeom_FrictPhys_CundallStrack()]),\n"
    "    NewtonIntegrator(damping=0, gravity=gravity)]\n";

static void put_vector(FILE *stream, const double x[3], const char *after) {
  for (int c = 0; c < 3; c++)
    cdem_stream_real(stream, c == 0 ? "(" : ", ", x[c], c == 2 ? ")" : "");
  fputs(after, stream);
}

/* Velocity and spin of all grains as YADE keeps them: [grains][6]. */
static cdem_status find_motion(const cdem_scene *scene, double **motion, cdem_fault *fault) {
  const cdem_grains *g = &scene->grains;
  int32_t *grain = NULL;
  CDEM_NEW(*motion, 6 * g->grains, fault);
  for (int64_t i = 0; i < 6 * g->grains; i++)
    (*motion)[i] = i % 6 < 3 ? g->velocity[i / 6 * 3 + i % 6] : g->spin[i / 6 * 3 + i % 6 - 3];
  if (scene->dem == NULL)
    return CDEM_OK;
  CDEM_NEW(grain, g->grains, fault);
  for (int64_t i = 0; i < g->grains; i++)
    grain[i] = (int32_t)i;
  cdem_dem_motions_of(scene->dem, g->grains, grain, *motion);
  free(grain);
  return CDEM_OK;
}

static void put_materials(const cdem_scene *scene, FILE *stream) {
  fputs("materials = [  # name, density\n", stream);
  for (int m = 0; m < scene->materials; m++) {
    fputs("    (", stream);
    cdem_scene_put_name(stream, scene->material[m].name, '\'');
    cdem_stream_real(stream, ", ", scene->material[m].density, "),\n");
  }
  fputs("]\n", stream);
}

static void put_grains(const cdem_scene *scene, const double *motion, FILE *stream) {
  const cdem_grains *g = &scene->grains;
  fputs("grains = [  # centre, radius, mass, material, driven, velocity, spin\n", stream);
  for (int64_t i = 0; i < g->grains; i++) {
    fputs("    (", stream);
    put_vector(stream, g->xyz + 3 * i, "");
    cdem_stream_real(stream, ", ", g->radius[i], "");
    cdem_stream_real(stream, ", ", cdem_scene_mass(scene, i), "");
    fprintf(stream, ", %d, %s, ", g->material[i],
            cdem_scene_is_driven(scene, i) ? "True" : "False");
    put_vector(stream, motion + 6 * i, ", ");
    put_vector(stream, motion + 6 * i + 3, "),\n");
  }
  fputs("]\n", stream);
}

static void put_contacts(const cdem_scene *scene, FILE *stream) {
  fputs("contacts = {  # of two materials: normal and shear stiffness (N/m), friction\n", stream);
  for (int a = 0; a < scene->materials; a++)
    for (int b = a; b < scene->materials; b++) {
      cdem_scene_contact c;
      cdem_scene_contact_of(scene, a, b, &c);
      fprintf(stream, "    (%d, %d): ", a, b);
      put_vector(stream, (double[3]){c.normal, c.shear, c.friction}, ",\n");
    }
  fputs("}\n", stream);
}

static void put_file(const cdem_scene *scene, const double *motion, const char *lost,
                     FILE *stream) {
  bool disc = scene->grains.dim == 2;
  cdem_scene_put_head(scene, "YADE", lost, stream);
  fputs("# Use: exec(open('THIS_FILE').read()), then O.run().\n", stream);
  put_materials(scene, stream);
  put_grains(scene, motion, stream);
  fprintf(stream, "blocked = '%s'\nshare = %s  # of m r^2, moment of inertia\n", disc ? "zXY" : "",
          disc ? "0.5" : "0.4");
  fputs(bodies, stream);
  if (scene->dem == NULL || !cdem_scene_has_law(scene, "linear")) {
    fputs("# Put O.engines and O.dt here.\n", stream);
    return;
  }
  put_contacts(scene, stream);
  fputs("gravity = ", stream);
  put_vector(stream, cdem_dem_options_of(scene->dem)->gravity, "\n");
  cdem_stream_real(stream, "O.dt = ", scene->dem->step, "\n");
  fputs("from math import atan\n", stream);
  fputs(engines, stream);
}

static cdem_status write_yade(const char *path, const cdem_scene *scene, const char *lost,
                              cdem_fault *fault) {
  cdem_output *output;
  CDEM_REQUIRE(scene->dem == NULL || cdem_dem_cell(scene->dem) == NULL, fault, CDEM_INPUT,
               "cannot write '%s': a cell of YADE begins at the origin and is periodic in all "
               "directions; write .data, or take the cell out of the case",
               path);
  double *motion = NULL;
  cdem_status status = find_motion(scene, &motion, fault);
  if (status == CDEM_OK)
    status = cdem_output_open(path, &output, fault);
  if (status == CDEM_OK) {
    put_file(scene, motion, lost, cdem_output_stream(output));
    status = cdem_output_commit(&output, fault);
  }
  free(motion);
  return status;
}

const cdem_grain_format cdem_grain_format_yade = {
    "yade", ".py .yade", "Python script for YADE, spheres or discs", true, write_yade, lacks};
