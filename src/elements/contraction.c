/* The material's side of equation (1): C = E_k^T D E_l. */
#include "elements/basis.h"

#include <float.h>
#include <string.h>

/* One nonzero entry of E: this feature adds `sign` times this degree of freedom to a strain. */
typedef struct {
  int8_t strain, feature, dof, sign;
} term;

static const term solid_terms[] = {
    {0, 0, 0, 1}, {1, 1, 1, 1}, {2, 2, 2, 1},               /* xx yy zz */
    {3, 2, 1, 1}, {3, 1, 2, 1}, {4, 2, 0, 1}, {4, 0, 2, 1}, /* yz xz */
    {5, 1, 0, 1}, {5, 0, 1, 1},                             /* xy */
};
static const term plane_terms[] = {{0, 0, 0, 1}, {1, 1, 1, 1}, {2, 1, 0, 1}, {2, 0, 1, 1}};
static const term cosserat_terms[] = {
    {0, 1, 0, 1}, {1, 2, 1, 1},  /* xx yy; features N, N,x, N,y */
    {2, 1, 1, 1}, {2, 0, 2, -1}, /* xy: u_y,x - omega */
    {3, 2, 0, 1}, {3, 0, 2, 1},  /* yx: u_x,y + omega */
    {4, 1, 2, 1}, {5, 2, 2, 1},  /* curvatures */
};

static const struct {
  cdem_moduli_kind moduli;
  int dofs, features, terms;
  const term *term;
} formulations[] = {
    [CDEM_SOLID] = {CDEM_MODULI_SOLID, 3, 3, sizeof solid_terms / sizeof(term), solid_terms},
    [CDEM_PLANE] = {CDEM_MODULI_PLANE, 2, 2, sizeof plane_terms / sizeof(term), plane_terms},
    [CDEM_PLANE_COSSERAT] = {CDEM_MODULI_PLANE_COSSERAT, 3, 3, sizeof cosserat_terms / sizeof(term),
                             cosserat_terms},
};

cdem_moduli_kind cdem_formulation_moduli(cdem_formulation formulation) {
  return formulations[formulation].moduli;
}

cdem_status cdem_formulation_thickness(cdem_formulation formulation, const cdem_section *section,
                                       double *thickness, cdem_fault *fault) {
  *thickness = 1.0;
  if (formulation == CDEM_SOLID)
    return CDEM_OK;
  CDEM_REQUIRE(section != NULL, fault, CDEM_USAGE,
               "a plane body needs a section: plane strain or plane stress, and a thickness");
  CDEM_REQUIRE(section->thickness > 0.0 && isfinite(section->thickness), fault, CDEM_INPUT,
               "thickness = %.10g m is out of range: it must be positive and finite",
               section->thickness);
  *thickness = section->thickness;
  return CDEM_OK;
}

/* The isotropic coefficient of c[a][b][k][l]. */
static double isotropic(double lambda, double mu, int a, int b, int k, int l) {
  return lambda * ((a == k) * (b == l)) + mu * ((a == b) * (k == l) + (a == l) * (b == k));
}

/* Finds lambda and mu when c has that form. Cosserat laws couple through N and never have. */
static void detect_isotropy(cdem_contraction *contraction, cdem_formulation formulation) {
  double lambda = contraction->c[0][1][0][1], mu = contraction->c[0][0][1][1], largest = 0.0;
  double difference = 0.0;
  int n = contraction->dofs;
  for (int i = 0; i < n * n * n * n; i++) {
    int a = i / (n * n * n), b = i / (n * n) % n, k = i / n % n, l = i % n;
    double c = contraction->c[a][b][k][l];
    largest = fmax(largest, fabs(c));
    difference = fmax(difference, fabs(c - isotropic(lambda, mu, a, b, k, l)));
  }
  contraction->isotropic =
      formulation != CDEM_PLANE_COSSERAT && difference <= 4.0 * DBL_EPSILON * largest;
  if (contraction->isotropic) {
    contraction->lambda = lambda;
    contraction->mu = mu;
  }
}

cdem_status cdem_contraction_build(const cdem_material *material, cdem_formulation formulation,
                                   const cdem_section *section, cdem_contraction *contraction,
                                   cdem_fault *fault) {
  double d[36], thickness;
  int rows;
  CDEM_TRY(
      cdem_material_moduli(material, formulations[formulation].moduli, section, d, &rows, fault));
  CDEM_TRY(cdem_formulation_thickness(formulation, section, &thickness, fault));
  cdem_contraction result = {.dofs = formulations[formulation].dofs,
                             .features = formulations[formulation].features};
  for (int i = 0; i < formulations[formulation].terms; i++)
    for (int j = 0; j < formulations[formulation].terms; j++) {
      term left = formulations[formulation].term[i], right = formulations[formulation].term[j];
      result.c[left.dof][right.dof][left.feature][right.feature] +=
          left.sign * right.sign * thickness * d[rows * left.strain + right.strain];
    }
  detect_isotropy(&result, formulation);
  *contraction = result;
  return CDEM_OK;
}
