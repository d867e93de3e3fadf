/* Neighbours: grains brought into the cell, and the images of those near its faces.
 *
 * Two points closer than R differ by less than R/w in parts of an edge, w the width of the cell
 * across it (rows of the inverse of h are 1/w long). With w >= 2 r_max + skin this is below 1: so
 * images one edge away are enough, and no grain is near its own image, since any whole number of
 * edges is at least as long as the width it crosses.
 */
#include "dem/neighbours.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rounding of parts of an edge: grains lie at most a few thousand times r_max apart per edge. */
static const double slack = 1.0 + 0x1p-16;

static double largest_radius(const cdem_dem_store *s) {
  double largest = 0.0;
  for (int64_t i = 0; i < s->grains; i++)
    largest = cdem_place(s, i)[3] > largest ? cdem_place(s, i)[3] : largest;
  return largest;
}

static cdem_status check_widths(const cdem_dem_store *s, const cdem_cell *cell, double largest,
                                cdem_fault *fault) {
  double width[3], least = 2.0 * largest + s->skin;
  cdem_cell_widths(cell, width);
  for (int c = 0; c < 3; c++)
    CDEM_REQUIRE(width[c] >= least, fault, CDEM_INPUT,
                 "cell: it is %g m wide across edge %c, but must be %g m at least (twice the "
                 "largest radius, %g m, and the skin of the neighbour list, %g m), or a grain "
                 "would touch its own image; take a larger cell or a smaller skin",
                 width[c], "xyz"[c], least, largest, s -> skin);
  return CDEM_OK;
}

static cdem_status check_places(const cdem_dem_store *s, cdem_fault *fault) {
  for (int64_t i = 0; i < s->grains; i++) {
    const double *place = cdem_place(s, i);
    /* Differences of finite numbers below this have finite squares. */
    bool fine = fabs(place[0]) < 0x1p500 && fabs(place[1]) < 0x1p500 && fabs(place[2]) < 0x1p500;
    CDEM_REQUIRE(fine, fault, CDEM_NUMERIC,
                 "neighbours: grain %" PRId32 " is at (%g, %g, %g) m; the motion has run away, "
                 "take a smaller step",
                 s->id[i], place[0], place[1], place[2]);
  }
  return CDEM_OK;
}

/* New edges are h' = h T^-1 where numbers of edges become T n; so are their velocities. */
static void flip_velocities(cdem_dem_store *s, const int turns[9]) {
  double t[9], inverse[9];
  for (int k = 0; k < 9; k++)
    t[k] = turns[k];
  cdem_inverse3(t, inverse); /* integers, determinant 1: exact */
  double velocity[27][3];
  for (int code = 0; code < 27; code++) {
    int edges[3];
    cdem_image_edges(code, edges);
    for (int r = 0; r < 3; r++)
      velocity[code][r] = 0.0;
    for (int d = 0, one = 1; d < 3; d++, one *= 3) {
      double old =
          inverse[3 * d] * edges[0] + inverse[3 * d + 1] * edges[1] + inverse[3 * d + 2] * edges[2];
      for (int r = 0; r < 3; r++)
        velocity[code][r] += old * s->image_velocity[CDEM_IMAGE_SELF + one][r];
    }
  }
  memcpy(s->image_velocity, velocity, sizeof velocity);
}

/* Brings a grain into the cell; true when it was outside. */
static bool wrap_grain(cdem_dem_store *s, const double inverse[9], int64_t i, int16_t turned[3]) {
  double *place = cdem_place(s, i), *motion = cdem_motion(s, i), from[3], turns[3];
  bool any = false;
  for (int c = 0; c < 3; c++)
    from[c] = place[c] - s->cell.corner[c];
  for (int c = 0; c < 3; c++) {
    turns[c] = s->cell.periodic[c] ? 0.0 - floor(cdem_dot3(inverse + 3 * c, from)) : 0.0;
    any = any || turns[c] != 0.0;
    turned[c] = (int16_t)fmax(-32767.0, fmin(32767.0, turns[c]));
  }
  if (!any)
    return false;
  for (int r = 0; r < 3; r++) {
    double shift = 0.0, velocity = 0.0;
    for (int c = 0, one = 1; c < 3; c++, one *= 3)
      if (turns[c] != 0.0) {
        shift += turns[c] * s->cell.h[3 * r + c];
        velocity += turns[c] * s->image_velocity[CDEM_IMAGE_SELF + one][r];
      }
    if (shift != 0.0)
      place[r] += shift;
    if (velocity != 0.0)
      motion[r] += velocity;
  }
  for (int c = 0; c < 3 && s->turns != NULL; c++)
    s->turns[4 * i + c] += (int32_t)fmax(-0x1p30, fmin(0x1p30, turns[c]));
  return true;
}

