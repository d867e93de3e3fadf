/* What `cdem springs` says about a network, as text for people and as JSON for scripts. */
#ifndef CDEM_TOOLS_SPRINGS_REPORT_H
#define CDEM_TOOLS_SPRINGS_REPORT_H

#include "network/certificate.h"
#include "network/deplete.h"
#include "springs_options.h"

#include <stdio.h>

typedef struct {
  const char *mesh; /* path */
  const cdem_model *model;
  bool certified, depleted;
  cdem_certificate certificate;
  cdem_depletion depletion;
  int64_t pairs_written;
  int outputs;
  const char *const *output; /* [outputs] paths */
  cdem_carried carried[MOST_OUTPUTS];
  double seconds; /* of the conversion */
} springs_report;

void springs_report_text(const springs_report *report, FILE *stream);
void springs_report_json(const springs_report *report, FILE *stream);

#endif
