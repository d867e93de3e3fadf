/* Private to cases: the checks that join several keys. Each gives the first failure with its place.
 */
#ifndef CDEM_CASES_CHECK_H
#define CDEM_CASES_CHECK_H

#include "cases/schema.h"

/* "SECTION[INDEX].KEY", "SECTION.NAME.KEY": two at a time are good. */
const char *cdem_case_item_key(char path[CDEM_CASE_PATH], const char *section, int64_t index,
                               const char *key);
const char *cdem_case_named_key(char path[CDEM_CASE_PATH], const char *section, const char *name,
                                const char *key);

/* Both of two keys below `prefix` ("interfaces[0]") were given. */
cdem_status cdem_case_check_exclusive(const cdem_case *cases, const char *prefix, const char *one,
                                      const char *other, cdem_fault *fault);

/* check_action.c */
cdem_status cdem_case_check_supports(const cdem_case *cases, cdem_fault *fault);
cdem_status cdem_case_check_loads(const cdem_case *cases, cdem_fault *fault);
cdem_status cdem_case_check_plates(const cdem_case *cases, cdem_fault *fault);
cdem_status cdem_case_check_initial(const cdem_case *cases, cdem_fault *fault);
cdem_status cdem_case_check_output(const cdem_case *cases, cdem_fault *fault);

/* check_body.c */
cdem_status cdem_case_check_mesh(const cdem_case *cases, cdem_fault *fault);
cdem_status cdem_case_check_materials(const cdem_case *cases, cdem_fault *fault);
cdem_status cdem_case_check_interfaces(const cdem_case *cases, cdem_fault *fault);

/* check_grains.c: a run of grains as a whole. */
cdem_status cdem_case_check_grains(const cdem_case *cases, cdem_fault *fault);
/* Keys of the one kind of run in the other. */
cdem_status cdem_case_check_kind(const cdem_case *cases, cdem_fault *fault);
/* check_coupling.c: grains inside a body. */
cdem_status cdem_case_check_coupling(const cdem_case *cases, cdem_fault *fault);
/* check_triaxial.c */
cdem_status cdem_case_check_triaxial(const cdem_case *cases, cdem_fault *fault);
/* check_walls.c */
cdem_status cdem_case_check_walls(const cdem_case *cases, cdem_fault *fault);
cdem_status cdem_case_check_cell(const cdem_case *cases, cdem_fault *fault);
/* Texts that must be x, y, z. */
cdem_status cdem_case_check_directions(const cdem_case *cases, const char *key,
                                       const cdem_case_texts *directions, cdem_fault *fault);
/* A material of grains; NULL as a name: the first. CDEM_INPUT at the key when there is none. */
cdem_status cdem_case_check_grain_material(const cdem_case *cases, const char *key,
                                           const char *name, cdem_fault *fault);

#endif
