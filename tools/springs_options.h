/* The command line of `cdem springs`. */
#ifndef CDEM_TOOLS_SPRINGS_OPTIONS_H
#define CDEM_TOOLS_SPRINGS_OPTIONS_H

#include "command.h"
#include "io/io.h"
#include "network/deplete.h"

enum { MOST_OUTPUTS = 8, MOST_GROUPS = 64, MOST_REMOVALS = 64 };

typedef struct {
  const char *mesh, *material_file, *format, *figures;
  cdem_material material;
  bool young, nu, cosserat_modulus, characteristic_length, couple_factor, plane, thickness, certify,
      json;
  cdem_section section;
  double length;
  int groups, outputs, removals, degree;
  const char *group[MOST_GROUPS], *output[MOST_OUTPUTS];
  cdem_removal removal[MOST_REMOVALS];
  cdem_convert_options convert;
  cdem_carry carry;
  int64_t mode_rows;
} springs_settings;

/* Reads and checks the command line; what is wrong there ends the program. */
void springs_options_parse(int argc, char **argv, springs_settings *settings);

/* The writer of an output: by --format, or by the ending of its path. */
const cdem_springs_format *springs_format_of(const springs_settings *settings, const char *path);

#endif
