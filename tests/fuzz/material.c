/* Material files. */
#include "fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  cdem_fault fault = {0};
  cdem_material_file file = {0};
  if (fuzz_is_read(cdem_read_materials(fuzz_file(data, size), &file, &fault), &fault))
    for (int a = 0; a < file.assignments; a++)
      fuzz_require(file.material_of[a] >= 0 && file.material_of[a] < file.materials,
                   "group '%s' has material %d of %d", file.group[a], file.material_of[a],
                   file.materials);
  cdem_material_file_release(&file);
  return 0;
}
