/* The files of a run folder: frames, history, states, locks. */
#ifndef CDEM_IO_RUN_FILES_H
#define CDEM_IO_RUN_FILES_H

#include "mesh/mesh.h"
#include "results/frame.h"
#include "results/map.h"
#include "results/results.h"
#include "results/state.h"

#include <stdbool.h>

/* ---- frames: FOLDER/SET.pvd and FOLDER/SET/SET-000012.vtu (frames_vtk.c) ---- */

typedef struct cdem_frame_writer cdem_frame_writer;
/* The folder is made where it is missing. resume_from: frames from this index on, left by a broken
 * run, are forgotten and their files removed; 0: a new run, which forgets all. Lists of others are
 * left alone. Each frame is on disk, and the .pvd rewritten, when the sink returns. The sink takes
 * names of sets of letters, digits, _ and -. */
cdem_status cdem_frame_writer_create(const char *folder, int64_t resume_from,
                                     cdem_frame_writer **writer, cdem_fault *fault);
cdem_frame_sink cdem_frame_writer_sink(cdem_frame_writer *writer);
void cdem_frame_writer_destroy(cdem_frame_writer **writer);

/* ---- history: a CSV that grows (history_file.c) ---- */

typedef struct cdem_history_writer cdem_history_writer;
/* The table gives the columns (its rows are not written); header `name [unit]`. keep_rows: rows of
 * a broken run to keep; 0: a new file. CDEM_INPUT when the file has fewer or other columns. */
cdem_status cdem_history_create(const char *path, const cdem_table *columns, int64_t keep_rows,
                                cdem_history_writer **writer, cdem_fault *fault);
/* Appends and flushes the last row of the table. */
cdem_status cdem_history_append(cdem_history_writer *writer, const cdem_table *table,
                                cdem_fault *fault);
void cdem_history_destroy(cdem_history_writer **writer);
/* Reads a history back (all columns real). */
cdem_status cdem_read_history(const char *path, cdem_table *table, cdem_fault *fault);

/* ---- summary.json, read back as far as runs are compared by it (summary_file.c) ---- */

/* A key result, and how the case takes it. Units and settings that are null or, in older files,
 * missing: NULL and NaN. */
typedef struct {
  char *name, *unit;
  double value; /* NaN: the run has none */
  char *of, *take;
  double from, to, factor;                 /* s, s, - */
  double reference, difference, tolerance; /* NaN: none */
} cdem_summary_result;

/* A text or a number at the top of the summary ("steps") or among its checksums ("checksums.mesh"),
 * in the order of the file; null: NULL. */
typedef struct {
  char *name, *text;
  double number; /* NaN: the text is none */
} cdem_summary_fact;

typedef struct {
  double wall_time; /* s */
  int64_t results;
  cdem_summary_result *result; /* [results], in the order of the case */
  int64_t facts, fact_capacity;
  cdem_summary_fact *fact; /* [facts] */
  int64_t warnings;
  char **warning; /* [warnings] that the run gave */
} cdem_summary_file;

/* CDEM_INPUT, with line, column and caret, for a file that is broken, changed or something else. */
cdem_status cdem_read_summary(const char *path, cdem_summary_file *summary, cdem_fault *fault);
/* Safe on a zeroed summary and twice. */
void cdem_summary_file_release(cdem_summary_file *summary);
/* The text of a fact, NULL where there is none. */
const char *cdem_summary_fact_find(const cdem_summary_file *summary, const char *name);

/* ---- states: HDF5, replaced as a whole (state_file.c, mesh_state.c) ---- */

/* Every bit of every array comes back. A file that was cut short or changed by one byte is
 * CDEM_INPUT: it carries its own checksum. */
cdem_status cdem_write_state(const char *path, const cdem_state *state, cdem_fault *fault);
cdem_status cdem_read_state(const char *path, cdem_state *state, cdem_fault *fault);
/* A mesh as arrays "PREFIX/xyz" ... of a state (borrowed), and back. */
cdem_status cdem_mesh_to_state(const cdem_mesh *mesh, const char *prefix, cdem_state *state,
                               cdem_fault *fault);
cdem_status cdem_mesh_from_state(const cdem_state *state, const char *prefix, cdem_mesh *mesh,
                                 cdem_fault *fault);

/* ---- folder and lock (folder.c) ---- */

/* Removes the pictures that were drawn into a folder, with the scripts and data that drew them;
 * what else is there stays, and so does the folder. No failure when there is none. */
cdem_status cdem_clear_figures(const char *folder, cdem_fault *fault);
/* Removes what processes that were killed have left of unfinished files in a folder of a run and in
 * the folders right below it; for who holds the lock. */
cdem_status cdem_clear_parts(const char *folder, cdem_fault *fault);
/* Makes a new folder for files that nobody keeps; path receives its name. */
cdem_status cdem_make_scratch(char path[64], cdem_fault *fault);
/* Removes it with all that is in it; any other folder is left alone. */
void cdem_remove_scratch(const char *path);
/* Makes a folder and those above it; no failure when it is there. */
cdem_status cdem_make_folder(const char *path, cdem_fault *fault);
/* Takes FOLDER/.lock (flock; gone with the process) in a folder that is there. CDEM_INPUT "is in
 * use by another run (process N)". */
typedef struct cdem_folder_lock cdem_folder_lock;
cdem_status cdem_folder_lock_take(const char *folder, cdem_folder_lock **lock, cdem_fault *fault);
void cdem_folder_lock_drop(cdem_folder_lock **lock);
/* Reads a whole text file; *text newly allocated, ended by zero. CDEM_INPUT when there is a zero
 * byte in it. */
cdem_status cdem_read_text(const char *path, char **text, cdem_fault *fault);

/* ---- looking at a folder (listing.c) ---- */

typedef struct {
  char *name;
  bool folder;
  int64_t bytes;
  int64_t changed; /* s since 1970, UTC */
} cdem_listed;

typedef struct {
  int64_t count, capacity;
  cdem_listed *item; /* [count] in the order of their names' bytes */
} cdem_listing;

/* Files and folders in a folder; names with a dot in front are left out. */
cdem_status cdem_list_folder(const char *path, cdem_listing *listing, cdem_fault *fault);
/* Safe on a zeroed listing and twice. */
void cdem_listing_release(cdem_listing *listing);
/* NULL: not there. */
const cdem_listed *cdem_listing_find(const cdem_listing *listing, const char *name);
/* The process that holds the lock of a folder; 0: none. */
int64_t cdem_folder_holder(const char *folder);
/* A whole file as it is; *data newly allocated. */
cdem_status cdem_read_bytes(const char *path, unsigned char **data, int64_t *bytes,
                            cdem_fault *fault);
/* The way from a file, whose folder is there, to a folder: "../run/"; "" where they are the same.
 * Newly allocated. */
cdem_status cdem_relative_path(const char *file, const char *folder, char **way, cdem_fault *fault);

/* ---- maps (map_gnuplot.c) ---- */
/* Draws FOLDER/NAME.png and .svg, keeping .gp and .dat, as cdem_write_figure does. */
cdem_status cdem_write_map(const char *folder, const char *name, const cdem_map *map,
                           cdem_fault *fault);

#endif
