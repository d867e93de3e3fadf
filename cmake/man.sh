#!/bin/sh
# Man pages from --help: cdem.1 and one page a command, by help2man.
# usage: man.sh PROGRAM SOURCE_FOLDER VERSION OUTPUT_FOLDER
set -eu
program=$1 source=$2 version=$3 out=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"
# The date of a page is that of the commit, so that the same sources give the same pages.
if [ -z "${SOURCE_DATE_EPOCH:-}" ]; then
  SOURCE_DATE_EPOCH=$(git -C "$source" log -1 --format=%ct 2>/dev/null || date +%s)
fi
export SOURCE_DATE_EPOCH LC_ALL=C

commands=$(sed -n 's/^X(\([a-z]*\),.*/\1/p' "$source/tools/commands.def")
summary() { sed -n "s/^X($1, \"\\(.*\\)\").*/\\1/p" "$source/tools/commands.def"; }

# What no --help says, for the end of page NAME.
more() {
  cat <<EOF
[EXIT STATUS]
0 success, 1 a requested check failed, 2 wrong usage, 3 bad input,
4 numerical failure, 5 out of memory, 6 file error, 130 interrupted.

[ENVIRONMENT]
.B OMP_NUM_THREADS
is the number of threads where no option says it. Results do not depend on it.

[FILES]
.I /usr/share/cdem
holds cases, meshes and materials to begin with.

[COPYRIGHT]
License GPL-3.0-or-later: you may change and share this program; there is no
warranty.

[SEE ALSO]
EOF
  for command in $commands; do
    [ "$1" = "cdem-$command" ] || list="${list:-}${list:+,
}.BR cdem-$command (1)"
  done
  [ "$1" = cdem ] || printf '.BR cdem (1),\n'
  printf '%s\n.PP\nThe pages in\n.I /usr/share/doc/cdem\n' "$list" | sed 's/(1),$/ (1),/; s/(1)$/ (1)/; s/  (/ (/'
}

# help2man takes a program's name from its file.
page() { # NAME SUMMARY COMMAND...
  name=$1 text=$2
  shift 2
  printf '#!/bin/sh\nexec "%s" %s "$@"\n' "$program" "$*" >"$work/$name"
  chmod +x "$work/$name"
  (list=; more "$name") >"$work/more"
  help2man --no-info --section=1 --name="$text" --version-string="$version" --source="cdem $version" \
    --manual="cdem" --include="$work/more" "$work/$name" >"$work/page"
  # The command belongs to the name of the program; titles of groups of options are headings; examples stay as typed;
  # the date is one that mandoc can read; other lines end before column 80.
  awk -v command="$*" -v date="$(date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%d)" '
    function put(line,   n) {
      while (!typed && line !~ /^\./ && length(line) > 79) {
        for (n = 79; n > 1 && substr(line, n, 1) != " "; n--) ;
        if (n == 1) break
        print substr(line, 1, n - 1)
        line = substr(line, n + 1)
      }
      print line
    }
    /^\.TH / { sub(/"[A-Z][a-z]+ [0-9]+"/, date) }
    /^\.SH / && typed { print ".fi"; typed = 0 }
    $0 == "Examples:" || $0 == ".SH EXAMPLES" { print ".SH EXAMPLES"; print ".nf"; typed = 1; next }
    typed && ($0 == ".IP" || $0 == ".PP") { next }
    typed && $0 == ".HP" { getline; print "    " $0; next }
    held == ".IP" { held = ""; if (/^[A-Z][^.]*:$/) { sub(/:$/, ""); print ".SS \"" $0 "\""; next } print ".IP" }
    held == ".B cdem" { held = ""
      if (command != "" && sub("^\\\\fI\\\\," command " \\\\/\\\\fR", "")) { print ".B cdem " command; put($0); next }
      print ".B cdem" }
    $0 == ".IP" || $0 == ".B cdem" { held = $0; next }
    { put($0) }' "$work/page" >"$out/$name.1"
}

page cdem "finite-element stiffness as springs; rock and soil that break"
for command in $commands; do
  page "cdem-$command" "$(summary "$command")" "$command"
done
for file in "$out"/cdem*.1; do
  gzip -9nf "$file"
done
