#!/bin/sh
# Runs that are killed (SIGKILL) at random moments, continued, killed again ..., and brought to their end: the same bits
# as unbroken ones, in every file. The moments are drawn from a seed: while the program starts, between two rows, as soon
# as an unfinished file stands in the folder, near the end with its pictures. In which phase a run was hit is read from
# what it left, and told at the end.
# usage: kill.sh BUILD_FOLDER SOURCE_FOLDER KILLS SEED
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
. "$2/tests/cli/runs.sh"
cases=$2/tests/robust/cases
kills=$3
seed=$4
export OMP_NUM_THREADS=1

# One line a kind of run: its case, and overrides that make it long enough to be hit.
cat >kinds <<'EOC'
breaking.yaml end=4ms checkpoint_every=20us frame_every=0.1ms history_every=10us
bonded.yaml end=20ms checkpoint_every=0.1ms frame_every=0.5ms history_every=50us
membrane.yaml checkpoint_every=50us frame_every=0.5ms history_every=20us
deformable.yaml end=1ms checkpoint_every=10us frame_every=50us history_every=5us
coupled.yaml end=40ms checkpoint_every=0.2ms frame_every=1ms history_every=0.1ms
EOC

# A number from 0 to $1 - 1: the generator of Park & Miller (1988), which the shell's whole numbers hold.
draw() {
  seed=$((seed * 16807 % 2147483647))
  drawn=$((seed % $1))
}

# start FOLDER: a new run, or the rest of one that has a checkpoint; its number in $process
start() {
  if [ -e "$1/checkpoint.h5" ]; then
    "$cdem" run -q --resume "$1" >out 2>&1 &
  else
    "$cdem" run -q "$case" $sets -o "$1" >out 2>&1 &
  fi
  process=$!
}

alive() {
  kill -0 $process 2>/dev/null
}

# until_true COMMAND: tries it again and again while the run lives
until_true() {
  while alive && ! eval "$1"; do :; done
}

pause() {
  sleep "$(printf '0.%03d' "$1")"
}

# aim FOLDER: waits for a random moment of the run
aim() {
  last=$(rows_of whole)
  draw 5
  case $drawn in
    0) draw 400; pause $drawn ;;
    1) until_true '[ -e "$1/.checkpoint.h5.part-$process" ]' ;;
    2) draw 3; [ $drawn -eq 0 ] || until_true 'ls -A "$1"/* 2>/dev/null | grep -q part' ;;
    3) until_true "[ \$(rows_of $1) -ge $last ]"; draw 200; pause $drawn ;;
    *) now=$(rows_of "$1"); draw $((last - now + 1)); until_true "[ \$(rows_of $1) -ge $((now + drawn)) ]"
       draw 30; pause $drawn ;;
  esac
}

# phase FOLDER: in which one it was killed, from what it left
phase() {
  if [ ! -e "$1/checkpoint.h5" ]; then echo start
  elif ls -A "$1" "$1"/*/ | grep -q '^\.checkpoint.*part'; then echo checkpoint
  elif ls -A "$1" "$1"/*/ | grep -q 'part-'; then echo frame
  elif [ -e "$1/history.csv" ] && [ -n "$(tail -c 1 "$1/history.csv")" ]; then echo row
  elif [ "$(rows_of "$1")" -ge "$(rows_of whole)" ]; then echo end
  else echo steps
  fi
}

# break_once FOLDER: starts it and kills it; false when it has ended before
break_once() {
  start "$1"
  aim "$1"
  kill -9 $process 2>/dev/null || true
  code=0
  wait $process 2>/dev/null || code=$?
  [ $code -eq 0 ] && return 1
  [ $code -eq 137 ] || { echo "$case: exit code $code"; cat out; exit 1; }
  [ ! -e "$1/summary.json" ] || return 0 # killed between its last file and its end
  if [ ! -e "$1/checkpoint.h5" ] && [ -e "$1/.lock" ]; then
    "$cdem" run -q --resume "$1" 2>err && exit 1
    grep -q '^error: there is no run to continue .*anew' err || { cat err; exit 1; }
  fi
  phase "$1" >>phases
}

: >phases
kind=0 done=0
while read -r name sets; do
  case=$cases/$name
  sets=$(for set in $sets; do printf -- '--set %s ' "$set"; done)
  kind=$((kind + 1))
  rm -rf whole killed
  "$cdem" run -q "$case" $sets -o whole >out 2>&1 || { cat out; exit 1; }
  attempts=0
  while [ "$(wc -l <phases)" -lt $((kills * kind / 5)) ]; do
    attempts=$((attempts + 1))
    [ $attempts -lt $((20 * kills)) ] || { echo "$name: it ends before it can be killed"; exit 1; }
    if ! break_once killed || [ -e killed/summary.json ]; then
      same killed
      rm -rf killed
    fi
  done
  if [ -e killed ]; then
    start killed
    wait $process || { echo "$name: $(cat out)"; exit 1; }
    same killed
  fi
done <kinds
echo "$(wc -l <phases) kills of 5 kinds of run, each continued to the same bits; by phase:"
sort phases | uniq -c
