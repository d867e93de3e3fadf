#include "springs/closed.h"

#include "springs/parts.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* A 2x2 block [[mean + half_difference, upper], [lower, mean - half_difference]] in the orthonormal
 * basis e1, e2; its eigenvalues are mean +- sqrt(square). */
typedef struct {
  double mean, square, half_difference, upper, lower;
  const double *e1, *e2;
} plane_block;

static const double axis_x[3] = {1, 0, 0}, axis_y[3] = {0, 1, 0}, axis_z[3] = {0, 0, 1};

static double modulus(const cdem_closed_solid *solid) {
  return solid->young * solid->length / ((1.0 + solid->poisson) * (1.0 - 2.0 * solid->poisson));
}

static void lame(const cdem_closed_sheet *sheet, double *lambda, double *shear) {
  double nu = sheet->poisson;
  *shear = sheet->thickness * sheet->young / (2.0 * (1.0 + nu));
  *lambda = sheet->thickness * sheet->young * nu /
            (sheet->plane_stress ? 1.0 - nu * nu : (1.0 + nu) * (1.0 - 2.0 * nu));
}

/* Unit length and canonical sign. */
static void set_direction(double x, double y, double z, double dir[3]) {
  double length = sqrt(x * x + y * y + z * z);
  const double v[3] = {x / length, y / length, z / length};
  double sign = cdem_springs_sign(v);
  for (int i = 0; i < 3; i++)
    dir[i] = sign * v[i] + 0.0; /* + 0.0: no negative zeros in files */
}

/* out = a e1 + b e2, as it is. */
static void combine(const plane_block *block, double a, double b, double out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = a * block->e1[i] + b * block->e2[i];
}

/* Eigenvector to mean + root: the better conditioned of the two rows of (block - value). */
static void real_direction(const plane_block *block, double root, double dir[3]) {
  double v[3], a = block->upper, b = root - block->half_difference;
  if (fabs(root + block->half_difference) > fabs(b))
    a = root + block->half_difference, b = block->lower;
  combine(block, a, b, v);
  set_direction(v[0], v[1], v[2], dir);
}

/* Re v and Im v of the eigenvector to mean + i root, turned in phase until |Re v| = |Im v| = 1 and
 * Re v . Im v >= 0, that is until v . v = i |v . v|. */
static void complex_directions(const plane_block *block, double root, double re[3], double im[3]) {
  double x[2] = {block->upper, -block->half_difference}, y[2] = {0.0, root};
  double vv_re = x[0] * x[0] + x[1] * x[1] - y[1] * y[1], vv_im = 2.0 * x[1] * y[1];
  double phase = 0.5 * (M_PI_2 - atan2(vv_im, vv_re));
  double scale = sqrt(2.0 / (x[0] * x[0] + x[1] * x[1] + y[1] * y[1]));
  double cosine = scale * cos(phase), sine = scale * sin(phase);
  combine(block, cosine * x[0] - sine * y[0], cosine * x[1] - sine * y[1], re);
  combine(block, cosine * y[0] + sine * x[0], cosine * y[1] + sine * x[1], im);
  double sign = cdem_springs_sign(re);
  for (int i = 0; i < 3; i++)
    re[i] *= sign, im[i] *= sign;
}

/* The defective pair: eigenvector, its normal, and the coupling N normal = coupling * eigenvector
 * of the nilpotent part N. */
static double jordan_directions(const plane_block *block, double first[3], double second[3]) {
  real_direction(block, 0.0, first);
  double a = cdem_dot3(first, block->e1), b = cdem_dot3(first, block->e2), v[3];
  combine(block, -b, a, v);
  double sign = cdem_springs_sign(v);
  for (int i = 0; i < 3; i++)
    second[i] = sign * v[i];
  double n1 = -b * block->half_difference + a * block->upper;
  double n2 = -b * block->lower - a * block->half_difference;
  return sign * (n1 * a + n2 * b);
}

/* Fills the pair of a closed form; 3x3: `single` and its direction are the third spring. */
static void set_pair(const plane_block *block, int size, double single, const double direction[3],
                     cdem_closed *closed) {
  *closed = (cdem_closed){.size = size, .frame_h = NAN};
  /* The square carries rounding of this size, so a smaller one is a defect as far as one can say.
   */
  double scale =
      block->half_difference * block->half_difference + fabs(block->upper * block->lower) + DBL_MIN;
  double root = sqrt(fabs(block->square));
  closed->form = fabs(block->square) <= 16.0 * DBL_EPSILON * scale ? CDEM_FORM_JORDAN2
                 : block->square > 0.0                             ? CDEM_FORM_DIAGONAL
                                                                   : CDEM_FORM_COMPLEX;
  /* The pair comes first in a diagonal set and in the plane, last behind a single spring. */
  int pair = size == 3 && closed->form != CDEM_FORM_DIAGONAL ? 1 : 0;
  double *first = closed->dir[pair], *second = closed->dir[pair + 1];
  closed->k[pair] = closed->k[pair + 1] = block->mean;
  if (closed->form == CDEM_FORM_DIAGONAL) {
    closed->k[0] += root, closed->k[1] -= root;
    real_direction(block, root, first);
    real_direction(block, -root, second);
  } else if (closed->form == CDEM_FORM_COMPLEX) {
    closed->coupling = root;
    complex_directions(block, root, first, second);
  } else {
    closed->coupling = jordan_directions(block, first, second);
  }
  if (size == 3) {
    int third = pair == 0 ? 2 : 0;
    closed->k[third] = single;
    set_direction(direction[0], direction[1], direction[2], closed->dir[third]);
  }
}

