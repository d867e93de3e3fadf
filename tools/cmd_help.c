/* cdem help [COMMAND|TOPIC] */
#include "command.h"
#include "io/case_file.h"

#include <string.h>

static const char overview[] = "cdem: finite-element stiffness as springs, for "
                               "continuum-discontinuum models of rock and soil\n"
                               "\n"
                               "Usage: cdem COMMAND [OPTION...] [OPERAND...]\n"
                               "\n";

static const char topics_text[] = "\n"
                                  "`cdem COMMAND --help` shows a command's options, `cdem help "
                                  "signs|errors|files|case` explains\n"
                                  "the sign rules of springs, the exit codes, the material file, "
                                  "and the case file of `cdem run`\n"
                                  "(`cdem help case interfaces.tension`: one key).\n";

static const char own_usage[] =
    "Usage: cdem help [COMMAND|TOPIC]\n"
    "Help on a command, or on a topic: signs, errors, files, case.\n"
    "\n"
    "`cdem help case KEY` explains a section or a key of case files, `cdem help case --schema`\n"
    "writes their JSON Schema, `cdem help case --markdown` their reference.\n";

static const char signs[] =
    "signs and forms of springs\n"
    "  The spring tensor of the node pair i, j is S = -K_ij: the force on i from j is S (u_j - "
    "u_i), and\n"
    "  S_ji is the transpose. The rows of a spring set rebuild it:\n"
    "      S = sum over rows of dir (x) (stiffness * dual + coupling * dual of spring couples_to)\n"
    "  diagonal  one stiffness a direction, no coupling\n"
    "  complex   one real spring and a pair a +- ib: springs 2 and 3 have stiffness a and "
    "couplings +b, -b\n"
    "  jordan2   a double value with one direction: spring 2 is coupled to 3\n"
    "  jordan3   a triple value with one direction: 1 is coupled to 2, 2 to 3\n"
    "  frame     a transversely isotropic pair as four springs: one along its axis, three across "
    "at 120 degrees\n"
    "  Classes: edge, face, body = the smallest entity of the element that holds both nodes.\n"
    "  Plane Cosserat: S acts on d_j - T d_i, T the rigid transport from i to j; rotations in "
    "rad,\n"
    "  counter-clockwise; dir_rz and dual_rz are multiplied by the column `length`.\n";

static const char files[] =
    "material file (YAML, units by UDUNITS, plain numbers are SI)\n"
    "  one material for all:            several, by mesh group:\n"
    "    young: 40 GPa                    materials:\n"
    "    poisson: 0.25                      granite: {young: 40 GPa, poisson: 0.25}\n"
    "                                       shale: {model: orthotropic, e1: 20 GPa, ...}\n"
    "                                     groups: {rock: granite, layer: shale}\n"
    "                                     default: granite\n"
    "  `cdem list materials` shows the models and their keys. Orthotropic and anisotropic "
    "materials may be\n"
    "  turned: axis1: [x, y, z] and axis2: [x, y, z] are the material axes 1 and 2 in the mesh "
    "(axis 2 is made\n"
    "  perpendicular to axis 1).\n";

static void print_errors(void) {
  printf("exit codes\n");
  for (int status = 0; status < CDEM_STATUS_COUNT; status++)
    printf("  %3d  %s\n", cdem_status_exit_code((cdem_status)status),
           cdem_status_text((cdem_status)status));
}

/* cdem help case [TOPIC | --schema | --markdown] */
static int help_case(int arguments, char **argument) {
  cdem_fault fault = {0};
  cdem_status status;
  const char *topic = arguments > 0 ? argument[0] : NULL;
  if (arguments > 1)
    command_usage("cdem help case: one section or key, or --schema, or --markdown");
  if (topic != NULL && strcmp(topic, "--schema") == 0)
    status = cdem_write_case_schema(stdout, &fault);
  else if (topic != NULL && strcmp(topic, "--markdown") == 0)
    status = cdem_write_case_reference(stdout, &fault);
  else if (topic != NULL && topic[0] == '-')
    command_usage("cdem help case: there is no option '%s'; there are --schema (JSON Schema for "
                  "editors) and --markdown",
                  topic);
  else
    status = cdem_write_case_help(stdout, topic, &fault);
  return status == CDEM_OK ? 0 : command_fail(&fault);
}

static void print_overview(void) {
  fputs(overview, stdout);
  for (const command *c = commands; c->name != NULL; c++)
    printf("  %-10s %s\n", c->name, c->summary);
  fputs(topics_text, stdout);
}

int cmd_help(int argc, char **argv) {
  const char *topic = argc > 1 ? argv[1] : NULL;
  if (topic == NULL) {
    print_overview();
    return 0;
  }
  if (strcmp(topic, "--help") == 0 || strcmp(topic, "help") == 0) {
    fputs(own_usage, stdout);
    return 0;
  }
  if (strcmp(topic, "case") == 0)
    return help_case(argc - 2, argv + 2);
  if (strcmp(topic, "signs") == 0)
    fputs(signs, stdout);
  else if (strcmp(topic, "files") == 0)
    fputs(files, stdout);
  else if (strcmp(topic, "errors") == 0)
    print_errors();
  else {
    for (const command *c = commands; c->name != NULL; c++)
      if (strcmp(c->name, topic) == 0) {
        char called[64], option[] = "--help";
        snprintf(called, sizeof called, "cdem %s", c->name);
        char *arguments[] = {called, option, NULL};
        return c->run(2, arguments);
      }
    command_usage(
        "there is no help on '%s'; topics are signs, errors, files, case and the commands", topic);
  }
  return 0;
}