/* Whole edges so far, in numbers of the new edges. */
static void flip_turns(cdem_dem_store *s, const int turns[9]) {
  for (int64_t i = 0; i < s->grains && s->turns != NULL; i++) {
    int32_t *now = s->turns + 4 * i, old[3] = {now[0], now[1], now[2]};
    for (int r = 0; r < 3; r++)
      now[r] = turns[3 * r] * old[0] + turns[3 * r + 1] * old[1] + turns[3 * r + 2] * old[2];
  }
}

cdem_status cdem_neighbours_wrap(cdem_dem_store *s, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  n->moved = false;
  CDEM_TRY(check_places(s, fault));
  n->largest = largest_radius(s);
  if (!cdem_cell_is_periodic(&s->cell))
    return CDEM_OK;
  cdem_cell cell = s->cell;
  bool flipped = cdem_cell_flip(&cell, n->turns);
  CDEM_TRY(check_widths(s, &cell, n->largest, fault));
  CDEM_TRY(cdem_neighbours_room(&n->turned, &n->capacity[4], 3 * (int64_t)s->grains,
                                sizeof *n->turned, fault));
  s->cell = cell;
  cdem_cell_images(&s->cell, s->image);
  if (flipped) {
    flip_velocities(s, n->turns);
    flip_turns(s, n->turns);
  }
  double inverse[9];
  cdem_cell_inverse(&s->cell, inverse);
  n->moved = flipped;
  for (int64_t i = 0; i < s->grains; i++)
    if (wrap_grain(s, inverse, i, n->turned + 3 * i))
      n->moved = true;
  return CDEM_OK;
}

/* ---- images ---- */

/* Codes of the images of a grain that others may be near to. */
static int images_of(const cdem_dem_store *s, const double inverse[9], const double part[3],
                     int64_t i, int code[26]) {
  const double *place = cdem_place(s, i);
  double reach = (place[3] + s->search->largest + s->skin) * slack, from[3];
  int first[3] = {0, 0, 0}, last[3] = {0, 0, 0}, images = 0;
  bool any = false;
  for (int c = 0; c < 3; c++)
    from[c] = place[c] - s->cell.corner[c];
  for (int c = 0; c < 3; c++) {
    if (!s->cell.periodic[c])
      continue;
    double at = cdem_dot3(inverse + 3 * c, from), near = reach * part[c] + 0x1p-40;
    first[c] = at > 1.0 - near ? -1 : 0;
    last[c] = at < near ? 1 : 0;
    any = any || first[c] != last[c];
  }
  if (!any)
    return 0;
  int edges[3];
  for (edges[2] = first[2]; edges[2] <= last[2]; edges[2]++)
    for (edges[1] = first[1]; edges[1] <= last[1]; edges[1]++)
      for (edges[0] = first[0]; edges[0] <= last[0]; edges[0]++) {
        code[images] = cdem_image_code(edges);
        images += code[images] != CDEM_IMAGE_SELF;
      }
  return images;
}

static cdem_status make_ghosts(cdem_dem_store *s, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  double inverse[9], part[3];
  cdem_cell_inverse(&s->cell, inverse);
  for (int c = 0; c < 3; c++)
    part[c] = cdem_norm3(inverse + 3 * c);
  int64_t ghosts = 0, *room = n->capacity;
  for (int64_t i = 0; i < s->grains; i++) {
    int code[27], images = images_of(s, inverse, part, i, code);
    CDEM_REQUIRE(s->grains + ghosts + images < INT32_MAX - 64, fault, CDEM_INPUT,
                 "neighbours: more than 2^31 grains and images; take fewer grains");
    CDEM_TRY(cdem_grow(&n->ghost, &room[5], 4 * (ghosts + images), sizeof *n->ghost, fault));
    CDEM_TRY(cdem_grow(&n->ghost_of, &room[6], ghosts + images, sizeof *n->ghost_of, fault));
    CDEM_TRY(cdem_grow(&n->ghost_image, &room[8], ghosts + images, 1, fault));
    for (int k = 0; k < images; k++, ghosts++) {
      for (int r = 0; r < 3; r++)
        n->ghost[4 * ghosts + r] = cdem_place(s, i)[r] + s->image[code[k]][r];
      n->ghost[4 * ghosts + 3] = cdem_place(s, i)[3];
      n->ghost_of[ghosts] = (int32_t)i;
      n->ghost_image[ghosts] = (uint8_t)code[k];
    }
  }
  n->points = s->grains + ghosts;
  return CDEM_OK;
}

