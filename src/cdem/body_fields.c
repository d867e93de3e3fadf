/* Stress, strain, spring energies and rotations of cells; stress at nodes. */
#include "base/mat3.h"
#include "cdem/body_store.h"

#include <math.h>
#include <string.h>

/* The strain that a plane law gives out of its plane, and the stress. */
static void plane_strain_law(const double solid[36], cdem_body_law *law) {
  static const int column[3] = {0, 1, 5};
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 3; j++)
      law->stress[i][column[j]] = solid[6 * i + column[j]];
}

/* Stresses zz yz xz vanish: C_oo e_o = -C_op e_p. */
static void plane_stress_law(const double solid[36], cdem_body_law *law) {
  static const int in[3] = {0, 1, 5}, out[3] = {2, 3, 4};
  double c[9], inverse[9];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      c[3 * i + j] = solid[6 * out[i] + out[j]];
  cdem_inverse3(c, inverse);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++)
        law->strain[out[i]][in[j]] -= inverse[3 * i + k] * solid[6 * out[k] + in[j]];
}

static void in_plane_law(const double d[9], cdem_body_law *law) {
  static const int in[3] = {0, 1, 5};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      law->stress[in[i]][in[j]] = d[3 * i + j];
}

/* Order of d: xx yy xy yx and curvatures. Column 6 is the rotation relative to the body's,
 * u_y,x - omega less u_x,y + omega. Symmetric part of the stress only. */
static void cosserat_law(const cdem_material *material, const cdem_section *section,
                         const double d[36], cdem_body_law *law) {
  law->stress[0][0] = d[0], law->stress[0][1] = d[1];
  law->stress[1][0] = d[6], law->stress[1][1] = d[7];
  /* s = (sxy + syx)/2 with exy = (g + r)/2, eyx = (g - r)/2. */
  law->stress[5][5] = 0.25 * (d[14] + d[15] + d[20] + d[21]);
  law->stress[5][6] = 0.25 * (d[14] - d[15] + d[20] - d[21]);
  if (material->model != CDEM_COSSERAT && material->model != CDEM_COSSERAT_PRINTED)
    return;                     /* plane moduli: nothing is known out of the plane */
  double poisson = d[1] / d[0]; /* in plane stress */
  for (int j = 0; j < 2; j++)
    if (section->plane == CDEM_PLANE_STRAIN)
      law->stress[2][j] = d[1];
    else
      law->strain[2][j] = -poisson / (1.0 - poisson);
}

cdem_status cdem_body_law_build(const cdem_model *model, int m, cdem_body_law *law,
                                cdem_fault *fault) {
  const cdem_material *material = &model->materials_of[m];
  double d[36], solid[36];
  int rows;
  memset(law, 0, sizeof *law);
  for (int i = 0; i < 6; i++)
    law->strain[i][i] = 1.0;
  switch (model->formulation) {
  case CDEM_SOLID:
    CDEM_TRY(cdem_material_moduli(material, CDEM_MODULI_SOLID, NULL, d, &rows, fault));
    for (int i = 0; i < 36; i++)
      law->stress[i / 6][i % 6] = d[i];
    return CDEM_OK;
  case CDEM_PLANE_COSSERAT:
    CDEM_TRY(cdem_material_moduli(material, CDEM_MODULI_PLANE_COSSERAT, &model->section, d, &rows,
                                  fault));
    cosserat_law(material, &model->section, d, law);
    return CDEM_OK;
  case CDEM_PLANE:
    break;
  }
  CDEM_TRY(cdem_material_moduli(material, CDEM_MODULI_PLANE, &model->section, d, &rows, fault));
  bool has_solid =
      cdem_material_moduli(material, CDEM_MODULI_SOLID, NULL, solid, &rows, NULL) == CDEM_OK;
  if (model->section.plane == CDEM_PLANE_STRAIN && has_solid)
    plane_strain_law(solid, law);
  else if (has_solid)
    plane_stress_law(solid, law);
  else /* a sheet of Poisson's ratio beyond 1/2 */
    for (int j = 0; j < 2; j++)
      law->strain[2][j] = -material->parameter[1] / (1.0 - material->parameter[1]);
  in_plane_law(d, law);
  return CDEM_OK;
}

