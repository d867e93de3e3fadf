/* Which library this is, for `cdem --version`, summary.json and the files that say what wrote them.
 */
#ifndef CDEM_BASE_VERSION_H
#define CDEM_BASE_VERSION_H

/* "1.0.0": semantic; what it promises stands in docs/reference/library.md. */
const char *cdem_version(void);

/* What git says of the sources at the time of the build, "22d8d69" or "v1.0.0-3-g22d8d69", with
 * "-dirty" behind it where files differ from the commit; "unknown" for sources without git that are
 * no archive of it. A file of its own, commit.c, which program and library alone are linked with.
 */
const char *cdem_version_commit(void);

/* Compiler, kind of build and what was chosen: "GNU 12.2.0, Release, OpenMP 4.5, kernels for three
 * generations of processors". */
const char *cdem_version_build(void);

#endif
