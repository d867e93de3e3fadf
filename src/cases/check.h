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

#endif