/* Local strain [7], less the opening, from gradients [nodes][3] and values [nodes] of the shape
 * functions at a point: Voigt with engineering shears; [6]: see cosserat_law. */
static void strain_at(const cdem_body_element *element, const double *shape,
                      const double (*gradient)[3], double strain[7]) {
  const cdem_body_kind *kind = element->record.kind;
  double h[9] = {0}, omega = 0.0;
  for (int a = 0; a < kind->nodes; a++) {
    for (int i = 0; i < kind->dimension; i++)
      for (int k = 0; k < kind->dimension; k++)
        h[3 * i + k] += element->d[a][i] * gradient[a][k];
    if (kind->formulation == CDEM_PLANE_COSSERAT)
      omega += shape[a] * element->d[a][2];
  }
  strain[0] = h[0], strain[1] = h[4], strain[2] = h[8];
  strain[3] = h[5] + h[7], strain[4] = h[2] + h[6], strain[5] = h[1] + h[3];
  strain[6] = kind->formulation == CDEM_PLANE_COSSERAT ? h[3] - h[1] - 2.0 * omega : 0.0;
}

/* R v R^T of a symmetric tensor in Voigt order, shears times `shear` (1/2 for strains). */
static void turn_tensor(const double r[9], double shear, double v[6]) {
  const double m[9] = {v[0],         shear * v[5], shear * v[4], shear * v[5], v[1],
                       shear * v[3], shear * v[4], shear * v[3], v[2]};
  static const int voigt[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  for (int e = 0; e < 6; e++) {
    double sum = 0.0;
    for (int k = 0; k < 9; k++)
      sum += r[3 * voigt[e][0] + k / 3] * m[k] * r[3 * voigt[e][1] + k % 3];
    v[e] = e < 3 ? sum : sum / shear;
  }
}

/* Global stress [6], and strain [6] where not NULL, from a local strain [7]; what has opened is
 * strain without stress. */
static void apply_law(const cdem_body_law *law, const cdem_body_element *element,
                      const double local[7], double *stress, double *strain) {
  const double *rotation = element->rotation;
  double s[6] = {0}, e[6] = {0};
  for (int i = 0; i < 6; i++) {
    for (int j = 0; j < 7; j++)
      s[i] += law->stress[i][j] * local[j];
    for (int j = 0; j < 6; j++)
      e[i] += law->strain[i][j] * local[j];
    e[i] += element->opening[i];
  }
  turn_tensor(rotation, 1.0, s);
  turn_tensor(rotation, 0.5, e);
  if (stress != NULL)
    memcpy(stress, s, sizeof s);
  if (strain != NULL)
    memcpy(strain, e, sizeof e);
}

/* Energies and sums of forces of the spring classes of one element. */
static void spring_fields(const cdem_body_element *element, double energy[CDEM_CLASSES],
                          double force[CDEM_CLASSES]) {
  const cdem_body_kind *kind = element->record.kind;
  cdem_body_element centred = *element;
  int n = kind->dofs;
  for (int c = 0; c < CDEM_CLASSES; c++)
    energy[c] = force[c] = 0.0;
  for (int c = 0; c < kind->dimension; c++) {
    double mean = 0.0;
    for (int a = 0; a < kind->nodes; a++)
      mean += element->d[a][c] / kind->nodes;
    for (int a = 0; a < kind->nodes; a++)
      centred.d[a][c] -= mean;
  }
  for (int i = 0, p = 0; i < kind->nodes; i++)
    for (int j = i + 1; j < kind->nodes; j++, p++) {
      double s[9], there[3], back[3], sum = 0.0, norm = 0.0;
      cdem_body_spring(&centred, p, s);
      cdem_body_elongation(&centred, i, j, there);
      cdem_body_elongation(&centred, j, i, back);
      for (int a = 0; a < n; a++) {
        double f = 0.0;
        for (int b = 0; b < n; b++) {
          f += s[n * a + b] * there[b];
          sum += s[n * a + b] * (centred.d[i][a] * there[b] + centred.d[j][b] * back[a]);
        }
        norm += a < kind->dimension ? f * f : 0.0;
      }
      energy[kind->class_[p]] -= 0.5 * sum;
      force[kind->class_[p]] += sqrt(norm);
    }
}

void cdem_body_cell_fields(const cdem_body *body, const double *u, const cdem_body_fields *fields) {
  const cdem_model *model = body->model;
#pragma omp parallel for schedule(static) num_threads(body->threads) if (body->store->tiles > 1)
  for (int32_t cell = 0; cell < model->cells; cell++) {
    cdem_body_element element;
    double strain[7], energy[CDEM_CLASSES], force[CDEM_CLASSES];
    cdem_body_element_at(body, u, cell, &element);
    const cdem_body_kind *kind = element.record.kind;
    if (fields->stress != NULL || fields->strain != NULL) {
      strain_at(&element, kind->shape, (const double(*)[3])element.gradient, strain);
      apply_law(&body->store->law[model->material[cell]], &element, strain,
                fields->stress != NULL ? fields->stress + 6 * (int64_t)cell : NULL,
                fields->strain != NULL ? fields->strain + 6 * (int64_t)cell : NULL);
    }
    if (fields->rotation != NULL)
      memcpy(fields->rotation + 9 * (int64_t)cell, element.rotation, sizeof element.rotation);
    if (fields->energy == NULL && fields->pair_force == NULL)
      continue;
    spring_fields(&element, energy, force);
    if (fields->energy != NULL)
      memcpy(fields->energy + CDEM_CLASSES * (int64_t)cell, energy, sizeof energy);
    if (fields->pair_force != NULL)
      memcpy(fields->pair_force + CDEM_CLASSES * (int64_t)cell, force, sizeof force);
  }
}

/* Gradients at a corner; those at the centre where the corner is flat. */
static void corner_gradients(const cdem_body_element *element, const double (*dn)[3],
                             double (*gradient)[3]) {
  const cdem_body_kind *kind = element->record.kind;
  double inverse[9];
  bool good = cdem_body_jacobian(kind, element->x, dn, inverse) > 1e-9;
  for (int a = 0; a < kind->nodes; a++)
    for (int i = 0; i < 3; i++) {
      gradient[a][i] = good ? 0.0 : element->gradient[a][i];
      for (int k = 0; k < kind->dimension && good && i < kind->dimension; k++)
        gradient[a][i] += dn[a][k] * inverse[3 * k + i];
    }
}

void cdem_body_node_stress(const cdem_body *body, const double *u, double *stress) {
  const cdem_model *model = body->model;
  memset(stress, 0, sizeof *stress * 6 * (size_t)body->nodes);
  for (int32_t cell = 0; cell < model->cells; cell++) {
    const cdem_tabulation *t = &model->kinds_of[model->kind[cell]].tabulation;
    cdem_body_element element;
    double share[CDEM_BODY_NODES];
    cdem_body_element_at(body, u, cell, &element);
    cdem_body_shares(model, cell, share);
    for (int a = 0; a < t->nodes; a++) {
      double gradient[CDEM_BODY_NODES][3], shape[CDEM_BODY_NODES] = {0}, strain[7], here[6];
      corner_gradients(&element, (const double(*)[3])(t->corner + (ptrdiff_t)3 * t->nodes * a),
                       gradient);
      shape[a] = 1.0;
      strain_at(&element, shape, (const double(*)[3])gradient, strain);
      apply_law(&body->store->law[model->material[cell]], &element, strain, here, NULL);
      for (int c = 0; c < 6; c++)
        stress[6 * (int64_t)element.node[a] + c] += share[a] * here[c];
    }
  }
  for (int32_t n = 0; n < body->nodes; n++)
    for (int c = 0; c < 6 && body->store->volume[n] > 0.0; c++)
      stress[6 * (int64_t)n + c] /= body->store->volume[n];
}
