/* The assembled network as a Python script for YADE.
 *
 * Nodes are spheres that cannot turn. A pair of line form (springs_pairs.h) is an interaction of
 * ScGeom6D and CohFrictPhys, with kn = along and ks = across, that neither breaks nor slides; its
 * normal force is kn times the elongation. YADE adds up the shear over the steps, to first order
 * ks times the displacement across. What is left over of a pair acts in a PyRunner, on the
 * displacements from the places of the start: exact, and as slow as Python. */
#include "io/output.h"
#include "io/springs_pairs.h"
#include "io/text.h"

#include <inttypes.h>

static const char engines[] =
    "body = O.bodies.append([sphere(n[1:], radius=radius, material=matter) for n in nodes])\n"
    "id_of = {n[0]: b for n, b in zip(nodes, body)}  # by the tag of the mesh\n"
    "for b in body:\n"
    "    O.bodies[b].state.mass = 1.0\n"
    "    O.bodies[b].state.blockedDOFs = blocked\n"
    "\n"
    "\n"
    "def pull_others():\n"
    "    for i, j, s in others:\n"
    "        a, b = O.bodies[body[i]].state, O.bodies[body[j]].state\n"
    "        u = (b.pos - b.refPos) - (a.pos - a.refPos)\n"
    "        O.forces.addF(body[i], s * u)\n"
    "        O.forces.addF(body[j], -(s.transpose() * u))\n"
    "\n"
    "\n"
    "contacts = InteractionLoop(\n"
    "    [Ig2_Sphere_Sphere_ScGeom6D(avoidGranularRatcheting=False)],\n"
    "    [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],\n"
    "    [Law2_ScGeom6D_CohFrictPhys_CohesionMoment()])\n"
    "O.engines = [ForceResetter(), contacts]\n"
    "if others:\n"
    "    O.engines = O.engines + [PyRunner(command='pull_others()', iterPeriod=1)]\n"
    "O.engines = O.engines + [NewtonIntegrator(damping=0, gravity=(0, 0, 0))]\n"
    "for i, j, kn, ks in springs:\n"
    "    joined = createInteraction(body[i], body[j])\n"
    "    joined.phys.kn, joined.phys.ks = kn, ks\n"
    "    joined.phys.unp = joined.geom.penetrationDepth  # no force at the start\n"
    "    joined.phys.normalAdhesion = joined.phys.shearAdhesion = 1e300\n"
    "    joined.phys.cohesionBroken = joined.phys.fragile = False\n"
    "    joined.phys.cohesionDisablesFriction = True\n";

static void put_nodes(const cdem_matrix_writer *matrix, FILE *stream) {
  const cdem_mesh *mesh = matrix->model->mesh;
  fputs("nodes = [  # tag, x, y, z\n", stream);
  for (int32_t p = 0; p < matrix->sparse.nodes; p++) {
    const double *x = mesh->xyz + 3 * (int64_t)matrix->sparse.node[p];
    fprintf(stream, "    (%" PRId64, mesh->node_tag[matrix->sparse.node[p]]);
    for (int c = 0; c < 3; c++)
      cdem_stream_real(stream, ", ", x[c], c == 2 ? "),\n" : "");
  }
  fputs("]\n", stream);
}

static void put_springs(const cdem_line_pairs *pairs, FILE *stream) {
  fputs("springs = [  # places in nodes, stiffness along and across, N/m\n", stream);
  for (int64_t i = 0; i < pairs->pairs; i++) {
    const cdem_line_pair *pair = &pairs->pair[i];
    if (pair->along == 0.0 && pair->across == 0.0)
      continue;
    fprintf(stream, "    (%" PRId32 ", %" PRId32, pair->position[0], pair->position[1]);
    cdem_stream_real(stream, ", ", pair->along, "");
    cdem_stream_real(stream, ", ", pair->across, "),\n");
  }
  fputs("]\n", stream);
}

static void put_others(const cdem_line_pairs *pairs, int dofs, FILE *stream) {
  fputs("others = [  # places in nodes, tensor: the force on the first is tensor (u_j - u_i)\n",
        stream);
  for (int64_t i = 0; i < pairs->pairs; i++) {
    const cdem_line_pair *pair = &pairs->pair[i];
    if (!pair->has_other)
      continue;
    fprintf(stream, "    (%" PRId32 ", %" PRId32 ", Matrix3(", pair->position[0],
            pair->position[1]);
    for (int e = 0; e < 9; e++) {
      bool inside = e / 3 < dofs && e % 3 < dofs;
      cdem_stream_real(stream, e > 0 ? ", " : "", inside ? pair->other[e / 3 * dofs + e % 3] : 0.0,
                       "");
    }
    fputs(")),\n", stream);
  }
  fputs("]\n", stream);
}

static void put_file(const cdem_matrix_writer *matrix, const cdem_line_pairs *pairs, FILE *stream) {
  cdem_line_pairs_put_head(matrix, "YADE", stream);
  fputs("# Bodies are nodes; id_of gives the body of a tag. They cannot turn, and masses are no\n"
        "# part of a spring network: all are 1 kg. Small strains and rotations, as those of the\n"
        "# network. `springs` are interactions, `others` a loop in Python.\n"
        "# Use: exec(open('THIS_FILE').read()), then fix and load its bodies, and O.run().\n",
        stream);
  put_nodes(matrix, stream);
  put_springs(pairs, stream);
  put_others(pairs, matrix->sparse.dofs, stream);
  fprintf(stream, "blocked = '%s'\n", matrix->sparse.dofs == 2 ? "zXYZ" : "XYZ");
  cdem_stream_real(stream, "radius = ", pairs->shortest > 0.0 ? 0.25 * pairs->shortest : 1.0,
                   "  # for pictures; no force depends on it\n");
  cdem_stream_real(stream, "O.dt = ", cdem_line_pairs_step(pairs),
                   "  # a tenth of the stability limit for these masses\n");
  fputs("matter = O.materials.append(CohFrictMat(young=1e9, poisson=0.3, density=1000))\n", stream);
  fputs(engines, stream);
}

static cdem_status put_yade(cdem_matrix_writer *matrix, cdem_fault *fault) {
  cdem_line_pairs pairs = {0};
  cdem_status status = cdem_line_pairs_init(matrix, true, &pairs, fault);
  if (status == CDEM_OK)
    put_file(matrix, &pairs, cdem_output_stream(matrix->output));
  cdem_line_pairs_release(&pairs);
  return status;
}

static cdem_status open_yade(const char *path, const cdem_model *model,
                             cdem_springs_writer **writer, cdem_fault *fault) {
  *writer = NULL;
  CDEM_TRY(
      cdem_matrix_refuse_cosserat(path, model,
                                  "the interactions of YADE couple displacements and rotations by "
                                  "the contact point alone, a Cosserat network does not",
                                  fault));
  return cdem_matrix_writer_open(path, model, put_yade, writer, fault);
}

const cdem_springs_format cdem_springs_yade = {
    "yade", ".py .yade", "Python script for YADE, the assembled network", open_yade, true};
