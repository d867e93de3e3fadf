/* A body and grains that move together, the body by steps m times as long (Li & Wan 2010, section
 * 2.3).
 *
 * One coarse step from t_n to t_n + m dt:
 *     1. the body steps with its own forces and those of the grains at t_n;
 *     2. interface grains go from N d_n to N d_{n+1} and the grains take m steps (eqs 27-30);
 *     3. the forces of the grains at t_{n+1} go to the body (eqs 31-34, by central differences).
 *
 * Two ways from N d_n to N d_{n+1}, the same for m = 1:
 *
 * velocity      N v_{n+1/2} all the way. Without any damping, the energy of body and grains stays
 *               within 1 % over thousands of steps of the longest that is let through, within 0.3 %
 *               at half that.
 * acceleration  from N v_n with N a_n, a_n = 2 (v_{n+1/2} - v_n)/(m dt) (eqs 25-26 as printed). The
 *               velocity is smoother, but its slope lags by half a step: the slow motion is damped
 *               and, for m > 1, fast ones of the body grow. In a bonded strip with elements of
 *               0.25 m, energy grew by 5 a second at 0.6 of the longest step: for runs with more
 *               damping than that.
 *
 * Two forms of the force on the body:
 *
 * interface    N^T R, R the forces of fine grains on interface grains. The body is made of the
 *              outer cells alone; nodes inside the fine region follow the grains by the projection
 *              d = M^-1 N^T Mp q and move nothing. Nodes on the edge of the fine region are the
 *              body's.
 *
 * virtual work N^T F over fine and interface grains, F holding every contact of at least one fine
 *              grain and what is applied to fine grains; nodes of the fine region have the lumped
 *              row sums of N^T Mp N added to their masses, with which the body's solver weighs and
 *              damps the grains, and move by these forces. (A sum over fine grains alone, a literal
 *              reading of eq. 16, leaves out the reaction of the interface and is wrong by all of
 *              it.) The motion of inner nodes is then no projection, and is for looking at only.
 *
 * Both solvers are the caller's, borrowed, at the same time, and have fixed steps: that of the body
 * is m times that of the grains.
 */
#ifndef CDEM_BSM_COUPLING_H
#define CDEM_BSM_COUPLING_H

#include "bsm/absorb.h"
#include "bsm/tie.h"
#include "cdem/solver.h"
#include "dem/dem.h"

typedef enum { CDEM_BSM_INTERFACE, CDEM_BSM_VIRTUAL_WORK } cdem_bsm_form;
typedef enum { CDEM_BSM_VELOCITY, CDEM_BSM_ACCELERATION } cdem_bsm_way;

typedef struct {
  cdem_solver *coarse;
  cdem_dem *fine;
  cdem_bsm_form form;
  cdem_bsm_way way;         /* of interface grains within a step of the body */
  int cycles;               /* m >= 1 */
  const cdem_tie *tie;      /* interface grains, which are driven, to the body */
  const cdem_tie *fine_tie; /* virtual work: fine grains to the body's nodes; else NULL */
  cdem_absorb *absorb;      /* a layer that takes away short waves; NULL: none */
  double most_step;         /* s, as cdem_coupling_limit says; checked against the body's step */
  double (*clock)(void);    /* s, says what the parts of a step cost; NULL: nobody asks */
} cdem_coupling_options;

/* What the parts of all steps so far have taken, s; 0 without a clock. Transfer: motion to
 * interface grains and forces to the body. */
typedef struct {
  double fine, coarse, transfer;
} cdem_coupling_cost;

typedef struct {
  cdem_coupling_options options;
  double step; /* s, m dt */
  double work; /* J, of interface grains (virtual work: of all) on the body since the start */
  cdem_coupling_cost cost;
  double *before, *after;     /* [nodes][dofs] velocities of the body */
  double *reaction;           /* [nodes][dofs] forces of the grains at t_n */
  double *motion, *rate, *on; /* [largest tie][6] */
} cdem_coupling;

/* CDEM_INPUT: steps that do not fit, or longer than most_step (names the largest m that is stable).
 * Hands the forces at the start to the body. Release at any stage. */
cdem_status cdem_coupling_init(const cdem_coupling_options *options, cdem_coupling *coupling,
                               cdem_fault *fault);
void cdem_coupling_release(cdem_coupling *coupling);

/* Longest step of a body with these interface grains, s: 0.8 of what is stable when the springs of
 * contacts on interface grains add their frequency to the body's own (`limit`, s). CDEM_MEMORY. */
cdem_status cdem_coupling_limit(const cdem_body *body, double limit, const cdem_tie *tie,
                                const cdem_dem *fine, double *most_step, cdem_fault *fault);

/* One coarse step. CDEM_USAGE when a solver has changed its step. CDEM_NUMERIC also when the
 * body has had to shorten its step (breaking, contact): names the step that is stable now. */
cdem_status cdem_coupling_step(cdem_coupling *coupling, cdem_fault *fault);

/* Beside the two solvers' own states, which are restored before it. */
cdem_status cdem_coupling_save(const cdem_coupling *coupling, cdem_state *state, cdem_fault *fault);
cdem_status cdem_coupling_restore(cdem_coupling *coupling, const cdem_state *state,
                                  cdem_fault *fault);

#endif
