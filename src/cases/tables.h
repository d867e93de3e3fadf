/* Private to cases: words of the tables of keys. */
#ifndef CDEM_CASES_TABLES_H
#define CDEM_CASES_TABLES_H

#include "cases/schema.h"

#include <math.h>
#include <stddef.h>

/* Exponents of length, time, mass. */
#define RATIO                                                                                      \
  { 0, 0, 0 }
#define LENGTH                                                                                     \
  { 1, 0, 0 }
#define AREA                                                                                       \
  { 2, 0, 0 }
#define TIME                                                                                       \
  { 0, 1, 0 }
#define RATE                                                                                       \
  { 0, -1, 0 }
#define VELOCITY                                                                                   \
  { 1, -1, 0 }
#define ACCELERATION                                                                               \
  { 1, -2, 0 }
#define DENSITY                                                                                    \
  { -3, 0, 1 }
#define FORCE                                                                                      \
  { 1, -2, 1 }
#define MOMENT                                                                                     \
  { 2, -2, 1 }
#define PRESSURE                                                                                   \
  { -1, -2, 1 }
#define BEDDING /* Pa/m */                                                                         \
  { -2, -2, 1 }
#define STIFFNESS /* N/m */                                                                        \
  { 0, -2, 1 }
#define TURNING_STIFFNESS /* N m/rad */                                                            \
  { 2, -2, 1 }
#define TOUGHNESS /* J/m^2 */                                                                      \
  { 0, -2, 1 }

#define AT(type, member)  .key = #member, .offset = offsetof(type, member)
#define POSITIVE          .least = 0, .most = INFINITY, .above = true
#define NOT_NEGATIVE      .least = 0, .most = INFINITY
#define AT_LEAST(value)   .least = (value), .most = INFINITY
#define BETWEEN(low, top) .least = (low), .most = (top)
#define GRAIN             .tag = CDEM_TAG_GRAIN
#define LAW               .tag = CDEM_TAG_LAW
#define DOMAIN            .tag = CDEM_TAG_DOMAIN

#define SECTION(title, type, keys_, ...)                                                           \
  {                                                                                                \
    .name = title, .size = sizeof(type), .keys = (int)(sizeof(keys_) / sizeof *(keys_)),           \
    .key = keys_, __VA_ARGS__                                                                      \
  }

/* One table a file. */
extern const cdem_case_section cdem_section_mesh, cdem_section_materials, cdem_section_blocks,
    cdem_section_interfaces, cdem_section_contact, cdem_section_supports, cdem_section_loads,
    cdem_section_plates, cdem_section_initial, cdem_section_probes, cdem_section_curves,
    cdem_section_results, cdem_section_grains, cdem_section_contacts, cdem_section_walls,
    cdem_section_bonds, cdem_section_cell, cdem_section_region, cdem_section_coupling,
    cdem_section_triaxial;

#endif
