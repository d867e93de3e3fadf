/* cdem --version: release, commit, build and the libraries it runs with, to stdout. */
#ifndef CDEM_TOOLS_VERSION_H
#define CDEM_TOOLS_VERSION_H

void version_print(void);

#endif