/* Eqs (13)-(15), table 1. The radicand of eq (15) is printed with the wrong sign. */
static void cube_edge(double c, double mu, cdem_closed *closed) {
  const double across[3] = {0, M_SQRT1_2, M_SQRT1_2}, third[3] = {0, -1, 1};
  double skew = M_SQRT2 * c * (4.0 * mu - 1.0) / 24.0;
  double radicand = (-512.0 * mu + 256.0) * mu - 7.0;
  set_pair(&(plane_block){.mean = c / 288.0,
                          .square = c * c * radicand / 9216.0,
                          .half_difference = 15.0 * c / 288.0,
                          .upper = -skew,
                          .lower = skew,
                          .e1 = axis_x,
                          .e2 = across},
           3, -c / 144.0, third, closed);
}

/* Eqs (17)-(20), table 2. The radicand of eq (20) is printed with the wrong sign, and so is the
 * y component of the third direction in table 2. */
static void cube_face(double c, double mu, cdem_closed *closed) {
  const double diagonal[3] = {M_SQRT1_2, M_SQRT1_2, 0}, third[3] = {-1, 1, 0};
  double skew = M_SQRT2 * c * (4.0 * mu - 1.0) / 48.0;
  double radicand = (-32.0 * mu + 16.0) * mu + 2.0;
  set_pair(&(plane_block){.mean = c * (10.0 - 12.0 * mu) / 144.0,
                          .square = c * c * radicand / 2304.0,
                          .half_difference = c / 24.0,
                          .upper = -skew,
                          .lower = skew,
                          .e1 = diagonal,
                          .e2 = axis_z},
           3, c * (1.0 - 3.0 * mu) / 36.0, third, closed);
}

/* Eq (22), tables 3 and 4; the printed 432 of table 4 must be 216 (errata). */
static void cube_body(double c, double mu, cdem_closed *closed) {
  *closed = (cdem_closed){.form = CDEM_FORM_DIAGONAL,
                          .size = 3,
                          .k = {c * (7.0 - 6.0 * mu) / 72.0, c * (5.0 - 12.0 * mu) / 144.0,
                                c * (5.0 - 12.0 * mu) / 144.0},
                          .frame_h = c * (5.0 - 12.0 * mu) / 216.0};
  set_direction(1, 1, 1, closed->dir[0]);
  set_direction(-1, -1, 2, closed->dir[1]);
  set_direction(-1, 1, 0, closed->dir[2]);
}

void cdem_closed_cube(cdem_class class_, const cdem_closed_solid *solid, cdem_closed *closed) {
  double c = modulus(solid);
  if (class_ == CDEM_CLASS_EDGE)
    cube_edge(c, solid->poisson, closed);
  else if (class_ == CDEM_CLASS_FACE)
    cube_face(c, solid->poisson, closed);
  else
    cube_body(c, solid->poisson, closed);
}

void cdem_closed_cube_interior(cdem_class class_, const cdem_closed_solid *solid,
                               cdem_closed *closed) {
  double c = modulus(solid), mu = solid->poisson;
  if (class_ == CDEM_CLASS_BODY) {
    cube_body(c, mu, closed);
    return;
  }
  *closed = (cdem_closed){.form = CDEM_FORM_DIAGONAL, .size = 3, .frame_h = NAN};
  if (class_ == CDEM_CLASS_FACE) {
    closed->k[0] = c * (4.0 - 3.0 * mu) / 18.0;
    closed->k[1] = closed->k[2] = c * (1.0 - 3.0 * mu) / 18.0;
    set_direction(1, 1, 0, closed->dir[0]);
    set_direction(0, 0, 1, closed->dir[1]);
    set_direction(-1, 1, 0, closed->dir[2]);
  } else {
    closed->k[0] = 2.0 * c / 9.0;
    closed->k[1] = closed->k[2] = -c / 9.0;
    set_direction(1, 0, 0, closed->dir[0]);
    set_direction(0, 0, 1, closed->dir[1]);
    set_direction(0, 1, 0, closed->dir[2]);
  }
}

