/* Invariants of symmetric tensors in VTK's order xx yy zz xy yz xz. */
#ifndef CDEM_RESULTS_TENSOR_H
#define CDEM_RESULTS_TENSOR_H

/* sqrt(3/2 s:s) of the deviator s. */
double cdem_tensor_von_mises(const double t[6]);

/* The principal values, descending, in closed form (Smith 1961). Off by rounding of the largest;
 * where two nearly coincide, they are apart by up to 1e-8 of it. */
void cdem_tensor_principal(const double t[6], double value[3]);

#endif