/* ---- levels ---- */

/* Largest radius below a bound; negative: none. */
static double next_radius(const cdem_dem_store *s, double size, double *least) {
  double largest = -1.0;
  *least = INFINITY;
  for (int64_t i = 0; i < s->grains; i++) {
    double radius = cdem_place(s, i)[3];
    *least = radius < *least ? radius : *least;
    if (2.0 * radius + s->skin <= size && radius > largest)
      largest = radius;
  }
  return largest;
}

/* A level with few points in the space of all grains has mostly empty rows, and all finer grains
 * search them. It becomes part of the next coarser one, which then has at most two more points in
 * a cube of its size. */
static void merge_levels(cdem_dem_store *s) {
  struct cdem_neighbours *n = s->search;
  double space = 0.0, points[CDEM_NEIGHBOUR_LEVELS] = {0};
  int becomes[CDEM_NEIGHBOUR_LEVELS], levels = 0;
  for (int64_t i = 0; i < s->grains; i++) {
    double edge = 2.0 * cdem_place(s, i)[3];
    space += s->dim == 2 ? edge * edge : edge * edge * edge;
    points[n->level_of[i]] += 1.0;
  }
  for (int l = n->levels - 1; l > 0; l--) {
    double size = n->level[l].size, cell = s->dim == 2 ? size * size : size * size * size;
    becomes[l] = points[l] * cell < 0.25 * space ? l - 1 : l;
    points[l - 1] += becomes[l] < l ? points[l] : 0.0;
  }
  for (int l = 0; l < n->levels; l++) {
    bool kept = l == 0 || becomes[l] == l;
    if (kept)
      n->level[levels] = n->level[l];
    levels += kept;
    becomes[l] = levels - 1;
  }
  n->levels = levels;
  for (int64_t p = 0; p < n->points; p++)
    n->level_of[p] = (uint8_t)becomes[n->level_of[p]];
}

static cdem_status set_levels(cdem_dem_store *s, cdem_fault *fault) {
  struct cdem_neighbours *n = s->search;
  double size = INFINITY, least, bound[CDEM_NEIGHBOUR_LEVELS];
  n->levels = 0;
  while (n->levels < CDEM_NEIGHBOUR_LEVELS) {
    double radius = next_radius(s, size, &least);
    if (radius < 0.0)
      break;
    cdem_neighbour_level *level = &n->level[n->levels];
    *level = (cdem_neighbour_level){.radius = radius};
    double largest = 2.0 * radius + s->skin;
    level->size = largest * slack;
    bound[n->levels++] = size = 0.5 * largest;
    if (2.0 * least + s->skin > size)
      break;
  }
  CDEM_TRY(cdem_neighbours_room(&n->level_of, &n->capacity[9], n->points, 1, fault));
  if (n->levels <= 1) {
    memset(n->level_of, 0, (size_t)n->points);
    return CDEM_OK;
  }
  for (int64_t i = 0; i < n->points; i++) {
    double mine = 2.0 * cdem_neighbours_place(s, n, i)[3] + s->skin;
    int level = 0;
    while (level + 1 < n->levels && mine <= bound[level])
      level++;
    n->level_of[i] = (uint8_t)level;
  }
  merge_levels(s);
  return CDEM_OK;
}

cdem_status cdem_neighbours_points(cdem_dem_store *s, cdem_fault *fault) {
  s->search->points = s->grains;
  if (cdem_cell_is_periodic(&s->cell))
    CDEM_TRY(make_ghosts(s, fault));
  return set_levels(s, fault);
}