/* With M_ab = integral of N_1,a N_2,b: M_xx = -across/(3 along), M_yy = along/(6 across),
 * M_xy = 1/4 = -M_yx, and S_ab = -(lambda M_ab + G M_ba + G delta_ab (M_xx + M_yy)). For the square
 * k = [lambda + 3 G +- 6 sqrt(lambda G)]/12, which is the form of springs.md section 3. */
void cdem_closed_rectangle_edge(const cdem_closed_sheet *sheet, double along, double across,
                                cdem_closed *closed) {
  double lambda, shear, slender = across / along;
  lame(sheet, &lambda, &shear);
  double stretch = lambda + 2.0 * shear;
  double xx = stretch * slender / 3.0 - shear / (6.0 * slender);
  double yy = shear * slender / 3.0 - stretch / (6.0 * slender);
  double skew = 0.25 * (lambda - shear), half = 0.5 * (xx - yy);
  set_pair(&(plane_block){.mean = 0.5 * (xx + yy),
                          .square = (half - skew) * (half + skew),
                          .half_difference = half,
                          .upper = -skew,
                          .lower = skew,
                          .e1 = axis_x,
                          .e2 = axis_y},
           2, 0.0, NULL, closed);
}

/* M_xx = -height/(6 width), M_yy = -width/(6 height), M_xy = M_yx = -1/4. */
void cdem_closed_rectangle_diagonal(const cdem_closed_sheet *sheet, double width, double height,
                                    cdem_closed *closed) {
  double lambda, shear, slender = height / width;
  lame(sheet, &lambda, &shear);
  double stretch = lambda + 2.0 * shear;
  double xx = stretch * slender / 6.0 + shear / (6.0 * slender);
  double yy = shear * slender / 6.0 + stretch / (6.0 * slender);
  double xy = 0.25 * (lambda + shear), half = 0.5 * (xx - yy);
  set_pair(&(plane_block){.mean = 0.5 * (xx + yy),
                          .square = half * half + xy * xy,
                          .half_difference = half,
                          .upper = xy,
                          .lower = xy,
                          .e1 = axis_x,
                          .e2 = axis_y},
           2, 0.0, NULL, closed);
}

/* Gradients of equal size at 120 degrees: S = [[(3 lambda + 5 G)/4, .], [., (G - lambda)/4]]/sqrt 3
 * with skew part -+(lambda - G)/4. */
void cdem_closed_triangle_edge(const cdem_closed_sheet *sheet, cdem_closed *closed) {
  double lambda, shear;
  lame(sheet, &lambda, &shear);
  double skew = 0.25 * (lambda - shear);
  double radicand = lambda * lambda + 14.0 * lambda * shear + shear * shear;
  set_pair(&(plane_block){.mean = (lambda + 3.0 * shear) / (4.0 * sqrt(3.0)),
                          .square = radicand / 48.0,
                          .half_difference = (lambda + shear) / (2.0 * sqrt(3.0)),
                          .upper = -skew,
                          .lower = skew,
                          .e1 = axis_x,
                          .e2 = axis_y},
           2, 0.0, NULL, closed);
}

/* The skew parts of the two triangles cancel. With plane-strain moduli (3 lambda + 5 G)/(2 sqrt 3)
 * is sqrt(3) E t (5 - 4 mu)/(12 (1 + mu)(1 - 2 mu)), the printed value with spring sign. */
void cdem_closed_triangle_interior(const cdem_closed_sheet *sheet, cdem_closed *closed) {
  double lambda, shear;
  lame(sheet, &lambda, &shear);
  *closed = (cdem_closed){
      .form = CDEM_FORM_DIAGONAL,
      .size = 2,
      .k = {(3.0 * lambda + 5.0 * shear) / (2.0 * sqrt(3.0)), (shear - lambda) / (2.0 * sqrt(3.0))},
      .frame_h = NAN};
  set_direction(1, 0, 0, closed->dir[0]);
  set_direction(0, 1, 0, closed->dir[1]);
}

void cdem_closed_rebuild(const cdem_closed *closed, double *s) {
  int n = closed->size, pair = n == 3 ? 1 : 0;
  double p[9] = {0, 0, 0, 0, 0, 0, 0, 0, 1}, inverse[9], l[9] = {0}, pl[9], full[9];
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < n; k++)
      p[3 * i + k] = closed->dir[k][i];
    l[4 * i] = closed->k[i];
  }
  if (closed->form != CDEM_FORM_DIAGONAL)
    l[3 * pair + pair + 1] = closed->coupling;
  if (closed->form == CDEM_FORM_COMPLEX)
    l[3 * (pair + 1) + pair] = -closed->coupling;
  cdem_inverse3(p, inverse);
  cdem_product3(p, l, pl);
  cdem_product3(pl, inverse, full);
  for (int i = 0; i < n; i++)
    memcpy(s + n * i, full + 3 * i, (size_t)n * sizeof *s);
}
