/* What others see of the grains. */
#include "fdem/solver_store.h"

#include <string.h>

static void copy(double *to, const double *from, int64_t count) {
  if (to != NULL)
    memcpy(to, from, (size_t)count * sizeof *to);
}

void cdem_fdem_look(const cdem_fdem *fdem, const cdem_fdem_view *view) {
  const cdem_fdem_store *s = fdem->store;
  copy(view->xyz, s->center, 3 * s->grains);
  copy(view->velocity, s->velocity, 3 * s->grains);
  copy(view->orientation, s->quaternion, 4 * s->grains);
  for (int64_t g = 0; g < s->grains; g++) {
    if (view->spin != NULL)
      cdem_fdem_spin_of(s, g, s->turn + 9 * g, s->momentum + 3 * g, view->spin + 3 * g);
    double moment[3];
    if (view->force != NULL)
      cdem_fdem_resultant(s, g, view->force + 3 * g, moment);
  }
  if (view->contacts != NULL) {
    cdem_contact_view seen = cdem_fdem_contact_view(s, 0.0);
    cdem_fdem_contacts_count(s->contacts, &seen, view->contacts);
  }
}

double cdem_fdem_mass(const cdem_fdem *fdem, int64_t g) {
  return fdem->store->mass[g];
}

const cdem_template *cdem_fdem_shape(const cdem_fdem *fdem, int64_t g) {
  return cdem_fdem_template(fdem->store, g);
}

cdem_fdem_nodes cdem_fdem_nodes_of(const cdem_fdem *fdem, int64_t g) {
  const cdem_fdem_store *s = fdem->store;
  int64_t first = 3 * s->first[g];
  return (cdem_fdem_nodes){.nodes = (int32_t)(s->first[g + 1] - s->first[g]),
                           .now = s->now + first,
                           .force = s->force + first,
                           .place = s->place + first};
}

cdem_status cdem_fdem_touches(const cdem_fdem *fdem, int64_t *touches, cdem_fdem_touch **touch,
                              cdem_fault *fault) {
  cdem_contact_view view = cdem_fdem_contact_view(fdem->store, 0.0);
  return cdem_fdem_contacts_list(fdem->store->contacts, &view, touches, touch, fault);
}

void cdem_fdem_wall_now(const cdem_fdem *fdem, int wall, double force[3], double center[3],
                        double velocity[3]) {
  const cdem_fdem_store *s = fdem->store;
  for (int c = 0; c < 3; c++) {
    force[c] = s->wall_force[3 * wall + c];
    center[c] = s->wall[wall].center[c];
    velocity[c] = s->wall[wall].velocity[c];
  }
}
