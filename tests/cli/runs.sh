# Shared by the scripts that break runs: sourced with $1 the build folder, after a `cd` to an empty folder. The unbroken
# run is in the folder `whole`, or in the one that $whole names.
cdem=$1/cdem
same_state=$1/tests/cli/test_cli_same_state
whole=whole
export OMP_WAIT_POLICY=passive OPENBLAS_NUM_THREADS=1

# Whole rows of a history, the header too.
rows_of() {
  if [ -e "$1/history.csv" ]; then wc -l <"$1/history.csv"; else echo 0; fi
}

# wait_for_rows FOLDER ROWS PROCESS: until the history has come that far
wait_for_rows() {
  tries=0
  while [ "$(rows_of "$1")" -lt "$2" ]; do
    kill -0 "$3" 2>/dev/null || { echo "$1: ended before it could be broken"; exit 1; }
    tries=$((tries + 1))
    [ $tries -lt 6000 ] || { echo "$1: no rows appeared"; exit 1; }
    sleep 0.01
  done
}

# A summary but for the wall time and for names of files: a continued run does not know the path of the case, and its own
# case names files from the root on.
summary_of() {
  sed -E '/^ *"(wall_time|wall_fine|wall_coarse|wall_transfer|grain_steps_per_second|case|file|threads)":/d' "$1/summary.json"
}

# Everything but what holds the wall time.
same() {
  [ -s "$1/summary.json" ] && [ -s "$1/checkpoint.h5" ] || { echo "$1: not ended"; exit 1; }
  diff -r -x .lock -x summary.json -x checkpoint.h5 $whole "$1" || { echo "$1: files differ"; exit 1; }
  summary_of $whole >expected.json
  summary_of "$1" | diff expected.json - || { echo "$1: summaries differ"; exit 1; }
  "$same_state" $whole/checkpoint.h5 "$1/checkpoint.h5" || { echo "$1: checkpoints differ"; exit 1; }
}
