/* What a run refuses once it has the mesh or the grains: the message says what is wrong, and no
 * folder is made (check_bad). */
#include "run/support.h"

static void plates_out_of_the_plane(void **state) {
  (void)state;
  write_case("body.yaml",
             "end: 1 us\n"
             "mesh: {shape: quad4, count: [4, 2], size: [2 m, 1 m]}\n"
             "plates: {lid: {point: [1, 1], normal: [0, -1], axis: [1, 0]}}\n"
             "materials: {rock: {young: 30 GPa, poisson: 0.25, density: 2700 kg/m3}}\n");
  check_bad("body.yaml", "plates.lid.normal=[0, 0, 1]", "leave the z component out");
  check_bad("body.yaml", "plates.lid.axis=[1, 0, 1]", "leave the z component out");
  check_bad("body.yaml", "plates.lid.axis=[0, 2]", "must not be zero or along its normal");
}

#define GRAINS                                                                                     \
  "end: 1 us\n"                                                                                    \
  "contacts: [{normal_stiffness: 1e5, friction: 0.5, restitution: 1}]\n"                           \
  "walls: {floor: {shape: mesh, file: floor.stl}}\n"

static void walls_and_materials_of_grains(void **state) {
  (void)state;
  write_case("two.csv", "x,y,z,radius\n0,0,1,0.1\n0,0,2,0.1\n");
  write_case("floor.stl", "solid f\nfacet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 -1 0\n"
                          "vertex 0 1 0\nendloop\nendfacet\nendsolid f\n");
  write_case("grains.yaml",
             GRAINS "grains: {dimension: 3, file: two.csv, materials: {sand: {density: 2600}}}\n");
  check_bad("grains.yaml", "walls.floor.group=lid", "'floor.stl' has no group 'lid'");
  write_case("light.yaml", GRAINS "grains: {dimension: 3, file: two.csv, materials: {sand: {}}}\n");
  check_bad("light.yaml", "title=light", "material 'sand' of the grains needs 'density'");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plates_out_of_the_plane),
      cmocka_unit_test(walls_and_materials_of_grains),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
