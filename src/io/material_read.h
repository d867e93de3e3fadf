/* Private to io: quantities and materials in YAML trees, for material files and cases alike. */
#ifndef CDEM_IO_MATERIAL_READ_H
#define CDEM_IO_MATERIAL_READ_H

#include "io/io.h"
#include "io/units.h"
#include "io/yaml_tree.h"

/* A quantity with a unit. False after an error, which stands at the value and names `key`. */
bool cdem_yaml_quantity(cdem_yaml *yaml, cdem_units *units, const cdem_yaml_node *at,
                        const char *key, cdem_dimension dimension, double *value);

/* Model, axes and moduli of a material; errors go to the tree. `mark` is where the material begins;
 * others [other_keys] are keys of the map that belong to somebody else. The name is left alone. */
void cdem_yaml_material(cdem_yaml *yaml, cdem_units *units, const cdem_yaml_node *map,
                        const cdem_yaml_node *mark, const char *const *others, int other_keys,
                        cdem_material *material);

#endif
