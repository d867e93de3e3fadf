/* Private to tools: the page docs/reference/verification.md. */
#ifndef CDEM_TOOLS_VERIFY_PAGE_H
#define CDEM_TOOLS_VERIFY_PAGE_H

#include "results/results.h"

/* Prints every check of the program as Markdown, with the values of `list`; a check that is not in
 * it has a dash for its value. */
void verify_print_page(const cdem_check_list *list);

#endif
