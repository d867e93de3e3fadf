/* What the address and leak sanitizers pass over in test programs that call gmsh. One a program. */
#ifndef CDEM_TESTS_SUPPORT_SANITIZERS_H
#define CDEM_TESTS_SUPPORT_SANITIZERS_H

/* gmsh 4.8 and Open CASCADE leak a little and release arrays as single objects; what they do is not
 * ours to mend, and what we allocate is still watched. Read by the sanitizers only. */
const char *__asan_default_options(void);
const char *__lsan_default_suppressions(void);
const char *__asan_default_options(void) {
  return "alloc_dealloc_mismatch=0";
}
const char *__lsan_default_suppressions(void) {
  return "leak:libgmsh\nleak:libTK\n";
}

#endif
