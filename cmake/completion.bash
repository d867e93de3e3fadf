# bash completion of cdem: commands, options as --help shows them, topics, files.
_cdem() {
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} words IFS=$'\n'
  if [ "$COMP_CWORD" -eq 1 ]; then
    words=$(cdem --help 2>/dev/null | sed -n 's/^  \([a-z]*\)  .*/\1/p'; printf '%s\n' --help --version)
  elif [ "$command" = help ]; then
    words=$(cdem --help 2>/dev/null | sed -n 's/^  \([a-z]*\)  .*/\1/p'; printf '%s\n' signs errors files case)
  elif [ "${word#-}" != "$word" ]; then
    words=$(cdem "$command" --help 2>/dev/null | grep -oE -- '--[a-z][a-z-]*' | sort -u)
  else
    # shellcheck disable=SC2207
    COMPREPLY=($(compgen -f -- "$word"))
    return
  fi
  # shellcheck disable=SC2207
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}
complete -o filenames -F _cdem cdem
